//! Which effect is missing.

use crate::{
    coefficient::Coefficient,
    comparison::Comparison,
    curve::Curve,
    effect::{Effect, Span},
    error::Error,
    fit::{Fit, Problem, check, generalized::Solution, weights::Weights},
    kurtosis::Kurtosis,
    model::{MAX_EFFECTS, Model, Term},
    nnls::Vector,
    search::{Found, Search},
};
use heapless::Vec;

/// Candidates that a step fits in full and reports.
pub const MAX_CANDIDATES: usize = 4;

/// How to look for missing effects.
#[derive(Clone, Copy, Debug)]
pub struct Diagnosis {
    /// Tolerance of the model, as of [`Settings`](crate::Settings).
    pub tolerance: f64,
    /// A model of lower p-value is not adequate, and an effect is looked for.
    pub adequate_p: f64,
    /// Least improvement of `−2 ln L`, less what the effect's own parameters cost, that an effect is
    /// accepted for.
    pub threshold: f64,
    /// Candidates whose scores lie within this of the best are ambiguous.
    pub ambiguity: f64,
    /// Most effects to add.
    pub max_effects: usize,
}

impl Default for Diagnosis {
    fn default() -> Self {
        Self {
            tolerance: 0.01,
            adequate_p: 0.05,
            threshold: 8.0,
            ambiguity: 6.0,
            max_effects: 3,
        }
    }
}

/// An effect that a step tried.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// The effect with its best shape.
    pub term: Term,
    /// Its coefficient.
    pub coefficient: Coefficient,
    /// χ² of the model with it.
    pub chi_squared: f64,
    /// How far it lowers `−2 ln L`, less two for each of its parameters.
    pub improvement: f64,
}

/// A model on the way of a diagnosis.
#[derive(Clone, Debug)]
pub struct Step<const K: usize> {
    /// The model so far.
    pub model: Model,
    /// Its fit.
    pub fit: Fit,
    /// Where it fails.
    pub comparison: Comparison<K>,
    /// What was tried next, best first; none where the model is adequate.
    pub candidates: Vec<Candidate, MAX_CANDIDATES>,
    /// The effect that was added: the first candidate, if any.
    pub added: Option<Term>,
    /// Candidates that explain the curve about as well as the one that was added.
    pub ambiguous: Vec<&'static str, MAX_CANDIDATES>,
}

/// How a diagnosis ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Verdict {
    /// The model that was asked about explains the curve.
    Adequate,
    /// With the effects that were added, the model explains the curve, or more of it.
    Improved,
    /// The model does not explain the curve, and no effect in the list helps.
    Unexplained,
}

