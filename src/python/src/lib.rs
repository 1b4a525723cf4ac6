//! The native part of the package `allanite` for Python: records, diagnoses and models of the host library, which stay in
//! memory, and their documents, from which the Python part builds its types.
//!
//! Everything that reads or computes does so without the interpreter's lock, so that other threads of Python go on. Python
//! is asked for signals in between: see `watched`.

mod accumulator;
mod arrays;
mod comparison;
mod diagnosis;
mod effect;
mod error;
mod options;
mod own;
mod pieces;
mod record;
mod table;
mod watched;

use pyo3::prelude::*;

/// The native part of `allanite`.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::accumulator::Accumulator;
    #[pymodule_export]
    use super::comparison::Comparison;
    #[pymodule_export]
    use super::diagnosis::Diagnosis;
    #[pymodule_export]
    use super::effect::{check_effect, effect_name};
    #[pymodule_export]
    use super::own::OwnEffect;
    #[pymodule_export]
    use super::pieces::Pieces;
    #[pymodule_export]
    use super::record::{Record, deviations, explained};
}
