//! Measurements in the format MDF, which another program makes a table of.

use super::{read_text, try_read};
use allanite_log::Options;
use std::{fmt::Write as _, fs};
use tempfile::TempDir;

/// ASAM MDF 4.1 marks samples as invalid by bits of their own. asammdf 8.8 leaves them out of `mdf.get(name)`, with their stamps, and
/// keeps whatever they hold in its table of the whole file.
#[test]
fn a_measurement_is_refused_with_a_table_that_keeps_invalid_samples_out() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.mf4");
    fs::write(&path, [&b"MDF     4.10    "[..], &[0; 48]].concat()).unwrap();
    let line = try_read(&path, &Options::default()).unwrap_err();
    let (what, remedy) = line.split_once("; ").unwrap();
    assert_eq!(what, "a.mf4: this is a measurement in the format MDF");
    for words in [
        "NaN",
        "MDF('a.mf4')",
        "mdf.get(name)",
        "index_label='time_s'",
    ] {
        assert!(remedy.contains(words), "{words}: {line}");
    }

    // The table that this writes, of which five samples of two axes are invalid.
    let mut text = String::from("time_s,gyro_x,gyro_y,gyro_z\n");
    let mut state = 1_u32;
    let mut value = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24)
    };
    for n in 0..2000 {
        let stamp = f64::from(n) / 200.0;
        let [x, y, z] = [value(), value(), value()];
        match (300..305).contains(&n) {
            true => writeln!(text, "{stamp},,,{z}").unwrap(),
            false => writeln!(text, "{stamp},{x},{y},{z}").unwrap(),
        }
    }
    let log = read_text(&text, &Options::default()).unwrap();
    assert_eq!(log.rate_hz, 200.0);
    let said = log.notes.join("\n");
    assert!(said.contains("5 samples lost"), "{said}");
}
