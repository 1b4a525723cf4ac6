//! Studies whether p-values are uniform and intervals contain the truth, with and without a hidden effect.

use super::{
    RATE_HZ, expected_curve,
    hidden_effect::{added, steps},
    measured::Sums,
    quantum,
    theory::squares,
};
use allanite::{
    Model, Scale,
    diagnosis::Options,
    effect::MAX_PARAMETERS,
    fit::{Fit, State, fit},
};
use allanite_host::simulate::{
    Coefficients, Hidden, Preset, Random, Simulator, band_limited_flicker,
};
use rand::{RngExt as _, SeedableRng as _};
use rayon::prelude::*;
use serde::Serialize;

/// The number of samples of a record, which is 22 minutes long.
pub const SAMPLES: usize = 1 << 17;

/// The number of samples of a short record. The intervals of its longest octaves have few differences.
const FEW: usize = 1 << 12;

/// The symbols of the four terms that the presets have.
pub const TERMS: [&str; 4] = ["Q", "N", "B", "K"];

/// The probabilities of the intervals, and the quantiles of the normal distribution that belong to them. An interval of
/// a smaller probability is that of 95 %, drawn together around the value in the ratio of the quantiles.
pub const LEVELS: [(f64, f64); 3] = [(0.50, 0.674_49), (0.90, 1.644_85), (0.95, 1.959_96)];

/// The share of records in which a term is measured, from which on the coverage of its intervals is told.
const NEARLY_ALL: f64 = 0.97;

/// The effects that are hidden, each with its shape and its size in standard deviations of the white noise of a sample.
/// An effect that replaces white noise keeps its coefficient. A power law is not among them: the five terms explain one of
/// this length.
pub const EFFECTS: [(&str, [f64; MAX_PARAMETERS], f64); 8] = [
    ("sinusoid", [7.7, 0.0, 0.0], 0.4),
    ("resonance", [5.0, 3.0, 0.0], 1.0),
    ("resonance", [20.0, 20.0, 0.0], 0.5),
    ("low_pass", [0.02, 2.0, 0.0], 1.0),
    ("decimation_filter", [0.03, 1.0, 0.0], 1.0),
    ("gauss_markov", [1.0, 0.0, 0.0], 0.3),
    ("notch", [30.0, 2.0, 0.0], 1.0),
    ("random_telegraph", [1.0, 0.0, 0.0], 0.5),
];

/// What distinguishes the records of a case.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Case {
    /// Nothing is hidden.
    Nothing,
    /// Nothing is hidden in records of 2^12 samples.
    Short,
    /// Nothing is hidden in records with gaps.
    Gaps,
    /// Nothing is hidden, and the rate random walk is as large as a record just shows: its square is twice its standard
    /// error. So its bound is sometimes below the truth.
    Faint,
    /// Flicker noise ends at half the sample rate, instead of being averaged over each sample interval.
    BandLimited,
    /// The effect of [`EFFECTS`] at this place is hidden.
    Hidden(usize),
}

impl Case {
    /// All cases.
    pub fn all() -> impl Iterator<Item = Self> {
        let nothing = [
            Self::Nothing,
            Self::Short,
            Self::Gaps,
            Self::Faint,
            Self::BandLimited,
        ];
        let hidden = (0..EFFECTS.len()).map(Self::Hidden);
        nothing.into_iter().chain(hidden)
    }

    fn samples(self) -> usize {
        match self {
            Self::Short => FEW,
            _ => SAMPLES,
        }
    }
}

/// A gyro whose rate random walk is [just shown](Case::Faint) by a record. The standard error is that of the expected curve.
fn faint(base: Coefficients) -> Coefficients {
    let mut coefficients = base;
    // The error depends a little on the coefficient itself.
    for _ in 0..8 {
        let model = Model::ieee_952();
        let squares = squares(coefficients);
        let curve = expected_curve(SAMPLES, |m| model.variance(&squares, m, 1.0 / RATE_HZ));
        let fit =
            fit(&curve, &model, Default::default()).expect("the model explains its own curve");
        coefficients.rate_random_walk = (2.0 * fit.coefficients[3].square_error).sqrt();
    }
    coefficients
}

/// The lengths of the stretches between gaps, and of the gaps, in samples. Each is drawn uniformly.
const STRETCHES: std::ops::Range<usize> = 50..4000;
const GAPS: std::ops::Range<usize> = 1..200;

/// What a diagnosis says about one record.
struct Judged {
    added: Vec<&'static str>,
    fit: Fit,
    model: Model,
    /// The standard errors by which the octaves and the bins lie above the last model.
    octaves: Vec<f64>,
    bins: Vec<f64>,
}

