//! HDF5 files, such as those of MATLAB 7.3, whose datasets of one group and length are the columns.

use super::{
    arrays::{self, Array, Values},
    arrow_rows::Written,
    hdf5_left_out::LeftOut,
    hdf5_links,
    hdf5_lowest::Lowest,
    wrong::Wrong,
};
use crate::{
    converted::{MOST_TEXT, MOST_TIMES, Text},
    unit_names::{are_units, with_unit},
};
use hdf5_pure::{AttrValue, DType, Dataset, Error, File, FormatError, Group};
use std::{collections::HashMap, path::Path};

/// How deep groups are looked into, and how many datasets are looked at. Chosen by hand.
const DEEPEST: usize = 8;
const MOST: usize = 1000;

pub(super) fn convert(
    path: &Path,
    topic: Option<&str>,
    to: (&mut Text, Option<Text>),
) -> Result<Written, Wrong> {
    let size = path.metadata()?.len();
    let file = File::open_streaming(path).map_err(Wrong::damaged)?;
    let mut found = Found {
        path,
        size,
        arrays: Vec::new(),
        left_out: LeftOut::default(),
        lowest: Lowest::default(),
    };
    found
        .gather(&file.root(), "", DEEPEST)
        .map_err(Wrong::damaged)?;
    let left_out = found.left_out.note();
    if found.arrays.is_empty()
        && let Some(wrong) = found.left_out.refusal()
    {
        return Err(wrong);
    }
    let written = arrays::write(found.arrays, topic, to);
    let (note, layout) = written.map_err(|wrong| match (wrong, &left_out) {
        (Wrong::Unfit(what, remedy), Some(left_out)) => {
            Wrong::unfit(format!("{what}, and {left_out}"), remedy)
        }
        (wrong, _) => wrong,
    })?;
    let notes: Vec<String> = [note, found.lowest.note(), left_out]
        .into_iter()
        .flatten()
        .collect();
    let notes = (!notes.is_empty()).then(|| notes.join("; "));
    Ok((notes, layout))
}

/// What a file holds.
struct Found<'a> {
    path: &'a Path,
    size: u64,
    arrays: Vec<Array>,
    left_out: LeftOut,
    lowest: Lowest,
}

impl Found<'_> {
    /// Collects the datasets of numbers in a group and in those within it.
    fn gather(&mut self, group: &Group, place: &str, levels: usize) -> Result<(), Error> {
        let (datasets, groups) = self.names(group, place)?;
        for name in datasets {
            if self.arrays.len() >= MOST {
                return Ok(());
            }
            let here = format!("{place}/{name}");
            match group.dataset(&name) {
                Ok(dataset) => match self.array(&dataset, place, &name) {
                    Ok(array) => self.arrays.extend(array),
                    Err(error) => self.left_out.dataset(here, Some(&dataset), &error),
                },
                Err(error) => self.left_out.dataset(here, None, &error),
            }
        }
        if levels > 0 {
            // MATLAB keeps what its cells refer to in groups whose names begin with #.
            for name in groups.iter().filter(|name| !name.starts_with('#')) {
                let place = format!("{place}/{name}");
                self.gather(&group.group(name)?, &place, levels - 1)?;
            }
        }
        Ok(())
    }

    /// The names of the datasets and of the groups in a group.
    fn names(&mut self, group: &Group, place: &str) -> Result<(Vec<String>, Vec<String>), Error> {
        let listed = group
            .datasets()
            .and_then(|names| Ok((names, group.groups()?)));
        let error = match listed {
            Ok(names) => return Ok(names),
            // The undefined address of the object of a soft link, plus what precedes HDF5 in the file.
            Err(error @ Error::Format(FormatError::OffsetOverflow { .. })) => error,
            Err(error) => return Err(error),
        };
        let Some(links) = hdf5_links::of(self.path, place) else {
            return Err(error);
        };
        for (name, to) in links.soft {
            self.left_out.link(format!("{place}/{name}"), to);
        }
        let (mut datasets, mut groups) = (Vec::new(), Vec::new());
        for name in links.objects {
            match group.dataset(&name) {
                Err(Error::NotADataset(_)) if group.group(&name).is_ok() => groups.push(name),
                Err(Error::NotADataset(_)) => {}
                Ok(_) | Err(_) => datasets.push(name),
            }
        }
        Ok((datasets, groups))
    }

    /// A dataset of numbers as an array.
    fn array(
        &mut self,
        dataset: &Dataset,
        place: &str,
        name: &str,
    ) -> Result<Option<Array>, Error> {
        let shape = dataset.shape()?;
        // A damaged file may claim any size.
        let claimed = shape
            .iter()
            .try_fold(8_u64, |all, &length| all.checked_mul(length));
        if claimed.is_none_or(|bytes| bytes > MOST_TIMES * self.size + MOST_TEXT) {
            return Ok(None);
        }
        let Some(values) = values(dataset)? else {
            return Ok(None);
        };
        self.lowest
            .look(&format!("{place}/{name}"), dataset, &values);
        let conventions = Conventions::of(&dataset.attrs()?);
        let (name, values) = (conventions.named(name), conventions.applied(values));
        let shape: Vec<usize> = shape.iter().map(|&length| length as usize).collect();
        Ok(Array::new(place.to_owned(), name, &shape, false, values))
    }
}

