//! Which effect is missing.

mod follow;
mod revise;
mod trial;
mod twins;

use crate::{
    coefficient::Coefficient,
    comparison::Comparison,
    cross_sums::CrossCurve,
    curve::Curve,
    effect::{Effect, Span, covariate::Slope},
    error::Error,
    fit::{
        Fit, Problem, check,
        generalized::{Rounds, Solution},
    },
    integrity::Reason,
    kurtosis::Kurtosis,
    model::{Model, Term},
    nnls::Vector,
    search::{Found, Search},
};
use heapless::Vec;
use revise::Preferred;
use trial::Better;

/// Candidates that a step fits in full and reports.
pub const MAX_CANDIDATES: usize = 4;

/// Names that a step calls ambiguous: two of every other candidate, and twins of two.
pub const MAX_AMBIGUOUS: usize = 2 * MAX_CANDIDATES;

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
    /// A covariate is believed from a slope of so many standard errors on.
    pub covariate_z: f64,
    /// Most effects to add, a covariate among them.
    pub max_effects: usize,
}

impl Default for Diagnosis {
    fn default() -> Self {
        Self {
            tolerance: 0.01,
            adequate_p: 0.05,
            threshold: 8.0,
            ambiguity: 6.0,
            covariate_z: 3.5,
            max_effects: 3,
        }
    }
}

/// What is known of a record beside its curve: all of it optional.
#[derive(Clone, Copy, Debug)]
pub struct Evidence<'a, const K: usize> {
    /// Tells effects apart that the curve does not.
    pub kurtosis: Option<&'a Kurtosis<K>>,
    /// What the rate may follow. One of them is taken into account, the one with the surest slope: of
    /// two that share their course, cross sums with the gyro do not tell which it is.
    pub covariates: &'a [CrossCurve<K>],
    /// Why the curve cannot mean what it says, as of [`Integrity`](crate::Integrity).
    pub invalid: Option<Reason>,
}

impl<const K: usize> Evidence<'_, K> {
    /// The curve alone.
    pub const NONE: Self = Self {
        kurtosis: None,
        covariates: &[],
        invalid: None,
    };
}

/// An effect that a step tried.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// The effect with its best shape.
    pub term: Term,
    /// What else changes where it is added.
    pub swap: Option<Swap>,
    /// Its coefficient.
    pub coefficient: Coefficient,
    /// χ² of the model with it.
    pub chi_squared: f64,
    /// How far it lowers `−2 ln L`, less two for each parameter that it brings.
    pub improvement: f64,
}

impl Candidate {
    /// Parameters that it brings: a coefficient and shapes.
    fn cost(&self) -> f64 {
        let swap = self
            .swap
            .map_or(0.0, |swap| cost(swap.taken) - cost(swap.dropped));
        cost(self.term.effect) + swap
    }

    /// Whether both swap, and bring the same pair.
    fn brings_the_same(&self, other: &Self) -> bool {
        let pair = |one: &Self| {
            one.swap
                .map(|swap| (one.term.effect.name(), swap.taken.name()))
        };
        let (Some(one), Some((first, second))) = (pair(self), pair(other)) else {
            return false;
        };
        one == (first, second) || one == (second, first)
    }

    /// The effects by which its model differs from those of other candidates, if `dropped` gives way to
    /// some of them.
    fn brings(&self, dropped: Option<&'static str>) -> [Option<&'static str>; 2] {
        let beside = self.swap.map(|swap| swap.taken.name());
        [Some(self.term.effect.name()), beside.or(dropped)]
    }
}

/// An effect that was added before and gives way to another when a further one is added: alone, it
/// had taken the part of both.
#[derive(Clone, Copy)]
pub struct Swap {
    /// The one that gives way.
    pub dropped: &'static dyn Effect,
    /// The one in its place.
    pub taken: &'static dyn Effect,
}

impl core::fmt::Debug for Swap {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{} → {}", self.dropped.name(), self.taken.name())
    }
}

/// A covariate that the rate follows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Follows {
    /// Its place among [`Evidence::covariates`].
    pub covariate: usize,
    /// How.
    pub slope: Slope,
}

/// Parameters of an effect whose shape is fitted.
fn cost(effect: &'static dyn Effect) -> f64 {
    (1 + Term::fitted(effect).fitted_parameters().count()) as f64
}

/// What a step adds to the model.
#[derive(Clone, Copy, Debug)]
pub enum Addition {
    /// An effect of the list: the first candidate.
    Effect(Term),
    /// A covariate: what follows it is taken off the curve.
    Covariate(Follows),
}

/// A model on the way of a diagnosis.
#[derive(Clone, Debug)]
pub struct Step<const K: usize> {
    /// The model so far.
    pub model: Model,
    /// The covariate whose share has been taken off the curve.
    pub follows: Option<Follows>,
    /// The model's fit.
    pub fit: Fit,
    /// Where it fails.
    pub comparison: Comparison<K>,
    /// What was tried next, best first; none where the model is adequate.
    pub candidates: Vec<Candidate, MAX_CANDIDATES>,
    /// What was added.
    pub added: Option<Addition>,
    /// Candidates that explain the curve about as well as the one that was added.
    pub ambiguous: Vec<&'static str, MAX_AMBIGUOUS>,
}

