//! The aggregate functions.

use crate::{
    arguments::{Argument, coerced, counts},
    groups::{Groups, One},
    refused,
};
use datafusion::{
    arrow::datatypes::{DataType, Field, FieldRef},
    error::Result,
    logical_expr::{
        Accumulator, AggregateUDFImpl, GroupsAccumulator, Signature, Volatility,
        function::{AccumulatorArgs, StateFieldsArgs},
    },
};
use std::sync::Arc;

/// What a row of the input is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Rows {
    /// The number of a first sample, and a list of counts.
    Batches,
    /// The number of a sample, and its count.
    Samples,
    /// A state.
    States,
}

/// An aggregate function whose result is a state.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(crate) struct Aggregate {
    name: &'static str,
    rows: Rows,
    signature: Signature,
}

/// All of them.
pub(crate) fn all() -> [Aggregate; 3] {
    let aggregate = |name, rows| Aggregate {
        name,
        rows,
        signature: Signature::user_defined(Volatility::Immutable),
    };
    [
        aggregate("allan_state", Rows::Batches),
        aggregate("allan_state_of_samples", Rows::Samples),
        aggregate("allan_merge", Rows::States),
    ]
}

impl Rows {
    /// The columns of a row.
    fn columns(self) -> Vec<Argument> {
        let (first, second) = match self {
            Self::Batches => (("start", DataType::Int64), ("counts", counts())),
            Self::Samples => (("number", DataType::Int64), ("count", DataType::Int32)),
            Self::States => return vec![("state", DataType::Binary)],
        };
        let of_sensor = ["rate", "scale"].map(|name| (name, DataType::Float64));
        [vec![first, second], of_sensor.to_vec()].concat()
    }
}

impl AggregateUDFImpl for Aggregate {
    fn name(&self) -> &str {
        self.name
    }

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn return_type(&self, _: &[DataType]) -> Result<DataType> {
        Ok(DataType::Binary)
    }

    fn coerce_types(&self, given: &[DataType]) -> Result<Vec<DataType>> {
        coerced(self.name, &self.rows.columns(), given)
    }

    fn state_fields(&self, arguments: StateFieldsArgs) -> Result<Vec<FieldRef>> {
        let name = format!("{}[state]", arguments.name);
        Ok(vec![Arc::new(Field::new(name, DataType::Binary, true))])
    }

    fn accumulator(&self, arguments: AccumulatorArgs) -> Result<Box<dyn Accumulator>> {
        self.is_plain(&arguments)?;
        Ok(Box::new(One::new(self.rows)))
    }

    fn groups_accumulator_supported(&self, arguments: AccumulatorArgs) -> bool {
        // What is not plain is refused by the other way.
        self.is_plain(&arguments).is_ok()
    }

    fn create_groups_accumulator(
        &self,
        arguments: AccumulatorArgs,
    ) -> Result<Box<dyn GroupsAccumulator>> {
        self.is_plain(&arguments)?;
        Ok(Box::new(Groups::new(self.rows)))
    }
}

impl Aggregate {
    /// Refuses `DISTINCT`. An order changes nothing and is let pass.
    fn is_plain(&self, arguments: &AccumulatorArgs) -> Result<()> {
        match arguments.is_distinct {
            true => Err(refused(
                format_args!("{} takes no DISTINCT", self.name),
                "leave it out: samples that come twice are refused",
            )),
            false => Ok(()),
        }
    }
}
