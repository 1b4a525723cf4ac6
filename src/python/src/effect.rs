//! Effects of the catalogue.

use crate::error::raised;
use allanite_cli::command::interface;
use pyo3::prelude::*;

/// Reads an effect as the command line does, and raises what it would refuse.
#[pyfunction]
pub(crate) fn check_effect(text: &str, fitted: bool) -> PyResult<()> {
    interface::check_effect(text, fitted).map_err(raised)
}
