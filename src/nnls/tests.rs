//! The non-negative solution against the best of all choices of unknowns above zero.

use super::*;
use crate::{
    real::{double, real},
    test_random::Random,
};

/// Observations of a random problem.
const ROWS: usize = 24;
/// Unknowns of the largest random problem.
const MOST: usize = 8;

/// What a solution of well separated columns may differ by, relative to the largest unknown.
const DIGITS: f64 = if cfg!(feature = "double") {
    1e-11
} else {
    1e-4
};

/// A least-squares problem in double precision: `H = A'A` and `b = A'y`, with `|y|²`.
struct Problem {
    count: usize,
    h: [[f64; MOST]; MOST],
    b: [f64; MOST],
    size: f64,
}

impl Problem {
    /// Random columns and random data, with the columns changed by `shape(columns, random)` first.
    fn random(
        count: usize,
        random: &mut Random,
        shape: impl Fn(&mut [[f64; ROWS]], &mut Random),
    ) -> Self {
        let mut columns = [[0.0; ROWS]; MOST];
        for column in &mut columns[..count] {
            // Positive in the mean, as variances are: columns resemble one another.
            *column = core::array::from_fn(|_| random.signed() + 0.3);
        }
        shape(&mut columns[..count], random);
        // Half of the true unknowns are negative, so that the constraint matters.
        let mut data = [0.0; ROWS];
        for column in &columns[..count] {
            let size = libm::sqrt(column.iter().map(|x| x * x).sum());
            let unknown = random.signed() / size.max(1e-300);
            for (data, element) in data.iter_mut().zip(column) {
                *data += unknown * element + 0.1 * random.signed();
            }
        }
        Self::of(&columns[..count], &data)
    }

    fn of(columns: &[[f64; ROWS]], data: &[f64; ROWS]) -> Self {
        let dot = |x: &[f64; ROWS], y: &[f64; ROWS]| x.iter().zip(y).map(|(x, y)| x * y).sum();
        let mut problem = Self {
            count: columns.len(),
            h: [[0.0; MOST]; MOST],
            b: [0.0; MOST],
            size: dot(data, data),
        };
        for (i, one) in columns.iter().enumerate() {
            problem.b[i] = dot(one, data);
            for (j, other) in columns.iter().enumerate() {
                problem.h[i][j] = dot(one, other);
            }
        }
        problem
    }

    fn equations(&self) -> NormalEquations {
        let mut equations = NormalEquations::empty();
        let set = equations.set(self.count, &|i, row| {
            for j in 0..=i {
                row.put(j, real(self.h[i][j]));
            }
            real(self.b[i])
        });
        assert!(set.is_ok());
        equations
    }

    /// The length of a column.
    fn length(&self, i: usize) -> f64 {
        libm::sqrt(self.h[i][i])
    }

    /// The unknowns of a choice, in units of one over their columns' length, by Gauss's elimination with
    /// pivots. `None` if a pivot is rounding.
    fn eliminated(&self, chosen: u32, right: impl Fn(usize) -> f64) -> Option<[f64; MOST]> {
        let places = || (0..self.count).filter(|i| chosen >> i & 1 == 1);
        // The identity, where nothing is chosen.
        let mut rows: [[f64; MOST + 1]; MOST] =
            core::array::from_fn(|i| core::array::from_fn(|j| f64::from(u8::from(i == j))));
        for i in places() {
            for j in places() {
                rows[i][j] = self.h[i][j] / (self.length(i) * self.length(j));
            }
            rows[i][MOST] = right(i);
        }
        for i in 0..self.count {
            let size = |k: &usize| rows[*k][i].abs();
            let pivot = (i..self.count).max_by(|a, b| size(a).total_cmp(&size(b)))?;
            rows.swap(i, pivot);
            if rows[i][i].abs() < 1e-13 {
                return None;
            }
            for k in 0..self.count {
                if k != i {
                    let factor = rows[k][i] / rows[i][i];
                    let own = rows[i];
                    for (element, own) in rows[k].iter_mut().zip(own) {
                        *element -= factor * own;
                    }
                }
            }
        }
        Some(core::array::from_fn(|i| {
            if i < self.count {
                rows[i][MOST] / rows[i][i]
            } else {
                0.0
            }
        }))
    }

    /// The same for the data.
    fn unknowns(&self, chosen: u32) -> Option<[f64; MOST]> {
        self.eliminated(chosen, |i| self.b[i] / self.length(i))
    }

    /// The slope `b − H x` of scaled unknowns, in scaled units.
    fn slope(&self, x: &[f64; MOST], i: usize) -> f64 {
        let products = (0..self.count).map(|j| self.h[i][j] / self.length(j) * x[j]);
        (self.b[i] - products.sum::<f64>()) / self.length(i)
    }

    /// How far scaled unknowns lower the sum of squared residuals.
    fn explained(&self, x: &[f64; MOST]) -> f64 {
        let part = |i: usize| x[i] * (self.b[i] / self.length(i) + self.slope(x, i));
        (0..self.count).map(part).sum()
    }

    /// The best of all choices without a negative unknown, those of `held` at zero.
    fn best(&self, held: u32) -> ([f64; MOST], f64) {
        let choices = (0..1_u32 << self.count).filter(|chosen| chosen & held == 0);
        let solutions = choices.filter_map(|chosen| self.unknowns(chosen));
        let allowed = solutions.filter(|x| x.iter().all(|&x| x >= 0.0));
        let judged = allowed.map(|x| (x, self.explained(&x)));
        judged
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or(([0.0; MOST], 0.0))
    }

