//! Failures as errors of the engine.

use allanite_log::failure::Failure;
use datafusion::error::DataFusionError;

/// A failure of the host library as an error of the engine.
pub(crate) fn raised(failure: Failure) -> DataFusionError {
    DataFusionError::External(Box::new(failure))
}

/// An input that a function cannot use, and what to do about it.
pub(crate) fn refused(what: impl std::fmt::Display, remedy: &str) -> DataFusionError {
    raised(Failure::option(what.to_string(), remedy))
}
