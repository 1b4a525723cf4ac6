//! Studies whether p-values are uniform and intervals contain the truth, with and without a hidden effect.

use super::{
    OCTAVES, RATE_HZ,
    hidden_effect::{Outcome, added, diagnose_with, steps},
    quantum,
    theory::squares,
};
use crate::{
    log::SpectrumSums,
    simulate::{Coefficients, Hidden, Preset, Random, Simulator},
};
use allanite::{Axis, Model, Scale, diagnosis::Options, effect::MAX_PARAMETERS, fit::Fit};
use rand::{RngExt as _, SeedableRng as _};
use rayon::prelude::*;
use serde::Serialize;

/// The number of samples of a record, which is 22 minutes long.
pub const SAMPLES: usize = 1 << 17;

/// The symbols of the four terms that the presets have.
pub const TERMS: [&str; 4] = ["Q", "N", "B", "K"];

/// The effects that are hidden, each with its shape and its size in standard deviations of the white noise of a sample.
/// An effect that replaces white noise keeps its coefficient.
pub const CASES: [Option<(&str, [f64; MAX_PARAMETERS], f64)>; 8] = [
    None,
    Some(("sinusoid", [7.7, 0.0], 0.4)),
    Some(("resonance", [5.0, 3.0], 1.0)),
    Some(("resonance", [20.0, 20.0], 0.5)),
    Some(("low_pass", [0.02, 2.0], 1.0)),
    Some(("decimation_filter", [0.03, 1.0], 1.0)),
    Some(("gauss_markov", [1.0, 0.0], 0.3)),
    Some(("notch", [30.0, 2.0], 1.0)),
];

/// The cases: [`CASES`] in whole records, and nothing hidden in records with gaps.
pub const ALL: usize = CASES.len() + 1;

/// The lengths of the stretches between gaps, and of the gaps, in samples. Each is drawn uniformly.
const STRETCHES: std::ops::Range<usize> = 50..4000;
const GAPS: std::ops::Range<usize> = 1..200;

/// Diagnoses a record in which nothing is hidden, with gaps at random.
fn with_gaps(base: Coefficients, seed: u64, options: Options) -> Judged {
    let mut simulator = Simulator::new(base, RATE_HZ, seed);
    let mut random = Random::seed_from_u64(!seed);
    let mut gyro = Axis::<OCTAVES, 0, ()>::new();
    let mut sums = SpectrumSums::new();
    let quantum = quantum(base, RATE_HZ);
    let mut left = SAMPLES;
    while left > 0 {
        let stretch = random.random_range(STRETCHES).min(left);
        left -= stretch;
        for rate in simulator.by_ref().take(stretch) {
            let count = (rate / quantum).round() as i32;
            gyro.push(count);
            sums.push_slice(&[count]);
        }
        for _ in 0..random.random_range(GAPS) {
            simulator.next();
        }
        gyro.gap();
        sums.gap();
    }
    let scale = Scale::new(quantum, RATE_HZ).expect("positive");
    let [accumulator] = gyro.accumulators();
    let (steps, _) = steps(
        &gyro,
        accumulator.curve(scale),
        sums.spectrum(scale),
        options,
    );
    let last = &steps[steps.len() - 1];
    Judged {
        added: added(&steps)
            .iter()
            .map(|(term, _)| term.effect.name())
            .collect(),
        fit: last.fit.clone(),
        model: last.model.clone(),
    }
}

/// What a diagnosis says about one record.
struct Judged {
    added: Vec<&'static str>,
    fit: Fit,
    model: Model,
}

impl From<Outcome> for Judged {
    fn from(outcome: Outcome) -> Self {
        let added = outcome.added.iter().map(|(term, _)| term.effect.name());
        Self {
            added: added.collect(),
            fit: outcome.fit,
            model: outcome.model,
        }
    }
}

/// The results of one case: shares of the records of which the diagnosis names the hidden effect and nothing else.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The preset.
    pub preset: String,
    /// The hidden effect; `None` where nothing is hidden.
    pub effect: Option<&'static str>,
    /// Whether the records have gaps.
    pub gaps: bool,
    /// Its shape.
    pub shape: [f64; MAX_PARAMETERS],
    /// The number of records in which it is named alone.
    pub records: usize,
    /// The share of p-values below 5 % and below 1 %.
    pub p_below: [f64; 2],
    /// The largest distance of the distribution of p from the uniform one (Kolmogorov 1933).
    pub distance: f64,
    /// The share of intervals and bounds that contain the truth, for each of [`TERMS`].
    pub covered: [f64; 4],
    /// The same for the coefficient of the hidden effect and its shape; NaN for what it does not have, and for the
    /// coefficient of a filter, which is N.
    pub covered_effect: [f64; 1 + MAX_PARAMETERS],
}

