//! First stage: a model is fitted, its shapes get their intervals, and it is compared with the curve.

use super::step::Step;
use crate::{
    comparison::Comparison,
    effect::Span,
    error::Error,
    fit::{Estimator, Fit, Problem, Refinement, Solver, Start, Tolerance, Work},
    limits::MAX_SHAPE,
    math,
    model::Term,
    nnls::Vector,
    observed::Observed,
    profile::{Evaluation, JointInterval, Profile},
    real::Real,
};

/// What the later stages know of a model that was judged.
#[derive(Clone, Copy, Debug)]
pub(super) struct Judged {
    /// The model's squared coefficients.
    pub(super) squares: Vector,
    /// Whether the model explains the curve; `None` if the curve is too short for a judgement.
    pub(super) adequate: Option<bool>,
    /// The tolerance that the model was granted.
    pub(super) tolerance: Real,
}

impl Judged {
    /// No judgement yet.
    #[inline(always)]
    pub(super) fn none() -> Self {
        Self {
            squares: Vector::zeros(),
            adequate: None,
            tolerance: 0.0,
        }
    }
}

/// The judgement of a model, in progress.
// The large variants share their memory with those of other stages.
#[allow(clippy::large_enum_variant)]
pub(super) enum Judging<const K: usize, const B: usize> {
    /// The model is being solved.
    Solving,
    /// It is solved.
    Solved,
    /// Its coefficients are being estimated.
    Estimating(Estimator),
    /// The interval of the shape at this place in the fit is being computed.
    Bounding {
        shape: usize,
        interval: Option<JointInterval>,
        profile: Profile<K, B>,
        /// The variance of each shape relative to the one that follows from the weights.
        widening: [Real; MAX_SHAPE],
    },
    /// The model is judged, and its coefficients are estimated anew.
    Refining {
        judged: Judged,
        refining: Refinement,
    },
    /// The new coefficients, whose squares these are, are being compared with the record.
    Comparing { judged: Judged, squares: Vector },
}

impl<const K: usize, const B: usize> Judging<K, B> {
    /// Begins with a model that the solver has begun to solve.
    pub(super) const fn new() -> Self {
        Self::Solving
    }

    /// Does one piece of work on the step's model. Returns the judgement when the step's fit and
    /// comparison are complete.
    ///
    /// # Errors
    /// The same as those of a fit.
    #[inline(never)]
    pub(super) fn advance(
        &mut self,
        observed: Observed<'_, K, B>,
        span: &Span,
        work: &mut Work<K, B>,
        step: &mut Step<K, B>,
    ) -> Result<Option<Judged>, Error> {
        let problem = Problem::new(observed, &step.model, &work.columns);
        let solver = &mut work.solver;
        match self {
            Self::Solving => {
                if solver.advance(&problem)? {
                    *self = Self::Solved;
                }
                Ok(None)
            }
            Self::Solved => {
                self.begin_estimating(&problem, solver, &mut step.fit);
                Ok(None)
            }
            Self::Estimating(estimator) => {
                if !estimator.advance(&problem, solver, &mut step.fit) {
                    return Ok(None);
                }
                if !step.fit.shape.is_empty() {
                    let widening = estimator.widening_of_shapes();
                    self.begin_bounding(&problem, solver, widening);
                    return Ok(None);
                }
                let judged = judged(solver, &step.fit);
                let refined = Refinement::applies(&step.model, &step.fit);
                if !refined || observed.spectrum().is_none() {
                    let (fit, comparison) = (&step.fit, &mut step.comparison);
                    compare(&problem, solver, &solver.squares, fit, comparison);
                }
                if !refined {
                    return Ok(Some(judged));
                }
                // The model explains the record, so that no later stage needs the solver as it is.
                let refining = Refinement::NEW;
                *self = Self::Refining { judged, refining };
                if let Self::Refining { refining, .. } = self {
                    refining.begin(observed, &step.model, &step.fit, work)?;
                }
                Ok(None)
            }
            Self::Bounding {
                shape,
                interval,
                profile,
                widening,
            } => {
                let Some(estimate) = step.fit.shape.get_mut(*shape) else {
                    let (fit, comparison) = (&step.fit, &mut step.comparison);
                    compare(&problem, solver, &solver.squares, fit, comparison);
                    return Ok(Some(judged(solver, fit)));
                };
                if interval.is_none() {
                    let Some((term, j)) = only_shape(&problem, estimate.term) else {
                        *shape = shape.saturating_add(1);
                        return Ok(None);
                    };
                    profile.choose(&problem, estimate.term, &solver.squares)?;
                    profile.release();
                    let mut evaluation = Evaluation::new(profile, &problem, &solver.weights);
                    let overlap = widening.get(*shape).copied().unwrap_or(1.0);
                    let widened = step.fit.birge_ratio * math::sqrt(overlap);
                    begin_interval(interval, &mut evaluation, term, j, span, widened);
                    return Ok(None);
                }
                let mut evaluation = Evaluation::new(profile, &problem, &solver.weights);
                let bounded = interval.as_mut();
                let bounded = bounded.and_then(|interval| interval.advance(&mut evaluation, span));
                if let Some((lower, upper)) = bounded {
                    (estimate.lower, estimate.upper) = (lower, upper);
                    *shape = shape.saturating_add(1);
                    *interval = None;
                }
                Ok(None)
            }
            Self::Refining { judged, refining } => {
                if refining.advance(observed, &step.model, work, &mut step.fit)? {
                    if observed.spectrum().is_none() {
                        return Ok(Some(*judged));
                    }
                    let problem = Problem::new(observed, &step.model, &work.columns);
                    let squares = problem.squares_of(&step.fit);
                    let (start, tolerance) = (Start::Once(squares), step.fit.tolerance);
                    let judged = *judged;
                    work.begin_at(observed, &step.model, start, Tolerance::Fixed(tolerance))?;
                    *self = Self::Comparing { judged, squares };
                }
                Ok(None)
            }
            Self::Comparing { judged, squares } => {
                if !solver.advance(&problem)? {
                    return Ok(None);
                }
                let (fit, comparison) = (&step.fit, &mut step.comparison);
                compare(&problem, solver, squares, fit, comparison);
                Ok(Some(*judged))
            }
        }
    }
}

