//! What an effect leaves in a record: its kernel, its Allan variances, and how octaves scatter together.

pub(crate) mod covariance;
pub mod effect;
pub(crate) mod lattice;
pub mod model;
