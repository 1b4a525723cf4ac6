//! Failures as exceptions.

use allanite_log::failure::Failure;
use pyo3::{PyErr, exceptions::PyRuntimeError, import_exception};

import_exception!(allanite._error, AllaniteError);

/// The exception that says what a failure says, in its parts: the file, the row, what is wrong, and the remedy.
pub(crate) fn raised(failure: Failure) -> PyErr {
    match failure {
        Failure::Input {
            place,
            what,
            remedy,
        } => {
            let path = place.path().map(|path| path.to_string_lossy().into_owned());
            AllaniteError::new_err((path, place.at_row(), what, remedy))
        }
        other => PyRuntimeError::new_err(other.to_string()),
    }
}
