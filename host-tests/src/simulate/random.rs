//! Random numbers.

use rand::RngExt;
use rand_distr::StandardNormal;
use rand_xoshiro::Xoshiro256PlusPlus;

/// The generator behind every simulation: a seed names a record for good.
pub type Random = Xoshiro256PlusPlus;

/// A standard normal number (ziggurat of `rand_distr`).
pub(super) fn normal(random: &mut Random) -> f64 {
    random.sample(StandardNormal)
}
