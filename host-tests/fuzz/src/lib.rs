//! What each fuzz target does with its bytes. It panics if something is wrong. The tests replay the corpora.
//!
//! The interface for C is compiled in single precision, in which its sizes hold, and all else beside the tools, which need
//! double precision. So it has a build of its own.

#[cfg(feature = "tools")]
pub mod accumulator;
#[cfg(feature = "tools")]
pub mod axis;
#[cfg(feature = "c")]
pub mod c;
#[cfg(feature = "tools")]
pub mod comparison;
#[cfg(feature = "tools")]
pub mod diagnosis;
#[cfg(feature = "tools")]
pub mod explore;
#[cfg(feature = "tools")]
pub mod file;
#[cfg(feature = "tools")]
pub mod formula;
#[cfg(feature = "tools")]
pub mod sensor;
#[cfg(feature = "tools")]
pub mod spectrum;
#[cfg(feature = "tools")]
pub mod stored;
