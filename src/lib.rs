#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]

mod algebra;
mod axis;
mod chi_squared;
mod cholesky;
mod coefficient;
mod comparison;
mod covariance;
pub mod covariate;
mod curve;
pub mod diagnosis;
pub mod effect;
#[cfg(feature = "storage")]
mod envelope;
mod error;
pub mod fit;
#[cfg(feature = "flash")]
mod flash;
mod integrity;
mod kurtosis;
mod lattice;
mod limits;
mod list;
mod math;
mod model;
mod nnls;
mod observability;
mod octave;
mod profile;
pub mod queue;
mod real;
#[cfg(feature = "storage")]
mod record;
pub mod self_test;
pub mod sensor;
#[cfg(feature = "storage")]
mod snapshot;
mod square_sum;
#[cfg(test)]
mod test_random;

pub use axis::{Axes, Axis, AxisEvidence, GatePart, Gated, MomentPart, Moments, Sample};
pub use chi_squared::chi_squared_tail;
pub use coefficient::{Coefficient, State};
pub use comparison::{ComparedOctave, Comparison, Stretch};
pub use covariance::curve_covariance;
pub use covariate::{CrossCurve, CrossPoint};
pub use curve::{Curve, Point, Scale};
pub use error::Error;
#[cfg(feature = "flash")]
pub use flash::{SnapshotStore, StoreError};
pub use integrity::{Integrity, InvalidLimit, Limits, Observation, Reason, Tally};
pub use kurtosis::{Kurtosis, KurtosisPoint};
pub use limits::{MAX_EFFECTS, MAX_SHAPE};
pub use model::{Model, Term};
pub use octave::{Accumulator, OctaveSum};
pub use real::Real;
#[cfg(feature = "storage")]
pub use record::{
    AxisRecord, Conditions, EffectCode, MAX_AXES, MAX_DEVICE_BYTES, RateUnit, Record,
    RecordedShape, RecordedState, RecordedTerm,
};
#[cfg(feature = "storage")]
pub use snapshot::{Snapshot, SnapshotInterval};
pub use square_sum::SquareSum;
