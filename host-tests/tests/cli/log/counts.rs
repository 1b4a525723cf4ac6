//! Logs of all formats are read into counts, with columns, units and rates as chosen.

use super::{
    accumulators, assert_axes, at_100_hz, columns, counts, gzip, header, npy, read, rows_of_text,
};
use allanite::Accumulator;
use allanite_log::{
    OCTAVES, Options,
    npy_header::{Header, Kind},
    unit::Unit,
};
use program::rows;
use std::fmt::Write as _;

#[test]
fn every_format_gives_the_same_counts() {
    let rows = counts(20_000);
    let expected = accumulators(&rows);
    let text = rows_of_text(&rows);
    let quoted = text.replace('\n', "\"\n\"").replace(',', "\",\"");
    let quoted = format!(
        "\"gx\",\"gy\",\"gz\"\n\"{}",
        quoted.strip_suffix('"').unwrap()
    );
    let whole_floats = rows.iter().fold(String::new(), |mut text, [x, y, z]| {
        let _ = writeln!(text, "{x}.0,{y}e0, {z} ");
        text
    });
    let n = rows.len() as u64;
    let flat = || rows.iter().flatten().copied();
    let by_column = || (0..3).flat_map(|axis| rows.iter().map(move |row| row[axis]));
    let bytes =
        |elements: &mut dyn Iterator<Item = Vec<u8>>| elements.flatten().collect::<Vec<u8>>();

    let logs = rows! {
        "header.csv", format!("gx,gy,gz\n{text}").into_bytes();
        "bare.csv", text.clone().into_bytes();
        "BARE.CSV", text.clone().into_bytes();
        "windows.csv", format!("\u{feff}gx,gy,gz\r\n{}", text.replace('\n', "\r\n")).into_bytes();
        "semicolons.csv", text.replace(',', ";").into_bytes();
        "tabs.csv", text.replace(',', "\t").into_bytes();
        "comments.csv", text.replace("7\n", "7\n# lost 0 samples\n\n").into_bytes();
        "endless.csv", text.trim_end().as_bytes().to_vec();
        "quoted.csv", quoted.into_bytes();
        "whole.csv", whole_floats.into_bytes();
        "packed.csv.gz", gzip(format!("gx,gy,gz\n{text}").as_bytes());
        "members.csv.gz", [gzip(b"gx,gy,gz\n"), gzip(text.as_bytes())].concat();
        "i4.npy", npy(&header(Kind::Signed, 4, &[n, 3]), &bytes(&mut flat().map(|count| count.to_le_bytes().to_vec())));
        "i2.npy",
            npy(
                &Header { big_endian: true, ..header(Kind::Signed, 2, &[n, 3]) },
                &bytes(&mut flat().map(|count| (count as i16).to_be_bytes().to_vec())),
            );
        "f8.npy",
            npy(&header(Kind::Float, 8, &[n, 3]), &bytes(&mut flat().map(|count| f64::from(count).to_le_bytes().to_vec())));
        "f4-by-column.npy",
            npy(
                &Header { fortran_order: true, ..header(Kind::Float, 4, &[n, 3]) },
                &bytes(&mut by_column().map(|count| (count as f32).to_le_bytes().to_vec())),
            );
    };
    for (name, bytes) in logs {
        let log = read(name, &bytes, &at_100_hz());
        let names: Vec<_> = log.axes.iter().map(|axis| axis.name.as_str()).collect();
        assert_eq!(names, ["gx", "gy", "gz"], "{name}");
        assert!(
            log.axes.iter().all(|axis| axis.rate_per_count == 0.05),
            "{name}"
        );
        assert_axes(&log, &expected, name);
    }
}

