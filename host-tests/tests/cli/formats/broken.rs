//! Reads logs that were cut off, or in which a byte was changed.

use super::{GYRO, ROWS, assert_sums, counts, fixture, try_read};
use allanite_log::Options;
use std::fs;
use tempfile::TempDir;

/// The step between the places at which the files are cut. It is odd, so that the places fall on every byte of a word.
const STEP: usize = 7;

#[test]
fn truncation_is_refused_or_gives_the_rows_before_it_with_a_note() {
    cut_at_every(STEP);
}

mod thorough {
    #[test]
    fn truncation_at_any_byte_is_refused_or_gives_the_rows_before_it_with_a_note() {
        super::cut_at_every(1);
    }
}

/// Cuts files of every format at every multiple of `step` bytes.
fn cut_at_every(step: usize) {
    let rows = counts();
    let folder = TempDir::new().unwrap();
    for name in [
        "imu-zstd.mcap",
        "imu-lz4.mcap",
        "imu-plain.mcap",
        "gyro.ulg",
        "euroc.csv",
        "stamped.npy",
    ] {
        let bytes = fs::read(fixture(name)).unwrap();
        let path = folder.path().join(name);
        let mut whole = 0;
        for cut in (0..bytes.len()).step_by(step) {
            fs::write(&path, &bytes[..cut]).unwrap();
            let Ok(log) = try_read(&path, &Options::default()) else {
                continue;
            };
            assert!(
                name.ends_with("ulg") || name.ends_with("csv"),
                "{name} {cut}"
            );
            let said = log.notes.iter().any(|note| note.contains("cut off"));
            let samples = log.axes[0].accumulator.samples() as usize;
            let what = format!("{name} cut at {cut}");
            if name.ends_with("csv") {
                // The last row may be incomplete.
                let is_whole = bytes[..cut].ends_with(b"\n");
                assert_eq!(said, !is_whole, "{what}");
                whole += usize::from(is_whole);
                if !is_whole {
                    continue;
                }
            } else {
                whole += usize::from(!said);
            }
            // In a ULog that is cut early, another topic may have more messages.
            let every = if log.rate_hz == 200.0 { 1 } else { 2 };
            let before = rows.iter().step_by(every).take(samples);
            assert_sums(&log, before, 0, GYRO, &what);
        }
        // Only a cut between rows leaves a complete file.
        assert!(whole <= 2 * ROWS, "{name}: {whole}");
    }
}

#[test]
fn any_changed_byte_of_a_ulog_causes_no_panic() {
    let bytes = fs::read(fixture("gyro.ulg")).unwrap();
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.ulg");
    for at in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[at] ^= 0x41;
        fs::write(&path, &changed).unwrap();
        // A ULog has no checksum. A changed value may therefore be read, but no rows may be added.
        if let Ok(log) = try_read(&path, &Options::default()) {
            assert!(log.axes[0].accumulator.samples() <= ROWS as u64);
        }
    }
}

#[test]
fn any_changed_byte_of_a_bag_causes_no_panic() {
    let rows = counts();
    let bytes = fs::read(fixture("imu-plain.mcap")).unwrap();
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.mcap");
    for at in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[at] ^= 0x41;
        fs::write(&path, &changed).unwrap();
        if let Ok(log) = try_read(&path, &Options::default()) {
            assert_sums(
                &log,
                rows[..16].iter(),
                0,
                GYRO,
                &format!("byte {at} changed"),
            );
        }
    }
}
