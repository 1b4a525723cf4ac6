//! Records of many devices on [DataFusion](datafusion) and on clusters of [Ballista](ballista): SQL functions from batches of
//! samples to coefficients.
//!
//! ```sql
//! SELECT device, axis, allan_fit(allan_state(start, counts, rate, scale), 'deg/s') AS fit
//! FROM logs GROUP BY device, axis
//! ```
//!
//! A state is what [`Pieces`](host_tests::pieces::Pieces) keep of one axis, as bytes in a column. It does not depend on how the
//! rows are partitioned, and states merge in any order, so that an engine may cut, shuffle and repeat as it likes. The package
//! for Python has the same functions with the same bytes.
//!
//! | function | gives |
//! |---|---|
//! | `allan_state(start, counts, rate, scale)` | aggregate: the state of one axis. `start` is the number of a row's first sample in the record, `counts` a list of whole numbers of 32 bits, `rate` in samples per second, `scale` in rate units per count |
//! | `allan_state_of_samples(number, count, rate, scale)` | aggregate: the same with one sample a row |
//! | `allan_merge(state)` | aggregate: the state of all parts |
//! | `allan_samples(state)` | the number of samples |
//! | `allan_fit(state, unit)` | a struct of the five coefficients with their 95 % intervals, in the unit times the powers of s of IEEE Std 952, `NULL` where the record does not show one; `adequate`, `chi2`, `dof`, `samples`, `stretches`, and `invalid`: why the samples are not those of a gyro at rest, or `NULL` |
//! | `allan_diagnose(state, unit)` | a struct of `verdict`, `missing` (a list of effects) and `conclusion` in words |

mod aggregate;
mod answer;
mod arguments;
mod axis;
pub mod cluster;
mod groups;
mod rows;

use datafusion::{
    error::{DataFusionError, Result},
    execution::FunctionRegistry,
    logical_expr::{AggregateUDF, ScalarUDF},
};
use host_tests::failure::Failure;
use std::sync::Arc;

/// Gives a session, a scheduler or an executor the functions.
///
/// # Errors
/// When the registry takes no functions.
pub fn register(registry: &mut dyn FunctionRegistry) -> Result<()> {
    for aggregate in aggregate::all() {
        registry.register_udaf(Arc::new(AggregateUDF::from(aggregate)))?;
    }
    for answer in answer::all() {
        registry.register_udf(Arc::new(ScalarUDF::from(answer)))?;
    }
    Ok(())
}

/// A failure of the host library as an error of the engine.
fn raised(failure: Failure) -> DataFusionError {
    DataFusionError::External(Box::new(failure))
}

/// An input that a function cannot use, and what to do about it.
fn refused(what: impl std::fmt::Display, remedy: &str) -> DataFusionError {
    raised(Failure::option(what.to_string(), remedy))
}
