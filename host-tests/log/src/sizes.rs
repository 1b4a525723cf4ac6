//! How much the host keeps of an axis, whether it comes from a log or in pieces.

/// The number of octaves that the host accumulates. They cannot overflow, and they suffice for
/// records of years.
pub const OCTAVES: usize = 30;

/// The number of blocks in a segment of the spectrum that the host accumulates. It is that of a device, so that both
/// see the same bins.
pub const SEGMENT: usize = 64;

/// The number of levels of the spectrum.
pub const LEVELS: usize = 7;

/// The number of bins that there is room for: those of all levels.
pub const BINS: usize = 196;

/// The largest number of samples of a record, and the largest number that a sample can have: a thousand years at 33 kHz.
pub const MOST_SAMPLES: u64 = 1 << 50;
