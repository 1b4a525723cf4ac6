//! The shapes of a model, polished by the likelihood of a fit: the covariance follows the model.

use crate::{
    error::Error,
    evidence::observed::Observed,
    fit::{Problem, ShapeEquations, Start, Tolerance, Work},
    limits::MAX_SHAPE,
    numerics::{
        math,
        nnls::Vector,
        real::{Real, real, single},
    },
    pause::{Pause, Stop, call},
    theory::{effect::Span, model::Model},
};
use heapless::Vec;

/// The largest number of rounds of fitting a candidate and polishing its shapes. Chosen by hand.
/// `cargo xtask study hidden-effect` runs with this value and does not vary it.
const ROUNDS: u8 = 10;
/// The rounds end when `−2 ln L` changes by less than this. Chosen by hand, to save rounds: it is small
/// compared with the improvement of 8 for which an effect is accepted.
const SETTLED: Real = 0.5;
/// The largest step of a shape's logarithm. Chosen by hand: a round changes a shape by at most 22 %.
/// `cargo xtask study hidden-effect` runs with this value and does not vary it.
const STRIDE: Real = 0.2;
/// How often a step may be halved because it led too far. Chosen by hand: the last step is then a
/// sixteenth of the first. `cargo xtask study hidden-effect` runs with this value and does not vary it.
const HALVINGS: u8 = 4;

/// Changes of the logarithms of fitted shapes, with the place of the effect and of the parameter.
type Steps = Vec<(u8, u8, f32), MAX_SHAPE>;

/// A model, and the squared coefficients at which its covariance is taken.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    pub(super) model: Model,
    pub(super) squares: Vector,
    /// χ² at the polished shapes; infinite before.
    pub(super) chi_squared: Real,
}

impl Fitted {
    /// Changes the logarithms of shapes within their ranges.
    fn change(&mut self, steps: &Steps, sign: Real, span: &Span) {
        for &(i, j, step) in steps {
            let (j, step) = (usize::from(j), real(step));
            let Some(term) = self.model.terms_mut().get_mut(usize::from(i)) else {
                continue;
            };
            let Some(range) = term.effect.search_range(j, span) else {
                continue;
            };
            let changed = term.parameter(j) * math::exp(sign * step);
            let highest = range.high.max(range.low);
            term.set_parameter(j, changed.max(range.low).min(highest));
        }
    }
}

/// The rounds of polishing a model. Each takes the covariance, fits the coefficients, and changes the shapes by the method of
/// Gauss and Newton.
struct Rounds {
    present: Fitted,
    /// The best model so far, and its score.
    kept: Option<(Fitted, Real)>,
    before: Real,
    steps: Steps,
    halvings: u8,
}

/// Fits a model, and polishes its shapes.
///
/// # Errors
/// As of [`polish`].
#[inline(never)]
pub(super) fn polished<const K: usize, const B: usize>(
    observed: Observed<'_, K, B>,
    model: Model,
    granted: Tolerance,
    pause: &mut Pause<'_>,
) -> Result<Fitted, Stop> {
    call(pause)?;
    let mut work = Work::<K, B>::NEW;
    work.solve(observed, &model, Start::Independent, granted, pause)?;
    let (squares, tolerance) = (work.solver.squares, work.solver.weights.tolerance);
    let fitted = Fitted {
        model,
        squares,
        chi_squared: Real::INFINITY,
    };
    let mut polished = polish(observed, fitted, tolerance, &mut work, pause)?;
    polished.chi_squared = work.solver.chi_squared;
    Ok(polished)
}

