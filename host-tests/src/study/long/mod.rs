//! Studies long records: exact sums, time and memory against length, and records that many processes measure.

mod distributed;
mod growth;
mod sequence;

pub use distributed::{Cost, Distributed, Program, RATE_HZ, distributed};
pub use growth::{Length, Merged, Slope, growth, merged, slope};
pub use sequence::{Expected, Sequence};

/// The octaves of the accumulator, all that it can have.
pub const OCTAVES: usize = 30;
