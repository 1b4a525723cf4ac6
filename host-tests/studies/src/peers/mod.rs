//! Compares the library with other programs for the Allan deviation, on the same records.

pub mod agreement;
pub mod bootstrap;
pub mod coefficients;
pub mod cost;
mod environment;
mod python;
mod record;

pub use environment::{Environment, Overlap, PEERS, Peer};
pub use python::Python;
