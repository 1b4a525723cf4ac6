//! Studies long records: exact sums, time and memory against length, and records that many processes measure.

mod distributed;
mod growth;
mod sequence;

pub use distributed::{Cost, Distributed, Program, RATE_HZ, distributed};
pub use growth::{Length, Merged, OCTAVES, Slope, growth, merged, slope};
pub use sequence::{Expected, Sequence};