/// The rates of a record without gaps, which never ends unless its flicker noise is band-limited.
fn rates(
    base: Coefficients,
    hidden: &[Hidden],
    case: Case,
    seed: u64,
) -> Box<dyn Iterator<Item = f64>> {
    if case != Case::BandLimited {
        return Box::new(Simulator::with_hidden(base, hidden, RATE_HZ, seed));
    }
    let mut random = Random::seed_from_u64(!seed);
    let flicker = band_limited_flicker(base.bias_instability, SAMPLES, &mut random);
    let others = Coefficients {
        bias_instability: 0.0,
        ..base
    };
    let others = Simulator::new(others, RATE_HZ, seed);
    Box::new(others.zip(flicker).map(|(other, flicker)| other + flicker))
}

/// Diagnoses one record.
fn diagnose(
    base: Coefficients,
    hidden: &[Hidden],
    case: Case,
    seed: u64,
    options: Options,
) -> Judged {
    let mut rates = rates(base, hidden, case, seed);
    let mut random = Random::seed_from_u64(!seed);
    let mut sums = Sums::new();
    let quantum = quantum(base, RATE_HZ);
    let mut left = case.samples();
    while left > 0 {
        let stretch = match case {
            Case::Gaps => random.random_range(STRETCHES).min(left),
            _ => left,
        };
        left -= stretch;
        let rates_of_stretch = rates.by_ref().take(stretch);
        let counts: Vec<i32> = rates_of_stretch
            .map(|rate| (rate / quantum).round() as i32)
            .collect();
        sums.push_slice(&counts);
        if left > 0 {
            let missing = random.random_range(GAPS);
            rates.nth(missing - 1);
            sums.lost(missing as u64);
        }
    }
    let scale = Scale::new(quantum, RATE_HZ).expect("positive");
    let (steps, _) = steps(&sums.measured(scale), options);
    let last = &steps[steps.len() - 1];
    let octaves = last.comparison.octaves.iter();
    let bins = last.comparison.bins.iter();
    Judged {
        added: added(&steps)
            .iter()
            .map(|(term, _)| term.effect.name())
            .collect(),
        octaves: octaves.map(|octave| octave.z).collect(),
        bins: bins.map(|bin| bin.z).collect(),
        fit: last.fit.clone(),
        model: last.model.clone(),
    }
}

/// The results of one case: shares of the records of which the diagnosis names the hidden effect and nothing else.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The preset.
    pub preset: String,
    /// The records.
    pub case: Case,
    /// The hidden effect; `None` where nothing is hidden.
    pub effect: Option<&'static str>,
    /// Its shape.
    pub shape: [f64; MAX_PARAMETERS],
    /// The number of records in which it is named alone.
    pub records: usize,
    /// The share of p-values below 5 % and below 1 %.
    pub p_below: [f64; 2],
    /// The largest distance of the distribution of p from the uniform one (Kolmogorov 1933).
    pub distance: f64,
    /// The share of intervals of [`LEVELS`] that contain the truth, for each of [`TERMS`] that is measured in nearly all
    /// records. Where it is not, those in which it is are not any ones.
    pub covered: [[f64; 3]; 4],
    /// The share of records in which the truth is not above the bound, or above the upper end of the interval, of each of
    /// [`TERMS`].
    pub bounded: [f64; 4],
    /// The share of bounds among them.
    pub bounds: [f64; 4],
    /// The share of intervals of 95 % that contain the truth, for the coefficient of the hidden effect and its shape; NaN
    /// for what it does not have, and for the coefficient of a filter, which is N.
    pub covered_effect: [f64; 1 + MAX_PARAMETERS],
    /// The mean and the standard deviation of the standard errors by which octaves lie above the model, and the same of
    /// bins. Those of a true model with known coefficients are 0 and 1.
    pub octaves: [f64; 2],
    /// See [`octaves`](Self::octaves).
    pub bins: [f64; 2],
    /// Of the single octaves and the single bins, the smallest and the largest standard deviation.
    pub octave_range: [f64; 2],
    /// See [`octave_range`](Self::octave_range).
    pub bin_range: [f64; 2],
}

/// The effect of [`EFFECTS`] at a place, in a gyro with these coefficients.
pub fn hidden_effect(base: Coefficients, place: usize) -> Option<Hidden> {
    let white = base.angle_random_walk * RATE_HZ.sqrt();
    let &(name, parameters, size) = EFFECTS.get(place)?;
    let mut hidden = Hidden::new(name, parameters, base.angle_random_walk)?;
    if !hidden.replaces_white_noise() {
        hidden.coefficient = size * white;
    }
    Some(hidden)
}

/// The mean and the standard deviation of numbers.
fn mean_and_deviation(numbers: impl Iterator<Item = f64> + Clone) -> [f64; 2] {
    let n = numbers.clone().count() as f64;
    let mean = numbers.clone().sum::<f64>() / n;
    let variance = numbers.map(|x| (x - mean).powi(2)).sum::<f64>() / n;
    [mean, variance.sqrt()]
}

