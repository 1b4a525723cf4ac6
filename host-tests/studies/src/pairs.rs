//! Studies records with two or three hidden effects of random kinds, sizes and shapes.

use super::{OCTAVES, RATE_HZ, hidden_effect::steps, measured::Measured, said::Said};
use allanite::{
    Term,
    detection::Detection,
    diagnosis::{Options, Step},
    effect::CATALOGUE,
};
use allanite_host::simulate::{Coefficients, Hidden, Preset, Random, Simulator};
use allanite_log::BINS;
use rand::{RngExt, SeedableRng, seq::IndexedRandom};
use rayon::prelude::*;

/// The number of samples of a record, which is 22 minutes long.
pub const SAMPLES: usize = 1 << 17;

/// What adds to the noise, at most one of those in a row of this list that have no frequency.
const ADDED: [&str; 3] = ["sinusoid", "resonance", "gauss_markov"];
/// What the white noise passes.
const FILTERS: [&str; 3] = ["low_pass", "digital_low_pass", "decimation_filter"];
/// Other kinds, which are rarer.
const ADDED_TOO: [&str; 4] = [
    "random_telegraph",
    "power_law",
    "drifting_sinusoid",
    "drifting_resonance",
];
const FILTERS_TOO: [&str; 2] = ["cascade", "notch"];

/// The share of records with a filter.
const FILTERED: f64 = 0.6;

/// Every effect alone is this multiple of its limit of detection.
const OF_LIMIT: f64 = 2.0;

/// The logarithms of two frequencies in a record are this far apart.
const APART: f64 = 0.2;

/// Which kinds are hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kinds {
    /// Lines, resonances, Gauss–Markov noise, low passes and decimation filters.
    Usual,
    /// Every kind of the catalogue.
    Every,
}

/// The counts of records.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// All records.
    pub records: usize,
    /// All that is hidden is named, and nothing else.
    pub exact: usize,
    /// The same if alternatives count.
    pub among: usize,
    /// Something is named that is not hidden.
    pub wrong: usize,
    /// Something hidden is not named.
    pub missing: usize,
    /// The interval of N contains its true value.
    pub covered: usize,
    /// Something is left that has no name.
    pub unexplained: usize,
    /// χ² of a step is larger than that of the step before.
    pub rises: usize,
    /// What was hidden and what was said, of records that are not exact.
    pub others: Vec<(String, String)>,
}

/// A record of a gyro without hidden effects, from which limits of detection are taken.
pub struct Clean {
    measured: Measured,
    step: Step<OCTAVES, BINS>,
}

impl Clean {
    /// A record of a preset.
    pub fn of(base: Coefficients) -> Self {
        let mut simulator = Simulator::new(base, RATE_HZ, 1);
        let measured = Measured::of(&mut simulator, base, SAMPLES);
        let (steps, _) = steps(&measured, Options::default());
        let step = steps.into_iter().last().expect("one step at least");
        Self { measured, step }
    }

    /// Whether the record would have shown an effect of half its size.
    fn shows(&self, hidden: &Hidden) -> bool {
        // An effect with the spectrum of another one has the limit of that one.
        let effect = hidden.effect.mirror().unwrap_or(hidden.effect);
        let mut term = Term::new(effect);
        term.fitted = true;
        term.parameters = hidden.parameters;
        let options = Options::default();
        let detection = Detection::new(self.measured.record(), &self.step, &CATALOGUE, options);
        let Some(limit) = detection.limit_of(term) else {
            return false;
        };
        let first = hidden.effect.parameters().first();
        match (limit.is_of_shape(), first.map(|first| first.unit)) {
            // The size of a notch is its width, which has no limit of its own.
            (true, Some("Hz")) => true,
            (true, _) => hidden.parameters[0] >= OF_LIMIT * limit.size(),
            (false, _) => hidden.coefficient >= OF_LIMIT * limit.size(),
        }
    }
}

/// Draws the effects of a record, each of which the gyro would show alone at half its size.
pub fn draw(
    base: Coefficients,
    clean: &Clean,
    count: usize,
    kinds: Kinds,
    seed: u64,
) -> Vec<Hidden> {
    let mut random = Random::seed_from_u64(seed ^ 0x7061_6972);
    let with = |usual: &[&'static str], more: &[&'static str]| -> Vec<&'static str> {
        let more = more.iter().filter(|_| kinds == Kinds::Every);
        usual.iter().chain(more).copied().collect()
    };
    let (filters, added) = (with(&FILTERS, &FILTERS_TOO), with(&ADDED, &ADDED_TOO));
    loop {
        let mut names: Vec<&str> = Vec::new();
        if random.random::<f64>() < FILTERED {
            names.extend(filters.choose(&mut random).copied());
        }
        while names.len() < count {
            names.extend(added.choose(&mut random).copied());
        }
        let slow = ["gauss_markov", "random_telegraph", "power_law"];
        if names.iter().filter(|name| slow.contains(name)).count() > 1 {
            continue;
        }
        let drawn = names.iter().map(|name| one(base, name, &mut random));
        let drawn: Vec<Hidden> = drawn.collect();
        let frequencies = drawn.iter().filter(|hidden| {
            let first = hidden.effect.parameters().first();
            first.is_some_and(|first| first.unit == "Hz")
        });
        let logs: Vec<f64> = frequencies
            .map(|hidden| hidden.parameters[0].ln())
            .collect();
        let is_near = |(i, a): (usize, &f64)| logs.iter().take(i).any(|b| (a - b).abs() < APART);
        let is_apart = !logs.iter().enumerate().any(is_near);
        if is_apart && drawn.iter().all(|hidden| clean.shows(hidden)) {
            return drawn;
        }
    }
}

