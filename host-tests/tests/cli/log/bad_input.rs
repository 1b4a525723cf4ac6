//! Bad logs are refused in one line.

use super::{at_100_hz, counts, gzip, header, npy, refusal, rows_of_text, try_read};
use allanite_log::{Options, npy_header::Kind};
use std::fmt::Write as _;

#[test]
fn outlier_that_makes_the_noise_smaller_than_a_count_is_refused() {
    let mut text = String::from("gx\n1e9\n");
    for [x, ..] in counts(500) {
        let _ = writeln!(text, "{}", f64::from(x) * 1e-4);
    }
    assert_eq!(
        refusal("a.csv", text.as_bytes(), &at_100_hz()),
        "a.csv: axis gx: 499 of 500 steps between values are smaller than a count, 2^-30 of the range; \
         remove the outliers that make the range so wide"
    );
}

#[test]
fn broken_gzip_is_refused_with_its_row() {
    let packed = gzip(rows_of_text(&counts(20_000)).as_bytes());
    let line = refusal("a.csv.gz", &packed[..packed.len() / 2], &at_100_hz());
    let row: u64 = line.split(':').nth(1).unwrap().parse().unwrap();
    assert!((5_000..20_000).contains(&row), "{line}");
}

#[test]
fn the_first_bad_row_is_reported_whatever_its_column() {
    let rows = 3000;
    let spoilt = |places: &[(usize, usize)]| {
        let mut values = vec![0.5_f64; 3 * rows];
        // Fewer rows would be lost samples.
        let many = (2600..rows).map(|row| (row, 1));
        for (row, column) in places.iter().copied().chain(many) {
            values[3 * row + column] = f64::NAN;
        }
        let bytes: Vec<u8> = values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        npy(&header(Kind::Float, 8, &[rows as u64, 3]), &bytes)
    };
    for (places, expected) in [
        (&[(900, 0), (700, 1), (800, 2)][..], "a.npy:701: axis gy: "),
        (&[(900, 2), (900, 1)], "a.npy:901: axis gy: "),
        (&[(2999, 0), (1024, 2)], "a.npy:1025: axis gz: "),
        (&[(2999, 0)], "a.npy:2601: axis gy: "),
    ] {
        let line = refusal("a.npy", &spoilt(places), &at_100_hz());
        assert!(line.starts_with(expected), "{line}");
    }
}

#[test]
fn any_bytes_are_read_or_refused_without_a_panic() {
    let mut state = 7u64;
    let alphabet = b"0123456789,,,\n\n\r\"#-+.eNa;\t \xff\0";
    for name in ["a.csv", "a.csv.gz", "a.npy"] {
        for length in (0..400).step_by(3) {
            let bytes: Vec<u8> = (0..length)
                .map(|_| {
                    state = state
                        .wrapping_mul(6_364_136_223_846_793_005)
                        .wrapping_add(1);
                    alphabet[(state >> 33) as usize % alphabet.len()]
                })
                .collect();
            let _ = try_read(name, &bytes, &at_100_hz());
            let mut array = npy(&header(Kind::Signed, 4, &[9, 2]), &bytes);
            let spot = bytes.first().map_or(0, |&byte| usize::from(byte) % 100);
            array[spot] ^= 0x15;
            let _ = try_read("a.npy", &array, &at_100_hz());
        }
    }
}

/// The values of one level are held for ten rows each, and the two levels are separated by a gap in
/// time: few steps change at all, and none spans the jump.
#[test]
fn noise_below_a_count_is_refused_beside_held_values_and_level_jumps_over_a_gap() {
    let values = counts(4000);
    for (noise, is_refused) in [(1e-3, true), (0.05, true), (1.0, true), (100.0, false)] {
        for hold in [1, 10] {
            let mut text = String::from("time_us,gx [deg/s]\n");
            for i in 0..values.len() {
                let [held, ..] = values[i / hold * hold];
                let level = if i < 2000 { 0.0 } else { 2f64.powi(30) };
                let gap = if i < 2000 { 0 } else { 1_000_000_000 };
                // The scatter of the generator's numbers is 1182.
                let rate = level + f64::from(held) * noise / 1182.0 + 0.25;
                let _ = writeln!(text, "{},{rate}", 5000 * i + gap);
            }
            let options = Options::default();
            match try_read("a.csv", text.as_bytes(), &options) {
                Ok(_) => assert!(!is_refused, "noise {noise} held {hold}"),
                Err(line) => assert!(
                    is_refused && line.contains("2^-30 of the range"),
                    "noise {noise} held {hold}: {line}"
                ),
            }
        }
    }
}
