//! HDF5 files, such as those of MATLAB 7.3, whose datasets of one group and length are the columns.

use super::{
    arrays::{self, Array, Values},
    wrong::Wrong,
};
use crate::converted::{MOST_TEXT, MOST_TIMES, Text};
use hdf5_pure::{DType, Dataset, Error, File, Group};
use std::path::Path;

/// How deep groups are looked into, and how many datasets are looked at. Chosen by hand.
const DEEPEST: usize = 8;
const MOST: usize = 1000;

pub(super) fn convert(
    path: &Path,
    topic: Option<&str>,
    text: &mut Text,
) -> Result<Option<String>, Wrong> {
    let size = path.metadata()?.len();
    let file = File::open_streaming(path).map_err(Wrong::damaged)?;
    let mut arrays = Vec::new();
    gather(&file.root(), "", size, 0, &mut arrays).map_err(Wrong::damaged)?;
    arrays::write(arrays, topic, text)
}

/// Collects the datasets of numbers in a group and in those within it.
fn gather(
    group: &Group,
    place: &str,
    size: u64,
    depth: usize,
    arrays: &mut Vec<Array>,
) -> Result<(), Error> {
    for name in group.datasets()? {
        if arrays.len() >= MOST {
            return Ok(());
        }
        let dataset = group.dataset(&name)?;
        let shape = dataset.shape()?;
        // A damaged file may claim any size.
        let claimed = shape
            .iter()
            .try_fold(8_u64, |all, &length| all.checked_mul(length));
        if claimed.is_none_or(|bytes| bytes > MOST_TIMES * size + MOST_TEXT) {
            continue;
        }
        let Some(values) = values(&dataset)? else {
            continue;
        };
        let shape: Vec<usize> = shape.iter().map(|&length| length as usize).collect();
        arrays.extend(Array::new(place.to_owned(), name, &shape, false, values));
    }
    if depth < DEEPEST {
        // MATLAB keeps what its cells refer to in groups whose names begin with #.
        for name in group.groups()?.iter().filter(|name| !name.starts_with('#')) {
            let place = format!("{place}/{name}");
            gather(&group.group(name)?, &place, size, depth + 1, arrays)?;
        }
    }
    Ok(())
}

/// The values of a dataset of numbers.
fn values(dataset: &Dataset) -> Result<Option<Values>, Error> {
    Ok(Some(match dataset.dtype()? {
        DType::F32 | DType::F64 => Values::Float(dataset.read_f64()?),
        DType::I8 | DType::I16 | DType::I32 | DType::I64 => Values::Signed(dataset.read_i64()?),
        DType::U8 | DType::U16 | DType::U32 | DType::U64 => Values::Unsigned(dataset.read_u64()?),
        _ => return Ok(None),
    }))
}