/// The hidden effect of one of [`CASES`] in a gyro with these coefficients; `None` where nothing is hidden.
pub fn hidden_case(base: Coefficients, case: usize) -> Option<Hidden> {
    let white = base.angle_random_walk * RATE_HZ.sqrt();
    let (name, parameters, size) = (*CASES.get(case)?)?;
    let mut hidden = Hidden::new(name, parameters, base.angle_random_walk)?;
    if !hidden.replaces_white_noise() {
        hidden.coefficient = size * white;
    }
    Some(hidden)
}

/// Diagnoses records of a gyro of the case of this number, below [`ALL`].
pub fn study(preset: Preset, case: usize, records: u64, options: Options) -> Row {
    let base = preset.coefficients();
    let hidden = hidden_case(base, case);
    let gaps = case == CASES.len();
    let outcomes: Vec<Judged> = (0..records)
        .into_par_iter()
        .map(|seed| match gaps {
            true => with_gaps(base, seed, options),
            false => diagnose_with(base, hidden.as_slice(), SAMPLES, seed, options).into(),
        })
        .filter(|outcome| {
            let hidden = hidden.iter().map(|one| one.effect.name());
            outcome.added.iter().copied().eq(hidden)
        })
        .collect();
    let share = |is: &dyn Fn(&Judged) -> Option<bool>| {
        let known: Vec<bool> = outcomes.iter().filter_map(is).collect();
        known.iter().filter(|&&is| is).count() as f64 / known.len() as f64
    };
    // The coefficient of an effect in a fit contains the truth.
    let contains = |outcome: &Judged, name: &str, truth: f64| {
        let mut terms = outcome.model.terms().iter();
        let at = terms.position(|term| term.effect.name() == name)?;
        let found = outcome.fit.coefficients.get(at)?;
        Some((found.lower..=found.upper).contains(&truth))
    };
    let names = [
        "quantization",
        "angle_random_walk",
        "bias_instability",
        "rate_random_walk",
    ];
    let truth = squares(base).map(f64::sqrt);
    let covered = std::array::from_fn(|i| {
        share(&|outcome| {
            // A filter takes the place of the white noise, and keeps its coefficient.
            let filter = hidden.filter(|one| i == 1 && one.replaces_white_noise());
            let name = filter.map_or(names[i], |filter| filter.effect.name());
            contains(outcome, name, truth[i])
        })
    });
    let covered_effect = std::array::from_fn(|i| {
        let Some(hidden) = hidden else {
            return f64::NAN;
        };
        let name = hidden.effect.name();
        match i.checked_sub(1) {
            None if hidden.replaces_white_noise() => f64::NAN,
            None => share(&|outcome| contains(outcome, name, hidden.coefficient)),
            Some(parameter) => share(&|outcome| {
                let named = hidden.effect.parameters().get(parameter)?.name;
                let mut shapes = outcome.fit.shape.iter();
                let found = shapes.find(|shape| shape.name == named)?;
                Some((found.lower..=found.upper).contains(&hidden.parameters[parameter]))
            }),
        }
    });
    let mut p: Vec<f64> = outcomes.iter().map(|one| one.fit.p_value).collect();
    p.sort_by(f64::total_cmp);
    let n = p.len() as f64;
    let distances = p.iter().zip(0..).map(|(p, i)| {
        let i = f64::from(i);
        (p - i / n).abs().max(((i + 1.0) / n - p).abs())
    });
    Row {
        preset: format!("{preset:?}").to_lowercase(),
        effect: hidden.map(|hidden| hidden.effect.name()),
        gaps,
        shape: hidden.map_or([0.0; MAX_PARAMETERS], |hidden| hidden.parameters),
        records: outcomes.len(),
        p_below: [0.05, 0.01].map(|limit| share(&|outcome| Some(outcome.fit.p_value < limit))),
        distance: distances.fold(0.0, f64::max),
        covered,
        covered_effect,
    }
}
