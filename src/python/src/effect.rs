//! Effects of the catalogue.

use crate::error::raised;
use allanite_host::interface;
use pyo3::prelude::*;

/// The name of the effect that a text gives, which may be a formula.
#[pyfunction]
pub(crate) fn effect_name(text: &str) -> String {
    interface::effect_name(text).to_owned()
}

/// Reads an effect as the command line does, and raises what it would refuse.
#[pyfunction]
pub(crate) fn check_effect(text: &str, fitted: bool) -> PyResult<()> {
    interface::check_effect(text, fitted).map_err(raised)
}
