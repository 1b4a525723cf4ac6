//! A diagnosis that knows low passes of any form.
//!
//! Where the filters of the catalogue do not explain a record alone, a wrong kernel passes for a second effect, a resonance near
//! half the rate for example, and takes N with it. The response of the filter is then fitted to the record's densities, and the
//! record is diagnosed once more with a filter of this response instead of those of the catalogue.
//!
//! The response is a sum of columns with coefficients that are not negative: poles with free zeros, or a curve that only falls from
//! knot to knot. Only one of the columns behind poles is not zero at frequency zero, so that N² is one coefficient.

mod bands;
mod effect;
mod family;
mod non_negative;
mod response;
mod words;

pub use effect::NAME;
pub use words::Freeform;

use crate::{
    diagnosis::diagnose,
    known_filter::{is_filter, known_filter},
};
use allanite::{
    Error, Model, Record, Term,
    diagnosis::{Options, Step, Verdict},
    effect::{AngleRandomWalk, Distribution, Effect},
    fit::State,
};
use bands::Bands;
use effect::FreeformFilter;
use std::sync::Arc;

/// The steps of a diagnosis, and its verdict.
pub type Diagnosed<const K: usize, const B: usize> = (Vec<Step<K, B>>, Verdict);

/// Diagnoses a record, with a low pass of any form where those among the effects do not explain it alone.
///
/// # Errors
/// As of [`diagnose`].
pub fn diagnose_freely<const K: usize, const B: usize>(
    record: Record<'_, K, B>,
    model: &Model,
    effects: &[&'static dyn Effect],
    options: Options,
) -> Result<Diagnosed<K, B>, Error> {
    let (steps, verdict) = steps(record, model, effects, options)?;
    let better = match steps.last() {
        Some(last) => alternative(record, model, (last, verdict), effects, options)?,
        None => None,
    };
    Ok(better.unwrap_or((steps, verdict)))
}

/// The diagnosis of a record by a low pass of any form, if the model and the verdict that a diagnosis ended with call for one, and
/// it explains the record about as well with fewer effects, or better.
///
/// # Errors
/// As of [`diagnose`].
pub fn alternative<const K: usize, const B: usize>(
    record: Record<'_, K, B>,
    model: &Model,
    (last, verdict): (&Step<K, B>, Verdict),
    effects: &[&'static dyn Effect],
    options: Options,
) -> Result<Option<Diagnosed<K, B>>, Error> {
    let Some(spectrum) = record.spectrum else {
        return Ok(None);
    };
    if last.covariate.is_some() || known_filter(model).is_some() || !needs_another(verdict, last) {
        return Ok(None);
    }
    let bands = Arc::new(Bands::new(spectrum.rate_hz()));
    let found = response::responses(spectrum, &last.model, bands.clone());
    let Some(best) = found.first() else {
        return Ok(None);
    };
    let filter = FreeformFilter::leaked(best.clone(), bands, spectrum.rate_hz());
    let found = explained(record, model, (last, filter, &found), effects, options);
    filter.rest();
    found
}

/// The diagnosis by a filter, if it explains the record about as well with fewer effects, or better.
fn explained<const K: usize, const B: usize>(
    record: Record<'_, K, B>,
    model: &Model,
    (last, filter, found): (&Step<K, B>, &'static FreeformFilter, &[response::Response]),
    effects: &[&'static dyn Effect],
    options: Options,
) -> Result<Option<Diagnosed<K, B>>, Error> {
    let filter: &'static dyn Effect = filter;
    let parameters = found.first().map_or(0, |best| best.parameters);
    // At first without what imitates a filter, and then with everything.
    let others = || {
        let others = effects.iter().copied();
        others.filter(|effect| !is_filter(*effect) && !effect.passes_all())
    };
    let certain = others().filter(|effect| !imitates(*effect));
    let lists: [Vec<_>; 2] = [
        certain.chain([filter]).collect(),
        others().chain([filter]).collect(),
    ];
    for list in lists {
        let (mut freely, judged) = steps(record, model, &list, options)?;
        let Some(new) = freely.last_mut().filter(|step| is_named(step)) else {
            continue;
        };
        // The cut-off is among the parameters of both.
        let free = parameters as f64 - 1.0;
        let gain = improvement(last, new) - 2.0 * free;
        if gain >= needed(last, new, options.threshold) {
            widen(new, found);
            return Ok(Some((freely, judged)));
        }
    }
    Ok(None)
}

/// The steps of a whole diagnosis.
fn steps<const K: usize, const B: usize>(
    record: Record<'_, K, B>,
    model: &Model,
    effects: &[&'static dyn Effect],
    options: Options,
) -> Result<Diagnosed<K, B>, Error> {
    let mut steps = Vec::new();
    let verdict = diagnose(record, model, effects, options, |step| {
        steps.push(step.clone());
    })?;
    Ok((steps, verdict))
}

/// The gain that another filter needs over a model. Instead of a filter and what was named besides, it may explain the record a little
/// less well, because each of them had to pay for its choice among many. Without a filter, noise of one fast pole is the simpler word.
fn needed<const K: usize, const B: usize>(
    last: &Step<K, B>,
    new: &Step<K, B>,
    threshold: f64,
) -> f64 {
    let fewer = beside(last) as f64 - beside(new) as f64;
    if fewer <= 0.0 {
        return threshold;
    }
    match last.model.terms().iter().any(|term| is_filter(term.effect)) {
        true => -0.5 * threshold * fewer,
        false => 0.0,
    }
}

/// Whether the filter of any form is in the model of a step.
fn is_named<const K: usize, const B: usize>(step: &Step<K, B>) -> bool {
    let mut terms = step.model.terms().iter();
    terms.any(|term| term.effect.name() == NAME)
}

/// Whether an effect has a broad spectrum at high frequency, by which it makes up for a filter of another form: a resonance or a
/// power law.
fn imitates(effect: &dyn Effect) -> bool {
    let parameters = effect.parameters();
    let is_line = effect.description().distribution == Distribution::Deterministic;
    let unit = parameters.first().map(|first| first.unit);
    matches!(unit, Some("Hz" | "")) && !is_line
}

/// Whether a filter of another form could explain a record better: something is left, or something that is no filter is named
/// besides, and there is white noise to be filtered. What the distribution of the values decided, as that of telegraph noise, is known
/// by other evidence.
fn needs_another<const K: usize, const B: usize>(verdict: Verdict, last: &Step<K, B>) -> bool {
    let mut terms = last.model.terms().iter();
    let is_known =
        terms.any(|term| term.effect.description().distribution == Distribution::TwoLevels);
    match verdict {
        _ if is_known => false,
        Verdict::Improved | Verdict::Incomplete => {
            beside(last) > 0 || last.fit.is_adequate() == Some(false)
        }
        Verdict::Unexplained => true,
        _ => false,
    }
}

/// The effects of a model that are neither filters nor among the five terms.
fn beside<const K: usize, const B: usize>(step: &Step<K, B>) -> usize {
    let is_white = |term: &Term| term.effect.name() == AngleRandomWalk.description().name;
    let terms = || step.model.terms().iter();
    let is_filtered = terms().any(|term| is_filter(term.effect));
    terms()
        .filter(|term| {
            // White noise besides that behind a filter was added.
            let is_added = !term.effect.parameters().is_empty() || is_filtered && is_white(term);
            !is_filter(term.effect) && is_added
        })
        .count()
}

/// How much another model improves a fit: the decrease of −2 ln L, less two for each parameter that it has more.
fn improvement<const K: usize, const B: usize>(before: &Step<K, B>, after: &Step<K, B>) -> f64 {
    let parameters = before.fit.degrees_of_freedom as f64 - after.fit.degrees_of_freedom as f64;
    before.fit.minus_two_log_likelihood - after.fit.minus_two_log_likelihood - 2.0 * parameters
}

/// Widens the interval of the white noise to what the responses that are as good leave of it.
fn widen<const K: usize, const B: usize>(step: &mut Step<K, B>, responses: &[response::Response]) {
    let place = step
        .model
        .terms()
        .iter()
        .position(|term| term.effect.name() == NAME);
    let Some(white) = place.and_then(|place| step.fit.coefficients.get_mut(place)) else {
        return;
    };
    for response in responses {
        let [square, error] = response.white;
        let root = |square: f64| square.max(0.0).sqrt();
        if white.state == State::Measured {
            white.lower = white.lower.min(root(square - 2.0 * error));
            white.upper = white.upper.max(root(square + 2.0 * error));
        }
    }
}
