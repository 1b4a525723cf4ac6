//! Diagnoses.

use crate::{
    comparison::Comparison,
    error::raised,
    own::{self, OwnEffect},
    watched::left,
};
use allanite_cli::command::interface;
use pyo3::prelude::*;
use std::sync::Arc;

/// The diagnoses of all axes of a record.
#[pyclass(module = "allanite._native", frozen)]
pub(crate) struct Diagnosis(Arc<interface::Diagnosis>);

impl Diagnosis {
    pub(crate) fn new(diagnosis: interface::Diagnosis) -> Self {
        Self(Arc::new(diagnosis))
    }
}

#[pymethods]
impl Diagnosis {
    /// The document of `diagnose`.
    fn json(&self) -> PyResult<String> {
        self.0.json().map_err(raised)
    }

    /// The text of `diagnose`.
    fn text(&self) -> PyResult<String> {
        self.0.text().map_err(raised)
    }

    /// The first lines of the text.
    fn conclusion(&self) -> Vec<String> {
        self.0.conclusion()
    }

    /// The last model of every axis, as JSON.
    fn models(&self) -> PyResult<String> {
        self.0.models().map_err(raised)
    }

    /// The picture of `plot`.
    fn svg(&self, options: Vec<String>) -> PyResult<String> {
        self.0.svg(&options).map_err(raised)
    }

    /// Fits another model to an axis.
    fn compare(
        &self,
        py: Python<'_>,
        axis: String,
        options: Vec<String>,
        own: Vec<Py<OwnEffect>>,
    ) -> PyResult<Comparison> {
        let (diagnosis, effects) = (self.0.clone(), own::effects(&own));
        let compared = left(py, None, move |_| {
            diagnosis.compare(&axis, &options, &effects)
        });
        own::checked(&own, compared.map(Comparison::new))
    }
}
