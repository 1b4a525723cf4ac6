//! Studies whether a line of any frequency and size is found, whether anything is named beside it, and whether the interval
//! of a frequency near half the sample rate holds it.

use super::{OCTAVES, RATE_HZ, measured::Measured};
use allanite::{
    Model, Term,
    diagnosis::{Options, Step},
    effect::{CATALOGUE, Effect, IEEE_952, Sinusoid},
    fit::fit,
};
use allanite_host::{
    diagnosis,
    simulate::{Hidden, Preset, Random, Simulator},
};
use allanite_log::BINS;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

/// The number of samples of a record, which is 11 minutes long.
const SAMPLES: usize = 1 << 16;

/// The range of frequencies, in Hz: from 13 periods in a record to half the sample rate.
const FREQUENCIES_HZ: (f64, f64) = (0.02, 50.0);

/// The range of amplitudes, relative to the standard deviation of the white noise of a sample.
const AMPLITUDES: (f64, f64) = (0.1, 60.0);

/// A line that is drawn at random.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// The frequency in Hz.
    pub frequency_hz: f64,
    /// The amplitude, in the rate unit of the gyro.
    pub amplitude: f64,
}

/// What a diagnosis says about a record with one line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Said {
    /// The five-term fit or the diagnosis ends without a result.
    Aborted,
    /// The five terms are called adequate.
    Nothing,
    /// A sinusoid, and nothing else.
    Line {
        /// Its frequency is off by less than 1 %.
        is_exact: bool,
        /// Another effect is said to explain the curve as well.
        is_ambiguous: bool,
    },
    /// A sinusoid and another effect.
    LineAndMore,
    /// Effects without a sinusoid.
    Others,
    /// The model is inadequate, and no effect helps.
    Unexplained,
}

/// The number of records by what was said, and the lines of which something else was said than the line
/// alone or nothing.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// The number of records.
    pub records: usize,
    /// Records without a result.
    pub aborted: usize,
    /// Records in which nothing is missing.
    pub nothing: usize,
    /// Records with the line alone.
    pub line: usize,
    /// Those of them with a frequency that is off by less than 1 %.
    pub exact: usize,
    /// Those of them with another effect that would explain the curve as well.
    pub ambiguous: usize,
    /// Records with the line and another effect.
    pub more: usize,
    /// Records with other effects only.
    pub others: usize,
    /// Records in which no effect helps.
    pub unexplained: usize,
    /// The lines of the last three kinds, with the effects that were named.
    pub wrong: Vec<(Line, Vec<Term>)>,
}

/// Diagnoses records of a gyro, each with a line of random frequency and amplitude, both uniform in their
/// logarithm.
pub fn study(preset: Preset, records: u64) -> Tally {
    let outcomes: Vec<(Line, Said, Vec<Term>)> = (0..records)
        .into_par_iter()
        .map(|seed| {
            let line = draw(preset, seed);
            let (said, named) = diagnose(preset, line, seed);
            (line, said, named)
        })
        .collect();
    let mut tally = Tally::default();
    for (line, said, named) in outcomes {
        tally.records += 1;
        match said {
            Said::Aborted => tally.aborted += 1,
            Said::Nothing => tally.nothing += 1,
            Said::Line {
                is_exact,
                is_ambiguous,
            } => {
                tally.line += 1;
                tally.exact += usize::from(is_exact);
                tally.ambiguous += usize::from(is_ambiguous);
            }
            Said::LineAndMore => tally.more += 1,
            Said::Others => tally.others += 1,
            Said::Unexplained => tally.unexplained += 1,
        }
        if matches!(said, Said::LineAndMore | Said::Others | Said::Unexplained) {
            tally.wrong.push((line, named));
        }
    }
    tally
}

/// The line of a seed.
pub fn draw(preset: Preset, seed: u64) -> Line {
    let mut random = Random::seed_from_u64(seed ^ 0x6c69_6e65);
    let mut between = |(low, high): (f64, f64)| low * (high / low).powf(random.random::<f64>());
    let white = preset.coefficients().angle_random_walk * RATE_HZ.sqrt();
    Line {
        frequency_hz: between(FREQUENCIES_HZ),
        amplitude: white * between(AMPLITUDES),
    }
}

