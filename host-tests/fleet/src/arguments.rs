//! The arguments of the functions.

use crate::failure::refused;
use datafusion::{
    arrow::datatypes::{DataType, Field},
    error::Result,
};
use std::sync::Arc;

/// The name of an argument, for messages, and the type that a function takes.
pub(crate) type Argument = (&'static str, DataType);

/// A list of counts.
pub(crate) fn counts() -> DataType {
    DataType::List(Arc::new(Field::new_list_field(DataType::Int32, true)))
}

/// The types to which the engine is to bring what was given.
///
/// # Errors
/// When the number of arguments is another one, or a type loses what matters.
pub(crate) fn coerced(
    function: &str,
    arguments: &[Argument],
    given: &[DataType],
) -> Result<Vec<DataType>> {
    let names: Vec<&str> = arguments.iter().map(|(name, _)| *name).collect();
    let usage = format!("write {function}({})", names.join(", "));
    if given.len() != arguments.len() {
        let (wanted, given) = (arguments.len(), given.len());
        let what = format!("{function} takes {wanted} arguments and not {given}");
        return Err(refused(what, &usage));
    }
    for (given, (name, wanted)) in given.iter().zip(arguments) {
        if !becomes(given, wanted) {
            let what = match wanted {
                DataType::List(_) => "a list of whole numbers",
                DataType::Binary => "the bytes of a state",
                DataType::Float64 => "a number",
                DataType::Utf8 => "a text",
                _ => "a whole number",
            };
            let what = format!("{name} of {function} is {what} and not {given}");
            return Err(refused(what, &usage));
        }
    }
    Ok(arguments.iter().map(|(_, kind)| kind.clone()).collect())
}

/// Whether the engine may turn values of the one type into the other one: none is lost without an error.
fn becomes(from: &DataType, to: &DataType) -> bool {
    use DataType::{
        Binary, BinaryView, FixedSizeList, Float64, Int32, Int64, LargeBinary, LargeList,
        LargeListView, LargeUtf8, List, ListView, Null, Utf8, Utf8View,
    };
    match (from, to) {
        (Null, _) => true,
        (from, Int32 | Int64) => from.is_integer(),
        (from, Float64) => from.is_numeric(),
        (
            List(from)
            | LargeList(from)
            | FixedSizeList(from, _)
            | ListView(from)
            | LargeListView(from),
            List(_),
        ) => from.data_type().is_integer(),
        (Binary | LargeBinary | BinaryView, Binary) => true,
        (Utf8 | LargeUtf8 | Utf8View, Utf8) => true,
        _ => false,
    }
}
