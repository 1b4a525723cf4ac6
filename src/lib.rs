//! x
#![no_std]
#![forbid(unsafe_code)]

mod chi_squared;
mod coefficient;
mod covariance;
mod curve;
pub mod effect;
mod error;
mod fit;
mod lattice;
mod math;
mod model;
mod nnls;
mod observability;
mod octave;
mod square_sum;

pub use chi_squared::chi_squared_tail;
pub use coefficient::{Coefficient, State};
pub use covariance::curve_covariance;
pub use curve::{Curve, Point, Scale};
pub use error::Error;
pub use fit::{Fit, Method, Settings, fit};
pub use model::{MAX_EFFECTS, Model, Term};
pub use octave::{Accumulator, OctaveSum};
pub use square_sum::SquareSum;
