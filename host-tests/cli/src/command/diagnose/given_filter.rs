//! Whether the filter that was given fits a record, and what explains it better if it does not.

use crate::command::known_filter::{described, is_filter, known_filter};
use allanite::{
    Error, Term,
    diagnosis::{Addition, Options, Step, Verdict},
    fit::Fit,
};
use allanite_log::{BINS, OCTAVES};

type Steps = Vec<Step<OCTAVES, BINS>>;

/// What explains a record better than the filter that was given.
pub(crate) struct Better {
    /// The filter that was found instead; `None` if the record shows no filter.
    pub(crate) filter: Option<Term>,
    chi_squared: f64,
}

impl Better {
    /// Looks for a better filter if the model with the given one does not explain the record. `diagnose` diagnoses
    /// the five terms without the filter; it may add one effect more, since the filter counts as one.
    ///
    /// The given filter is refuted if the other diagnosis ends with another shape of the filter, outside of its
    /// interval, and with a score that is better by the threshold for an effect. If it needs fewer effects beside its
    /// filter, these imitate what is wrong with the given one, and a score that is as good is enough.
    ///
    /// # Errors
    /// As of a diagnosis.
    pub(super) fn than_given(
        steps: &Steps,
        options: Options,
        diagnose: impl FnOnce(Options) -> Result<(Steps, Verdict), Error>,
    ) -> Result<Option<Self>, Error> {
        let (Some(first), Some(last)) = (steps.first(), steps.last()) else {
            return Ok(None);
        };
        let given = known_filter(&first.model);
        let Some(given) = given.filter(|_| first.fit.is_adequate() == Some(false)) else {
            return Ok(None);
        };
        let (free, _) = diagnose(Options {
            max_effects: options.max_effects.saturating_add(1),
            ..options
        })?;
        let Some(best) = free.last() else {
            return Ok(None);
        };
        let terms = best.model.terms().iter().enumerate();
        let found = terms.clone().find(|(_, term)| is_filter(term.effect));
        let beside = |last: &Step<OCTAVES, BINS>| {
            let filters = last
                .model
                .terms()
                .iter()
                .filter(|term| is_filter(term.effect));
            last.model.terms().len() - filters.count()
        };
        let needed = match beside(best) < beside(last) {
            true => 0.0,
            false => options.threshold,
        };
        let refuted = found.is_none_or(|(at, term)| is_other(term, &best.fit, at, given))
            && improvement(&last.fit, &best.fit) >= needed;
        Ok(refuted.then_some(Self {
            filter: found.map(|(_, term)| *term),
            chi_squared: best.fit.chi_squared,
        }))
    }

    /// The steps of a diagnosis whose filter is refuted: what was added beside a wrong filter says nothing. A covariate
    /// is known by its own evidence.
    pub(super) fn keep_what_is_sure(steps: &mut Steps) {
        let is_covariate =
            |step: &&Step<OCTAVES, BINS>| matches!(step.added, Some(Addition::Covariate(_)));
        let kept = steps.iter().take_while(is_covariate).count() + 1;
        steps.truncate(kept);
        if let Some(last) = steps.last_mut() {
            last.added = None;
            last.candidates.clear();
            last.ambiguous.clear();
        }
    }

    /// What fits better, in words.
    pub(crate) fn words(&self) -> String {
        let better = match &self.filter {
            Some(filter) => described(filter),
            None => "no filter".into(),
        };
        format!("{better} fits better, χ² {:.1}", self.chi_squared)
    }
}

/// Whether a fitted filter is another one than the given one.
fn is_other(found: &Term, fit: &Fit, at: usize, given: &Term) -> bool {
    if found.effect.name() != given.effect.name() {
        return true;
    }
    let parameters = found.effect.parameters().iter().enumerate();
    parameters
        .zip(given.parameters)
        .any(|((j, parameter), value)| {
            let mut shape = fit.shape.iter();
            match shape.find(|one| one.term == at && one.name == parameter.name) {
                Some(estimate) => !(estimate.lower..=estimate.upper).contains(&value),
                None => found.parameters[j] != value,
            }
        })
}

/// How much another model improves a fit: the decrease of −2 ln L, less two for each parameter that it has more.
fn improvement(fit: &Fit, other: &Fit) -> f64 {
    let parameters = fit.degrees_of_freedom as f64 - other.degrees_of_freedom as f64;
    fit.minus_two_log_likelihood - other.minus_two_log_likelihood - 2.0 * parameters
}