    /// A solution in scaled units.
    fn scaled(&self, solution: &Vector) -> [f64; MOST] {
        core::array::from_fn(|i| {
            if i < self.count {
                double(solution[i]) * self.length(i)
            } else {
                0.0
            }
        })
    }
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, x| x.abs().max(most))
}

/// Calls with well separated columns: every pivot of the scaled equations is above a tenth.
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
fn the_non_negative_solution_is_the_best_of_all_choices() {
    let mut at_zero = 0;
    separated(|problem, _| {
        let (solution, free) = problem.equations().solve_non_negative(&Free::default());
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
fn slopes_vanish_above_zero_and_point_below_zero_elsewhere() {
    separated(|problem, _| {
        let (solution, free) = problem.equations().solve_non_negative(&Free::default());
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
        let held = random.bits() & ((1 << problem.count) - 1);
        let chosen = Free::of(|i| held >> i & 1 == 1);
        let (solution, free) = problem.equations().solve_non_negative(&chosen);
        let (best, _) = problem.best(held);
        let found = problem.scaled(&solution);
        for i in 0..problem.count {
            assert!(!(chosen.has(i) && (free.has(i) || found[i] != 0.0)));
            let off = (found[i] - best[i]).abs();
            assert!(off <= DIGITS * largest(&best), "{found:?}, not {best:?}");
        }
    });
}

#[test]
fn a_guess_right_or_wrong_leads_to_the_same_solution() {
    separated(|problem, random| {
        let guess = random.bits();
        let guess = Free::of(|i| i < problem.count && guess >> i & 1 == 1);
        let equations = problem.equations();
        let (found, free) = equations.solve_non_negative_near(&guess, &Free::default());
        let (expected, expected_free) = equations.solve_non_negative(&Free::default());
        assert_eq!(free, expected_free);
        let (found, expected) = (problem.scaled(&found), problem.scaled(&expected));
        for i in 0..problem.count {
            assert!((found[i] - expected[i]).abs() <= DIGITS * largest(&expected));
        }
    });
}

#[test]
fn solutions_and_covariances_of_free_unknowns_are_those_of_elimination() {
    separated(|problem, random| {
        let chosen = 1 + random.below((1 << problem.count) - 1) as u32;
        let free = Free::of(|i| chosen >> i & 1 == 1);
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
fn an_exchanged_unknown_leaves_the_equations_that_it_would_have_made() {
    separated(|problem, random| {
        let place = random.below(problem.count);
        let mut before = problem.equations();
        // Another column stood there before.
        let other = |j| real(if j == place { 7.0 } else { 0.5 });
        assert!(before.exchange(place, &other, 3.0).is_ok());
        let entry = |j: usize| real(problem.h[place][j]);
        let right = real(problem.b[place]);
        assert!(before.exchange(place, &entry, right).is_ok());
        let (found, free) = before.solve_non_negative(&Free::default());
        let (expected, expected_free) = problem.equations().solve_non_negative(&Free::default());
        assert_eq!(free, expected_free);
        let (found, expected) = (problem.scaled(&found), problem.scaled(&expected));
        for i in 0..problem.count {
            assert!((found[i] - expected[i]).abs() <= DIGITS * largest(&expected));
        }
    });
}

#[test]
fn what_a_solution_explains_is_what_it_takes_off_the_squares() {
    separated(|problem, random| {
        // Of any unknowns, the best ones or not.
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
fn columns_of_any_scale_make_no_difference() {
    // The squares of the lengths fill the range of single precision.
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
        let (solution, _) = scaled.equations().solve_non_negative(&Free::default());
        let explained = plain.explained(&scaled.scaled(&solution));
        let (_, best) = plain.best(0);
        assert!(
            (explained - best).abs() <= DIGITS * plain.size,
            "{explained} of {best}"
        );
    }
}

#[test]
fn data_of_any_size_make_no_difference() {
    let mut random = Random::new(5);
    for _ in 0..300 {
        let count = 2 + random.below(MOST - 1);
        let plain = Problem::random(count, &mut random, |_, _| {});
        // From a hundredth of a standard error to a million.
        let factor = libm::pow(10.0, 2.0 + 4.0 * random.signed());
        let scaled = Problem {
            b: plain.b.map(|b| b * factor),
            ..plain
        };
        let (solution, _) = scaled.equations().solve_non_negative(&Free::default());
        let found = scaled.scaled(&solution).map(|x| x / factor);
        assert!(found.iter().all(|&x| x >= 0.0));
        let (_, best) = plain.best(0);
        let lost = best - plain.explained(&found);
        assert!(lost.abs() <= DIGITS * plain.size, "{lost:e} at {factor:e}");
    }
}

#[test]
fn columns_that_resemble_one_another_cost_little_of_what_can_be_explained() {
    // A pivot below the least one is refused: it would explain a difference of its size at most.
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
        let (solution, _) = equations.solve_non_negative(&Free::default());
        let found = problem.scaled(&solution);
        assert!(found.iter().all(|&x| x >= 0.0 && x.is_finite()));
        let (_, best) = problem.best(0);
        let lost = (best - problem.explained(&found)) / problem.size;
        assert!(lost <= most, "{lost:e} of {best}, {difference:e} apart");
        // Pivots below the least one: nothing is told of two columns that differ by their rounding.
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
            let mut equations = NormalEquations::empty();
            let set = equations.set(3, &|i, row| {
                row.put(i, diagonal(i));
                1.0
            });
            assert_eq!(set, Err(Error::Singular));
            let mut equations = NormalEquations::empty();
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
