//! Files of MATLAB up to version 7, whose arrays of numbers are the columns. Those of version 7.3 are HDF5 files.

use super::{
    arrays::{self, Array, Values},
    arrow_rows::Written,
    wrong::Wrong,
};
use crate::converted::Text;
use ::matfile::{MatFile, NumericData};
use std::{fs::File, io::BufReader, path::Path};

pub(super) fn convert(
    path: &Path,
    topic: Option<&str>,
    to: (&mut Text, Option<Text>),
) -> Result<Written, Wrong> {
    let file = MatFile::parse(BufReader::new(File::open(path)?)).map_err(Wrong::damaged)?;
    let arrays = file.arrays().iter().filter_map(|array| {
        let values = values(array.data())?;
        let name = array.name().to_owned();
        Array::new(String::new(), name, array.size(), true, values)
    });
    let arrays: Vec<Array> = arrays.collect();
    if arrays.is_empty() {
        return Err(Wrong::unfit(
            "no array of numbers; structures, tables and timetables of MATLAB are not read",
            "save the columns by themselves, or the table with `writetable(TABLE, 'log.csv')`",
        ));
    }
    arrays::write(arrays, topic, to)
}

/// The values of an array of real numbers.
fn values(data: &NumericData) -> Option<Values> {
    use NumericData::{Double, Int8, Int16, Int32, Int64, Single, UInt8, UInt16, UInt32, UInt64};
    fn signed<T: Copy + Into<i64>>(values: &[T]) -> Option<Values> {
        Some(Values::Signed(
            values.iter().map(|&value| value.into()).collect(),
        ))
    }
    match data {
        Int8 { real, imag: None } => signed(real),
        UInt8 { real, imag: None } => signed(real),
        Int16 { real, imag: None } => signed(real),
        UInt16 { real, imag: None } => signed(real),
        Int32 { real, imag: None } => signed(real),
        UInt32 { real, imag: None } => signed(real),
        Int64 { real, imag: None } => signed(real),
        UInt64 { real, imag: None } => Some(Values::Unsigned(real.clone())),
        Single { real, imag: None } => Some(Values::of_floats(
            real.iter().map(|&value| value.into()).collect(),
        )),
        Double { real, imag: None } => Some(Values::of_floats(real.clone())),
        _ => None,
    }
}
