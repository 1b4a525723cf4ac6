//! The non-negative solution is compared with the best one of all choices of unknowns above zero.

mod interval;
mod problem;

use super::*;
use crate::numerics::{
    real::{double, real},
    test_random::Random,
};
use problem::Problem;

/// The number of observations of a random problem.
const ROWS: usize = 24;
/// The number of unknowns of the largest random problem.
const MOST: usize = 8;

/// The tolerance for solutions of well separated columns, relative to the largest unknown.
const DIGITS: f64 = if cfg!(feature = "double") {
    1e-11
} else {
    1e-4
};

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, x| x.abs().max(most))
}

/// Calls `check` with well separated columns: every pivot of the scaled equations is above a tenth.
fn separated(mut check: impl FnMut(&Problem, &mut Random)) {
    let mut random = Random::new(952);
    let mut checked = 0;
    while checked < 400 {
        let count = 2 + random.below(MOST - 1);
        let problem = Problem::random(count, &mut random, |_, _| {});
        let all = (1 << count) - 1;
        let variance = |i| problem.eliminated(all, |j| f64::from(u8::from(i == j)));
        let told = (0..count).all(|i| variance(i).is_some_and(|column| column[i] < 10.0));
        if told {
            check(&problem, &mut random);
            checked += 1;
        }
    }
}

#[test]
fn the_non_negative_solution_is_the_best_over_all_sets_of_free_unknowns() {
    let mut at_zero = 0;
    separated(|problem, _| {
        let (solution, free) = problem
            .equations()
            .solve_non_negative(&PassiveSet::default());
        let (best, _) = problem.best(0);
        let found = problem.scaled(&solution);
        for i in 0..problem.count {
            let off = (found[i] - best[i]).abs();
            assert!(off <= DIGITS * largest(&best), "{found:?}, not {best:?}");
            assert_eq!(free.has(i), found[i] > 0.0);
            at_zero += u32::from(!free.has(i));
        }
    });
    assert!(at_zero > 400, "the constraint matters");
}

#[test]
fn solutions_fulfil_the_optimality_conditions_of_karush_kuhn_and_tucker() {
    separated(|problem, _| {
        let (solution, free) = problem
            .equations()
            .solve_non_negative(&PassiveSet::default());
        let found = problem.scaled(&solution);
        let size = libm::sqrt(problem.size);
        for i in 0..problem.count {
            let slope = problem.slope(&found, i) / size;
            let allowed = if free.has(i) { slope.abs() } else { slope };
            assert!(found[i] >= 0.0);
            assert!(allowed <= DIGITS, "slope {slope:e} of unknown {i}");
        }
    });
}

#[test]
fn unknowns_that_are_held_stay_at_zero() {
    separated(|problem, random| {
        let pinned = random.bits() & ((1 << problem.count) - 1);
        let chosen = PassiveSet::of(|i| pinned >> i & 1 == 1);
        let (solution, free) = problem.equations().solve_non_negative(&chosen);
        let (best, _) = problem.best(pinned);
        let found = problem.scaled(&solution);
        for i in 0..problem.count {
            assert!(!(chosen.has(i) && (free.has(i) || found[i] != 0.0)));
            let off = (found[i] - best[i]).abs();
            assert!(off <= DIGITS * largest(&best), "{found:?}, not {best:?}");
        }
    });
}

#[test]
fn any_initial_guess_leads_to_the_same_solution() {
    separated(|problem, random| {
        let guess = random.bits();
        let guess = PassiveSet::of(|i| i < problem.count && guess >> i & 1 == 1);
        let equations = problem.equations();
        let (found, free) = equations.solve_non_negative_near(&guess, &PassiveSet::default());
        let (expected, expected_free) = equations.solve_non_negative(&PassiveSet::default());
        assert_eq!(free, expected_free);
        let (found, expected) = (problem.scaled(&found), problem.scaled(&expected));
        for i in 0..problem.count {
            assert!((found[i] - expected[i]).abs() <= DIGITS * largest(&expected));
        }
    });
}

#[test]
fn solutions_and_covariances_of_free_unknowns_equal_those_of_elimination() {
    separated(|problem, random| {
        let chosen = 1 + random.below((1 << problem.count) - 1) as u32;
        let free = PassiveSet::of(|i| chosen >> i & 1 == 1);
        let equations = problem.equations();
        let expected = problem.unknowns(chosen).expect("separated");
        let found = equations.solve_free(&free).expect("separated");
        let found = problem.scaled(&found);
        assert!((0..MOST).all(|i| (found[i] - expected[i]).abs() <= DIGITS * largest(&expected)));
        if chosen + 1 == 1 << problem.count {
            let all = problem.scaled(&equations.solve().expect("separated"));
            assert_eq!(all, found);
        }
        for i in (0..problem.count).filter(|&i| free.has(i)) {
            let unit = |j| f64::from(u8::from(i == j));
            let expected = problem.eliminated(chosen, unit).expect("separated");
            let column = equations.column(i, &free).expect("separated");
            let column = problem.scaled(&column);
            let size = problem.length(i);
            for j in 0..problem.count {
                let off = (column[j] * size - expected[j]).abs();
                assert!(off <= DIGITS * largest(&expected));
            }
            let variance = double(equations.variance(i, &free).expect("separated"));
            let off = variance * size * size / expected[i] - 1.0;
            assert!(off.abs() <= DIGITS);
        }
    });
}

