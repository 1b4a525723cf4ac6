//! Random numbers for the simulations.

use rand::RngExt;
use rand_distr::StandardNormal;
use rand_xoshiro::Xoshiro256PlusPlus;

/// The generator behind every simulation. It is fixed, so that a seed always gives the same record.
pub type Random = Xoshiro256PlusPlus;

/// Draws a standard normal number with the ziggurat of `rand_distr`.
pub(super) fn normal(random: &mut Random) -> f64 {
    random.sample(StandardNormal)
}
