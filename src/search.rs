//! The shape of an effect that would explain a curve best.

use crate::{
    effect::{Effect, MAX_PARAMETERS, SearchRange, Span},
    error::Error,
    fit::{
        Problem,
        weights::{Weights, Whitened},
    },
    list::numbered,
    math,
    model::{MAX_EFFECTS, Term},
    nnls::{Free, NormalEquations, Vector},
    real::{Real, real},
};

/// The 95 % quantile of χ² with one degree of freedom.
const RISE: Real = 3.841_459;
/// Halvings of the step in a refinement: from half a grid step to a 32nd.
const HALVINGS: usize = 5;

/// The fit of a curve with one effect of any shape among others whose shapes are known, in units in
/// which octaves are independent.
pub(crate) struct Search<'a, 'b, const K: usize> {
    problem: &'a Problem<'b, K>,
    weights: &'a Weights<K>,
    /// Standard errors of the octaves are those of the measured curve instead of the model's.
    to_measured: bool,
    whitened: Whitened<K>,
    /// Those of the others, and of the shape that was tried last.
    equations: NormalEquations,
    /// The effect's place among the others.
    place: usize,
    free: Free,
    held: Free,
}

impl<'a, 'b, const K: usize> Search<'a, 'b, K> {
    /// With no effect chosen. With `to_measured`, the covariance is rescaled to the measured curve:
    /// before an effect is found, the model is too far off to say how much the octaves that it
    /// dominates scatter.
    #[inline(always)]
    pub(crate) fn new(
        problem: &'a Problem<'b, K>,
        weights: &'a Weights<K>,
        to_measured: bool,
    ) -> Self {
        Self {
            problem,
            weights,
            to_measured,
            whitened: Whitened::empty(),
            equations: NormalEquations::empty(),
            place: 0,
            free: Free::default(),
            held: Free::default(),
        }
    }

    /// Chooses an effect by its `place`: that of the effect it replaces, or the first behind the
    /// others. The effects above zero are guessed to be those for which `squares` are.
    ///
    /// # Errors
    /// [`Error::TooManyEffects`] without such a place, [`Error::Singular`].
    #[inline(never)]
    pub(crate) fn at(&mut self, place: usize, squares: &Vector) -> Result<(), Error> {
        if place >= MAX_EFFECTS {
            return Err(Error::TooManyEffects {
                capacity: MAX_EFFECTS,
            });
        }
        let (problem, weights, to_measured) = (self.problem, self.weights, self.to_measured);
        if self.whitened.columns.is_empty() {
            let scatter = |k| scatter(problem, weights, to_measured, k);
            weights.whiten_into(problem, &scatter, &mut self.whitened);
        }
        let Whitened { columns, curve } = &self.whitened;
        let own = |i: usize| columns.get(i);
        self.equations
            .set(columns.len().max(place.saturating_add(1)), &|i, row| {
                for j in 0..=i {
                    let element = match (i == place || j == place, own(i).zip(own(j))) {
                        (false, Some((one, other))) => one.dot(other),
                        _ => real(u8::from(i == j)),
                    };
                    row.put(j, element);
                }
                own(i).map_or(0.0, |column| column.dot(curve))
            })?;
        self.place = place;
        self.held = self.problem.held();
        self.held.drop(place);
        let held = self.held;
        let above = |i: usize| i < MAX_EFFECTS && squares[i] > 0.0;
        self.free = Free::of(|i| i == place || (above(i) && !held.has(i)));
        Ok(())
    }

    /// With the effects that are held at zero free as well.
    pub(crate) fn release(&mut self) {
        self.held = Free::default();
    }

