//! Studies stationary records whose five terms have random sizes: how often an effect, a step, a warm-up or a change
//! of the noise is told that is not there.

use super::{
    RATE_HZ,
    clean::{LENGTHS, covered},
    measured::Sums,
    quantum,
};
use allanite::{
    Model, Scale,
    course::What,
    diagnosis::Options,
    effect::{CATALOGUE, IEEE_952},
};
use allanite_host::{
    diagnosis,
    simulate::{Coefficients, Random, Simulator},
    stationarity::Stationarity,
};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use std::f64::consts::{LN_2, PI};

/// The terms that a gyro has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Terms {
    /// All five terms.
    All,
    /// White noise, rate random walk and rate ramp.
    WalkAndRamp,
}

/// How a record's rates are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stored {
    /// As floats, which the program rounds far below their noise.
    Floats,
    /// As counts of a size between a hundredth and the whole of a sample's standard deviation.
    Counts,
}

/// The records of one length.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// The number of records.
    pub records: usize,
    /// Records in which the fit or the diagnosis ends without a result.
    pub aborted: usize,
    /// The first effect that is told, for every record of which one is told.
    pub told: Vec<&'static str>,
    /// The seeds of the records that are called not stationary.
    pub not_stationary: Vec<u64>,
    /// Records with an event of each kind: noise change, bursts, step, warm-up.
    pub events: [usize; 4],
    /// Records in which the p-value of the five terms is below 5 %.
    pub improbable: usize,
    /// Records in which the interval or the bound of each of the five terms contains its true value.
    pub covered: [usize; 5],
}

/// What is said about one record.
struct Said {
    told: Option<&'static str>,
    is_disturbed: bool,
    events: [bool; 4],
    is_improbable: bool,
    covered: [bool; 5],
}

/// Diagnoses `records` records of every length of [`LENGTHS`], from the seed `first` on.
pub fn study(terms: Terms, stored: Stored, first: u64, records: u64) -> [Tally; LENGTHS.len()] {
    LENGTHS.map(|length| {
        let seeds = (first..first.saturating_add(records)).into_par_iter();
        let said: Vec<(u64, Option<Said>)> = seeds
            .map(|seed| (seed, said(terms, stored, length, seed)))
            .collect();
        let mut tally = Tally::default();
        for (seed, said) in said {
            tally.records += 1;
            let Some(said) = said else {
                tally.aborted += 1;
                continue;
            };
            tally.told.extend(said.told);
            tally
                .not_stationary
                .extend(said.is_disturbed.then_some(seed));
            for (count, is_told) in tally.events.iter_mut().zip(said.events) {
                *count += usize::from(is_told);
            }
            tally.improbable += usize::from(said.is_improbable);
            for (count, covers) in tally.covered.iter_mut().zip(said.covered) {
                *count += usize::from(covers);
            }
        }
        tally
    })
}

/// The coefficients of a gyro whose white noise has the coefficient 1.
///
/// Each other term is as large as the white noise at an averaging time that is drawn log-uniformly: quantization
/// between a thirtieth of a sample interval and 30 of them, bias instability and rate random walk between ten sample
/// intervals and ten times the record, the rate ramp between a hundred sample intervals and ten times the record.
pub fn coefficients(terms: Terms, samples: u64, random: &mut Random) -> Coefficients {
    let interval_s = 1.0 / RATE_HZ;
    let duration_s = samples as f64 * interval_s;
    let mut draw = |low: f64, high: f64| low * (high / low).powf(random.random::<f64>());
    let quantization_s = draw(interval_s / 30.0, 30.0 * interval_s);
    let flicker_s = draw(10.0 * interval_s, 10.0 * duration_s);
    let walk_s = draw(10.0 * interval_s, 10.0 * duration_s);
    let ramp_s = draw(100.0 * interval_s, 10.0 * duration_s);
    // σ² = 3Q²/τ², N²/τ, (2 ln 2/π)B², K²τ/3 and R²τ²/2, at these averaging times.
    let all = Coefficients {
        quantization: (quantization_s / 3.0).sqrt(),
        angle_random_walk: 1.0,
        bias_instability: (PI / (2.0 * LN_2 * flicker_s)).sqrt(),
        rate_random_walk: 3f64.sqrt() / walk_s,
        rate_ramp: 2f64.sqrt() / (ramp_s * ramp_s.sqrt()),
    };
    match terms {
        Terms::All => all,
        Terms::WalkAndRamp => Coefficients {
            quantization: 0.0,
            bias_instability: 0.0,
            ..all
        },
    }
}

/// Simulates a record and diagnoses it as the program does.
fn said(terms: Terms, stored: Stored, length: u32, seed: u64) -> Option<Said> {
    let samples = 1_u64 << length;
    let mut random = Random::seed_from_u64(seed ^ 0x316C_5000);
    let coefficients = coefficients(terms, samples, &mut random);
    let deviation = coefficients.angle_random_walk * RATE_HZ.sqrt();
    let count = match stored {
        Stored::Floats => quantum(coefficients, RATE_HZ),
        Stored::Counts => deviation * 0.01f64.powf(random.random::<f64>()),
    };
    let mut sums = Sums::new();
    let mut simulator = Simulator::new(coefficients, RATE_HZ, seed);
    while sums.samples() < samples {
        let rate = simulator.next().unwrap_or_default();
        sums.push_slice(&[(rate / count).round() as i32]);
    }
    let scale = Scale::new(count, RATE_HZ).expect("positive");
    let measured = sums.measured(scale);
    let (mut five_terms, mut last, mut told) = (None, None, None);
    let model = Model::ieee_952();
    let options = Options::default();
    diagnosis::diagnose(measured.record(), &model, &CATALOGUE, options, |step| {
        five_terms.get_or_insert_with(|| step.fit.clone());
        let is_own = |name: &str| IEEE_952.iter().any(|effect| effect.name() == name);
        let mut terms = step.model.terms().iter();
        let added = terms.find(|term| !is_own(term.effect.name()));
        told = told.or(added.map(|term| term.effect.name()));
        last = Some(step.model.clone());
    })
    .ok()?;
    let stationarity = Stationarity::of(sums.course(), scale, &measured.curve, &last?, &[]).ok()?;
    let has = |kind: fn(&What) -> bool| stationarity.events.iter().any(|event| kind(&event.what));
    Some(Said {
        told,
        is_disturbed: stationarity.is_disturbed(),
        events: [
            has(|what| matches!(what, What::NoiseChange)),
            has(|what| matches!(what, What::Bursts { .. })),
            has(|what| matches!(what, What::Step)),
            has(|what| matches!(what, What::WarmUp { .. })),
        ],
        is_improbable: five_terms.as_ref()?.p_value < 0.05,
        covered: covered(coefficients, five_terms.as_ref()?),
    })
}