#[test]
fn exchanging_an_unknown_equals_setting_the_equations_with_it() {
    separated(|problem, random| {
        let place = random.below(problem.count);
        let mut before = problem.equations();
        // Another column stands in this place first.
        let other = |j| real(if j == place { 7.0 } else { 0.5 });
        assert!(before.exchange(place, &other, 3.0).is_ok());
        let entry = |j: usize| real(problem.h[place][j]);
        let right = real(problem.b[place]);
        assert!(before.exchange(place, &entry, right).is_ok());
        let (found, free) = before.solve_non_negative(&PassiveSet::default());
        let (expected, expected_free) = problem
            .equations()
            .solve_non_negative(&PassiveSet::default());
        assert_eq!(free, expected_free);
        let (found, expected) = (problem.scaled(&found), problem.scaled(&expected));
        for i in 0..problem.count {
            assert!((found[i] - expected[i]).abs() <= DIGITS * largest(&expected));
        }
    });
}

#[test]
fn the_explained_part_is_the_decrease_of_the_sum_of_squares() {
    separated(|problem, random| {
        // The unknowns are random, so that they are usually not the best ones.
        let solution = Vector::from_fn(|i| {
            if i < problem.count {
                real(random.signed() / problem.length(i))
            } else {
                0.0
            }
        });
        let found = double(problem.equations().explained(&solution));
        let expected = problem.explained(&problem.scaled(&solution));
        let most = DIGITS * (problem.size + expected.abs());
        assert!((found - expected).abs() <= most, "{found}, not {expected}");
    });
}

#[test]
fn the_scale_of_columns_does_not_change_the_solution() {
    // The squares of the columns' lengths fill the range of single precision.
    let decades = if cfg!(feature = "double") { 60.0 } else { 8.0 };
    let mut random = Random::new(3);
    for _ in 0..300 {
        let count = 2 + random.below(MOST - 1);
        let mut scales = [1.0; MOST];
        for scale in &mut scales[..count] {
            *scale = libm::pow(10.0, decades * random.signed());
        }
        let plain = Problem::random(count, &mut random, |_, _| {});
        let mut scaled = Problem { ..plain };
        for i in 0..count {
            scaled.b[i] *= scales[i];
            for j in 0..count {
                scaled.h[i][j] *= scales[i] * scales[j];
            }
        }
        let (solution, _) = scaled
            .equations()
            .solve_non_negative(&PassiveSet::default());
        let explained = plain.explained(&scaled.scaled(&solution));
        let (_, best) = plain.best(0);
        assert!(
            (explained - best).abs() <= DIGITS * plain.size,
            "{explained} of {best}"
        );
    }
}

#[test]
fn the_size_of_the_data_does_not_change_the_solution() {
    let mut random = Random::new(5);
    for _ in 0..300 {
        let count = 2 + random.below(MOST - 1);
        let plain = Problem::random(count, &mut random, |_, _| {});
        // The data range from a hundredth of a standard error to a million standard errors.
        let factor = libm::pow(10.0, 2.0 + 4.0 * random.signed());
        let scaled = Problem {
            b: plain.b.map(|b| b * factor),
            ..plain
        };
        let (solution, _) = scaled
            .equations()
            .solve_non_negative(&PassiveSet::default());
        let found = scaled.scaled(&solution).map(|x| x / factor);
        assert!(found.iter().all(|&x| x >= 0.0));
        let (_, best) = plain.best(0);
        let lost = best - plain.explained(&found);
        assert!(lost.abs() <= DIGITS * plain.size, "{lost:e} at {factor:e}");
    }
}

#[test]
fn nearly_equal_columns_lose_little_of_the_explained_squares() {
    // A pivot below the smallest allowed one is refused. It would explain a difference of its own size
    // at most.
    let most = 10.0 * libm::sqrt(double(LEAST_PIVOT));
    let mut random = Random::new(4);
    let mut refused = 0;
    for _ in 0..600 {
        let count = 2 + random.below(MOST - 1);
        let difference = libm::pow(10.0, -4.0 + 4.0 * random.signed());
        let difference = if random.below(4) == 0 {
            0.0
        } else {
            difference
        };
        let problem = Problem::random(count, &mut random, |columns, random| {
            let from = random.below(count);
            let to = (from + 1) % count;
            let copied = columns[from];
            columns[to] = copied.map(|x| x * (1.0 + difference * random.signed()));
        });
        let equations = problem.equations();
        let (solution, _) = equations.solve_non_negative(&PassiveSet::default());
        let found = problem.scaled(&solution);
        assert!(found.iter().all(|&x| x >= 0.0 && x.is_finite()));
        let (_, best) = problem.best(0);
        let lost = (best - problem.explained(&found)) / problem.size;
        assert!(lost <= most, "{lost:e} of {best}, {difference:e} apart");
        // Such pivots are below the smallest allowed one: two columns that differ by their rounding
        // cannot be told apart.
        if difference < 0.3 * libm::sqrt(double(LEAST_PIVOT)) {
            assert!(equations.solve().is_err(), "{difference:e} apart");
            refused += 1;
        }
    }
    assert!(refused > 100, "{refused} problems were singular");
}

#[test]
fn columns_that_are_zero_or_not_finite_are_refused() {
    for bad in [0.0, -1.0, Real::NAN, Real::INFINITY] {
        for place in 0..3 {
            let diagonal = |i: usize| if i == place { bad } else { 1.0 };
            let mut equations = NormalEquations::EMPTY;
            let set = equations.set(3, &|i, row| {
                row.put(i, diagonal(i));
                1.0
            });
            assert_eq!(set, Err(Error::Singular));
            let mut equations = NormalEquations::EMPTY;
            let set = equations.set(3, &|i, row| {
                row.put(i, 1.0);
                1.0
            });
            assert!(set.is_ok());
            let unit = |j: usize| if j == place { bad } else { 0.0 };
            assert_eq!(equations.exchange(place, &unit, 1.0), Err(Error::Singular));
        }
    }
}
