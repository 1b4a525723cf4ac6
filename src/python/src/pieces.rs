//! Records that are read in pieces.

use crate::{
    error::raised,
    options::{self, Arguments},
    record::Record,
};
use allanite_host::interface;
use allanite_log::pieces::{Gathered, Pieces as State};
use numpy::PyReadonlyArray1;
use pyo3::{prelude::*, types::PyBytes};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The pieces of one axis.
#[pyclass(module = "allanite._native", frozen)]
pub(crate) struct Pieces(Mutex<Gathered>);

#[pymethods]
impl Pieces {
    #[new]
    fn new(rate_hz: f64, rate_per_count: f64) -> PyResult<Self> {
        let state = State::new(rate_hz, rate_per_count).map_err(raised)?;
        Ok(Self::of(state))
    }

    /// Adds the counts of neighbouring samples.
    fn push(&self, py: Python<'_>, first: u64, counts: PyReadonlyArray1<'_, i32>) -> PyResult<()> {
        let counts = counts.as_slice()?;
        py.detach(|| self.state().push(first, counts))
            .map_err(raised)
    }

    /// Adds samples with their numbers.
    fn push_numbered(
        &self,
        py: Python<'_>,
        numbers: PyReadonlyArray1<'_, u64>,
        counts: PyReadonlyArray1<'_, i32>,
    ) -> PyResult<()> {
        let (numbers, counts) = (numbers.as_slice()?, counts.as_slice()?);
        py.detach(|| self.state().push_numbered(numbers, counts))
            .map_err(raised)
    }

    /// Adds the pieces of another part of the record.
    fn merge(&self, py: Python<'_>, other: &Self) -> PyResult<()> {
        // One after the other, because both may be the same.
        let merged = py.detach(|| {
            let other = other.state().pieces().clone();
            self.state().pieces().merge(other)
        });
        merged.map_err(raised)
    }

    fn rate_hz(&self) -> f64 {
        self.state().pieces().rate_hz()
    }

    fn rate_per_count(&self) -> f64 {
        self.state().pieces().rate_per_count()
    }

    /// The numbers of the first sample of each stretch, and behind the last one.
    fn stretches(&self) -> Vec<(u64, u64)> {
        let mut state = self.state();
        let stretches = state.pieces().stretches();
        stretches.map(|range| (range.start, range.end)).collect()
    }

    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = py.detach(|| self.state().pieces().to_bytes());
        Ok(PyBytes::new(py, &bytes.map_err(raised)?))
    }

    #[staticmethod]
    fn from_bytes(py: Python<'_>, bytes: &[u8]) -> PyResult<Self> {
        let state = py.detach(|| State::from_bytes(bytes)).map_err(raised)?;
        Ok(Self::of(state))
    }

    /// The record of these axes.
    #[staticmethod]
    fn record(
        py: Python<'_>,
        axes: Vec<(String, Py<Pieces>)>,
        options: Arguments,
    ) -> PyResult<Record> {
        let unit = options::unit(options).map_err(raised)?;
        let record = py.detach(|| {
            let own = |(axis, pieces): (String, Py<Self>)| {
                let state = pieces.get().state().pieces().clone();
                (axis, state)
            };
            let axes: Vec<(String, State)> = axes.into_iter().map(own).collect();
            interface::Record::of_pieces(&axes, unit)
        });
        record.map(Record::of).map_err(raised)
    }
}

impl Pieces {
    fn of(state: State) -> Self {
        Self(Mutex::new(Gathered::new(state)))
    }

    fn state(&self) -> MutexGuard<'_, Gathered> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
