//! Studies whether a line of any frequency and size is found, and whether anything is named beside it.

use super::{OCTAVES, RATE_HZ, measured::Measured};
use crate::{
    diagnosis,
    log::BINS,
    simulate::{Hidden, Preset, Random, Simulator},
};
use allanite::{
    Model, Term,
    diagnosis::{Options, Step},
    effect::{CATALOGUE, Effect, IEEE_952, Sinusoid},
    fit::fit,
};
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
    let base = preset.coefficients();
    let hidden = Hidden {
        effect: &Sinusoid,
        parameters: [line.frequency_hz, 0.0, 0.0],
        coefficient: line.amplitude,
    };
    let mut simulator = Simulator::with_hidden(base, &[hidden], RATE_HZ, seed);
    let measured = Measured::of(&mut simulator, base, SAMPLES);
    let (model, options) = (Model::ieee_952(), Options::default());
    if fit(&measured.curve, &model, allanite::fit::Options::default()).is_err() {
        return (Said::Aborted, Vec::new());
    }
    let mut steps: Vec<Step<OCTAVES, BINS>> = Vec::new();
    let verdict = diagnosis::diagnose(measured.record(), &model, &CATALOGUE, options, |step| {
        steps.push(step.clone());
    });
    let (Ok(_), Some(last)) = (verdict, steps.last()) else {
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

fn same(effect: &dyn Effect, term: &Term) -> bool {
    effect.name() == term.effect.name()
}
