//! The diagnosis of a simulated gyro that has an effect beyond the five terms, from counts to the effect's
//! name. An image computes it on the target, and the host computes it again to compare the bits.

use super::{
    AMPLITUDES,
    simulated::{Disturbance, SimulatedGyro},
};
use allanite::{
    Axis, Error, Model, Real, Scale,
    axis::{AxisRecord, Gated, Moments, Spectral},
    diagnosis::{Diagnosis, Options, Step, Verdict},
    effect::CATALOGUE,
    spectrum::Spectrum,
};
use core::ops::ControlFlow;

/// The number of octaves of averaging time.
pub const OCTAVES: usize = 20;

/// The number of samples in the record: 22 minutes.
pub const SAMPLES: usize = 1 << 17;

/// The sample rate, in samples per second.
pub const RATE_HZ: Real = 100.0;

/// The number of bins of the spectrum: four levels of 28, the last one of which is sparse.
pub const BINS: usize = 112;

/// What can be hidden.
#[derive(Clone, Copy, Debug)]
pub struct Hidden {
    /// The name of the case, which is the argument of the image.
    pub case: &'static str,
    /// The name of the effect in the catalogue.
    pub effect: &'static str,
    /// What is added to the gyro.
    pub disturbance: Disturbance,
}

impl Hidden {
    const fn new(case: &'static str, effect: &'static str, disturbance: Disturbance) -> Self {
        Self {
            case,
            effect,
            disturbance,
        }
    }
}

/// Everything that can be hidden.
pub const HIDDEN: [Hidden; 5] = [
    Hidden::new(
        // The amplitude is 0.12 °/s at 7.7 Hz.
        "sinusoid_7_7_hz",
        "sinusoid",
        Disturbance::Sinusoid {
            amplitude: 16 << 24,
            turn: 8_032_000,
        },
    ),
    Hidden::new(
        // At a third of the sample rate, an Allan curve shows a line like quantization. The amplitude is a fifth
        // of the white noise's standard deviation. An ellipse of this turn is 1/cos(0.33 π) times as high.
        "sinusoid_33_hz",
        "sinusoid",
        Disturbance::Sinusoid {
            amplitude: 11_190_000,
            turn: 28_881_710,
        },
    ),
    Hidden::new(
        // The white noise keeps its density below 20 Hz.
        "low_pass_20_hz",
        "low_pass",
        Disturbance::TwoPoleLowPass {
            deviation: 73_130_000,
        },
    ),
    Hidden::new(
        // The rms is 0.03 °/s, with a correlation time of 1.28 s.
        "gauss_markov_1_28_s",
        "gauss_markov",
        Disturbance::GaussMarkov {
            deviation: 4 << 24,
            relaxation: 7,
        },
    ),
    Hidden::new(
        // The width is 30 ms.
        "decimation_filter_30_ms",
        "decimation_filter",
        Disturbance::MovingAverage { length: 3 },
    ),
];

/// The disturbance of the case with this name; `None` if there is none.
pub fn hidden(case: &str) -> Option<Disturbance> {
    let named = HIDDEN.iter().find(|hidden| hidden.case == case);
    named.map(|hidden| hidden.disturbance)
}

/// Simulates a gyro with a disturbance and with noise from this seed, and diagnoses it. The diagnosis
/// receives only the counts. `report` is called with every step.
///
/// # Errors
/// The errors of [`Diagnosis::run`].
pub fn diagnose(
    disturbance: Option<Disturbance>,
    seed: u64,
    mut report: impl FnMut(&Step<OCTAVES, BINS>),
) -> Result<Verdict, Error> {
    let record = recorded(disturbance, seed)?;
    let (model, options) = (Model::ieee_952(), Options::default());
    let mut diagnosis = Diagnosis::new(&record, &model, &CATALOGUE, options);
    loop {
        // A pause that never ends the work leads to a verdict.
        let mut pause = || ControlFlow::Continue(());
        if let Some(verdict) = diagnosis.run(&mut report, &mut pause)? {
            return Ok(verdict);
        }
    }
}

/// The curve, the spectrum and the kurtosis.
type Recorded = AxisRecord<OCTAVES, 0, Spectrum<BINS>>;

/// Records in a separate call, so that the gyro and the record leave the stack before the diagnosis.
#[inline(never)]
fn recorded(disturbance: Option<Disturbance>, seed: u64) -> Result<Recorded, Error> {
    let mut gyro = Axis::<OCTAVES, 0, Gated, Moments, Spectral<64, 7, BINS>>::new();
    for count in SimulatedGyro::disturbed(AMPLITUDES, disturbance, seed).take(SAMPLES) {
        gyro.push(count);
    }
    gyro.record(0, Scale::new(1.0 / 131.0, RATE_HZ)?)
}

/// The default seed of the noise.
pub const SEED: u64 = 1952;
