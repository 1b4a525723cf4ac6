//! Records.

use crate::{
    arrays::Lent,
    comparison::Comparison,
    diagnosis::Diagnosis,
    error::raised,
    options::{self, Arguments},
    own::{self, OwnEffect},
    table::Batches,
    watched::{left, watched},
};
use allanite_host::{interface, verdict};
use allanite_log::{Arrays, Column};
use pyo3::{prelude::*, types::PyBytes};
use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

/// The axes of a log, as everything that a diagnosis needs.
#[pyclass(module = "allanite._native", frozen)]
pub(crate) struct Record(Arc<interface::Record>);

#[pymethods]
impl Record {
    /// Reads a log, or a curve file.
    #[staticmethod]
    fn read(
        py: Python<'_>,
        path: PathBuf,
        options: Arguments,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let reading = options::reading(options).map_err(raised)?;
        let record = left(py, progress.as_ref(), move |bar| {
            interface::Record::read(&path, &reading, bar)
        })?;
        Ok(Self(Arc::new(record)))
    }

    /// Reads arrays of one dimension, which are not copied.
    #[staticmethod]
    fn of_arrays(
        py: Python<'_>,
        name: &str,
        columns: Vec<(String, Bound<'_, PyAny>)>,
        options: Arguments,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let lent = columns.into_iter().map(Lent::of);
        let lent = lent.collect::<PyResult<Vec<_>>>()?;
        let rows = lent.iter().map(Lent::rows).min().unwrap_or(0);
        let columns = lent.iter().map(Lent::column).collect();
        Self::of_columns(py, (name, rows, columns), options, progress.as_ref())
    }

    /// Reads a table that an object exports through `__arrow_c_stream__`, whose buffers are not copied.
    #[staticmethod]
    fn of_arrow(
        py: Python<'_>,
        name: &str,
        table: &Bound<'_, PyAny>,
        options: Arguments,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let batches = Batches::of(table)?;
        let table = (name, batches.rows(), batches.columns());
        Self::of_columns(py, table, options, progress.as_ref())
    }

    /// The curves of all axes and the reader's notes, as JSON.
    fn describe(&self) -> PyResult<String> {
        self.0.describe().map_err(raised)
    }

    /// The text of a curve file.
    fn curve_file(&self) -> PyResult<String> {
        self.0.curve_file().map_err(raised)
    }

    /// The document and the text of `fit`.
    fn fit(&self, py: Python<'_>, options: Arguments) -> PyResult<(String, String)> {
        let record = self.0.clone();
        let fitting = options::fitting(options).map_err(raised)?;
        left(py, None, move |_| {
            let fits = record.fit(&fitting)?;
            Ok((fits.json()?, fits.text()?))
        })
    }

    /// Diagnoses all axes.
    fn diagnose(
        &self,
        py: Python<'_>,
        options: Arguments,
        axes: u64,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Diagnosis> {
        let record = self.0.clone();
        let search = options::search(options).map_err(raised)?;
        let diagnosis = left(py, progress.as_ref(), move |bar| {
            bar.set_length(axes);
            record.diagnose(&search, &mut |number| {
                bar.set_position(number as u64);
                !bar.is_finished()
            })
        });
        diagnosis.map(Diagnosis::new)
    }

    /// Fits a model to an axis.
    fn compare(
        &self,
        py: Python<'_>,
        axis: String,
        options: Arguments,
        own: Vec<Py<OwnEffect>>,
    ) -> PyResult<Comparison> {
        let (record, effects) = (self.0.clone(), own::effects(&own));
        let model = options::model(options).map_err(raised)?;
        let compared = left(py, None, move |_| record.compare(&axis, &model, &effects));
        own::checked(&own, compared.map(Comparison::new))
    }

    /// The record as bytes, for pickle.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = self.0.to_bytes().map_err(raised)?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// The record whose bytes these are.
    #[staticmethod]
    fn from_bytes(bytes: &[u8]) -> PyResult<Self> {
        let record = interface::Record::from_bytes(bytes).map_err(raised)?;
        Ok(Self::of(record))
    }
}

impl Record {
    pub(crate) fn of(record: interface::Record) -> Self {
        Self(Arc::new(record))
    }

    fn of_columns(
        py: Python<'_>,
        (name, rows, columns): (&str, usize, Vec<Column<'_>>),
        options: Arguments,
        progress: Option<&Py<PyAny>>,
    ) -> PyResult<Self> {
        let reading = options::reading(options).map_err(raised)?;
        let arrays = Arrays::new(Path::new(name), rows, columns).map_err(raised)?;
        let record = watched(py, progress, |bar| {
            interface::Record::of_arrays(&arrays, &reading, bar)
        })?;
        Ok(Self::of(record))
    }
}

/// The Allan deviations of arrays of one dimension, as JSON.
#[pyfunction]
pub(crate) fn deviations(
    py: Python<'_>,
    columns: Vec<(String, Bound<'_, PyAny>)>,
    options: Arguments,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    let lent = columns.into_iter().map(Lent::of);
    let lent = lent.collect::<PyResult<Vec<_>>>()?;
    let rows = lent.iter().map(Lent::rows).min().unwrap_or(0);
    let columns = lent.iter().map(Lent::column).collect();
    let sensor = options::sensor(options).map_err(raised)?;
    let arrays = Arrays::new(Path::new("array"), rows, columns).map_err(raised)?;
    watched(py, progress.as_ref(), |bar| {
        interface::deviations(&arrays, (sensor.rate_hz, sensor.rate_per_count), bar)
    })
}

/// Whether the five terms explain a record, in words.
#[pyfunction]
pub(crate) fn explained(adequate: Option<bool>) -> &'static str {
    verdict::explained(adequate)
}
