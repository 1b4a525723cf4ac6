//! The spectrum of a record: an accumulator of power spectral densities over block means, what every effect
//! is expected to add to them, and how they scatter.
//!
//! Twenty octaves keep what a power law leaves in a record, but not its fine structure: a line of the
//! spectrum, a resonance and the edge of a filter look alike in an Allan curve. Densities distinguish them.
//!
//! Level `i` takes means over blocks of `M = 8^i` samples and estimates their density after Welch (1967, IEEE
//! Trans. Audio Electroacoust. AU-15, 70): segments of `P` blocks overlap by half, and each is weighted with
//! the periodic Hann window `w_j = ½ − ½ cos(2πj/P)`. Only the bins `k = P/16 … P/2 − 1` are kept, which span
//! three octaves of frequency. The next level continues where they end, so that the levels cover the
//! frequencies without a hole.
//!
//! ```text
//! P_k = (2Mτ₀/Σw²) |Σ_j w_j y_j e^(−2πijk/P)|²,      f_k = k/(P M τ₀)
//! ```
//!
//! is the one-sided density of the block means `y`, in rate units squared per hertz. Aliases by the block
//! means and leakage of the window are a part of it, and of [`expected_densities`] too.

mod accumulator;
mod bridged;
mod covariance;
mod density;
mod expected;
mod fine;
mod lanes;
mod level;
mod line;
mod lobe;
mod overlap;
mod part;
#[cfg(target_pointer_width = "64")]
mod several;
#[cfg(feature = "storage")]
mod stored;
mod transform;
mod window;

pub use crate::limits::MAX_SEGMENT;
pub use accumulator::SpectrumAccumulator;
pub use covariance::{BAND, covariance_rows, relative_covariance};
pub use density::{Bin, Spectrum};
pub use expected::expected_densities;
pub use lanes::segment_powers;
pub use part::{Spectral, SpectrumReading};

/// The one-sided density of white noise with a coefficient of one.
pub const WHITE_DENSITY: f32 = 2.0;

pub(crate) use density::levels_of;
pub(crate) use fine::{Fine, Sum};
pub(crate) use lobe::Lobe;
pub(crate) use overlap::{Lags, octave_lag};

#[cfg(test)]
mod tests;
