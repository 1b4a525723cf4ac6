//! All functions, for whatever takes functions.

use crate::{aggregate, answer};
use datafusion::{
    error::Result,
    execution::FunctionRegistry,
    logical_expr::{AggregateUDF, ScalarUDF},
};
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
