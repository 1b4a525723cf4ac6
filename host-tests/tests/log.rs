//! Logs of every format become the same counts, and bad ones are refused with their row.

use allanite::Accumulator;
use flate2::{Compression, write::GzEncoder};
use host_tests::{
    log::{
        self, ColumnChoice, Log, OCTAVES, Options,
        npy_header::{Header, Kind},
    },
    unit::Unit,
};
use indicatif::ProgressBar;
use std::{fmt::Write as _, fs, io::Write as _};
use tempfile::TempDir;

/// Counts of a noisy gyro with three axes, the same every time.
fn counts(rows: usize) -> Vec<[i32; 3]> {
    let mut state = 1u32;
    let mut count = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 20) as i32 - 2048
    };
    (0..rows)
        .map(|_| [count(), count() - 500, count() / 8])
        .collect()
}

/// The accumulators of counts, an axis each.
fn accumulators(rows: &[[i32; 3]]) -> Vec<Accumulator<OCTAVES>> {
    (0..3)
        .map(|axis| {
            let mut accumulator = Accumulator::new();
            rows.iter().for_each(|row| accumulator.push(row[axis]));
            accumulator
        })
        .collect()
}

fn rows_of_text(rows: &[[i32; 3]]) -> String {
    rows.iter().fold(String::new(), |mut text, [x, y, z]| {
        let _ = writeln!(text, "{x},{y},{z}");
        text
    })
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn npy(header: &Header, elements: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    header.write(&mut bytes).unwrap();
    bytes.extend_from_slice(elements);
    bytes
}

fn header(kind: Kind, size: usize, shape: &[u64]) -> Header {
    Header {
        kind,
        size,
        big_endian: false,
        fortran_order: false,
        shape: shape.to_vec(),
    }
}

fn at_100_hz() -> Options {
    Options {
        rate_hz: Some(100.0),
        scale: Some(0.05),
        unit: Some(Unit::DegreesPerSecond),
        ..Options::default()
    }
}

fn columns(list: &str) -> Options {
    Options {
        columns: Some(
            list.split(',')
                .map(|choice| choice.parse::<ColumnChoice>().unwrap())
                .collect(),
        ),
        ..at_100_hz()
    }
}

fn try_read(name: &str, bytes: &[u8], options: &Options) -> Result<Log, String> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    log::read(&path, options, &ProgressBar::hidden()).map_err(|failure| {
        let folder = format!("{}/", folder.path().display());
        failure.to_string().replace(&folder, "")
    })
}

fn read(name: &str, bytes: &[u8], options: &Options) -> Log {
    try_read(name, bytes, options).unwrap()
}

fn refusal(name: &str, bytes: &[u8], options: &Options) -> String {
    let line = try_read(name, bytes, options).unwrap_err();
    assert!(!line.contains('\n'), "{line}");
    line
}

