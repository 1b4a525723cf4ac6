//! The tests of the library. They need no command line, and run in the precision of the device and in double precision.

mod common;

#[cfg(feature = "storage")]
mod axis;
mod curve;
#[cfg(feature = "flash")]
mod flash;
mod octave;
mod python_effects;
mod queue;
#[cfg(feature = "async")]
mod sensor;
#[cfg(feature = "storage")]
mod snapshot;
