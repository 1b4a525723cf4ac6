//! First stage: a model is fitted, its shapes get their intervals, and it is compared with the curve.

use super::step::Step;
use crate::{
    evidence::observed::Observed,
    fit::{
        Fit, Problem, Refinement, Solver, Stage, Start, Tolerance, Work,
        profile::{Evaluation, JointInterval, Profile},
    },
    limits::MAX_SHAPE,
    numerics::{math, nnls::Vector, real::Real},
    pause::{Pause, Stop, call},
    theory::model::Term,
};

/// What the later stages know of a model that was judged.
#[derive(Clone, Copy, Debug)]
pub(super) struct Assessment {
    /// The model's squared coefficients.
    pub(super) squares: Vector,
    /// Whether the model explains the curve; `None` if the curve is too short for a judgement.
    pub(super) adequate: Option<bool>,
    /// The tolerance that the model was granted.
    pub(super) tolerance: Real,
}

impl Assessment {
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

/// Judges a step's model: fits it as [`fit`](crate::fit::fit()) does, gives its shapes their intervals, and compares it
/// with the record.
///
/// # Errors
/// The same as those of a fit, and the end of the pause.
#[inline(never)]
pub(super) fn assess<const K: usize, const B: usize>(
    observed: Observed<'_, K, B>,
    start: Start,
    tolerance: Tolerance,
    work: &mut Work<K, B>,
    step: &mut Step<K, B>,
    pause: &mut Pause<'_>,
) -> Result<Assessment, Stop> {
    call(pause)?;
    work.begin_at(observed, &step.model, start, tolerance)?;
    let mut stage = Stage::Solving;
    let widening = loop {
        call(pause)?;
        stage.advance(observed, &step.model, work, &mut step.fit)?;
        if let Some(estimator) = stage.estimated() {
            break estimator.widening_of_shapes();
        }
    };
    let judged = Assessment {
        squares: work.solver.squares,
        adequate: step.fit.is_adequate(),
        tolerance: work.solver.weights.tolerance,
    };
    let is_refined = Refinement::applies(&step.model, &step.fit);
    if !step.fit.shape.is_empty() {
        let problem = Problem::new(observed, &step.model, &work.columns);
        bound(&problem, &work.solver, &widening, &mut step.fit, pause)?;
    }
    // The coefficients of a model that explains the record are refined in the memory of the solution.
    if !is_refined || observed.spectrum().is_none() {
        compare(observed, work, &judged.squares, step);
    }
    if !is_refined {
        return Ok(judged);
    }
    loop {
        call(pause)?;
        if stage.advance(observed, &step.model, work, &mut step.fit)? {
            break;
        }
    }
    if observed.spectrum().is_some() {
        let squares = Problem::new(observed, &step.model, &work.columns).squares_of(&step.fit);
        let tolerance = Tolerance::Fixed(step.fit.tolerance);
        work.solve(
            observed,
            &step.model,
            Start::Once(squares),
            tolerance,
            pause,
        )?;
        compare(observed, work, &squares, step);
    }
    Ok(judged)
}

/// Gives the shapes of a fit their intervals, where an effect has only one.
#[inline(never)]
fn bound<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    solver: &Solver<K, B>,
    widening: &[Real; MAX_SHAPE],
    fit: &mut Fit,
    pause: &mut Pause<'_>,
) -> Result<(), Stop> {
    let span = problem.observed.span();
    let mut profile = Profile::EMPTY;
    profile.begin(problem, &solver.weights);
    for (estimate, widening) in fit.shape.iter_mut().zip(widening) {
        call(pause)?;
        let Some((term, j)) = only_shape(problem, estimate.term) else {
            continue;
        };
        profile.choose(problem, estimate.term, &solver.squares)?;
        profile.release();
        let mut evaluation = Evaluation::new(&mut profile, problem, &solver.weights);
        let widened = fit.birge_ratio * math::sqrt(*widening);
        let mut interval = JointInterval::new(&mut evaluation, term, j, &span, widened);
        (estimate.lower, estimate.upper) = loop {
            call(pause)?;
            if let Some(ends) = interval.advance(&mut evaluation, &span) {
                break ends;
            }
        };
    }
    Ok(())
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

/// Compares a step's model with the record, at these squared coefficients.
#[inline(never)]
fn compare<const K: usize, const B: usize>(
    observed: Observed<'_, K, B>,
    work: &Work<K, B>,
    squares: &Vector,
    step: &mut Step<K, B>,
) {
    let problem = Problem::new(observed, &step.model, &work.columns);
    let (fit, comparison) = (&step.fit, &mut step.comparison);
    let unknowns = problem.row_count().saturating_sub(fit.degrees_of_freedom);
    comparison.set(&problem, &work.solver.weights, squares, unknowns);
    // χ² is least at the coefficients of the joint fit. Those of the octaves differ from them by less than their errors.
    (comparison.chi_squared, comparison.p_value) = (fit.chi_squared, fit.p_value);
}
