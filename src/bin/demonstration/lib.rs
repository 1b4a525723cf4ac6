//! The whole chain from counts to results on a simulated gyro. The images compute it on the target, and the
//! host computes it again from the same source files to compare the bits.

#![no_std]

pub mod appliance;
pub mod characterise;
pub mod diagnose;
pub mod lines;
pub mod product;
pub mod simulated;
pub mod soak;
pub mod stream;

use simulated::Amplitudes;

/// A MEMS gyro of 131 counts per °/s at 100 Hz: Q 2e-4 °, N 5e-3 °/s/√Hz, B 4e-3 °/s, K 3e-4
/// °/s/√s, R 5e-6 °/s².
pub const AMPLITUDES: Amplitudes = Amplitudes {
    quantization: 43_700_000,
    white: 109_900_000,
    flicker: 4_130_000,
    walk: 65_900,
    ramp: 110,
};

/// A number in double precision, for either precision of the library.
pub fn double(x: impl Into<f64>) -> f64 {
    x.into()
}
