//! Models beside a record.

use crate::error::raised;
use allanite_cli::command::interface;
use pyo3::prelude::*;

/// A model that was fitted to an axis.
#[pyclass(module = "allanite._native", frozen)]
pub(crate) struct Comparison(interface::Comparison);

impl Comparison {
    pub(crate) fn new(comparison: interface::Comparison) -> Self {
        Self(comparison)
    }
}

#[pymethods]
impl Comparison {
    /// The document of `compare`.
    fn json(&self) -> PyResult<String> {
        self.0.json().map_err(raised)
    }

    /// The effects with their fitted shapes, as options.
    fn effects(&self) -> Vec<String> {
        self.0.effects()
    }

    /// The model in words.
    fn name(&self) -> String {
        self.0.name()
    }

    /// The picture of the record beside the model.
    fn svg(&self) -> String {
        self.0.svg()
    }
}
