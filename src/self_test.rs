//! The whole chain on a simulated gyro, from counts to coefficients: what the image computes on the
//! target, and the host again, to compare the bits.

use crate::{
    coefficient::Coefficient,
    curve::{Curve, Scale},
    error::Error,
    fit::{Fit, Settings, fit},
    model::Model,
    octave::Accumulator,
    simulated::{Amplitudes, SimulatedGyro},
};

/// Octaves of averaging time.
pub const OCTAVES: usize = 20;

/// Length of the record.
pub const SAMPLES: usize = 1 << 20;

/// A MEMS gyro of 131 counts per °/s at 100 Hz: Q 2e-4 °, N 5e-3 °/s/√Hz, B 4e-3 °/s, K 3e-4
/// °/s/√s, R 5e-6 °/s².
pub const AMPLITUDES: Amplitudes = Amplitudes {
    quantization: 43_700_000,
    white: 109_900_000,
    flicker: 4_130_000,
    walk: 65_900,
    ramp: 110,
};

const SEED: u64 = 952;

/// What came out.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SelfTest {
    /// The Allan curve, in °/s.
    pub curve: Curve<OCTAVES>,
    /// The five coefficients, in °/s and seconds.
    pub fit: Fit,
    /// The simulated coefficients.
    pub truth: [f64; 5],
}

impl SelfTest {
    /// Simulates, accumulates and fits.
    ///
    /// # Errors
    /// Those of [`fit`].
    pub fn run() -> Result<Self, Error> {
        let scale = Scale::new(1.0 / 131.0, 100.0)?;
        let mut accumulator = Accumulator::<OCTAVES>::new();
        for count in SimulatedGyro::new(AMPLITUDES, SEED).take(SAMPLES) {
            accumulator.push(count);
        }
        let curve = accumulator.curve(scale);
        let fit = fit(&curve, &Model::ieee_952(), Settings::default())?;
        Ok(Self {
            curve,
            fit,
            truth: AMPLITUDES.coefficients(scale),
        })
    }

    /// Whether the curve is explained (p > 0.1 %), and every coefficient within four standard
    /// errors of the simulated one.
    pub fn passed(&self) -> bool {
        let within = |(coefficient, truth): (&Coefficient, &f64)| {
            let square = truth * truth;
            (coefficient.square - square).abs() <= 4.0 * coefficient.square_error
        };
        self.fit.p_value > 1e-3 && self.fit.coefficients.iter().zip(&self.truth).all(within)
    }
}
