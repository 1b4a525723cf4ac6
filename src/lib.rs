#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]

mod algebra;
pub mod axis;
mod chi_squared;
mod cholesky;
mod coefficient;
pub mod comparison;
mod covariance;
pub mod covariate;
pub mod curve;
pub mod diagnosis;
pub mod effect;
mod error;
pub mod fit;
pub mod integrity;
pub mod kurtosis;
mod lattice;
mod limits;
mod list;
mod math;
pub mod model;
mod nnls;
mod observability;
pub mod octave;
mod profile;
pub mod queue;
mod real;
pub mod self_test;
pub mod sensor;
mod square_sum;
#[cfg(feature = "storage")]
pub mod storage;
#[cfg(test)]
mod test_random;

pub use axis::{Axes, Axis};
pub use coefficient::Coefficient;
pub use comparison::Comparison;
pub use curve::{Curve, Scale};
pub use error::Error;
pub use heapless;
pub use model::{Model, Term};
pub use octave::Accumulator;
pub use real::Real;
