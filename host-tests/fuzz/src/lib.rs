//! What each fuzz target does with its bytes. It panics if something is wrong. The tests replay the corpora.

pub mod accumulator;
pub mod diagnosis;
pub mod file;
pub mod spectrum;
pub mod stored;