/// What the attributes of a dataset say of its numbers, by the conventions for climate and forecast metadata (CF, section 2.5.1 and
/// 8.1), which netCDF, xarray and others follow: a count that stands for no value, scale and offset, and the unit.
struct Conventions {
    /// The numbers that stand for no value.
    missing: Vec<f64>,
    scale: f64,
    offset: f64,
    unit: String,
}

impl Conventions {
    fn of(attributes: &HashMap<String, AttrValue>) -> Self {
        let numbers = |name: &str| attributes.get(name).map(numbers).unwrap_or_default();
        let number = |name: &str, usual: f64| numbers(name).first().copied().unwrap_or(usual);
        let unit = attributes.get("units").and_then(AttrValue::as_str);
        Self {
            missing: [numbers("_FillValue"), numbers("missing_value")].concat(),
            scale: number("scale_factor", 1.0),
            offset: number("add_offset", 0.0),
            unit: unit.unwrap_or_default().to_owned(),
        }
    }

    /// The name with the unit, if it is one that a sensor of this kind has.
    fn named(&self, name: &str) -> String {
        match are_units(std::slice::from_ref(&self.unit)) {
            true => with_unit(name, &self.unit),
            false => name.to_owned(),
        }
    }

    /// The values in their unit, and NaN for those that are none.
    fn applied(&self, values: Values) -> Values {
        let is_packed = self.scale != 1.0 || self.offset != 0.0;
        let is_missing = |value: f64| self.missing.contains(&value);
        let convert = |value: f64| match is_missing(value) {
            true => f64::NAN,
            false if is_packed => value * self.scale + self.offset,
            false => value,
        };
        let floats: Vec<f64> = match &values {
            Values::Signed(values) => values.iter().map(|&value| convert(value as f64)).collect(),
            Values::Unsigned(values) => values.iter().map(|&value| convert(value as f64)).collect(),
            Values::Count(values) | Values::Float(values) => {
                values.iter().map(|&value| convert(value)).collect()
            }
        };
        // Whole numbers stay whole if there is nothing to say about them.
        match is_packed || floats.iter().any(|value| value.is_nan()) {
            true => Values::of_floats(floats),
            false => match values {
                Values::Float(values) => Values::of_floats(values),
                whole => whole,
            },
        }
    }
}

/// The numbers of an attribute; none if it is text.
fn numbers(attribute: &AttrValue) -> Vec<f64> {
    match attribute {
        AttrValue::F32(value) => vec![f64::from(*value)],
        AttrValue::F64(value) => vec![*value],
        AttrValue::I8(value) => vec![f64::from(*value)],
        AttrValue::I16(value) => vec![f64::from(*value)],
        AttrValue::I32(value) => vec![f64::from(*value)],
        AttrValue::I64(value) => vec![*value as f64],
        AttrValue::U8(value) => vec![f64::from(*value)],
        AttrValue::U16(value) => vec![f64::from(*value)],
        AttrValue::U32(value) => vec![f64::from(*value)],
        AttrValue::U64(value) => vec![*value as f64],
        AttrValue::F32Array(values) => values.iter().map(|&value| value.into()).collect(),
        AttrValue::F64Array(values) => values.clone(),
        AttrValue::I8Array(values) => values.iter().map(|&value| value.into()).collect(),
        AttrValue::I16Array(values) => values.iter().map(|&value| value.into()).collect(),
        AttrValue::I32Array(values) => values.iter().map(|&value| value.into()).collect(),
        AttrValue::I64Array(values) => values.iter().map(|&value| value as f64).collect(),
        _ => Vec::new(),
    }
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
