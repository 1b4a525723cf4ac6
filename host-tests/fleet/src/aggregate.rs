//! The aggregate functions.

use crate::{
    arguments::coerced,
    failure::refused,
    groups::{Groups, One},
    rows::Rows,
};
use datafusion::{
    arrow::datatypes::{DataType, Field, FieldRef},
    error::Result,
    logical_expr::{
        Accumulator, AggregateUDFImpl, GroupsAccumulator, Signature, Volatility,
        function::{AccumulatorArgs, StateFieldsArgs},
        utils::AggregateOrderSensitivity,
    },
};
use std::sync::Arc;

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

    fn order_sensitivity(&self) -> AggregateOrderSensitivity {
        // Otherwise the engine sorts each part of the rows, and hands over the columns of the order as well.
        AggregateOrderSensitivity::Insensitive
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