    /// χ² with the effect in a shape, and the squared coefficients.
    #[inline(never)]
    fn with(&mut self, term: &Term) -> (Real, Vector) {
        let without = (Real::INFINITY, Vector::zeros());
        let unit = self.problem.column(term);
        let scatter = |k| scatter(self.problem, self.weights, self.to_measured, k);
        let (column, size) = self
            .weights
            .whiten_trial(self.problem, &scatter, &|k| unit[k]);
        let column = column.map(|x| real(x) * size);
        let others = &self.whitened.columns;
        let exchanged = self.equations.exchange(
            self.place,
            &|i| match others.get(i) {
                Some(other) if i != self.place => other.dot(&column),
                _ => column.norm_squared(),
            },
            column.dot(&self.whitened.curve),
        );
        if exchanged.is_err() {
            return without;
        }
        let equations = &self.equations;
        let (squares, _) = equations.solve_non_negative_near(&self.free, &self.held);
        let chi_squared = self.whitened.curve.norm_squared() - equations.explained(&squares);
        (chi_squared, squares)
    }

    /// The best shape of an effect on its grid, refined.
    #[inline(never)]
    pub(crate) fn search(&mut self, effect: &'static dyn Effect, span: &Span) -> Found {
        let mut term = Term::fitted(effect);
        let mut best = Found {
            term,
            chi_squared: Real::INFINITY,
            squares: Vector::zeros(),
        };
        let ranges: [Grid; MAX_PARAMETERS] = core::array::from_fn(|i| Grid::of(effect, i, span));
        for first in 0..ranges[0].steps {
            for second in 0..ranges[1].steps {
                term.parameters = [ranges[0].at(first), ranges[1].at(second)];
                best.improve(term, self.with(&term));
            }
        }
        let steps = ranges.map(|grid| 0.5 * grid.log_step);
        self.refine(best, steps, &ranges)
    }

    /// The best shape near one that is known, within 10 %.
    #[inline(never)]
    pub(crate) fn refine_known(&mut self, term: Term, span: &Span) -> Found {
        let (chi_squared, squares) = self.with(&term);
        let found = Found {
            term,
            chi_squared,
            squares,
        };
        let ranges = core::array::from_fn(|i| Grid::of(term.effect, i, span));
        self.refine(found, [0.1; MAX_PARAMETERS], &ranges)
    }

    /// [`interval`](Self::interval) around a known shape, joined with those of the other values of a
    /// whole-numbered parameter that explain the curve as well.
    #[inline(never)]
    pub(crate) fn joint_interval(&mut self, term: Term, j: usize, span: &Span) -> (Real, Real) {
        let (chi_squared, squares) = self.with(&term);
        let known = Found {
            term,
            chi_squared,
            squares,
        };
        let (mut lower, mut upper) = self.interval(&known, j, span);
        let parameters = 0..term.effect.parameters().len().min(MAX_PARAMETERS);
        for whole in parameters.filter(|&i| term.effect.is_whole(i)) {
            let grid = Grid::of(term.effect, whole, span);
            for step in 0..grid.steps {
                let mut other = term;
                other.set_parameter(whole, grid.at(step));
                let found = self.refine_known(other, span);
                if found.chi_squared < chi_squared + RISE {
                    let interval = self.interval(&found, j, span);
                    lower = interval.0.min(lower);
                    upper = interval.1.max(upper);
                }
            }
        }
        (lower, upper)
    }

    /// The interval of an effect's only fitted parameter in which χ² stays within that of 95 % of the
    /// least, all coefficients free: also where another effect could take the shape's place.
    #[inline(never)]
    pub(crate) fn interval(&mut self, best: &Found, j: usize, span: &Span) -> (Real, Real) {
        let grid = Grid::of(best.term.effect, j, span);
        let value = best.term.parameter(j);
        let mut rise = |factor: Real| {
            let mut term = best.term;
            term.set_parameter(j, value * factor);
            self.with(&term).0 - best.chi_squared
        };
        let mut end = |direction: Real| {
            // Doubling steps of the logarithm until outside, then halving.
            let (mut inside, mut step) = (0.0, 0.005);
            loop {
                let at = inside + step;
                let reached = value * math::exp(direction * at);
                if !(grid.low..=grid.high).contains(&reached) {
                    return if direction < 0.0 {
                        grid.low.min(value)
                    } else {
                        grid.high.max(value)
                    };
                }
                if rise(math::exp(direction * at)) > RISE {
                    break;
                }
                inside = at;
                step *= 2.0;
            }
            for _ in 0..6 {
                step *= 0.5;
                if rise(math::exp(direction * (inside + step))) <= RISE {
                    inside += step;
                }
            }
            value * math::exp(direction * inside)
        };
        (end(-1.0), end(1.0))
    }

