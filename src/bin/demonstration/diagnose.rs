//! The diagnosis of a simulated gyro that has an effect beyond the five terms, from counts to the effect's
//! name. An image computes it on the target, and the host computes it again to compare the bits.

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

/// The number of octaves of averaging time.
pub const OCTAVES: usize = 20;

/// The number of samples in the record: 22 minutes.
pub const SAMPLES: usize = 1 << 17;

/// The sample rate, in samples per second.
pub const RATE_HZ: Real = 100.0;

/// The effects that can be hidden, with their names in the catalogue.
pub const HIDDEN: [(&str, Disturbance); 3] = [
    (
        // The amplitude is 0.12 °/s at 7.7 Hz.
        "sinusoid",
        Disturbance::Sinusoid {
            amplitude: 16 << 24,
            turn: 8_032_000,
        },
    ),
    (
        // The rms is 0.03 °/s, with a correlation time of 1.28 s.
        "gauss_markov",
        Disturbance::GaussMarkov {
            deviation: 4 << 24,
            relaxation: 7,
        },
    ),
    (
        // The width is 30 ms.
        "decimation_filter",
        Disturbance::MovingAverage { length: 3 },
    ),
];

/// The disturbance with this name; `None` if there is none.
pub fn hidden(name: &str) -> Option<Disturbance> {
    let named = HIDDEN.iter().find(|(hidden, _)| *hidden == name);
    named.map(|&(_, disturbance)| disturbance)
}

/// Simulates a gyro with a disturbance and with noise from this seed, and diagnoses it. The diagnosis
/// receives only the counts. `report` is called with every step.
///
/// # Errors
/// The errors of [`Diagnosis::run`].
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

/// Records in a separate call, so that the gyro and the record leave the stack before the diagnosis.
#[inline(never)]
fn recorded(disturbance: Option<Disturbance>, seed: u64) -> Result<AxisEvidence<OCTAVES>, Error> {
    let mut gyro = Axis::<OCTAVES>::new();
    for count in SimulatedGyro::disturbed(AMPLITUDES, disturbance, seed).take(SAMPLES) {
        gyro.push(count);
    }
    gyro.release();
    gyro.evidence(0, Scale::new(1.0 / 131.0, RATE_HZ)?, [])
}

/// The default seed of the noise.
pub const SEED: u64 = 1952;