impl Diagnosis {
    /// As [`run_with`](Self::run_with), with no evidence beyond the curve.
    ///
    /// # Errors
    /// As of [`fit`](crate::fit).
    pub fn run<const K: usize>(
        &self,
        curve: &Curve<K>,
        model: &Model,
        effects: &[&'static dyn Effect],
        report: impl FnMut(&Step<K>),
    ) -> Result<Verdict, Error> {
        self.run_with(curve, None, model, effects, report)
    }

    /// Looks for what a model lacks, in a list of effects such as
    /// [`CATALOGUE`](crate::effect::CATALOGUE): fits, compares, tries every effect, adds the best,
    /// and again, until the model is adequate or nothing helps. Every step is handed to `report`,
    /// the last one included. The kurtosis tells effects apart that the curve does not.
    ///
    /// # Errors
    /// As of [`fit`](crate::fit).
    pub fn run_with<const K: usize>(
        &self,
        curve: &Curve<K>,
        kurtosis: Option<&Kurtosis<K>>,
        model: &Model,
        effects: &[&'static dyn Effect],
        mut report: impl FnMut(&Step<K>),
    ) -> Result<Verdict, Error> {
        check(curve.points(), 2)?;
        let mut model = model.clone();
        let mut start: Option<Vector> = None;
        let mut added = 0;
        loop {
            let mut next = None;
            let verdict = {
                let problem = Problem::new(curve, &model);
                let mut solution = Solution::new(&problem);
                match start {
                    // Once the tolerance was granted it stays: steps are compared with each other.
                    Some(squares) => solution.converge(squares, self.tolerance)?,
                    None => solution.solve(self.tolerance)?,
                }
                let mut step = self.step(&model, &problem, &solution, &span(curve))?;
                let adequate = solution.p_value() >= self.adequate_p;
                if !adequate && added < self.max_effects {
                    next = self.look(curve, &model, &solution, effects, &mut step)?;
                    if let Some(better) = &mut next {
                        tell_twins(curve, kurtosis, effects, better, &mut step);
                    }
                }
                report(&step);
                match (added, adequate) {
                    (0, true) => Verdict::Adequate,
                    (0, false) => Verdict::Unexplained,
                    _ => Verdict::Improved,
                }
            };
            let Some(better) = next else {
                return Ok(verdict);
            };
            model = better.model;
            start = Some(better.squares);
            added += 1;
        }
    }

    fn step<const K: usize>(
        &self,
        model: &Model,
        problem: &Problem<'_, K>,
        solution: &Solution<'_, '_, K>,
        span: &Span,
    ) -> Result<Step<K>, Error> {
        let mut fit = solution.fit();
        for shape in &mut fit.shape {
            let term = model.terms()[shape.term];
            let mut parameters = term.fitted_parameters();
            if let (Some(j), None) = (parameters.next(), parameters.next()) {
                let (weights, squares) = (&solution.weights, &solution.squares);
                let mut search =
                    Search::new(problem, weights, squares, shape.term, false)?.released();
                (shape.lower, shape.upper) = search.joint_interval(term, j, span);
            }
        }
        let unknowns = problem.points.len().saturating_sub(fit.degrees_of_freedom);
        let comparison =
            Comparison::from_weights(problem, &solution.weights, &solution.squares, unknowns)?;
        Ok(Step {
            model: model.clone(),
            fit,
            comparison,
            candidates: Vec::new(),
            added: None,
            ambiguous: Vec::new(),
        })
    }

    /// Tries every effect: candidates and decision go into the step, the better model is returned.
    fn look<const K: usize>(
        &self,
        curve: &Curve<K>,
        model: &Model,
        solution: &Solution<'_, '_, K>,
        effects: &[&'static dyn Effect],
        step: &mut Step<K>,
    ) -> Result<Option<Better>, Error> {
        let span = span(curve);
        let mut found = self.scan(curve, model, solution, effects, &span)?;
        let before = solution.minus_two_log_likelihood();
        let mut tried: Vec<(Candidate, Better), MAX_CANDIDATES> = Vec::new();
        // Best first, by what the scan says.
        found.sort_unstable_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared));
        for candidate in found.iter().take(MAX_CANDIDATES) {
            // An effect that cannot be fitted is no candidate.
            if let Ok(Some(pair)) = self.try_one(curve, model, solution, candidate, before, &span) {
                let _ = tried.push(pair);
            }
        }
        tried.sort_unstable_by(|a, b| b.0.improvement.total_cmp(&a.0.improvement));
        step.candidates = tried.iter().map(|(candidate, _)| *candidate).collect();
        let Some((best, better)) = tried.first() else {
            return Ok(None);
        };
        if best.improvement < self.threshold {
            return Ok(None);
        }
        step.added = Some(best.term);
        for (candidate, _) in &tried[1..] {
            if candidate.improvement > best.improvement - self.ambiguity {
                let _ = step.ambiguous.push(candidate.term.effect.name());
            }
        }
        Ok(Some(better.clone()))
    }

    /// The best shape of every effect, with the covariance of the model so far.
    fn scan<const K: usize>(
        &self,
        curve: &Curve<K>,
        model: &Model,
        solution: &Solution<'_, '_, K>,
        effects: &[&'static dyn Effect],
        span: &Span,
    ) -> Result<Vec<Found, 16>, Error> {
        let problem = Problem::new(curve, model);
        let mut found = Vec::new();
        for &effect in effects {
            let present = model.position(effect.name()).is_some();
            let replaced = effect.replaces().map(|other| model.position(other.name()));
            let nothing_to_replace = replaced == Some(None);
            if effect.twin().is_some() || nothing_to_replace {
                continue;
            }
            if present && effect.parameters().is_empty() {
                continue;
            }
            let place = replaced.flatten().unwrap_or(problem.count());
            let weights = &solution.weights;
            let Ok(mut search) = Search::new(&problem, weights, &solution.squares, place, true)
            else {
                // No place left in the model.
                continue;
            };
            let best = search.search(effect, span);
            if best.square > 0.0 {
                let _ = found.push(best);
            }
        }
        Ok(found)
    }

    /// Fits a model with one more effect, with its own covariance, and polishes the shapes.
    fn try_one<const K: usize>(
        &self,
        curve: &Curve<K>,
        model: &Model,
        solution: &Solution<'_, '_, K>,
        found: &Found,
        before: f64,
        span: &Span,
    ) -> Result<Option<(Candidate, Better)>, Error> {
        let replaced = found.term.effect.replaces().map(|effect| effect.name());
        let mut extended = model.without(replaced.unwrap_or(""));
        extended.add(found.term)?;
        let mut squares = Vector::zeros();
        for (i, term) in extended.terms().iter().enumerate() {
            squares[i] = match model.position(term.effect.name()) {
                Some(at) if i + 1 < extended.terms().len() => solution.squares[at],
                _ => found.square,
            };
        }
        let mut score = f64::INFINITY;
        let mut best = None;
        for _ in 0..POLISHES {
            let problem = Problem::new(curve, &extended);
            let mut solution = Solution::new(&problem);
            solution.converge(squares, self.tolerance)?;
            squares = solution.squares;
            if let Some(confused) = solution.confused() {
                let mut held = extended.clone();
                held.terms_mut()[confused].held = true;
                squares[confused] = 0.0;
                extended = polish(&problem, &solution.weights, &squares, &held, span)?;
                continue;
            }
            let now = solution.minus_two_log_likelihood();
            if now < score {
                let at = extended.terms().len() - 1;
                let fit = solution.fit();
                let parameters = 1 + extended.terms()[at].fitted_parameters().count();
                let candidate = Candidate {
                    term: extended.terms()[at],
                    coefficient: fit.coefficients[at],
                    chi_squared: solution.chi_squared,
                    improvement: before - now - 2.0 * parameters as f64,
                };
                best = Some((
                    candidate,
                    Better {
                        model: extended.clone(),
                        squares,
                    },
                ));
                if score - now < SETTLED {
                    break;
                }
                score = now;
            } else {
                break;
            }
            extended = polish(&problem, &solution.weights, &squares, &extended, span)?;
        }
        Ok(best)
    }
}

/// Rounds of fitting and polishing the shapes of a candidate.
const POLISHES: usize = 4;
/// A gain of `−2 ln L` that ends the rounds.
const SETTLED: f64 = 0.05;

/// A model with one more effect, and its squared coefficients.
#[derive(Clone, Debug)]
struct Better {
    model: Model,
    squares: Vector,
}

/// The best shape of every fitted effect, each with the others as they are.
fn polish<const K: usize>(
    problem: &Problem<'_, K>,
    weights: &Weights<K>,
    squares: &Vector,
    model: &Model,
    span: &Span,
) -> Result<Model, Error> {
    let mut polished = model.clone();
    for at in 0..MAX_EFFECTS.min(model.terms().len()) {
        let term = model.terms()[at];
        if !term.fitted || squares[at] <= 0.0 {
            continue;
        }
        let mut search = Search::new(problem, weights, squares, at, false)?;
        let found = search.refine_known(term, span);
        polished.terms_mut()[at] = found.term;
    }
    Ok(polished)
}

/// An effect that shares its Allan variance with another: names the one that the kurtosis speaks
/// for, or both.
fn tell_twins<const K: usize>(
    curve: &Curve<K>,
    kurtosis: Option<&Kurtosis<K>>,
    effects: &[&'static dyn Effect],
    better: &mut Better,
    step: &mut Step<K>,
) {
    let Some(added) = &mut step.added else { return };
    let is_twin = |effect: &&&'static dyn Effect| {
        effect
            .twin()
            .is_some_and(|twin| twin.name() == added.effect.name())
    };
    let Some(&twin) = effects.iter().find(is_twin) else {
        return;
    };
    let at = better.model.terms().len() - 1;
    let problem = Problem::new(curve, &better.model);
    let share = |k: usize| problem.share(k, at, &better.squares);
    let correlation_time_s = added.parameters[0];
    match kurtosis.map(|kurtosis| kurtosis.jumps(curve, correlation_time_s, share)) {
        Some(Some(true)) => {
            added.effect = twin;
            better.model.terms_mut()[at].effect = twin;
            if let Some(first) = step.candidates.first_mut() {
                first.term.effect = twin;
            }
        }
        Some(Some(false)) => {}
        _ => {
            // As many names as candidates fit; the twin is one of the first.
            let _ = step.ambiguous.push(twin.name());
        }
    }
}

fn span<const K: usize>(curve: &Curve<K>) -> Span {
    Span {
        interval_s: curve.interval_s(),
        longest_tau_s: curve.points().last().map_or(0.0, |point| point.tau_s),
    }
}
