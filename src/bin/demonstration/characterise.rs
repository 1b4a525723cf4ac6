//! The characterisation of a simulated gyro, from counts to coefficients.

use super::{AMPLITUDES, double, simulated::SimulatedGyro};
use allanite::{
    Axis, Coefficient, Curve, Error, Model, Scale,
    fit::{Fit, Options, fit},
};

/// The number of octaves of averaging time.
pub const OCTAVES: usize = 18;

/// The number of samples in the record: 44 minutes.
pub const SAMPLES: usize = 1 << 18;

/// The default seed of the noise.
pub const SEED: u64 = 952;

/// The results of the characterisation.
#[derive(Clone, Debug, PartialEq)]
pub struct Characterised {
    /// The Allan curve, in °/s.
    pub curve: Curve<OCTAVES>,
    /// The five coefficients, in °/s and seconds.
    pub fit: Fit,
    /// The simulated coefficients.
    pub truth: [f64; 5],
}

impl Characterised {
    /// Simulates a gyro with noise from this seed, accumulates its counts and fits the curve.
    ///
    /// # Errors
    /// The errors of [`fit`].
    pub fn run(seed: u64) -> Result<Self, Error> {
        let scale = Scale::new(1.0 / 131.0, 100.0)?;
        let curve = accumulated(scale, seed);
        let fit = fit(&curve, &Model::ieee_952(), Options::default())?;
        Ok(Self {
            curve,
            fit,
            truth: AMPLITUDES.coefficients(scale),
        })
    }

    /// Whether the model explains the curve (p > 0.1 %) and the square of every coefficient is within four
    /// standard errors of the simulated one.
    pub fn passed(&self) -> bool {
        let within = |(coefficient, truth): (&Coefficient, &f64)| {
            let square = double(coefficient.square);
            (square - truth * truth).abs() <= 4.0 * double(coefficient.square_error)
        };
        self.fit.p_value > 1e-3 && self.fit.coefficients.iter().zip(&self.truth).all(within)
    }
}

/// Accumulates in a separate call, so that on a core with 16 KiB of RAM the gyro and the record leave the
/// stack before the fit.
#[inline(never)]
fn accumulated(scale: Scale, seed: u64) -> Curve<OCTAVES> {
    let mut gyro = Axis::<OCTAVES, 0, (), ()>::new();
    for count in SimulatedGyro::new(AMPLITUDES, seed).take(SAMPLES) {
        gyro.push(count);
    }
    let [accumulator] = gyro.accumulators();
    accumulator.curve(scale)
}
