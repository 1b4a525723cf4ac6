//! What surrounds the library on a host: simulator, logs and curve files, command line, studies.

pub mod command;
pub mod confidence;
pub mod curve_file;
#[path = "../../src/bin/demonstration/mod.rs"]
pub mod demonstration;
pub mod equivalent;
pub mod failure;
pub mod firmware;
pub mod log;
pub mod overbound;
pub mod plot;
pub mod program;
pub mod simulate;
pub mod study;
pub mod unit;
pub mod xtask;
