//! The gyro whose counts are sent to a host.

/// The seed of the noise.
pub const SEED: u64 = 2952;
