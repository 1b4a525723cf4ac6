//! Bad logs are refused in one line.

use super::{at_100_hz, columns, counts, gzip, header, npy, refusal, rows_of_text, try_read};
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
fn bad_text_is_refused_with_its_row() {
    let good = rows_of_text(&counts(50));
    // Of many rows, a single bad one would be a lost sample.
    let few = rows_of_text(&counts(8));
    for (text, expected) in [
        (
            String::new(),
            "bad.csv: the file is empty; record some samples",
        ),
        (
            "\n# only words\n".into(),
            "bad.csv: no rows; record some samples",
        ),
        ("gx,gy,gz\n".into(), "bad.csv: no rows; record some samples"),
        (
            format!("gx,gy,gz\n{few}1,2\n"),
            "bad.csv:10: 2 values where the first row has 3; correct the row or cut the record there",
        ),
        (
            format!("# rate_hz=1\n\n{few}1,2,3,4\n"),
            "bad.csv:11: 4 values where the first row has 3; correct the row or cut the record there",
        ),
        (
            format!("{few}1,two,3\n"),
            "bad.csv:9: axis gy: \"two\" is not a number; \
             correct it or choose other columns with --columns",
        ),
        (
            format!("{}1,two,3\r\n", few.replace('\n', "\r\n\r\n\r\n")),
            "bad.csv:25: axis gy: \"two\" is not a number; \
             correct it or choose other columns with --columns",
        ),
        (
            format!("\"gx\",\"gyro\ny\",\"gz\"\n{few}\"1\",two,3"),
            "bad.csv:11: axis gyro y: \"two\" is not a number; \
             correct it or choose other columns with --columns",
        ),
        (
            format!("{few}1,2,NaN\n"),
            "bad.csv:9: axis gz: \"NaN\" is not a finite number; \
             cut the record there or remove the value",
        ),
        (
            format!("{few}-inf,2,3"),
            "bad.csv:9: axis gx: \"-inf\" is not a finite number; \
             cut the record there or remove the value",
        ),
        (
            format!("{few}1e999,2,3\n"),
            "bad.csv:9: axis gx: \"1e999\" is not a finite number; \
             cut the record there or remove the value",
        ),
        (
            format!("{few}1,,3\n"),
            "bad.csv:9: axis gy: a value is missing; cut the record there or fill it in",
        ),
        (
            format!("gx,7,gz\n{good}"),
            "bad.csv:1: the first row mixes numbers and text such as \"gx\"; \
             make it a header of names only, or correct it",
        ),
        (
            "1,2,3\n4,5,7\n".into(),
            "bad.csv: 2 samples are too few: two octaves need 9; record longer",
        ),
        (
            "gx\n5\n5\n5\n5\n5\n5\n5\n5\n5\n5\n".into(),
            "bad.csv: axis gx never changes its value; \
             check the sensor, or choose other columns with --columns",
        ),
        (
            "gx\n0.1\n0.1\n0.1\n0.1\n0.1\n0.1\n0.1\n0.1\n0.1\n".into(),
            "bad.csv: axis gx never changes its value; \
             check the sensor, or choose other columns with --columns",
        ),
        (
            "gx\n-1e308\n1e308\n1e308\n-1e308\n".into(),
            "bad.csv: axis gx: the range of its values is too wide or too narrow for floats; \
             scale the values or remove the outliers",
        ),
        (
            format!("a,b,b\n{good}"),
            "bad.csv: two columns are named \"b\"; \
             tell them apart by number, such as --columns gx=1,gy=2",
        ),
        (
            format!("{good}1,\"2,3\n{}", good.repeat(5000)),
            "bad.csv:51: a row is longer than 1024 KiB; \
             look for a quote that is never closed",
        ),
        (
            "x".repeat(1 << 17),
            "bad.csv:1: a line has 64 KiB or more; check that the file is text",
        ),
    ] {
        assert_eq!(refusal("bad.csv", text.as_bytes(), &at_100_hz()), expected);
        if !text.is_empty() {
            let packed = gzip(text.as_bytes());
            let expected = expected.replace("bad.csv", "bad.csv.gz");
            assert_eq!(refusal("bad.csv.gz", &packed, &at_100_hz()), expected);
        }
    }
}

#[test]
fn broken_gzip_is_refused() {
    let packed = gzip(rows_of_text(&counts(20_000)).as_bytes());
    let line = refusal("a.csv.gz", &packed[..packed.len() / 2], &at_100_hz());
    let row: u64 = line.split(':').nth(1).unwrap().parse().unwrap();
    assert!(
        line.contains("the gzip stream ends in the middle"),
        "{line}"
    );
    assert!((5_000..20_000).contains(&row), "{line}");

    let line = refusal("a.csv.gz", b"gx,gy,gz\n1,2,3\n", &at_100_hz());
    assert!(line.starts_with("a.csv.gz: not a gzip stream"), "{line}");

    let mut flipped = packed;
    let middle = flipped.len() / 2;
    flipped[middle] ^= 0x55;
    refusal("a.csv.gz", &flipped, &at_100_hz());
}

