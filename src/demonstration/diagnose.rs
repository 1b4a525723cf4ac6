//! A hidden effect found with no host: counts of a simulated gyro that has more than the five terms,
//! accumulated, fitted, compared and diagnosed. What an image computes on the target, and the host again,
//! to compare the bits.

use super::AMPLITUDES;
use crate::{
    curve::Scale,
    diagnosis::{Diagnosis, Evidence, Options, Step, Verdict},
    effect::CATALOGUE,
    error::Error,
    integrity::Integrity,
    kurtosis::FourthMoments,
    model::Model,
    octave::Accumulator,
    real::Real,
    simulated::{Disturbance, SimulatedGyro},
};

/// Octaves of averaging time.
pub const OCTAVES: usize = 20;

/// Length of the record: 22 minutes.
pub const SAMPLES: usize = 1 << 17;

/// Samples per second.
pub const RATE_HZ: Real = 100.0;

/// Names of what can be hidden, those of the effects.
pub const HIDDEN: [(&str, Disturbance); 3] = [
    (
        // 0.12 °/s at 7.7 Hz.
        "sinusoid",
        Disturbance::Sinusoid {
            amplitude: 16 << 24,
            turn: 8_032_000,
        },
    ),
    (
        // 0.03 °/s, correlated over 1.28 s.
        "gauss_markov",
        Disturbance::GaussMarkov {
            deviation: 4 << 24,
            relaxation: 7,
        },
    ),
    (
        // 30 ms.
        "decimation_filter",
        Disturbance::MovingAverage { length: 3 },
    ),
];

/// The disturbance of that name.
pub fn hidden(name: &str) -> Option<Disturbance> {
    let named = HIDDEN.iter().find(|(hidden, _)| *hidden == name);
    named.map(|&(_, disturbance)| disturbance)
}

/// Simulates a gyro with a disturbance, its noise of a seed, and diagnoses it; every step is handed to
/// `report`. The diagnosis knows the counts alone.
///
/// # Errors
/// As of [`Diagnosis::run`].
pub fn diagnose(
    disturbance: Option<Disturbance>,
    seed: u64,
    report: impl FnMut(&Step<OCTAVES>),
) -> Result<Verdict, Error> {
    let mut accumulator = Accumulator::<OCTAVES>::new();
    let mut moments = FourthMoments::<OCTAVES>::new();
    let mut integrity = Integrity::default();
    for count in SimulatedGyro::disturbed(AMPLITUDES, disturbance, seed).take(SAMPLES) {
        accumulator.push(count);
        moments.push(count);
        integrity.push(count);
    }
    let curve = accumulator.curve(Scale::new(1.0 / 131.0, RATE_HZ)?);
    let kurtosis = moments.kurtosis();
    let evidence = Evidence {
        kurtosis: Some(&kurtosis),
        covariates: &[],
        invalid: integrity.verdict(),
    };
    let model = Model::ieee_952();
    Diagnosis::new(curve, evidence, &model, &CATALOGUE, Options::default())?.run(report)
}

/// The seed of its noise, where there is no reason for another.
pub const SEED: u64 = 1952;
