//! Studies records of the five terms alone: how often an effect is claimed that is not there, and how often a
//! term is called measured that is truly absent.

use super::{
    RATE_HZ,
    measured::{Measured, Sums},
    quantum,
};
use allanite::{
    Model, Scale,
    diagnosis::Options,
    effect::{CATALOGUE, IEEE_952},
    fit::{Fit, State},
};
use allanite_host::{
    diagnosis,
    simulate::{Coefficients, Preset, Simulator},
};
use rayon::prelude::*;

/// The lengths of the records, in octaves of samples.
pub const LENGTHS: [u32; 5] = [12, 14, 16, 18, 20];

/// Which of the five terms the simulated gyro lacks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Absent {
    /// It has all of them.
    None,
    /// It lacks the term at this place of [`IEEE_952`].
    Term(usize),
}

/// The records of one length.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// The number of records.
    pub records: usize,
    /// Records in which the fit or the diagnosis ends without a result.
    pub aborted: usize,
    /// Records of which the five terms are called inadequate.
    pub inadequate: usize,
    /// The first effect that is claimed, for every record with a claim.
    pub claimed: Vec<&'static str>,
    /// Records in which each of the five terms is called measured.
    pub measured: [usize; 5],
    /// Records in which the interval or the bound of each of the five terms contains its true value.
    pub covered: [usize; 5],
}

/// What is said about one record.
struct Said {
    adequate: Option<bool>,
    claimed: Option<&'static str>,
    measured: [bool; 5],
    covered: [bool; 5],
}

/// Diagnoses records of every length of [`LENGTHS`]. The records of a seed begin with the same samples.
pub fn study(coefficients: Coefficients, records: u64) -> [Tally; LENGTHS.len()] {
    let said: Vec<[Option<Said>; LENGTHS.len()]> = (0..records)
        .into_par_iter()
        .map(|seed| {
            records_of(coefficients, seed).map(|measured| diagnose(coefficients, &measured))
        })
        .collect();
    std::array::from_fn(|length| {
        let mut tally = Tally::default();
        for record in &said {
            tally.records += 1;
            let Some(said) = &record[length] else {
                tally.aborted += 1;
                continue;
            };
            tally.inadequate += usize::from(said.adequate == Some(false));
            tally.claimed.extend(said.claimed);
            for i in 0..5 {
                tally.measured[i] += usize::from(said.measured[i]);
                tally.covered[i] += usize::from(said.covered[i]);
            }
        }
        tally
    })
}

/// The coefficients of a gyro that lacks a term.
pub fn without(preset: Preset, absent: Absent) -> Coefficients {
    let mut coefficients = preset.coefficients();
    let fields = [
        &mut coefficients.quantization,
        &mut coefficients.angle_random_walk,
        &mut coefficients.bias_instability,
        &mut coefficients.rate_random_walk,
        &mut coefficients.rate_ramp,
    ];
    if let Absent::Term(i) = absent {
        *fields.into_iter().nth(i).expect("one of five") = 0.0;
    }
    coefficients
}

/// A record at each of its lengths.
fn records_of(coefficients: Coefficients, seed: u64) -> [Measured; LENGTHS.len()] {
    let mut simulator = Simulator::new(coefficients, RATE_HZ, seed);
    let quantum = quantum(coefficients, RATE_HZ);
    let scale = Scale::new(quantum, RATE_HZ).expect("positive");
    let mut sums = Sums::new();
    LENGTHS.map(|length| {
        while sums.samples() < 1 << length {
            let rate = simulator.next().unwrap_or_default();
            sums.push_slice(&[(rate / quantum).round() as i32]);
        }
        sums.measured(scale)
    })
}

fn diagnose(coefficients: Coefficients, measured: &Measured) -> Option<Said> {
    let mut first = None;
    let mut claimed = None;
    let model = Model::ieee_952();
    let (record, options) = (measured.record(), Options::default());
    let verdict = diagnosis::diagnose(record, &model, &CATALOGUE, options, |step| {
        first.get_or_insert_with(|| step.fit.clone());
        let is_own = |name: &str| IEEE_952.iter().any(|effect| effect.name() == name);
        let mut terms = step.model.terms().iter();
        let added = terms.find(|term| !is_own(term.effect.name()));
        claimed = claimed.or(added.map(|term| term.effect.name()));
    });
    verdict.ok()?;
    let fit = first?;
    Some(Said {
        adequate: fit.is_adequate(),
        claimed,
        measured: std::array::from_fn(|i| fit.coefficients[i].state == State::Measured),
        covered: covered(coefficients, &fit),
    })
}

/// Whether the interval or the bound of each of the five terms contains its true value.
pub(super) fn covered(coefficients: Coefficients, fit: &Fit) -> [bool; 5] {
    let truth = super::theory::squares(coefficients).map(f64::sqrt);
    std::array::from_fn(|i| {
        let found = &fit.coefficients[i];
        (found.lower..=found.upper).contains(&truth[i])
    })
}
