//! Failures as exceptions.

use allanite_log::failure::Failure;
use pyo3::{PyErr, exceptions::PyRuntimeError, import_exception};

import_exception!(allanite._error, AllaniteError);

/// The exception that says what a failure says, in its parts: the file, the row, what is wrong, the remedy, and the axis if it is
/// the failure of one.
pub(crate) fn raised(failure: Failure) -> PyErr {
    let (place, what, remedy, axis) = match failure {
        Failure::Input {
            place,
            what,
            remedy,
        } => (place, what, remedy, None),
        Failure::Axis {
            place,
            axis,
            what,
            remedy,
        } => (place, what, remedy, Some(axis)),
        other => return PyRuntimeError::new_err(other.to_string()),
    };
    let path = place.path().map(|path| path.to_string_lossy().into_owned());
    AllaniteError::new_err((path, place.at_row(), what, remedy, axis))
}
