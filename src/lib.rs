#![no_std]
#![forbid(unsafe_code)]

mod curve;
mod error;
mod math;
mod octave;
mod square_sum;

pub use curve::{Curve, Point, Scale};
pub use error::Error;
pub use octave::{Accumulator, OctaveSum};
pub use square_sum::SquareSum;