#[test]
fn floats_give_the_curve_of_their_counts_whatever_their_offset() {
    let rows = counts(20_000);
    let expected = accumulators(&rows);
    let mut text = String::from("gx,gy,gz\n");
    let mut elements = Vec::new();
    for row in &rows {
        let rates = row.map(|count| f64::from(count) * 0.05 + 1234.5);
        let _ = writeln!(text, "{},{},{}", rates[0], rates[1], rates[2]);
        rates
            .iter()
            .for_each(|rate| elements.extend(rate.to_le_bytes()));
    }
    let options = Options {
        scale: None,
        ..at_100_hz()
    };
    let from_text = read("rates.csv", text.as_bytes(), &options);
    let array = npy(&header(Kind::Float, 8, &[rows.len() as u64, 3]), &elements);
    let from_array = read("rates.npy", &array, &options);
    for ((text, array), counts) in from_text.axes.iter().zip(&from_array.axes).zip(&expected) {
        assert!(text.accumulator == array.accumulator);
        assert_eq!(text.rate_per_count, array.rate_per_count);
        for (float, count) in text.accumulator.octaves().zip(counts.octaves()).take(12) {
            let variance = float.sum.to_real() * text.rate_per_count.powi(2);
            let expected = count.sum.to_real() * 0.05f64.powi(2);
            assert!(
                (variance / expected - 1.0).abs() < 1e-6,
                "{variance} {expected}"
            );
        }
    }
}

#[test]
fn first_number_that_is_not_a_count_restarts_the_reading() {
    let mut rows = counts(5000);
    rows[4000][1] = 12;
    let text = rows_of_text(&rows);
    let at = text.match_indices('\n').nth(3999).unwrap().0 + 1;
    let end = at + text[at..].find('\n').unwrap();
    let [x, _, z] = rows[4000];
    let text = format!("{}{x},12.5,{z}{}", &text[..at], &text[end..]);
    let log = read("late.csv", text.as_bytes(), &at_100_hz());
    let expected = accumulators(&rows);
    // The numbers of the other axes remain counts.
    assert!(log.axes[0].accumulator == expected[0] && log.axes[2].accumulator == expected[2]);
    let axis = &log.axes[1];
    assert!(axis.rate_per_count < 0.05);
    assert_eq!(axis.accumulator.samples(), 5000);
}

#[test]
fn whole_numbers_beyond_32_bits_are_read_as_numbers() {
    let rows = counts(5000);
    let text = rows.iter().fold(String::new(), |mut text, row| {
        let _ = writeln!(text, "{}", i64::from(row[0]) + (1 << 40));
        text
    });
    let log = read("wide.csv", text.as_bytes(), &at_100_hz());
    let expected = &accumulators(&rows)[0];
    let shortest =
        |accumulator: &Accumulator<OCTAVES>| accumulator.octave(0).unwrap().sum.to_real();
    let quantum = log.axes[0].rate_per_count / 0.05;
    assert_eq!(
        shortest(&log.axes[0].accumulator) * quantum * quantum,
        shortest(expected)
    );
}

#[test]
fn columns_are_chosen_by_name_or_number_in_the_order_given() {
    let rows = counts(100);
    let expected = accumulators(&rows);
    let text = format!("t_s,a,b,c\n{}", {
        rows.iter()
            .enumerate()
            .fold(String::new(), |mut text, (i, [x, y, z])| {
                let _ = writeln!(text, "{},{x},{y},{z}", 0.01 * i as f64);
                text
            })
    });
    let bare = &text[text.find('\n').unwrap() + 1..];
    for (name, text, list, names, axes) in [
        ("a.csv", text.as_str(), "c,a", ["c", "a"], [2, 0]),
        ("a.csv", &text, "gy=b,gx=a", ["gy", "gx"], [1, 0]),
        ("a.csv", &text, "gz=4,2", ["gz", "a"], [2, 0]),
        ("b.csv", bare, "4,gx=2", ["c4", "gx"], [2, 0]),
    ] {
        let log = read(name, text.as_bytes(), &columns(list));
        assert_eq!(
            log.axes
                .iter()
                .map(|axis| axis.name.as_str())
                .collect::<Vec<_>>(),
            names
        );
        assert_axes(&log, &axes.map(|axis: usize| expected[axis].clone()), list);
        assert_eq!(log.notes, [""; 0]);
    }
    for text in [&text, bare] {
        let log = read("a.csv", text.as_bytes(), &at_100_hz());
        assert_axes(&log, &expected, "the time is left out");
        assert!(log.notes[0].contains("left out"), "{:?}", log.notes);
    }
}

