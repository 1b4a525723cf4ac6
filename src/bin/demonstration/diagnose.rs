//! From counts to a hidden effect: a simulated gyro that has more than the five terms is recorded and
//! diagnosed. An image computes this on the target, and the host computes it again, to compare the bits.

use super::{
    AMPLITUDES,
    simulated::{Disturbance, SimulatedGyro},
};
use allanite::{
    Axis, Error, Model, Real, Scale,
    axis::AxisEvidence,
    diagnosis::{Diagnosis, Options, Step, Verdict},
    effect::CATALOGUE,
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
    let record = recorded(disturbance, seed)?;
    let (model, options) = (Model::ieee_952(), Options::default());
    let curve = record.curve.clone();
    Diagnosis::new(curve, record.evidence(), &model, &CATALOGUE, options).run(report)
}

/// A call of its own: gyro and record leave the stack to the diagnosis.
#[inline(never)]
fn recorded(disturbance: Option<Disturbance>, seed: u64) -> Result<AxisEvidence<OCTAVES>, Error> {
    let mut gyro = Axis::<OCTAVES>::new();
    for count in SimulatedGyro::disturbed(AMPLITUDES, disturbance, seed).take(SAMPLES) {
        gyro.push(count);
    }
    gyro.release();
    gyro.evidence(0, Scale::new(1.0 / 131.0, RATE_HZ)?, [])
}

/// The seed of its noise, where there is no reason for another.
pub const SEED: u64 = 1952;
