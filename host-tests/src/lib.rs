//! The host's side of the project: simulator, logs, curve files, command line and studies.

pub mod comb;
pub mod command;
pub mod confidence;
pub mod curve_file;
pub mod dependence;
pub mod diagnosis;
pub mod equivalent;
pub mod failure;
pub mod log;
pub mod lot;
pub mod overbound;
pub mod pieces;
pub mod plot;
pub mod program;
pub mod quantile;
pub mod regular_file;
pub mod simulate;
pub mod sizes;
#[cfg(feature = "study")]
pub mod study;
pub mod unit;
mod visible;

pub use demonstration;