fn assert_axes(log: &Log, expected: &[Accumulator<OCTAVES>], what: &str) {
    assert_eq!(log.axes.len(), expected.len(), "{what}");
    for (axis, expected) in log.axes.iter().zip(expected) {
        assert!(axis.accumulator == *expected, "{what}, axis {}", axis.name);
    }
}

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

    let logs = [
        ("header.csv", format!("gx,gy,gz\n{text}").into_bytes()),
        ("bare.csv", text.clone().into_bytes()),
        ("BARE.CSV", text.clone().into_bytes()),
        (
            "windows.csv",
            format!("\u{feff}gx,gy,gz\r\n{}", text.replace('\n', "\r\n")).into_bytes(),
        ),
        ("semicolons.csv", text.replace(',', ";").into_bytes()),
        ("tabs.csv", text.replace(',', "\t").into_bytes()),
        (
            "comments.csv",
            text.replace("7\n", "7\n# said 1,2,3\n\n").into_bytes(),
        ),
        ("endless.csv", text.trim_end().as_bytes().to_vec()),
        ("quoted.csv", quoted.into_bytes()),
        ("whole.csv", whole_floats.into_bytes()),
        (
            "packed.csv.gz",
            gzip(format!("gx,gy,gz\n{text}").as_bytes()),
        ),
        (
            "members.csv.gz",
            [gzip(b"gx,gy,gz\n"), gzip(text.as_bytes())].concat(),
        ),
        (
            "i4.npy",
            npy(
                &header(Kind::Signed, 4, &[n, 3]),
                &bytes(&mut flat().map(|count| count.to_le_bytes().to_vec())),
            ),
        ),
        (
            "i2.npy",
            npy(
                &Header {
                    big_endian: true,
                    ..header(Kind::Signed, 2, &[n, 3])
                },
                &bytes(&mut flat().map(|count| (count as i16).to_be_bytes().to_vec())),
            ),
        ),
        (
            "f8.npy",
            npy(
                &header(Kind::Float, 8, &[n, 3]),
                &bytes(&mut flat().map(|count| f64::from(count).to_le_bytes().to_vec())),
            ),
        ),
        (
            "f4-by-column.npy",
            npy(
                &Header {
                    fortran_order: true,
                    ..header(Kind::Float, 4, &[n, 3])
                },
                &bytes(&mut by_column().map(|count| (count as f32).to_le_bytes().to_vec())),
            ),
        ),
    ];
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
            let variance = float.sum.to_f64() * text.rate_per_count.powi(2);
            let expected = count.sum.to_f64() * 0.05f64.powi(2);
            assert!(
                (variance / expected - 1.0).abs() < 1e-6,
                "{variance} {expected}"
            );
        }
    }
}

#[test]
fn first_number_that_is_no_count_restarts_the_reading() {
    let mut rows = counts(5000);
    rows[4000][1] = 12;
    let text = rows_of_text(&rows);
    let at = text.match_indices('\n').nth(3999).unwrap().0 + 1;
    let end = at + text[at..].find('\n').unwrap();
    let [x, _, z] = rows[4000];
    let text = format!("{}{x},12.5,{z}{}", &text[..at], &text[end..]);
    let log = read("late.csv", text.as_bytes(), &at_100_hz());
    let expected = accumulators(&rows);
    // The other axes' numbers are still the counts.
    assert!(log.axes[0].accumulator == expected[0] && log.axes[2].accumulator == expected[2]);
    let axis = &log.axes[1];
    assert!(axis.rate_per_count < 0.05);
    assert_eq!(axis.accumulator.samples(), 5000);
}

