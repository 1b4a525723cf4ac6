//! Samples that arrive while Python runs.

use crate::{
    error::raised,
    options::{self, Arguments},
    record::Record,
};
use allanite_host::interface::Recording;
use numpy::PyReadonlyArray1;
use pyo3::{exceptions::PyValueError, prelude::*};
use std::sync::{Mutex, PoisonError};

/// Accumulators of the axes of a sensor.
#[pyclass(module = "allanite._native", frozen)]
pub(crate) struct Accumulator(Mutex<Recording>);

#[pymethods]
impl Accumulator {
    #[new]
    fn new(options: Arguments) -> PyResult<Self> {
        let recording = options::sensor(options)
            .and_then(Recording::new)
            .map_err(raised)?;
        Ok(Self(Mutex::new(recording)))
    }

    /// Adds counts, an array for every axis, all of one length.
    fn push(&self, py: Python<'_>, columns: Vec<PyReadonlyArray1<'_, i32>>) -> PyResult<()> {
        let slices = columns.iter().map(PyReadonlyArray1::as_slice);
        let slices = slices.collect::<Result<Vec<&[i32]>, _>>()?;
        let rows = slices.first().map_or(0, |slice| slice.len());
        if slices.iter().any(|slice| slice.len() != rows) {
            return Err(PyValueError::new_err("the axes have different lengths"));
        }
        py.detach(|| {
            let mut recording = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            recording.push(&slices);
        });
        Ok(())
    }

    /// Tells that samples are missing here.
    fn gap(&self, py: Python<'_>) {
        py.detach(|| self.0.lock().unwrap_or_else(PoisonError::into_inner).gap());
    }

    /// Samples of each axis so far.
    fn samples(&self, py: Python<'_>) -> u64 {
        py.detach(|| {
            let recording = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            recording.samples()
        })
    }

    /// The record so far.
    fn record(&self, py: Python<'_>) -> PyResult<Record> {
        let recording = py.detach(|| {
            let recording = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            recording.clone()
        });
        recording.record().map(Record::of).map_err(raised)
    }
}