/// Diagnoses a record with a line, and returns the effects that are named, too.
pub fn diagnose(preset: Preset, line: Line, seed: u64) -> (Said, Vec<Term>) {
    let (is_complete, steps) = steps(preset, line, seed);
    let (true, Some(last)) = (is_complete, steps.last()) else {
        return (Said::Aborted, Vec::new());
    };
    let terms = last.model.terms().iter();
    let is_own = |term: &Term| IEEE_952.iter().any(|five| same(*five, term));
    let added: Vec<Term> = terms.filter(|term| !is_own(term)).copied().collect();
    let is_line = |term: &Term| same(&Sinusoid, term);
    let said = match added.as_slice() {
        [] if last.fit.is_adequate() == Some(false) => Said::Unexplained,
        [] => Said::Nothing,
        [only] if is_line(only) => Said::Line {
            is_exact: (only.parameters[0] / line.frequency_hz - 1.0).abs() < 0.01,
            is_ambiguous: steps.iter().any(|step| !step.ambiguous.is_empty()),
        },
        all if all.iter().any(is_line) => Said::LineAndMore,
        _ => Said::Others,
    };
    (said, added)
}

/// The steps of the diagnosis of a record with a line, and whether it ends without an error.
fn steps(preset: Preset, line: Line, seed: u64) -> (bool, Vec<Step<OCTAVES, BINS>>) {
    let base = preset.coefficients();
    let hidden = Hidden {
        effect: &Sinusoid,
        parameters: [line.frequency_hz, 0.0, 0.0],
        coefficient: line.amplitude,
    };
    let mut simulator = Simulator::with_hidden(base, &[hidden], RATE_HZ, seed);
    let measured = Measured::of(&mut simulator, base, SAMPLES);
    let (model, options) = (Model::ieee_952(), Options::default());
    let mut steps = Vec::new();
    if fit(&measured.curve, &model, allanite::fit::Options::default()).is_err() {
        return (false, steps);
    }
    let verdict = diagnosis::diagnose(measured.record(), &model, &CATALOGUE, options, |step| {
        steps.push(step.clone());
    });
    (verdict.is_ok(), steps)
}

/// The frequencies near half the sample rate, relative to it, and the amplitudes of their lines, relative to the standard
/// deviation of the white noise of a sample.
const NEAR_HALF: (f64, f64) = (0.97, 0.9999);
const AMPLITUDES_NEAR_HALF: (f64, f64) = (0.3, 2.0);

/// The number of records with a line near half the sample rate.
#[derive(Clone, Copy, Debug, Default)]
pub struct NearHalf {
    /// The number of records.
    pub records: usize,
    /// Those in which a line is found.
    pub found: usize,
    /// Those in which the 95 % interval of its frequency holds the true one.
    pub covered: usize,
    /// The sum of the errors of the frequencies in Hz.
    pub error_hz: f64,
}

/// Diagnoses records of a gyro with a line near half the sample rate. The frequency is uniform and the amplitude is so in
/// its logarithm.
pub fn near_half(preset: Preset, records: u64) -> NearHalf {
    let one = |seed: u64| {
        let mut random = Random::seed_from_u64(seed ^ 0x6e79_7175);
        let share = |random: &mut Random, (low, high): (f64, f64)| {
            low + (high - low) * random.random::<f64>()
        };
        let white = preset.coefficients().angle_random_walk * RATE_HZ.sqrt();
        let (low, high) = AMPLITUDES_NEAR_HALF;
        let line = Line {
            frequency_hz: 0.5 * RATE_HZ * share(&mut random, NEAR_HALF),
            amplitude: white * share(&mut random, (low.ln(), high.ln())).exp(),
        };
        (line.frequency_hz, interval(preset, line, seed))
    };
    let found: Vec<(f64, Option<[f64; 3]>)> = (0..records).into_par_iter().map(one).collect();
    let mut tally = NearHalf::default();
    for (frequency_hz, interval) in found {
        tally.records += 1;
        if let Some([lower, value, upper]) = interval {
            tally.found += 1;
            tally.covered += usize::from((lower..=upper).contains(&frequency_hz));
            tally.error_hz += value - frequency_hz;
        }
    }
    tally
}

/// The frequency of the line in the last model of a diagnosis, between the ends of its interval.
fn interval(preset: Preset, line: Line, seed: u64) -> Option<[f64; 3]> {
    let (_, steps) = steps(preset, line, seed);
    let last = steps.last()?;
    let is_line = |at: usize| {
        last.model
            .terms()
            .get(at)
            .is_some_and(|term| same(&Sinusoid, term))
    };
    let shape = last.fit.shape.iter().find(|shape| is_line(shape.term))?;
    Some([shape.lower, shape.value, shape.upper])
}

fn same(effect: &dyn Effect, term: &Term) -> bool {
    effect.name() == term.effect.name()
}