#[test]
fn bad_arrays_are_refused() {
    let good: Vec<u8> = counts(50)
        .iter()
        .flatten()
        .flat_map(|c| f64::from(*c).to_le_bytes())
        .collect();
    let spoilt = |value: f64| {
        let mut elements = good.clone();
        for row in 40..50 {
            elements[8 * (3 * row + 1)..][..8].copy_from_slice(&value.to_le_bytes());
        }
        npy(&header(Kind::Float, 8, &[50, 3]), &elements)
    };
    let shaped = |shape: &[u64]| npy(&header(Kind::Float, 8, shape), &good);
    for (bytes, expected) in [
        (
            spoilt(f64::NAN),
            "a.npy:41: axis gy: NaN is not a finite number",
        ),
        (
            spoilt(f64::INFINITY),
            "a.npy:41: axis gy: inf is not a finite number",
        ),
        (
            shaped(&[51, 3]),
            "a.npy:51: the file ends before the 51 rows that the header declares",
        ),
        (
            shaped(&[49, 3]),
            "a.npy: more data follow the 49 rows that the header declares",
        ),
        (shaped(&[0, 3]), "a.npy: no rows"),
        (
            shaped(&[3, 100]),
            "a.npy: the array has 3 rows and 100 columns",
        ),
        (shaped(&[5, 10, 3]), "a.npy: the array has 3 dimensions"),
        (shaped(&[]), "a.npy: the array has 0 dimensions"),
        (
            shaped(&[u64::MAX, 3]),
            "a.npy: an array of 18446744073709551615 rows is impossible",
        ),
        (
            shaped(&[50, 0]),
            "a.npy: the array has 50 rows and 0 columns",
        ),
        (Vec::new(), "a.npy: the file ends within its header"),
        (
            shaped(&[50, 3])[..20].to_vec(),
            "a.npy: the file ends within its header",
        ),
        (vec![b'x'; 200], "a.npy: this is not a NumPy array file"),
    ] {
        let line = refusal("a.npy", &bytes, &at_100_hz());
        assert!(line.starts_with(expected) && line.contains("; "), "{line}");
    }
    let elements = shaped(&[50, 3]);
    let text = String::from_utf8_lossy(&elements[..128]).replace("<f8", "<c8");
    let complex = [&elements[..10], &text.as_bytes()[text.find('{').unwrap()..]].concat();
    let line = refusal("a.npy", &complex, &at_100_hz());
    assert!(line.contains("\"<c8\" are not plain numbers"), "{line}");
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
fn missing_columns_are_reported_with_the_existing_ones() {
    let good = rows_of_text(&counts(50));
    let named = format!("gx,gy,gz\n{good}");
    for (text, list, expected) in [
        (
            &named,
            "gw",
            "a.csv: there is no column \"gw\"; choose by name from gx, gy, gz or by number",
        ),
        (
            &named,
            "4",
            "a.csv: there is no column \"4\"; choose by name from gx, gy, gz or by number",
        ),
        (
            &good,
            "gx",
            "a.csv: there is no column \"gx\"; there is no header: choose by number from 1 to 3",
        ),
        (
            &good,
            "0",
            "a.csv: there is no column \"0\"; there is no header: choose by number from 1 to 3",
        ),
        (
            &named,
            "gx,gx",
            "--columns names \"gx\" twice; name every axis and every column once",
        ),
        (
            &named,
            "a=gx,a=gy",
            "--columns names \"a\" twice; name every axis and every column once",
        ),
    ] {
        assert_eq!(refusal("a.csv", text.as_bytes(), &columns(list)), expected);
    }
}

#[test]
fn impossible_rates_and_scales_are_refused() {
    let good = rows_of_text(&counts(50));
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let rate = Options {
            rate_hz: Some(value),
            ..at_100_hz()
        };
        let scale = Options {
            scale: Some(value),
            ..at_100_hz()
        };
        for (name, options) in [("--rate", rate), ("--scale", scale)] {
            let line = refusal("a.csv", good.as_bytes(), &options);
            assert!(
                line.starts_with(&format!("{name} {value} is impossible; ")),
                "{line}"
            );
        }
    }
    let line = refusal("a.csv", good.as_bytes(), &Options::default());
    assert_eq!(
        line,
        "a.csv: the sampling rate is not known: there is no header, and no column rises as a time does; \
         give it with --rate HZ, or name a column of time stamps with --time"
    );
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
