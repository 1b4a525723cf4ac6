//! Logs of some devices in Parquet, and the states that they have.

use allanite_log::pieces::Pieces;
use datafusion::{
    arrow::{
        array::{
            ArrayRef, AsArray, BinaryArray, Float64Array, Int64Array, ListArray, RecordBatch,
            StringArray,
        },
        compute::concat_batches,
        datatypes::Int32Type,
    },
    parquet::{arrow::ArrowWriter, file::properties::WriterProperties},
};
use rand::{RngExt as _, SeedableRng as _};
pub(crate) use rand_xoshiro::Xoshiro256PlusPlus as Random;
use std::{fs::File, path::Path, sync::Arc};

pub(crate) const RATE_HZ: f64 = 200.0;
pub(crate) const SCALE: f64 = 0.01;
pub(crate) const AXES: [&str; 2] = ["x", "y"];

/// Devices whose axes have so many samples each.
#[derive(Clone, Copy)]
pub(crate) struct Fleet {
    pub(crate) devices: usize,
    pub(crate) samples: usize,
}

/// Neighbouring samples of one axis of one device.
#[derive(Clone)]
pub(crate) struct Row {
    pub(crate) device: String,
    pub(crate) axis: &'static str,
    pub(crate) start: i64,
    pub(crate) counts: Vec<Option<i32>>,
}

pub(crate) fn random(seed: u64) -> Random {
    Random::seed_from_u64(seed)
}

impl Fleet {
    pub(crate) const SMALL: Self = Self {
        devices: 3,
        samples: 40_000,
    };

    /// Uniform noise and a random walk.
    pub(crate) fn counts(self, device: usize, axis: usize) -> Vec<i32> {
        let mut random = random(100 * device as u64 + axis as u64);
        let half_width = 50 + 20 * axis as i32;
        let mut walk = 0;
        let count = |_| {
            walk += random.random_range(-1..=1);
            random.random_range(-half_width..=half_width) + walk / 8
        };
        (0..self.samples).map(count).collect()
    }

    /// The devices and axes, in order, with the bytes of their states.
    pub(crate) fn states(self) -> Vec<(String, String, Vec<u8>)> {
        let mut states = Vec::new();
        for device in 0..self.devices {
            for (number, axis) in AXES.into_iter().enumerate() {
                let mut pieces = Pieces::new(RATE_HZ, SCALE).unwrap();
                pieces.push(0, &self.counts(device, number)).unwrap();
                states.push((
                    format!("d{device}"),
                    axis.to_owned(),
                    pieces.to_bytes().unwrap(),
                ));
            }
        }
        states
    }

    /// Rows of lengths that `length` draws.
    pub(crate) fn rows(self, mut length: impl FnMut() -> usize) -> Vec<Row> {
        let mut rows = Vec::new();
        for device in 0..self.devices {
            for (number, axis) in AXES.into_iter().enumerate() {
                let counts = self.counts(device, number);
                let mut start = 0;
                while start < counts.len() {
                    let end = (start + length()).min(counts.len());
                    rows.push(Row {
                        device: format!("d{device}"),
                        axis,
                        start: start as i64,
                        counts: counts[start..end].iter().copied().map(Some).collect(),
                    });
                    start = end;
                }
            }
        }
        rows
    }
}

/// Writes rows, in an order that is drawn, to so many files with groups of so many rows.
pub(crate) fn write(
    folder: &Path,
    mut rows: Vec<Row>,
    files: usize,
    group: usize,
    random: &mut Random,
) {
    for at in (1..rows.len()).rev() {
        rows.swap(at, random.random_range(0..=at));
    }
    std::fs::create_dir_all(folder).unwrap();
    for number in 0..files {
        let part: Vec<&Row> = rows.iter().skip(number).step_by(files).collect();
        let text = |of: fn(&Row) -> &str| -> ArrayRef {
            Arc::new(StringArray::from_iter_values(
                part.iter().map(|row| of(row)),
            ))
        };
        let counts = part.iter().map(|row| Some(row.counts.iter().copied()));
        let counts = ListArray::from_iter_primitive::<Int32Type, _, _>(counts);
        let starts: Int64Array = part.iter().map(|row| row.start).collect();
        let same =
            |value: f64| -> ArrayRef { Arc::new(Float64Array::from(vec![value; part.len()])) };
        let columns = [
            ("device", text(|row| &row.device)),
            ("axis", text(|row| row.axis)),
            ("start", Arc::new(starts)),
            ("rate", same(RATE_HZ)),
            ("scale", same(SCALE)),
            ("counts", Arc::new(counts)),
        ];
        write_columns(&folder.join(format!("{number}.parquet")), columns, group);
    }
}

/// Writes columns to a file with groups of so many rows.
pub(crate) fn write_columns<'a>(
    path: &Path,
    columns: impl IntoIterator<Item = (&'a str, ArrayRef)>,
    group: usize,
) {
    let table = RecordBatch::try_from_iter(columns).unwrap();
    let properties = WriterProperties::builder()
        .set_max_row_group_row_count(Some(group))
        .build();
    let mut writer = ArrowWriter::try_new(
        File::create(path).unwrap(),
        table.schema(),
        Some(properties),
    )
    .unwrap();
    writer.write(&table).unwrap();
    writer.close().unwrap();
}

/// The rows of a result with the columns device, axis and state.
pub(crate) fn found(batches: &[RecordBatch]) -> Vec<(String, String, Vec<u8>)> {
    let table = concat_batches(&batches[0].schema(), batches).unwrap();
    let text = |name: &str| {
        let column = datafusion::arrow::compute::cast(
            table.column_by_name(name).unwrap(),
            &datafusion::arrow::datatypes::DataType::Utf8,
        );
        column.unwrap().as_string::<i32>().clone()
    };
    let (devices, axes) = (text("device"), text("axis"));
    let state = datafusion::arrow::compute::cast(
        table.column_by_name("state").unwrap(),
        &datafusion::arrow::datatypes::DataType::Binary,
    )
    .unwrap();
    let states: &BinaryArray = state.as_binary();
    let row = |at: usize| {
        (
            devices.value(at).to_owned(),
            axes.value(at).to_owned(),
            states.value(at).to_vec(),
        )
    };
    (0..table.num_rows()).map(row).collect()
}
