//! Long tables in columns, whose numbers are not written as text: they give what the same table as text gives.

use allanite_log::{self as log, Covariates, Options, RowChoice, unit::Unit};
use arrow::{
    array::{
        ArrayRef, Decimal128Array, Float32Array, Float64Array, Int16Array, Int64Array, RecordBatch,
        StringArray, TimestampMicrosecondArray, UInt64Array,
    },
    compute::cast,
    csv::WriterBuilder,
    datatypes::DataType,
    ipc::writer::StreamWriter,
};
use hdf5_pure::FileBuilder;
use indicatif::ProgressBar;
use parquet::arrow::ArrowWriter;
use rand::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::{
    fs::{self, File},
    ops::Range,
    path::Path,
    sync::Arc,
};
use tempfile::TempDir;

/// More than the first rows that are written as text in any case.
const ROWS: usize = 20_000;

/// What a log is read as, with the file's name left out.
fn read(path: &Path, options: &Options) -> String {
    let read = log::read_with_evidence(path, options, &Covariates::Found, &ProgressBar::hidden());
    let name = path.file_name().unwrap().to_string_lossy();
    match read {
        Ok(log) => format!("{log:?}").replace(&*name, "LOG"),
        Err(failure) => format!("refused: {failure}").replace(&*name, "LOG"),
    }
}

