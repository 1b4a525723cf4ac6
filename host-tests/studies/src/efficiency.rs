//! Studies how much of the information in a record the estimates keep.

use super::{
    OCTAVES, RATE_HZ,
    calibration::{EFFECTS, hidden_effect},
    hidden_effect::{Outcome, diagnose},
    record, spectrum,
    theory::squares,
    whittle::{PARAMETERS, bounds},
};
use allanite::{
    Model, Record,
    fit::{Fit, Method, Options, fit},
};
use allanite_host::simulate::{Hidden, Preset, Random, Simulator};
use allanite_log::{BINS, SpectrumSums};
use rand::{RngExt as _, SeedableRng as _};
use rayon::prelude::*;
use serde::Serialize;

/// The symbols of the terms that the presets have, in the order of the model.
pub const SYMBOLS: [&str; 4] = ["Q", "N", "B", "K"];

/// The lengths of the records, in samples.
pub const LENGTHS: [usize; 3] = [1 << 14, 1 << 17, 1 << 20];

/// The length of records that hide an effect, in samples.
pub const SAMPLES: usize = 1 << 17;

/// The number of bootstrap samples behind each standard error (Efron 1979).
const RESAMPLED: usize = 200;

/// What the coefficients are estimated from, and how.
pub const ESTIMATES: [(&str, Method, bool); 6] = [
    ("octaves", Method::Covariance, false),
    ("octaves and spectrum", Method::Covariance, true),
    ("ordinary", Method::Ordinary, false),
    ("accurate part", Method::AccuratePart, false),
    ("relative accuracy", Method::RelativeAccuracy, false),
    ("cluster count", Method::ClusterCount, false),
];

/// A root-mean-square error with its standard error.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Figure {
    /// The root of the mean squared error, relative to the true value.
    pub rms: f64,
    /// Its standard error, by the bootstrap.
    pub standard_error: f64,
    /// The number of records behind it.
    pub records: usize,
}

impl Figure {
    /// The root of the mean square of some errors.
    fn of(errors: &[f64]) -> Self {
        let root = |sum: f64| (sum / errors.len() as f64).sqrt();
        let mut random = Random::seed_from_u64(0);
        let resampled: Vec<f64> = (0..RESAMPLED)
            .map(|_| {
                let drawn = (0..errors.len()).map(|_| errors[random.random_range(0..errors.len())]);
                root(drawn.map(|error| error * error).sum())
            })
            .collect();
        let mean = resampled.iter().sum::<f64>() / RESAMPLED as f64;
        let scatter = resampled
            .iter()
            .map(|one| (one - mean).powi(2))
            .sum::<f64>();
        Self {
            rms: root(errors.iter().map(|error| error * error).sum()),
            standard_error: (scatter / (RESAMPLED - 1) as f64).sqrt(),
            records: errors.len(),
        }
    }
}

/// The errors of one coefficient, or of one shape parameter.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The preset.
    pub preset: String,
    /// The number of samples of a record.
    pub samples: usize,
    /// The hidden effect; `None` where nothing is hidden.
    pub effect: Option<&'static str>,
    /// The symbol of the term, or the name of what is estimated of the effect.
    pub name: &'static str,
    /// The smallest relative error that is possible (Cramér–Rao, by [`bounds`]).
    pub bound: f64,
    /// The errors: those of [`ESTIMATES`], or that of the diagnosis if an effect is hidden.
    pub errors: Vec<Figure>,
}

/// Fits records of a gyro with nothing hidden.
pub fn coefficients(preset: Preset, samples: usize, records: u64) -> Vec<Row> {
    let base = preset.coefficients();
    let truth = squares(base).map(f64::sqrt);
    let found: Vec<[Option<[f64; 4]>; ESTIMATES.len()]> = (0..records)
        .into_par_iter()
        .map(|seed| {
            let mut simulator = Simulator::new(base, RATE_HZ, seed);
            let mut sums = SpectrumSums::new();
            let curve = record(&mut simulator, base, samples, |counts| {
                sums.push_slice(counts);
            });
            let spectrum = spectrum(&sums, base);
            ESTIMATES.map(|(_, method, with_spectrum)| {
                let options = Options {
                    method,
                    ..Options::default()
                };
                let observed = Record::new(&curve, &spectrum);
                let fitted = match with_spectrum {
                    true => fit::<OCTAVES, BINS>(observed, &Model::ieee_952(), options),
                    false => fit(&curve, &Model::ieee_952(), options),
                };
                let error = |fit: &Fit, i: usize| fit.coefficients[i].value / truth[i] - 1.0;
                Some(fitted.ok()?).map(|fit| std::array::from_fn(|i| error(&fit, i)))
            })
        })
        .collect();
    let bounds = bounds(base, None, samples, 1.0 / RATE_HZ);
    let rows = SYMBOLS.iter().zip(bounds).enumerate();
    rows.map(|(i, (name, bound))| Row {
        preset: name_of(preset),
        samples,
        effect: None,
        name,
        bound,
        errors: (0..ESTIMATES.len())
            .map(|which| {
                let errors = found.iter().filter_map(|one| Some(one[which]?[i]));
                Figure::of(&errors.collect::<Vec<_>>())
            })
            .collect(),
    })
    .collect()
}