impl<const K: usize> Step<K> {
    /// What else changes with the effect that is added.
    pub fn swap(&self) -> Option<Swap> {
        match self.added {
            Some(Addition::Effect(_)) => self.candidates.first()?.swap,
            _ => None,
        }
    }
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
    /// The curve cannot mean what it says: no effect was looked for.
    Invalid(Reason),
}

/// The best shapes that a scan found.
type Scan = Vec<Found, MAX_CANDIDATES>;

/// A model's squared coefficients and its score, `−2 ln L`.
#[derive(Clone, Copy)]
struct Standing {
    squares: Vector,
    score: f64,
    adequate: bool,
}

impl Diagnosis {
    /// Looks for what a model lacks, in a list of effects such as
    /// [`CATALOGUE`](crate::effect::CATALOGUE): fits, compares, tries every effect, adds the best,
    /// and again, until the model is adequate or nothing helps. A covariate is tried first: it
    /// carries its own evidence. Every step is handed to `report`, the last one included.
    ///
    /// With 20 octaves it takes less than 16 KiB of stack and, where an effect is found, some
    /// 10⁸ instructions on a Cortex-M4F: `cargo xtask bench` measures this.
    ///
    /// # Errors
    /// As of [`fit`](crate::fit).
    pub fn run<const K: usize>(
        &self,
        curve: &Curve<K>,
        evidence: &Evidence<'_, K>,
        model: &Model,
        effects: &[&'static dyn Effect],
        mut report: impl FnMut(&Step<K>),
    ) -> Result<Verdict, Error> {
        check(curve.points(), 2)?;
        let mut corrected = None;
        let mut step = Step {
            model: model.clone(),
            follows: None,
            fit: Fit::empty(),
            comparison: Comparison::empty(),
            candidates: Vec::new(),
            added: None,
            ambiguous: Vec::new(),
        };
        let (mut start, mut added) = (None, 0);
        let mut preferred: Option<Preferred> = None;
        loop {
            let curve = corrected.as_ref().unwrap_or(curve);
            let room = added < self.max_effects && evidence.invalid.is_none();
            let mut found = Scan::new();
            let effects = if room { effects } else { &[] };
            let standing = self.report(curve, start, effects, &mut step, &mut found)?;
            step.added = None;
            step.candidates.clear();
            step.ambiguous.clear();
            let mut better = None;
            if room && step.follows.is_none() {
                step.added = self.follow(curve, evidence, &step, &standing)?;
            }
            if room && step.added.is_none() && !standing.adequate {
                self.try_all(curve, &standing, &found, None, &mut step, &mut better);
                if let Some(preferred) = &preferred {
                    self.revise(curve, &standing, preferred, effects, &mut step, &mut better);
                }
                self.choose(&mut step);
                if let (Some(better), Some(_)) = (&mut better, &step.added) {
                    twins::tell(curve, evidence.kurtosis, effects, better, &mut step);
                }
            }
            report(&step);
            match (step.added, &better) {
                (Some(Addition::Covariate(follows)), _) => {
                    let cross = &evidence.covariates[follows.covariate];
                    let rest = cross.corrected(curve, &follows.slope);
                    step.follows = Some(follows);
                    corrected = Some(rest);
                }
                (Some(Addition::Effect(_)), Some(better)) => {
                    preferred = Preferred::of(&step.candidates, self.threshold);
                    step.model.clone_from(&better.model);
                    start = Some(better.squares);
                }
                _ => {
                    return Ok(match (evidence.invalid, added, standing.adequate) {
                        (Some(reason), ..) => Verdict::Invalid(reason),
                        (_, 0, true) => Verdict::Adequate,
                        (_, 0, false) => Verdict::Unexplained,
                        _ => Verdict::Improved,
                    });
                }
            }
            added += 1;
        }
    }

    /// Fits and compares the step's model; where it is not adequate, finds the best shape of every
    /// effect.
    // What it takes of the stack is free again for the trials.
    #[inline(never)]
    fn report<const K: usize>(
        &self,
        curve: &Curve<K>,
        start: Option<Vector>,
        effects: &[&'static dyn Effect],
        step: &mut Step<K>,
        found: &mut Scan,
    ) -> Result<Standing, Error> {
        let problem = Problem::new(curve, &step.model);
        let mut solution = Solution::new(&problem);
        match start {
            // Once the tolerance was granted it stays: steps are compared with each other.
            Some(squares) => solution.converge(squares, self.tolerance, Rounds::All)?,
            None => solution.solve(self.tolerance)?,
        }
        let standing = Standing {
            squares: solution.squares,
            score: solution.minus_two_log_likelihood(),
            adequate: solution.p_value() >= self.adequate_p,
        };
        let span = span(curve);
        solution.report(&mut step.fit);
        solution.bound_shapes(&mut step.fit, &span)?;
        let unknowns = problem.points.len() - step.fit.degrees_of_freedom;
        step.comparison
            .set(&problem, &solution.weights, &solution.squares, unknowns);
        if !standing.adequate {
            scan(&problem, &solution, effects, &span, found);
        }
        Ok(standing)
    }

    /// Fits the shapes that a scan found: the best few become candidates of the step, the model with
    /// the very best goes into `best`. The scan was made of the step's model, or of one with a swap.
    #[inline(never)]
    fn try_all<const K: usize>(
        &self,
        curve: &Curve<K>,
        standing: &Standing,
        found: &Scan,
        swapped: Option<(&Model, Swap)>,
        step: &mut Step<K>,
        best: &mut Option<Better>,
    ) {
        let known = |step: &Step<K>, candidate: &Candidate| {
            let mut others = step.candidates.iter();
            others.any(|other| other.brings_the_same(candidate))
        };
        let gained = step
            .candidates
            .first()
            .map_or(0.0, |first| first.improvement);
        let mut least = standing.score - gained;
        for found in found {
            let model = swapped.map_or(&step.model, |(model, _)| model);
            let Ok(mut better) = Better::new(model, found) else {
                continue;
            };
            // An effect that cannot be fitted is no candidate.
            let mut candidate = Candidate {
                term: found.term,
                swap: swapped.map(|(_, swap)| swap),
                coefficient: Coefficient::new(found.term.effect, 0.0, None),
                chi_squared: f64::NAN,
                improvement: 0.0,
            };
            if known(step, &candidate) {
                continue;
            }
            let fitted = better.fit(curve, self.tolerance, least, &mut candidate);
            let Ok(Some(score)) = fitted else {
                continue;
            };
            least = least.min(score);
            candidate.improvement = standing.score - score - 2.0 * candidate.cost();
            let at = step
                .candidates
                .iter()
                .position(|other| other.improvement < candidate.improvement)
                .unwrap_or(step.candidates.len());
            if at == MAX_CANDIDATES {
                continue;
            }
            if at == 0 {
                *best = Some(better);
            }
            if step.candidates.is_full() {
                step.candidates.pop();
            }
            // There is room now.
            let _ = step.candidates.insert(at, candidate);
        }
    }

    /// Adds the best candidate if it is worth its parameters, and names those that are about as good.
    fn choose<const K: usize>(&self, step: &mut Step<K>) {
        let Some((first, others)) = step.candidates.split_first() else {
            return;
        };
        if first.improvement < self.threshold {
            return;
        }
        step.added = Some(Addition::Effect(first.term));
        let dropped = first.swap.map(|swap| swap.dropped.name());
        let chosen = first.brings(dropped);
        let close = |other: &&Candidate| other.improvement > first.improvement - self.ambiguity;
        for other in others.iter().filter(close) {
            for name in other.brings(dropped).into_iter().flatten() {
                if !chosen.contains(&Some(name)) && !step.ambiguous.contains(&name) {
                    // As many names as candidates bring.
                    let _ = step.ambiguous.push(name);
                }
            }
        }
    }
}

/// The shapes of effects that do best beside a model that has not been fitted yet.
#[inline(never)]
fn scan_beside<const K: usize>(
    curve: &Curve<K>,
    model: &Model,
    tolerance: f64,
    effects: &[&'static dyn Effect],
    found: &mut Scan,
) -> Result<(), Error> {
    let problem = Problem::new(curve, model);
    let mut solution = Solution::new(&problem);
    solution.solve(tolerance)?;
    scan(&problem, &solution, effects, &span(curve), found);
    Ok(())
}

/// The best shape of every effect, with the covariance of the model so far: the best few of them, best
/// first.
#[inline(never)]
fn scan<const K: usize>(
    problem: &Problem<'_, K>,
    solution: &Solution<'_, '_, K>,
    effects: &[&'static dyn Effect],
    span: &Span,
    found: &mut Scan,
) {
    let model = problem.model;
    let mut search = Search::new(problem, &solution.weights, true);
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
        if search.at(place, &solution.squares).is_err() {
            // No place left in the model.
            continue;
        }
        let best = search.search(effect, span);
        if best.squares[place] <= 0.0 {
            continue;
        }
        let at = found
            .iter()
            .position(|other| other.chi_squared > best.chi_squared)
            .unwrap_or(found.len());
        if at == MAX_CANDIDATES {
            continue;
        }
        if found.is_full() {
            found.pop();
        }
        // There is room now.
        let _ = found.insert(at, best);
    }
}

fn span<const K: usize>(curve: &Curve<K>) -> Span {
    Span {
        interval_s: curve.interval_s(),
        longest_tau_s: curve.points().last().map_or(0.0, |point| point.tau_s),
    }
}