/// The smallest and the largest standard deviation of the numbers at one place of all lists.
fn range_of_deviations(lists: &[&[f64]]) -> [f64; 2] {
    let places = lists.iter().map(|list| list.len()).min().unwrap_or(0);
    let deviations = (0..places).map(|place| {
        let at = lists.iter().map(|list| list[place]);
        mean_and_deviation(at)[1]
    });
    deviations.fold([f64::INFINITY, 0.0], |[least, most], one| {
        [least.min(one), most.max(one)]
    })
}

/// Diagnoses records of a gyro.
pub fn study(preset: Preset, case: Case, records: u64, options: Options) -> Row {
    let base = match case {
        Case::Faint => faint(preset.coefficients()),
        _ => preset.coefficients(),
    };
    let hidden = match case {
        Case::Hidden(place) => hidden_effect(base, place),
        _ => None,
    };
    let outcomes: Vec<Judged> = (0..records)
        .into_par_iter()
        .map(|seed| diagnose(base, hidden.as_slice(), case, seed, options))
        .filter(|outcome| {
            let hidden = hidden.iter().map(|one| one.effect.name());
            outcome.added.iter().copied().eq(hidden)
        })
        .collect();
    let share = |is: &dyn Fn(&Judged) -> Option<bool>| {
        let known: Vec<bool> = outcomes.iter().filter_map(is).collect();
        known.iter().filter(|&&is| is).count() as f64 / known.len() as f64
    };
    // The coefficient of an effect in a fit.
    let coefficient = |outcome: &Judged, name: &str| {
        let mut terms = outcome.model.terms().iter();
        let at = terms.position(|term| term.effect.name() == name)?;
        outcome.fit.coefficients.get(at).copied()
    };
    let names = [
        "quantization",
        "angle_random_walk",
        "bias_instability",
        "rate_random_walk",
    ];
    let truth = squares(base).map(f64::sqrt);
    let term = |outcome: &Judged, i: usize| {
        // A filter takes the place of the white noise, and keeps its coefficient. A power law takes that of flicker noise.
        let filter = hidden.filter(|one| i == 1 && one.replaces_white_noise());
        coefficient(
            outcome,
            filter.map_or(names[i], |filter| filter.effect.name()),
        )
    };
    let full = LEVELS[2].1;
    let measured: [f64; 4] =
        std::array::from_fn(|i| share(&|outcome| Some(term(outcome, i)?.state == State::Measured)));
    let covered = std::array::from_fn(|i| {
        LEVELS.map(|(_, quantile)| {
            if measured[i] < NEARLY_ALL {
                return f64::NAN;
            }
            share(&|outcome| {
                let found = term(outcome, i).filter(|found| found.state == State::Measured)?;
                let end = |end: f64| found.value + (end - found.value) * quantile / full;
                Some((end(found.lower)..=end(found.upper)).contains(&truth[i]))
            })
        })
    });
    let with_end = |outcome: &Judged, i: usize| {
        let found = term(outcome, i)?;
        (!matches!(found.state, State::NotObservable { .. })).then_some(found)
    };
    let covered_effect = std::array::from_fn(|i| {
        let Some(hidden) = hidden else {
            return f64::NAN;
        };
        let name = hidden.effect.name();
        match i.checked_sub(1) {
            None if hidden.replaces_white_noise() => f64::NAN,
            None => share(&|outcome| {
                let found = coefficient(outcome, name)?;
                Some((found.lower..=found.upper).contains(&hidden.coefficient))
            }),
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
    let lists = |of: fn(&Judged) -> &[f64]| outcomes.iter().map(of).collect::<Vec<_>>();
    let octaves = lists(|outcome| &outcome.octaves);
    let bins = lists(|outcome| &outcome.bins);
    let all = |lists: &[&[f64]]| mean_and_deviation(lists.iter().copied().flatten().copied());
    Row {
        preset: format!("{preset:?}").to_lowercase(),
        case,
        effect: hidden.map(|hidden| hidden.effect.name()),
        shape: hidden.map_or([0.0; MAX_PARAMETERS], |hidden| hidden.parameters),
        records: outcomes.len(),
        p_below: [0.05, 0.01].map(|limit| share(&|outcome| Some(outcome.fit.p_value < limit))),
        distance: distances.fold(0.0, f64::max),
        covered,
        bounded: std::array::from_fn(|i| {
            share(&|outcome| Some(with_end(outcome, i)?.upper >= truth[i]))
        }),
        bounds: std::array::from_fn(|i| {
            share(&|outcome| Some(with_end(outcome, i)?.state == State::UpperBound))
        }),
        covered_effect,
        octaves: all(&octaves),
        bins: all(&bins),
        octave_range: range_of_deviations(&octaves),
        bin_range: range_of_deviations(&bins),
    }
}
