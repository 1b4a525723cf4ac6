//! What a file says of its own numbers is heard: attributes of HDF5 and netCDF.

use allanite_log::{Options, read, unit::Unit};
use hdf5_pure::{AttrValue, FileBuilder};
use indicatif::ProgressBar;
use program::json;
use std::{fs, path::Path};
use tempfile::TempDir;

/// Counts of noise, of which so many in the middle are the fill value.
fn counts(lost: usize) -> Vec<i16> {
    let mut state = 1_u32;
    let mut counts: Vec<i16> = (0..20_000)
        .map(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as i16 - 128
        })
        .collect();
    counts[500..500 + lost].fill(-32_768);
    counts
}

fn written(folder: &Path, attributes: &[(&str, AttrValue)], lost: usize) {
    let mut builder = FileBuilder::new();
    for name in ["gyro_x", "gyro_y"] {
        let dataset = builder.create_dataset(name);
        dataset.with_i16_data(&counts(lost));
        for (name, value) in attributes {
            dataset.set_attr(name, value.clone());
        }
    }
    fs::write(folder.join("log.nc"), builder.finish().unwrap()).unwrap();
}

/// The library netCDF4 1.7.5 for Python writes a packed variable as whole numbers with `scale_factor`, `add_offset`, `_FillValue` and
/// `units` beside them (CF conventions 1.11, sections 2.5.1 and 8.1). Read without them, the fill values are rates of −32768.
#[test]
fn packed_values_have_their_unit_and_fill_values_are_lost_samples() {
    let folder = TempDir::new().unwrap();
    let attributes = [
        ("_FillValue", AttrValue::I16(-32_768)),
        ("scale_factor", AttrValue::F64(0.01)),
        ("add_offset", AttrValue::F64(2.0)),
        ("units", AttrValue::String("rad/s".into())),
    ];
    written(folder.path(), &attributes, 200);
    let options = Options {
        rate_hz: Some(200.0),
        ..Options::default()
    };
    let path = folder.path().join("log.nc");
    let log = read(&path, &options, &ProgressBar::hidden()).unwrap();
    assert_eq!(log.unit, Unit::RadiansPerSecond);
    assert_eq!(log.axes[0].accumulator.samples(), 19_800);
    let said = log.notes.join("\n");
    assert!(said.contains("200 samples lost"), "{said}");

    let fitted = json(folder.path(), &["fit", "log.nc", "--rate", "200"]);
    let white = &fitted["axes"][0]["coefficients"][1];
    // Uniform counts of 256 levels, in steps of 0.01 rad/s.
    let truth = 0.01 * 256.0 / 12_f64.sqrt() / 200_f64.sqrt();
    let [lower, upper] = ["lower", "upper"].map(|end| white[end].as_f64().unwrap());
    assert!(lower < truth && truth < upper, "{white} {truth}");
}

#[test]
fn numbers_without_attributes_stay_the_counts_that_they_are() {
    let folder = TempDir::new().unwrap();
    written(
        folder.path(),
        &[("units", AttrValue::String("furlongs".into()))],
        0,
    );
    let options = Options {
        rate_hz: Some(200.0),
        ..Options::default()
    };
    let path = folder.path().join("log.nc");
    let log = read(&path, &options, &ProgressBar::hidden()).unwrap();
    assert_eq!(log.axes[0].name, "gyro_x");
    assert!((log.axes[0].rate_per_count - 1.0).abs() < 1e-12);
    assert_eq!(log.axes[0].accumulator.samples(), 20_000);
}
