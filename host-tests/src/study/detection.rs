//! Studies whether an effect at its limit of detection shows with the probability that the limit promises.

use super::{OCTAVES, RATE_HZ, hidden_effect::SAMPLES, record, spectrum};
use crate::{
    log::{BINS, SpectrumSums},
    simulate::{Coefficients, Hidden, Preset, Random, Simulator},
};
use allanite::{
    Curve, Model, Term,
    detection::{Detection, Limit},
    diagnosis::{Addition, Diagnosis, Evidence, Options, Progress, Step},
    effect::{CATALOGUE, Effect, SearchRange, Span},
    spectrum::Spectrum,
};
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
    /// The curve and the spectrum.
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
    let measured = Measured::of(&mut simulator, base, judged);
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
    let measured = Measured::of(&mut simulator, base, judged);
    let Some(step) = measured.first_step() else {
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
    let step = measured.first_step()?;
    let Measured { curve, spectrum } = measured.clone();
    let span = Span {
        interval_s: curve.interval_s(),
        longest_tau_s: curve.points().last()?.tau_s,
    };
    let mut detection =
        Detection::with_spectrum(curve, spectrum, &step, &CATALOGUE, Options::default());
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
        detection.limit_of(term).ok().flatten()
    })
}

fn drawn(range: &SearchRange, is_whole: bool, random: &mut Random) -> f64 {
    let share: f64 = random.random();
    if is_whole {
        return (range.low + share * (range.high - range.low + 1.0)).floor();
    }
    range.low * (range.high.max(range.low) / range.low).powf(share)
}

/// What is known of a record.
#[derive(Clone)]
struct Measured {
    curve: Curve<OCTAVES>,
    spectrum: Spectrum<BINS>,
}

impl Measured {
    fn of(simulator: &mut Simulator, base: Coefficients, judged: Judged) -> Self {
        let mut sums = SpectrumSums::new();
        let curve = record(simulator, base, SAMPLES, |counts| {
            if judged == Judged::Spectrum {
                sums.push_slice(counts);
            }
        });
        let spectrum = match judged {
            Judged::Octaves => Spectrum::EMPTY,
            Judged::Spectrum => spectrum(&sums, base),
        };
        Self { curve, spectrum }
    }

    /// The first step of a diagnosis of the five terms. The others, which cost more, are not needed: an effect has
    /// shown once another model is preferred.
    fn first_step(&self) -> Option<Step<OCTAVES, BINS>> {
        let Self { curve, spectrum } = self.clone();
        let (model, options) = (Model::ieee_952(), Options::default());
        let evidence = Evidence::NONE;
        let mut diagnosis =
            Diagnosis::with_spectrum(curve, spectrum, evidence, &model, &CATALOGUE, options);
        loop {
            match diagnosis.advance().ok()? {
                Progress::Working => {}
                Progress::Step(step) => return Some(step.clone()),
                Progress::Finished(_) => return None,
            }
        }
    }
}
