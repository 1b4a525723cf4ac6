//! What is known of a record when it is read: the sums of `record` as a curve, a course, a kurtosis and dependences on
//! covariates, with units.

pub mod axis;
pub(crate) mod course;
pub mod covariate;
pub mod faults;
pub mod kurtosis;
pub mod motion;
pub(crate) mod observed;
mod reads;
pub(crate) mod record;
mod screen;
