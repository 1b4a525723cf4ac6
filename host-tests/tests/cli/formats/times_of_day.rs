//! Columns of Parquet and Arrow whose type is a time of day.

use super::try_read;
use allanite_log::Options;
use arrow::{
    array::{
        ArrayRef, Float64Array, RecordBatch, Time32MillisecondArray, Time64MicrosecondArray,
        Time64NanosecondArray,
    },
    ipc::writer::FileWriter,
};
use parquet::arrow::ArrowWriter;
use rand::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::{fs::File, sync::Arc};
use tempfile::TempDir;

const ROWS: i64 = 400;

/// The milliseconds of a day.
const DAY: i64 = 86_400_000;

/// The types TIME_MILLIS, TIME_MICROS and TIME_NANOS of Parquet (its format 2.10, logical type TIME) and Time32 and Time64 of Arrow count
/// from midnight: pandas 2 writes a column of `datetime.time` as Time64 in microseconds.
#[test]
fn a_time_of_day_gives_the_rate_also_over_midnight() {
    let folder = TempDir::new().unwrap();
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    // Midday, and one second before midnight. Rows 100 to 101 are lost.
    for start in [DAY / 2, DAY - 1000] {
        let row = |n: i64| n + 2 * i64::from(n >= 100);
        let stamps: Vec<i64> = (0..ROWS).map(|n| (start + 5 * row(n)) % DAY).collect();
        let millis = Time32MillisecondArray::from_iter_values(stamps.iter().map(|&t| t as i32));
        let micros = Time64MicrosecondArray::from_iter_values(stamps.iter().map(|&t| 1000 * t));
        let nanos = Time64NanosecondArray::from_iter_values(stamps.iter().map(|&t| 1_000_000 * t));
        let times: [ArrayRef; 3] = [Arc::new(millis), Arc::new(micros), Arc::new(nanos)];
        for time in times {
            let mut axis = || -> ArrayRef {
                let draw = |_| StandardNormal.sample(&mut random);
                Arc::new(Float64Array::from_iter_values((0..ROWS).map(draw)))
            };
            let batch = RecordBatch::try_from_iter([
                ("time", time),
                ("gyro_x", axis()),
                ("gyro_y", axis()),
                ("gyro_z", axis()),
            ])
            .unwrap();
            let (parquet, arrow) = (
                folder.path().join("a.parquet"),
                folder.path().join("a.arrow"),
            );
            let file = File::create(&parquet).unwrap();
            let mut writer = ArrowWriter::try_new(file, batch.schema(), None).unwrap();
            writer.write(&batch).unwrap();
            writer.close().unwrap();
            let file = File::create(&arrow).unwrap();
            let mut writer = FileWriter::try_new(file, &batch.schema()).unwrap();
            writer.write(&batch).unwrap();
            writer.finish().unwrap();
            for path in [parquet, arrow] {
                let log = try_read(&path, &Options::default()).unwrap();
                let names: Vec<&str> = log.axes.iter().map(|axis| axis.name.as_str()).collect();
                assert_eq!(names, ["gyro_x", "gyro_y", "gyro_z"]);
                assert_eq!(log.rate_hz, 200.0);
                let said = log.notes.join("\n");
                assert!(said.contains("2 samples lost"), "{said}");
                let accumulator = &log.axes[0].accumulator;
                assert_eq!(accumulator.samples(), ROWS as u64, "{said}");
                let is_over_midnight = said.contains("wrap");
                assert_eq!(is_over_midnight, start != DAY / 2, "{said}");
            }
        }
    }
}