// What begins a stage is apart from what goes on with it, so that its temporaries do not lie on the stack below
// the deepest calls.
impl<const K: usize, const B: usize> Judging<K, B> {
    #[inline(never)]
    fn begin_estimating(
        &mut self,
        problem: &Problem<'_, K, B>,
        solver: &Solver<K, B>,
        fit: &mut Fit,
    ) {
        *self = Self::Estimating(Estimator::NEW);
        if let Self::Estimating(estimator) = self {
            estimator.begin(problem, solver, fit);
        }
    }

    #[inline(never)]
    fn begin_bounding(
        &mut self,
        problem: &Problem<'_, K, B>,
        solver: &Solver<K, B>,
        widening: [Real; MAX_SHAPE],
    ) {
        *self = Self::Bounding {
            shape: 0,
            interval: None,
            profile: Profile::EMPTY,
            widening,
        };
        if let Self::Bounding { profile, .. } = self {
            profile.begin(problem, &solver.weights);
        }
    }
}

#[inline(never)]
fn begin_interval<const K: usize, const B: usize>(
    interval: &mut Option<JointInterval>,
    evaluation: &mut Evaluation<'_, K, B>,
    term: Term,
    j: usize,
    span: &Span,
    widened: Real,
) {
    *interval = Some(JointInterval::new(evaluation, term, j, span, widened));
}

/// The term at this place in the model and its fitted parameter, if that is its only fitted parameter.
/// Terms with several have no profile.
fn only_shape<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    place: usize,
) -> Option<(Term, usize)> {
    let term = problem.model.terms().get(place)?;
    let mut parameters = term.fitted_parameters();
    let first = parameters.next()?;
    parameters.next().is_none().then_some((*term, first))
}

/// What the later stages need of a solution and its fit.
fn judged<const K: usize, const B: usize>(solver: &Solver<K, B>, fit: &Fit) -> Judged {
    Judged {
        squares: solver.squares,
        adequate: fit.is_adequate(),
        tolerance: solver.weights.tolerance,
    }
}

/// Compares a model with the record, at these squared coefficients.
#[inline(never)]
fn compare<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    solver: &Solver<K, B>,
    squares: &Vector,
    fit: &Fit,
    comparison: &mut Comparison<K, B>,
) {
    let unknowns = problem.row_count().saturating_sub(fit.degrees_of_freedom);
    comparison.set(problem, &solver.weights, squares, unknowns);
    // χ² is least at the coefficients of the joint fit. Those of the octaves differ from them by less than their errors.
    (comparison.chi_squared, comparison.p_value) = (fit.chi_squared, fit.p_value);
}