#[test]
fn header_in_a_comment_names_the_columns() {
    let rows = counts(100);
    let mut text = String::from("#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],a_x\n");
    for (i, [x, y, z]) in rows.iter().enumerate() {
        let _ = writeln!(
            text,
            "{},{x},{y},{z}",
            1_403_636_579_758_555_392 + 10_000_000 * i as u64
        );
    }
    let log = read("euroc.csv", text.as_bytes(), &at_100_hz());
    assert_axes(&log, &accumulators(&rows)[..2], "two gyro axes");
    assert_eq!(
        log.notes,
        ["taken as axes: w_RS_S_x [rad s^-1], w_RS_S_y [rad s^-1]; \
          left out timestamp [ns], a_x (choose with --columns)"]
    );
}

#[test]
fn array_of_one_dimension_is_one_axis() {
    let rows = counts(100);
    let elements: Vec<u8> = rows
        .iter()
        .flat_map(|row| i64::from(row[0]).to_le_bytes())
        .collect();
    let log = read(
        "one.npy",
        &npy(&header(Kind::Signed, 8, &[100]), &elements),
        &at_100_hz(),
    );
    assert_axes(&log, &accumulators(&rows)[..1], "one axis");
    assert_eq!(log.axes[0].name, "gx");
}

#[test]
fn comments_apply_where_options_are_missing() {
    let text = format!(
        "# rate_hz=200 unit=rad/s scale=0.25\ngx,gy,gz\n{}",
        rows_of_text(&counts(50))
    );
    let log = read("a.csv", text.as_bytes(), &Options::default());
    assert_eq!((log.rate_hz, log.unit), (200.0, Unit::RadiansPerSecond));
    assert!(log.axes.iter().all(|axis| axis.rate_per_count == 0.25));
    let log = read("a.csv", text.as_bytes(), &at_100_hz());
    assert_eq!((log.rate_hz, log.unit), (100.0, Unit::DegreesPerSecond));
    assert!(log.axes.iter().all(|axis| axis.rate_per_count == 0.05));
}

#[test]
fn assumptions_are_noted() {
    let options = Options {
        rate_hz: Some(100.0),
        ..Options::default()
    };
    let text = format!("gx,gy,gz\n{}", rows_of_text(&counts(50)));
    let notes = read("a.csv", text.as_bytes(), &options).notes.join("\n");
    assert!(
        notes.contains("no scale given") && notes.contains("deg/s assumed"),
        "{notes}"
    );
}

/// A float holds whole numbers up to 2^53. Rounded to floats, the noise here would lose up to ten bits.
#[test]
fn whole_numbers_beyond_floats_give_the_curve_of_their_differences() {
    let rows = counts(20_000);
    let expected = accumulators(&rows);
    for base in [1_i64 << 53, 1 << 60, i64::MIN + 5000, -(1 << 55)] {
        let shifted: Vec<[i64; 3]> = rows
            .iter()
            .map(|row| row.map(|count| base + i64::from(count)))
            .collect();
        let text = shifted
            .iter()
            .fold(String::from("gx,gy,gz\n"), |mut text, [x, y, z]| {
                let _ = writeln!(text, "{x},{y}.0, {z}");
                text
            });
        let elements: Vec<u8> = shifted
            .iter()
            .flatten()
            .flat_map(|count| count.to_le_bytes())
            .collect();
        let array = npy(&header(Kind::Signed, 8, &[rows.len() as u64, 3]), &elements);
        for (name, bytes) in [("a.csv", text.as_bytes()), ("a.npy", &array)] {
            let log = read(name, bytes, &at_100_hz());
            for (axis, expected) in log.axes.iter().zip(&expected) {
                for (octave, expected) in axis.accumulator.octaves().zip(expected.octaves()) {
                    let found = octave.sum.to_real() * axis.rate_per_count.powi(2);
                    let expected = expected.sum.to_real() * 0.05_f64.powi(2);
                    let error = (found - expected).abs();
                    assert!(error <= 1e-12 * expected, "{name} {base}");
                }
            }
        }
    }
    let unsigned: Vec<u8> = rows
        .iter()
        .flat_map(|row| (u64::MAX - 5000 + (row[0] + 2048) as u64).to_le_bytes())
        .collect();
    let array = npy(&header(Kind::Unsigned, 8, &[rows.len() as u64]), &unsigned);
    let log = read("a.npy", &array, &at_100_hz());
    for (octave, expected) in log.axes[0].accumulator.octaves().zip(expected[0].octaves()) {
        assert_eq!(octave.sum.to_real(), expected.sum.to_real());
    }
}
