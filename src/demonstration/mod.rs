//! The whole chain on a simulated gyro: what an image computes on the target, and the host again, to
//! compare the bits.

pub mod characterise;
pub mod diagnose;
pub mod stream;
pub mod tell;

use crate::simulated::Amplitudes;

/// A MEMS gyro of 131 counts per °/s at 100 Hz: Q 2e-4 °, N 5e-3 °/s/√Hz, B 4e-3 °/s, K 3e-4
/// °/s/√s, R 5e-6 °/s².
pub const AMPLITUDES: Amplitudes = Amplitudes {
    quantization: 43_700_000,
    white: 109_900_000,
    flicker: 4_130_000,
    walk: 65_900,
    ramp: 110,
};
