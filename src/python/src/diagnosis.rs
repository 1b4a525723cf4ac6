//! Diagnoses.

use crate::{
    comparison::Comparison,
    error::raised,
    options::{self, Arguments},
    own::{self, OwnEffect},
    watched::left,
};
use allanite_host::interface;
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
    fn svg(&self, options: Arguments) -> PyResult<String> {
        let shown = options::shown(options).map_err(raised)?;
        self.0.svg(&shown).map_err(raised)
    }

    /// Fits another model to an axis.
    fn compare(
        &self,
        py: Python<'_>,
        axis: String,
        options: Arguments,
        own: Vec<Py<OwnEffect>>,
    ) -> PyResult<Comparison> {
        let (diagnosis, effects) = (self.0.clone(), own::effects(&own));
        let model = options::model(options).map_err(raised)?;
        let compared = left(py, None, move |_| {
            diagnosis.compare(&axis, &model, &effects)
        });
        own::checked(&own, compared.map(Comparison::new))
    }
}
