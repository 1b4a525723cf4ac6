//! Studies whether an effect at its limit of detection shows with the probability that the limit promises.

use super::{OCTAVES, RATE_HZ, hidden_effect::SAMPLES, measured::Measured};
use allanite::{
    Model, Record, Term,
    detection::{Detection, Limit},
    diagnosis::{Addition, Diagnosis, Options, Progress, Step},
    effect::{CATALOGUE, Effect, SearchRange, Span},
    spectrum::Spectrum,
};
use allanite_host::{
    diagnosis::go_on,
    simulate::{Coefficients, Hidden, Preset, Random, Simulator},
};
use allanite_log::BINS;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

/// The effects of the catalogue that have a limit beside the five terms.
pub fn effects() -> impl Iterator<Item = &'static dyn Effect> {
    let shaped = |effect: &&dyn Effect| !effect.parameters().is_empty();
    CATALOGUE
        .into_iter()
        .filter(|effect| effect.mirror().is_none())
        .filter(shaped)
}

/// What limits are taken from, and what is diagnosed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judged {
    /// The curve alone.
    Octaves,
    /// The curve, the spectrum and the course.
    Spectrum,
}

/// What diagnoses said about records with an effect at its limit.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// The number of records with the effect.
    pub records: usize,
    /// The number of records whose model was not adequate.
    pub inadequate: usize,
    /// The number of records in which the diagnosis added an effect.
    pub shown: usize,
    /// The number of records in which the effect was named alone.
    pub named: usize,
    /// The number of records in which it was one of several that would explain the curve as well.
    pub ambiguous: usize,
    /// The number of clean records without a limit: those that are not adequate, and those for which every shape
    /// that was drawn hides in the model.
    pub without_limits: usize,
}

/// Draws shapes at random, takes their limits from one record, and looks for the effect at its limit in
/// another record. Sizes are the limits times `factor`.
pub fn study(
    preset: Preset,
    effect: &'static dyn Effect,
    judged: Judged,
    records: u64,
    factor: f64,
) -> Tally {
    let outcomes: Vec<Outcome> = (0..records)
        .into_par_iter()
        .map(|seed| outcome(preset.coefficients(), effect, judged, seed, factor))
        .collect();
    let count = |is: fn(&Outcome) -> bool| outcomes.iter().filter(|one| is(one)).count();
    Tally {
        records: count(|one| one.is_limited),
        inadequate: count(|one| one.is_inadequate),
        shown: count(|one| one.is_shown),
        named: count(|one| one.is_named),
        ambiguous: count(|one| one.is_ambiguous),
        without_limits: count(|one| !one.is_limited),
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Outcome {
    is_limited: bool,
    is_inadequate: bool,
    is_shown: bool,
    is_named: bool,
    is_ambiguous: bool,
}

fn outcome(
    base: Coefficients,
    effect: &'static dyn Effect,
    judged: Judged,
    seed: u64,
    factor: f64,
) -> Outcome {
    let mut random = Random::seed_from_u64(0x11_417 + seed);
    let mut simulator = Simulator::new(base, RATE_HZ, 2 * seed);
    let measured = judged.of(&mut simulator, base);
    let Some(limit) = drawn_limit(&measured, effect, &mut random) else {
        return Outcome::default();
    };
    let mut hidden = Hidden {
        effect,
        parameters: limit.term.parameters,
        coefficient: limit.coefficient,
    };
    let [
        quantization,
        angle_random_walk,
        bias_instability,
        rate_random_walk,
        rate_ramp,
        ..,
    ] = limit.beside;
    let beside = Coefficients {
        quantization,
        angle_random_walk,
        bias_instability,
        rate_random_walk,
        rate_ramp,
    };
    if limit.is_of_shape() {
        hidden.parameters[0] *= factor;
    } else {
        hidden.coefficient *= factor;
    }
    let mut simulator = Simulator::with_hidden(beside, &[hidden], RATE_HZ, 2 * seed + 1);
    let measured = judged.of(&mut simulator, base);
    let Some(step) = first_step(measured.record()) else {
        return Outcome::default();
    };
    let added = match step.added {
        Some(Addition::Effect(term)) => Some(term.effect.name()),
        _ => None,
    };
    let ambiguous = step.ambiguous.as_slice();
    let name = effect.name();
    Outcome {
        is_limited: true,
        is_inadequate: step.fit.is_adequate() == Some(false),
        is_shown: added.is_some(),
        is_named: added == Some(name) && ambiguous.is_empty(),
        is_ambiguous: (added == Some(name) && !ambiguous.is_empty()) || ambiguous.contains(&name),
    }
}

/// The limit of a shape that is drawn from the range that a search covers. Shapes that have no limit are
/// drawn again.
fn drawn_limit(
    measured: &Measured,
    effect: &'static dyn Effect,
    random: &mut Random,
) -> Option<Limit> {
    let step = first_step(measured.record())?;
    let curve = &measured.curve;
    let span = Span {
        interval_s: curve.interval_s(),
        longest_tau_s: curve.points().last()?.tau_s,
    };
    let detection = Detection::new(measured.record(), &step, &CATALOGUE, Options::default());
    if step.fit.is_adequate() != Some(true) {
        return None;
    }
    (0..20).find_map(|_| {
        let mut term = Term::new(effect);
        term.fitted = true;
        for (j, parameter) in effect.parameters().iter().enumerate() {
            let range = (parameter.search_range)(&span);
            term.parameters[j] = drawn(&range, parameter.is_whole, random);
        }
        detection.limit_of(term)
    })
}

fn drawn(range: &SearchRange, is_whole: bool, random: &mut Random) -> f64 {
    let share: f64 = random.random();
    if is_whole {
        return (range.low + share * (range.high - range.low + 1.0)).floor();
    }
    range.low * (range.high.max(range.low) / range.low).powf(share)
}

impl Judged {
    /// What is known of the next record of a simulator.
    fn of(self, simulator: &mut Simulator, base: Coefficients) -> Measured {
        let measured = Measured::of(simulator, base, SAMPLES);
        match self {
            Self::Octaves => Measured {
                spectrum: Spectrum::EMPTY,
                course: None,
                ..measured
            },
            Self::Spectrum => measured,
        }
    }
}

/// The first step of a diagnosis of the five terms, which says whether anything is missing.
fn first_step(record: Record<'_, OCTAVES, BINS>) -> Option<Step<OCTAVES, BINS>> {
    let (model, options) = (Model::ieee_952(), Options::default());
    let mut diagnosis = Diagnosis::new(record, &model, &CATALOGUE, options);
    match diagnosis.advance(&mut go_on).ok()? {
        Progress::Step(step) => Some(step.clone()),
        Progress::Paused | Progress::Finished(_) => None,
    }
}
