//! A gyro that is watched while it sends.

/// The seed of its noise.
pub const SEED: u64 = 2952;