#[test]
fn whole_numbers_beyond_32_bits_are_numbers_all_the_same() {
    let rows = counts(5000);
    let text = rows.iter().fold(String::new(), |mut text, row| {
        let _ = writeln!(text, "{}", i64::from(row[0]) + (1 << 40));
        text
    });
    let log = read("wide.csv", text.as_bytes(), &at_100_hz());
    let expected = &accumulators(&rows)[0];
    let shortest = |accumulator: &Accumulator<OCTAVES>| accumulator.octave(0).unwrap().sum.to_f64();
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
            1_403_636_579_758_555_392 + 5_000_000 * i as u64
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
fn comments_say_what_options_do_not() {
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
fn what_is_assumed_is_said() {
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

#[test]
fn outlier_that_leaves_the_noise_no_counts_is_refused() {
    let mut text = String::from("gx\n1e9\n");
    for [x, ..] in counts(500) {
        let _ = writeln!(text, "{}", f64::from(x) * 1e-4);
    }
    assert_eq!(
        refusal("a.csv", text.as_bytes(), &at_100_hz()),
        "a.csv: axis gx: 499 of 500 steps between values are lost in 2^-30 of their range; \
         remove the outliers that make the range so wide"
    );
}

#[test]
fn bad_text_is_refused_with_its_row() {
    let good = rows_of_text(&counts(50));
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
            format!("gx,gy,gz\n{good}1,2\n{good}"),
            "bad.csv:52: 2 values where the first row has 3; correct the row or cut the record there",
        ),
        (
            format!("# rate_hz=1\n\n{good}1,2,3,4\n"),
            "bad.csv:53: 4 values where the first row has 3; correct the row or cut the record there",
        ),
        (
            format!("{good}1,two,3\n{good}"),
            "bad.csv:51: axis gy: \"two\" is not a number; \
             correct it or choose other columns with --columns",
        ),
        (
            format!("{}1,two,3\r\n", good.replace('\n', "\r\n# and\r\n\r\n")),
            "bad.csv:151: axis gy: \"two\" is not a number; \
             correct it or choose other columns with --columns",
        ),
        (
            format!("\"gx\",\"gyro\ny\",\"gz\"\n{good}\"1\",two,3"),
            "bad.csv:53: axis gyro y: \"two\" is not a number; \
             correct it or choose other columns with --columns",
        ),
        (
            format!("{good}1,2,NaN\n"),
            "bad.csv:51: axis gz: \"NaN\" is not a finite number; \
             cut the record there or remove the value",
        ),
        (
            format!("{good}-inf,2,3"),
            "bad.csv:51: axis gx: \"-inf\" is not a finite number; \
             cut the record there or remove the value",
        ),
        (
            format!("{good}1e999,2,3\n"),
            "bad.csv:51: axis gx: \"1e999\" is not a finite number; \
             cut the record there or remove the value",
        ),
        (
            format!("{good}1,,3\n"),
            "bad.csv:51: axis gy: a value is missing; cut the record there or fill it in",
        ),
        (
            format!("gx,7,gz\n{good}"),
            "bad.csv:1: the first row mixes numbers and text such as \"gx\"; \
             make it a header of names alone, or correct it",
        ),
        (
            "1,2,3\n4,5,7\n".into(),
            "bad.csv: 2 samples, and two octaves need 9; record longer",
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
            "bad.csv: axis gx: its range is beyond what floats can scale; \
             scale the values or remove the outliers",
        ),
        (
            format!("a,b,b\n{good}"),
            "bad.csv: two columns are named \"b\"; \
             tell them apart by number, such as --columns gx=1,gy=2",
        ),
        (
            format!("{good}1,\"2,3\n{}", good.repeat(5000)),
            "bad.csv:51: a row of more than 1024 KiB is not one of a log; \
             look for a quote that is never closed",
        ),
        (
            "x".repeat(1 << 17),
            "bad.csv:1: a line of 64 KiB or more is not one of a log; check that the file is text",
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
        elements[8 * (3 * 40 + 1)..][..8].copy_from_slice(&value.to_le_bytes());
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
            "a.npy:51: the file ends before the 51 rows of its header",
        ),
        (
            shaped(&[49, 3]),
            "a.npy: more data behind the 49 rows of its header",
        ),
        (shaped(&[0, 3]), "a.npy: no rows"),
        (
            shaped(&[3, 100]),
            "a.npy: an array of 3 rows and 100 columns",
        ),
        (shaped(&[5, 10, 3]), "a.npy: an array of 3 dimensions"),
        (shaped(&[]), "a.npy: an array of 0 dimensions"),
        (
            shaped(&[u64::MAX, 3]),
            "a.npy: an array of 18446744073709551615 rows cannot be",
        ),
        (shaped(&[50, 0]), "a.npy: an array of 50 rows and 0 columns"),
        (Vec::new(), "a.npy: the file ends within its header"),
        (
            shaped(&[50, 3])[..20].to_vec(),
            "a.npy: the file ends within its header",
        ),
        (
            vec![b'x'; 200],
            "a.npy: the file does not begin as a NumPy array",
        ),
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
fn missing_columns_are_named_with_those_there_are() {
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
        let options = Options {
            rate_hz: Some(value),
            ..at_100_hz()
        };
        let line = refusal("a.csv", good.as_bytes(), &options);
        assert!(
            line.starts_with(&format!("--rate {value} is impossible; ")),
            "{line}"
        );
        let options = Options {
            scale: Some(value),
            ..at_100_hz()
        };
        let line = refusal("a.csv", good.as_bytes(), &options);
        assert!(
            line.starts_with(&format!("--scale {value} is impossible; ")),
            "{line}"
        );
    }
    let line = refusal("a.csv", good.as_bytes(), &Options::default());
    assert_eq!(
        line,
        "a.csv: the sampling rate is not known; \
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
