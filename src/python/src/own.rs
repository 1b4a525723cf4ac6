//! Effects that are written in Python.

use crate::error::raised;
use allanite_cli::command::interface;
use pyo3::prelude::*;
use std::sync::{Arc, Mutex, PoisonError};

/// An effect whose covariance is a function of Python.
#[pyclass(module = "allanite._native", frozen)]
pub(crate) struct OwnEffect {
    effect: &'static interface::Own,
    raised: Arc<Mutex<Option<PyErr>>>,
}

#[pymethods]
impl OwnEffect {
    #[new]
    fn new(name: &str, symbol: &str, half_seconds: i8, covariance: Py<PyAny>) -> PyResult<Self> {
        let raised_in = Arc::new(Mutex::new(None));
        let keep = raised_in.clone();
        let call = move |lag_s: f64| {
            let value = Python::attach(|py| covariance.call1(py, (lag_s,))?.extract::<f64>(py));
            value.unwrap_or_else(|error| {
                let mut kept = keep.lock().unwrap_or_else(PoisonError::into_inner);
                kept.get_or_insert(error);
                f64::NAN
            })
        };
        let effect = interface::Own::new(name, symbol, half_seconds, Box::new(call));
        Ok(Self {
            effect: effect.map_err(raised)?,
            raised: raised_in,
        })
    }
}

/// The effects for a model.
pub(crate) fn effects(own: &[Py<OwnEffect>]) -> Vec<&'static interface::Own> {
    own.iter().map(|one| one.get().effect).collect()
}

/// What the functions of Python have raised goes first, because it is why the fit has failed.
///
/// # Errors
/// The first exception.
pub(crate) fn checked<T>(own: &[Py<OwnEffect>], result: PyResult<T>) -> PyResult<T> {
    for one in own {
        let kept = &one.get().raised;
        let error = kept.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(error) = error {
            return Err(error);
        }
    }
    result
}
