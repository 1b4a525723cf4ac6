//! Simulates gyros whose noise has known coefficients.

mod chain;
mod deterministic;
mod filtered;
mod flicker;
mod gaussian;
mod hidden;
mod ieee_952;
mod kernel;
mod markov;
mod preset;
mod random;
pub mod record;
mod simulator;
mod smoothed;
mod swept;
mod thermal;
mod two_levels;

pub use chain::Chain;
pub use flicker::band_limited_flicker;
pub use hidden::Hidden;
pub use preset::{CUSTOMARY, Preset};
pub use random::Random;
pub use simulator::{SWEEP, Simulator};
pub use thermal::{Course, Thermal};

/// The coefficients of the five IEEE-952 terms, in any rate unit and in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coefficients {
    /// Quantization Q, rate · s.
    pub quantization: f64,
    /// Angle random walk N, rate · √s.
    pub angle_random_walk: f64,
    /// Bias instability B, rate.
    pub bias_instability: f64,
    /// Rate random walk K, rate / √s.
    pub rate_random_walk: f64,
    /// Rate ramp R, rate / s.
    pub rate_ramp: f64,
}

/// A source that adds to the rate, sample by sample.
pub trait Source: Send {
    /// The contribution to the rate of the next sample.
    fn next(&mut self, random: &mut Random) -> f64;
}