/// Polishes the shapes of a model. Returns it with the squares at which its covariance was taken, and leaves its solution, with
/// fixed shapes, in the memory.
///
/// # Errors
/// An error means that the model cannot be fitted.
#[inline(never)]
fn polish<const K: usize, const B: usize>(
    observed: Observed<'_, K, B>,
    fitted: Fitted,
    tolerance: Real,
    work: &mut Work<K, B>,
    pause: &mut Pause<'_>,
) -> Result<Fitted, Stop> {
    let span = observed.span();
    let tolerance = Tolerance::Fixed(tolerance);
    let mut rounds = Rounds {
        present: fitted,
        kept: None,
        before: Real::INFINITY,
        steps: Steps::new(),
        halvings: 0,
    };
    for _ in 0..ROUNDS {
        let present = &rounds.present;
        let start = Start::Once(present.squares);
        work.solve(observed, &present.model, start, tolerance, pause)?;
        let problem = Problem::new(observed, &present.model, &work.columns);
        work.derivatives.clear();
        loop {
            call(pause)?;
            if work.derivatives.advance(&problem, &work.solver.squares) {
                break;
            }
        }
        if !rounds.end(observed, &span, work) {
            break;
        }
    }
    let (mut fitted, _) = rounds.kept.ok_or(Error::Singular)?;
    let start = Start::From(fitted.squares);
    work.solve(observed, &fitted.model, start, tolerance, pause)?;
    fitted.squares = work.solver.assumed;
    Ok(fitted)
}

impl Rounds {
    /// Ends a round whose coefficients are fitted: changes the shapes. Returns whether there is a next round.
    #[inline(never)]
    fn end<const K: usize, const B: usize>(
        &mut self,
        observed: Observed<'_, K, B>,
        span: &Span,
        work: &Work<K, B>,
    ) -> bool {
        let problem = Problem::new(observed, &self.present.model, &work.columns);
        let mut next = Steps::new();
        let confused = changes(&problem, work, &mut next);
        self.present.squares = work.solver.squares;
        let now = work.solver.minus_two_log_likelihood();
        match confused {
            Some(confused) => {
                // This is another model, whose scores cannot be compared with the earlier ones.
                if let Some(term) = self.present.model.terms_mut().get_mut(confused) {
                    term.pinned = true;
                }
                self.present.squares.put(confused, 0.0);
                self.before = Real::INFINITY;
                true
            }
            None => self.step(now, next, span),
        }
    }

    /// Keeps a round that is the best so far, and changes the shapes for the next round. Returns
    /// whether there is a next round.
    fn step(&mut self, now: Real, next: Steps, span: &Span) -> bool {
        let gain = self.before - now;
        let is_best = self.kept.as_ref().is_none_or(|(_, score)| now < *score);
        if is_best {
            self.kept = Some((self.present.clone(), now));
        }
        if gain > -SETTLED {
            if gain < SETTLED {
                if let Some((fitted, _)) = self.kept.as_mut().filter(|_| is_best) {
                    fitted.change(&next, 1.0, span);
                }
                return false;
            }
            self.before = now;
            self.steps = next;
            self.present.change(&self.steps, 1.0, span);
            return true;
        }
        // The step led too far, so half of it is taken back.
        self.halvings = self.halvings.saturating_add(1);
        if self.halvings > HALVINGS {
            return false;
        }
        for step in &mut self.steps {
            step.2 *= 0.5;
        }
        self.present.change(&self.steps, -1.0, span);
        true
    }
}

/// Finds how the shapes should change. Returns the effect that must be held at zero before the shapes
/// are determined, if there is one.
#[inline(never)]
fn changes<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    work: &Work<K, B>,
    steps: &mut Steps,
) -> Option<usize> {
    let solver = &work.solver;
    let mut shape = ShapeEquations::EMPTY;
    if !shape.set(problem, &solver.weights, &solver.squares, &work.derivatives) {
        return None;
    }
    let confused = solver.confused(problem, &shape);
    if confused.is_none() {
        shape.steps(&solver.free, |i, j, step| {
            // There is a place for every fitted shape.
            let _ = steps.push((i as u8, j as u8, single(step.clamp(-STRIDE, STRIDE))));
        });
    }
    confused
}
