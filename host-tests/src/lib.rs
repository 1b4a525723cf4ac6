//! What surrounds the library on a host: simulator, logs and curve files, command line, studies.

pub mod command;
pub mod confidence;
pub mod curve_file;
#[path = "../../src/bin/demonstration/mod.rs"]
pub mod demonstration;
pub mod equivalent;
pub mod failure;
#[cfg(feature = "firmware")]
pub mod firmware;
pub mod log;
pub mod overbound;
pub mod plot;
pub mod program;
pub mod simulate;
#[cfg(feature = "chores")]
pub mod study;
pub mod unit;
#[cfg(feature = "chores")]
pub mod xtask;