/// Diagnoses records that hide an effect of [`EFFECTS`]. The errors are those of the records of which the diagnosis names
/// the effect and nothing else.
pub fn effect(preset: Preset, place: usize, records: u64) -> Vec<Row> {
    let base = preset.coefficients();
    let Some(hidden) = hidden_effect(base, place) else {
        return Vec::new();
    };
    let outcomes: Vec<Outcome> = (0..records)
        .into_par_iter()
        .map(|seed| diagnose(base, &[hidden], SAMPLES, seed))
        .filter(|outcome| {
            let named = outcome.added.iter().map(|(term, _)| term.effect.name());
            named.eq([hidden.effect.name()])
        })
        .collect();
    let bounds = bounds(base, Some(&hidden), SAMPLES, 1.0 / RATE_HZ);
    let truth = truth(&hidden, squares(base).map(f64::sqrt));
    let names = names(&hidden);
    let rows = names.into_iter().zip(bounds).zip(truth).enumerate();
    rows.filter_map(|(i, ((name, bound), truth))| {
        let errors: Vec<f64> = outcomes
            .iter()
            .filter_map(|outcome| Some(estimate(outcome, &hidden, i)? / truth - 1.0))
            .collect();
        (!errors.is_empty() && bound.is_finite()).then(|| Row {
            preset: name_of(preset),
            samples: SAMPLES,
            effect: Some(hidden.effect.name()),
            name,
            bound,
            errors: vec![Figure::of(&errors)],
        })
    })
    .collect()
}

/// The places of the effects in [`EFFECTS`] whose bounds are known: telegraph noise is not Gaussian.
pub fn effects() -> impl Iterator<Item = usize> {
    let is_gaussian = |name: &str| name != "random_telegraph";
    (0..EFFECTS.len()).filter(move |&place| is_gaussian(EFFECTS[place].0))
}

fn name_of(preset: Preset) -> String {
    format!("{preset:?}").to_lowercase()
}

/// What is estimated, in the order of the bounds.
fn names(hidden: &Hidden) -> [&'static str; PARAMETERS] {
    let shape = |i: usize| hidden.effect.parameters().get(i).map_or("", |one| one.name);
    let [q, n, b, k] = SYMBOLS;
    [q, n, b, k, "coefficient", shape(0), shape(1)]
}

/// The true values, in the order of the bounds.
fn truth(hidden: &Hidden, terms: [f64; 5]) -> [f64; PARAMETERS] {
    let [first, second, ..] = hidden.parameters;
    let [q, n, b, k, _] = terms;
    [q, n, b, k, hidden.coefficient, first, second]
}

/// The estimate of one parameter, in the order of the bounds; `None` if the model does not have it.
fn estimate(outcome: &Outcome, hidden: &Hidden, parameter: usize) -> Option<f64> {
    const TERMS: [&str; 4] = [
        "quantization",
        "angle_random_walk",
        "bias_instability",
        "rate_random_walk",
    ];
    let own = hidden.effect.name();
    let coefficient = |name: &str| {
        let mut terms = outcome.model.terms().iter();
        let at = terms.position(|term| term.effect.name() == name)?;
        Some(outcome.fit.coefficients.get(at)?.value)
    };
    match parameter {
        // The coefficient of a filter is that of the white noise that it takes the place of.
        1 if hidden.replaces_white_noise() => coefficient(own),
        0..4 => coefficient(TERMS[parameter]),
        4 => coefficient(own),
        _ => {
            let named = hidden.effect.parameters().get(parameter - 5)?.name;
            let mut shapes = outcome.fit.shape.iter();
            Some(shapes.find(|shape| shape.name == named)?.value)
        }
    }
}
