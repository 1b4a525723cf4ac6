//! The ends of intervals are compared with bisections, in which the others are the best of all choices.

use super::{super::PassiveSet, separated};
use crate::numerics::{
    nnls::tests::problem::Problem,
    real::{by_precision, double, real},
};

/// The value on one side of the best one at which the sum of squares has risen by `rise`; zero if it has not
/// risen as far there.
fn end(problem: &Problem, i: usize, best: f64, least: f64, rise: f64, up: bool) -> f64 {
    let risen = |value: f64| least - problem.explained_beside(i, value);
    let (mut inside, mut outside) = (best, 0.0);
    if up {
        outside = best + 1.0;
        while risen(outside) < rise {
            outside += outside - best;
        }
    } else if risen(0.0) <= rise {
        return 0.0;
    }
    for _ in 0..30 {
        let middle = 0.5 * (inside + outside);
        if risen(middle) < rise {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}

#[test]
fn intervals_end_where_the_best_fit_of_the_others_has_risen_so_far() {
    let tolerance = double(by_precision(1e-5, 2e-3));
    let (mut wider, mut at_zero, mut checked) = (0, 0, 0);
    separated(|problem, _| {
        // All choices of a few unknowns are tried for every value.
        if problem.count > 4 {
            return;
        }
        let equations = problem.equations();
        let none = PassiveSet::default();
        let (solution, free) = equations.solve_non_negative(&none);
        let (best, least) = problem.best(0);
        for rise in [0.05, 0.5] {
            for i in (0..problem.count).filter(|&i| best[i] > 0.0) {
                let found = equations.interval(i, &solution, &free, &none, real(rise));
                let found = found.expect("separated");
                let length = problem.length(i);
                for (found, up) in [(found.lower, false), (found.upper, true)] {
                    let expected = end(problem, i, best[i], least, rise, up);
                    let off = double(found) * length - expected;
                    let width = (expected - best[i]).abs().max(0.1);
                    assert!(
                        off.abs() <= tolerance * width,
                        "unknown {i} of {best:?}: {}, not {expected}; up: {up}, rise {rise}",
                        double(found) * length
                    );
                }
                let spread = length * libm::sqrt(double(found.variance) * rise);
                let low = double(found.lower) * length;
                at_zero += u32::from(low == 0.0);
                wider += u32::from(low > 0.0 && best[i] - low > 1.01 * spread);
                checked += 1;
            }
        }
    });
    assert!(
        checked > 400 && wider > 5 && at_zero > 50,
        "{checked} {wider} {at_zero}"
    );
}
