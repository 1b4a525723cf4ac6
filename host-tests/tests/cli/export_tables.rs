//! The CSV tables of the spectrum and of the course agree with the diagnosis and with the log.

use program::{json, output};
use serde_json::Value;
use std::{fs, path::Path};
use tempfile::TempDir;

/// Whether two numbers are the same up to rounding.
fn close(one: f64, other: f64) -> bool {
    (one - other).abs() <= 1e-9 * other.abs()
}

/// The rows of a table below a comment, with its header.
fn rows(path: &Path) -> (Vec<String>, Vec<csv::StringRecord>) {
    let text = fs::read_to_string(path).unwrap();
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let header = reader
        .headers()
        .unwrap()
        .iter()
        .map(str::to_owned)
        .collect();
    (header, reader.records().map(Result::unwrap).collect())
}

#[test]
fn csv_files_of_spectrum_and_course_stand_beside_that_of_the_curve() {
    let folder = TempDir::new().unwrap();
    let simulate = ["simulate", "mems", "--duration", "200s", "--axes", "1"];
    let output = |arguments: &[&str]| output(folder.path(), arguments);
    output(&[&simulate[..], &["--output", "log.csv"]].concat());
    output(&["measure", "log.csv", "--output", "short.json"]);
    let export = ["export", "--format", "csv", "--output"];
    output(&[&export[..], &["gyro.csv", "log.csv"]].concat());
    let (header, bins) = rows(&folder.path().join("gyro.spectrum.csv"));
    let names = "axis frequency_hz density standard_error expected z segments block";
    assert_eq!(header, names.split(' ').collect::<Vec<_>>());
    // The first step of a diagnosis has the five terms.
    let diagnosed = json(
        folder.path(),
        &["diagnose", "log.csv", "--max-effects", "0"],
    );
    let mut expected: Vec<&Value> = diagnosed["axes"][0]["spectrum"]
        .as_array()
        .unwrap()
        .iter()
        .collect();
    let key = |bin: &Value, key: &str| bin[key].as_f64().unwrap();
    expected.sort_by(|a, b| key(a, "frequency_hz").total_cmp(&key(b, "frequency_hz")));
    assert!(expected.len() >= 28);
    assert_eq!(bins.len(), expected.len());
    let radians = std::f64::consts::PI / 180.0;
    for (row, bin) in bins.iter().zip(expected) {
        let number = |i: usize| row[i].parse::<f64>().unwrap();
        assert!(close(number(1), key(bin, "frequency_hz")));
        assert!(close(number(2), radians * key(bin, "density").sqrt()));
        assert!(close(number(4), radians * key(bin, "expected").sqrt()));
        let off = number(5) - key(bin, "z");
        // A fit and a diagnosis stop at weights that differ by less than this.
        let most = 1e-3 * (1.0 + number(5).abs());
        assert!(off.abs() < most, "{row:?}: {off:e}");
        // Steady Gaussian noise: half of 1/√n, with an error of the kurtosis.
        let ratio = number(3) / number(2) * 2.0 * (18.0 / 19.0 * number(6)).sqrt();
        assert!((0.5..2.0).contains(&ratio), "{row:?}");
    }
    let (header, blocks) = rows(&folder.path().join("gyro.course.csv"));
    assert_eq!(
        header.join(" "),
        "axis start_s duration_s samples mean noise"
    );
    // 20 000 samples fill 40 blocks of 512.
    assert_eq!(blocks.len(), 40);
    assert_eq!(&blocks[0][3], "512");
    let (_, samples) = rows(&folder.path().join("log.csv"));
    let rates: Vec<f64> = samples.iter().map(|row| row[0].parse().unwrap()).collect();
    let mean = |at: usize| rates[512 * at..512 * (at + 1)].iter().sum::<f64>() / 512.0;
    for at in 0..38 {
        let number = |at: usize, i: usize| blocks[at][i].parse::<f64>().unwrap();
        let change = (number(at + 1, 4) - number(at, 4)) / radians;
        assert!((change - (mean(at + 1) - mean(at))).abs() < 1e-6);
        let squares = rates[512 * at..512 * (at + 1)].windows(2);
        let sum: f64 = squares.map(|pair| (pair[1] - pair[0]).powi(2)).sum();
        let noise = (0.5 * sum / 511.0).sqrt();
        assert!((number(at, 5) / radians / noise - 1.0).abs() < 0.01);
    }
    // A curve file has no course.
    output(&[&export[..], &["curve.csv", "short.json"]].concat());
    assert!(folder.path().join("curve.spectrum.csv").exists());
    assert!(!folder.path().join("curve.course.csv").exists());
}