struct Table {
    columns: Vec<(&'static str, ArrayRef)>,
    options: Options,
    /// What a refusal says.
    refused: Option<&'static str>,
}

impl Table {
    fn of(columns: Vec<(&'static str, ArrayRef)>) -> Self {
        Self {
            columns,
            options: Options::default(),
            refused: None,
        }
    }

    fn refused(mut self, what: &'static str) -> Self {
        self.refused = Some(what);
        self
    }

    fn check(self, name: &str) {
        let folder = TempDir::new().unwrap();
        let batch = RecordBatch::try_from_iter_with_nullable(
            self.columns
                .into_iter()
                .map(|(name, column)| (name, column, true)),
        );
        let batch = batch.unwrap();
        let path = |extension: &str| folder.path().join(format!("log.{extension}"));
        let text = File::create(path("csv")).unwrap();
        let stamps = "%Y-%m-%dT%H:%M:%S%.9f".to_owned();
        let mut writer = WriterBuilder::new()
            .with_timestamp_format(stamps)
            .build(text);
        // A short float is the same number as a long one, but not in the fewest digits.
        let longer = |column: &ArrayRef| match column.data_type() {
            DataType::Float32 => cast(column, &DataType::Float64).unwrap(),
            _ => column.clone(),
        };
        let schema = batch.schema();
        let names = schema.fields().iter().map(|field| field.name());
        let columns = names.zip(batch.columns().iter().map(longer));
        let columns = columns.map(|(name, column)| (name, column, true));
        let text = RecordBatch::try_from_iter_with_nullable(columns).unwrap();
        writer.write(&text).unwrap();
        let parquet = File::create(path("parquet")).unwrap();
        let mut writer = ArrowWriter::try_new(parquet, batch.schema(), None).unwrap();
        writer.write(&batch).unwrap();
        writer.close().unwrap();
        let arrow = File::create(path("arrow")).unwrap();
        let mut writer = StreamWriter::try_new(arrow, &batch.schema()).unwrap();
        for first in (0..ROWS).step_by(3001) {
            let rows = 3001.min(ROWS - first);
            writer.write(&batch.slice(first, rows)).unwrap();
        }
        writer.finish().unwrap();
        let text = read(&path("csv"), &self.options);
        match self.refused {
            Some(what) => assert!(
                text.starts_with("refused") && text.contains(what),
                "{name}: {}",
                &text[..text.len().min(400)]
            ),
            None => assert!(
                !text.starts_with("refused"),
                "{name}: {}",
                &text[..text.len().min(400)]
            ),
        }
        for extension in ["parquet", "arrow"] {
            let table = read(&path(extension), &self.options);
            let differs = table.bytes().zip(text.bytes()).position(|(a, b)| a != b);
            assert!(
                table == text,
                "{name}, {extension}: from byte {differs:?} on: {} instead of {}",
                &table[differs.unwrap_or(0)..][..200.min(table.len() - differs.unwrap_or(0))],
                &text[differs.unwrap_or(0)..][..200.min(text.len() - differs.unwrap_or(0))]
            );
        }
    }
}

fn noise(seed: u64) -> Vec<f64> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let draw = |_| -> f64 { StandardNormal.sample(&mut random) };
    (0..ROWS).map(draw).collect()
}

fn floats(seed: u64) -> ArrayRef {
    Arc::new(Float64Array::from_iter_values(noise(seed)))
}

/// Seconds at 500 Hz, of which some are lost.
fn seconds(lost: impl Fn(usize) -> usize) -> Vec<f64> {
    let at = |row: usize| row.wrapping_add(lost(row)) as f64 / 500.0;
    (0..ROWS).map(at).collect()
}

fn axes(time: ArrayRef) -> Vec<(&'static str, ArrayRef)> {
    vec![
        ("time [s]", time),
        ("gx [deg/s]", floats(1)),
        ("gy [deg/s]", floats(2)),
        ("gz [deg/s]", floats(3)),
    ]
}

fn even() -> ArrayRef {
    Arc::new(Float64Array::from(seconds(|_| 0)))
}

#[test]
fn numbers_in_columns_are_those_of_the_text() {
    Table::of(axes(even())).check("floats");
    let gaps = seconds(|row| row / 6000 * 3);
    Table::of(axes(Arc::new(Float64Array::from(gaps)))).check("gaps");
    let repeated = seconds(|row| 0_usize.wrapping_sub(row / 7000));
    Table::of(axes(Arc::new(Float64Array::from(repeated)))).check("repeated stamps");
    let micros = (0..ROWS as i64).map(|row| 1_700_000_000_000_000 + 2000 * row);
    let micros = TimestampMicrosecondArray::from_iter_values(micros);
    Table::of(axes(Arc::new(micros))).check("dates");
    let micros = (0..ROWS as u64).map(|row| u64::MAX / 4 + 2000 * row);
    let mut unsigned = axes(Arc::new(UInt64Array::from_iter_values(micros)));
    unsigned[0].0 = "time [us]";
    Table::of(unsigned).check("unsigned stamps");
}

#[test]
fn columns_of_other_types_are_those_of_the_text() {
    let mut counts = axes(even());
    for (seed, name) in ["gx [deg/s]", "gy [deg/s]", "gz [deg/s]"]
        .into_iter()
        .enumerate()
    {
        let values = noise(seed as u64).into_iter();
        let values = values.map(|value| (40.0 * value).round() as i16);
        counts[seed + 1] = (name, Arc::new(Int16Array::from_iter_values(values)));
    }
    Table::of(counts).check("counts");
    let mut short = axes(even());
    let values = noise(1).into_iter().map(|value| value as f32);
    short[1].1 = Arc::new(Float32Array::from_iter_values(values));
    Table::of(short).check("short floats");
    let mut decimals = axes(even());
    let values = noise(1).into_iter().map(|value| (1e9 * value) as i128);
    let values = Decimal128Array::from_iter_values(values);
    decimals[1].1 = Arc::new(values.with_precision_and_scale(20, 9).unwrap());
    Table::of(decimals).check("decimals");
    let mut texts = axes(even());
    let values = noise(1).into_iter().map(|value| format!("{value}"));
    texts[1].1 = Arc::new(StringArray::from_iter_values(values));
    texts.push(("frame_id", Arc::new(StringArray::from(vec!["imu"; ROWS]))));
    Table::of(texts).check("texts");
    let mut warm = axes(even());
    let kelvins = (0..ROWS).map(|row| {
        if row < 12_000 {
            25.0
        } else {
            25.0 + row as f64 / 1e4
        }
    });
    warm.push((
        "temp [C]",
        Arc::new(Float64Array::from_iter_values(kelvins)),
    ));
    Table::of(warm).check("temperature");
}

#[test]
fn what_is_missing_or_wrong_is_that_of_the_text() {
    let without = |seed: u64, lost: fn(usize) -> bool| -> ArrayRef {
        let values = noise(seed).into_iter().enumerate();
        Arc::new(Float64Array::from_iter(
            values.map(|(row, value)| (!lost(row)).then_some(value)),
        ))
    };
    let mut missing = axes(even());
    missing[1].1 = without(1, |row| row == 9000);
    missing[3].1 = without(3, |row| row % 4001 == 4000);
    Table::of(missing).check("missing values");
    let mut times = axes(even());
    let stamps = seconds(|_| 0).into_iter().enumerate();
    let stamps = stamps.map(|(row, stamp)| (row != 11_111).then_some(stamp));
    times[0].1 = Arc::new(Float64Array::from_iter(stamps));
    Table::of(times).check("a stamp is missing");
    let back = seconds(|row| {
        if row == 15_000 {
            0_usize.wrapping_sub(9)
        } else {
            0
        }
    });
    Table::of(axes(Arc::new(Float64Array::from(back))))
        .refused("go back")
        .check("stamps go back");
    let empty = axes(even())
        .into_iter()
        .enumerate()
        .map(|(place, (name, column))| {
            let column = if place == 2 {
                without(2, |row| row > 10_000)
            } else {
                column
            };
            (name, column)
        });
    Table::of(empty.collect())
        .refused("rows hold no sample")
        .check("an axis ends");
}

#[test]
fn rows_of_another_sensor_are_found_as_in_the_text() {
    let sensors = |change: usize| {
        let ids = (0..ROWS).map(|row| if row < change { 1 } else { 2 });
        let time = (0..ROWS).map(|row| (row % change) as f64 / 500.0);
        let mut columns = axes(Arc::new(Float64Array::from_iter_values(time)));
        columns.push(("device", Arc::new(Int64Array::from_iter_values(ids))));
        columns
    };
    Table::of(sensors(13_000))
        .refused("several sensors")
        .check("two sensors");
    let mut chosen = Table::of(sensors(13_000));
    chosen.options.rows = Some(RowChoice {
        column: "device".into(),
        value: "2".into(),
    });
    chosen.check("the second sensor");
}

/// The columns of HDF5 have the order of their names.
#[test]
fn arrays_of_hdf5_are_those_of_their_text() {
    let counts = |seed| noise(seed).into_iter().map(|value| (40.0 * value).round());
    let with_gap = |seed, lost: Range<usize>| -> Vec<f64> {
        let values = counts(seed).enumerate();
        let values = values.map(|(row, value)| match lost.contains(&row) {
            true => f64::NAN,
            false => value,
        });
        values.collect()
    };
    let tables = [
        ("floats", [noise(1), noise(2), noise(3)]),
        ("counts", [1, 2, 3].map(|seed| counts(seed).collect())),
        (
            "counts with gaps",
            [
                with_gap(1, 5..8),
                with_gap(2, 9000..9003),
                with_gap(3, 0..0),
            ],
        ),
    ];
    for (name, axes) in tables {
        let folder = TempDir::new().unwrap();
        let path = |extension: &str| folder.path().join(format!("log.{extension}"));
        let mut builder = FileBuilder::new();
        let time = seconds(|row| row / 6000 * 3);
        let columns = ["gx", "gy", "gz", "time"]
            .into_iter()
            .zip(axes.iter().chain([&time]));
        for (name, values) in columns {
            builder.create_dataset(name).with_f64_data(values);
        }
        fs::write(path("h5"), builder.finish().unwrap()).unwrap();
        let row = |row: usize| {
            let [x, y, z] = [0, 1, 2].map(|axis| match axes[axis][row] {
                value if value.is_nan() => String::new(),
                value => value.to_string(),
            });
            format!("{x},{y},{z},{}\n", time[row])
        };
        let text = (0..ROWS).map(row).collect::<String>();
        fs::write(path("csv"), format!("gx,gy,gz,time\n{text}")).unwrap();
        let options = Options {
            unit: Some(Unit::DegreesPerSecond),
            scale: Some(0.01).filter(|_| name != "floats"),
            ..Options::default()
        };
        let (array, text) = (read(&path("h5"), &options), read(&path("csv"), &options));
        assert!(!text.starts_with("refused"), "{name}: {text}");
        assert!(array == text, "{name}: {array}\ninstead of\n{text}");
    }
}