/// An effect of random size and shape.
fn one(base: Coefficients, name: &str, random: &mut Random) -> Hidden {
    let mut log = |low: f64, high: f64| low * (high / low).powf(random.random::<f64>());
    let white = base.angle_random_walk * RATE_HZ.sqrt();
    let (parameters, size) = match name {
        "sinusoid" => ([log(0.3, 47.0), 0.0, 0.0], log(0.12, 2.0)),
        "resonance" => ([log(1.0, 40.0), log(3.0, 25.0), 0.0], log(0.25, 2.0)),
        "drifting_sinusoid" => ([log(3.0, 40.0), log(0.3, 2.0), 0.0], log(0.25, 2.0)),
        "drifting_resonance" => (
            [log(3.0, 40.0), log(5.0, 25.0), log(0.3, 2.0)],
            log(0.3, 2.0),
        ),
        "gauss_markov" => ([log(0.3, 20.0), 0.0, 0.0], log(0.3, 1.5)),
        "random_telegraph" => ([log(0.3, 20.0), 0.0, 0.0], log(0.5, 1.5)),
        "power_law" => ([log(0.6, 1.4), 0.0, 0.0], log(0.05, 0.3)),
        "notch" => ([log(5.0, 40.0), log(1.3, 5.0), 0.0], 1.0),
        "decimation_filter" => ([log(0.02, 0.08), log(1.0, 2.0).round(), 0.0], 1.0),
        "cascade" => ([log(0.005, 0.03), log(2.0, 4.0).round(), 0.0], 1.0),
        _ => (
            [
                1.0 / (std::f64::consts::TAU * log(4.0, 35.0)),
                log(1.0, 4.0).round(),
                0.0,
            ],
            1.0,
        ),
    };
    let mut hidden =
        Hidden::new(name, parameters, base.angle_random_walk).expect("of the catalogue");
    if !hidden.replaces_white_noise() {
        hidden.coefficient = size * white;
    }
    hidden
}

/// Diagnoses records of a preset with so many effects.
pub fn study(preset: Preset, count: usize, kinds: Kinds, records: u64) -> Tally {
    let base = preset.coefficients();
    let clean = Clean::of(base);
    let said: Vec<(Vec<Hidden>, Said)> = (0..records)
        .into_par_iter()
        .map(|seed| {
            let hidden = draw(base, &clean, count, kinds, seed);
            let mut simulator = Simulator::with_hidden(base, &hidden, RATE_HZ, seed);
            let measured = Measured::of(&mut simulator, base, SAMPLES);
            (hidden, Said::of(&measured))
        })
        .collect();
    let mut tally = Tally::default();
    for (hidden, said) in &said {
        let names: Vec<&str> = hidden.iter().map(|one| one.effect.name()).collect();
        let truth = hidden.iter().map(|one| {
            let used = one.effect.parameters().len();
            let shape = one
                .parameters
                .iter()
                .take(used)
                .map(|value| format!("{value:.4}"));
            let shape: Vec<String> = shape.collect();
            format!(
                "{}({}) {:.4}",
                one.effect.name(),
                shape.join(", "),
                one.coefficient
            )
        });
        let truth: Vec<String> = truth.collect();
        let covered = said.covers("N", base.angle_random_walk);
        tally.count(&names, &truth.join(" + "), said, covered);
    }
    tally
}

impl Tally {
    /// Counts a record.
    pub fn count(&mut self, hidden: &[&str], truth: &str, said: &Said, covered: bool) {
        let compared = said.compared(hidden);
        self.records += 1;
        self.exact += usize::from(compared.exact);
        self.among += usize::from(compared.among);
        self.wrong += usize::from(compared.wrong);
        self.missing += usize::from(compared.missing);
        self.covered += usize::from(covered);
        self.unexplained += usize::from(said.is_unexplained());
        self.rises += usize::from(said.rises);
        if !compared.exact {
            self.others.push((truth.to_owned(), said.words()));
        }
    }
}