    /// Goes downhill from a shape, one parameter after the other, in steps of the logarithm that
    /// are halved whenever none helps.
    #[inline(never)]
    fn refine(
        &mut self,
        start: Found,
        mut steps: [Real; MAX_PARAMETERS],
        ranges: &[Grid; MAX_PARAMETERS],
    ) -> Found {
        let mut best = start;
        for _ in 0..HALVINGS {
            for (j, (step, range)) in numbered(steps.iter_mut().zip(ranges)) {
                if !best.term.fitted_parameters().any(|fitted| fitted == j) {
                    continue;
                }
                for sign in [1.0, -1.0] {
                    let mut term = best.term;
                    let value = term.parameter(j) * math::exp(sign * *step);
                    term.set_parameter(j, value.max(range.low).min(range.high));
                    if best.improve(term, self.with(&term)) {
                        break;
                    }
                }
                *step *= 0.5;
            }
        }
        best
    }
}

/// How much more than the model says octave `k` scatters.
fn scatter<const K: usize>(
    problem: &Problem<'_, K>,
    weights: &Weights<K>,
    to_measured: bool,
    k: usize,
) -> Real {
    match problem.points.get(k) {
        Some(_) if to_measured => problem.measured(k) / weights.model[k],
        _ => 1.0,
    }
}

/// A shape, and what it would make of the curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    pub(crate) term: Term,
    pub(crate) chi_squared: Real,
    /// The effect's at its place in the search.
    pub(crate) squares: Vector,
}

impl Found {
    fn improve(&mut self, term: Term, (chi_squared, squares): (Real, Vector)) -> bool {
        let better = chi_squared < self.chi_squared;
        if better {
            *self = Self {
                term,
                chi_squared,
                squares,
            };
        }
        better
    }
}

/// Evenly spaced logarithms, or whole numbers.
#[derive(Clone, Copy, Debug)]
struct Grid {
    low: Real,
    high: Real,
    /// Zero for whole numbers.
    log_step: Real,
    steps: u32,
}

impl Grid {
    /// For a parameter that an effect does not have.
    const SINGLE: Self = Self {
        low: 0.0,
        high: 0.0,
        log_step: 0.0,
        steps: 1,
    };

    /// Of a parameter; a single step for one that the effect does not have.
    fn of(effect: &dyn Effect, parameter: usize, span: &Span) -> Self {
        let Some(range) = effect.search_range(parameter, span) else {
            return Self::SINGLE;
        };
        if effect.is_whole(parameter) {
            return Self {
                low: range.low,
                high: range.high,
                log_step: 0.0,
                steps: ((range.high - range.low) as u32).saturating_add(1),
            };
        }
        Self::new(range)
    }

    fn new(range: SearchRange) -> Self {
        let high = range.high.max(range.low);
        let octaves = math::log2_roughly(high / range.low);
        // A step more or less does not matter: the last is held at the upper end.
        let steps = ((octaves * range.steps_per_octave) as u32).saturating_add(2);
        Self {
            low: range.low,
            high,
            log_step: math::log(high / range.low) / real(steps.saturating_sub(1)),
            steps,
        }
    }

    /// The value after so many steps.
    fn at(&self, step: u32) -> Real {
        if step == 0 {
            return self.low;
        }
        if self.log_step == 0.0 {
            return self.low + real(step);
        }
        (self.low * math::exp(self.log_step * real(step))).min(self.high)
    }
}
