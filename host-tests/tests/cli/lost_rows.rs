//! Logs with rows that hold no sample, of other forms, and from a pipe.

use program::{command, json, output, piped, refusal, run};
use std::{fmt::Write as _, fs, io::Write as _};
use tempfile::TempDir;

/// A log of 2000 samples of white noise, in which `change(row, line)` replaces lines.
fn log(change: impl Fn(usize, String) -> String) -> String {
    let mut state = 5_u64;
    let mut value = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 50) as i64 - 8192
    };
    (0..2000).fold(
        String::from("# rate_hz=100 unit=deg/s scale=0.001\ngx,gy\n"),
        |mut text, row| {
            let _ = writeln!(text, "{}", change(row, format!("{},{}", value(), value())));
            text
        },
    )
}

#[test]
fn a_row_without_a_sample_is_lost_and_told() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("log.csv");
    for (line, words) in [
        ("nan,3", "axis gx: \"nan\" is not a finite number"),
        ("7,", "axis gy: a value is missing"),
        ("sensor reset", "1 value where the first row has 2"),
        ("7,3,2,1", "4 values where the first row has 2"),
    ] {
        let change = |row, good| {
            if row == 1000 || row == 1500 {
                line.into()
            } else {
                good
            }
        };
        fs::write(&path, log(change)).unwrap();
        let ran = run(folder.path(), &["fit", "log.csv"]);
        let notes = String::from_utf8_lossy(&ran.stderr).into_owned();
        let expected = format!("2 samples lost, the first in row 1003: {words}");
        assert!(notes.contains(&expected), "{line}: {notes}");
        let axis = &json(folder.path(), &["fit", "log.csv"])["axes"][0];
        let told = String::from_utf8_lossy(&ran.stdout).into_owned();
        assert!(told.starts_with("gx: 1998 samples "), "{line}: {told}");
        // The rest is read as the same counts as a log with a told loss.
        let told = log(|row, good| {
            if row == 1000 || row == 1500 {
                "# lost 1 sample".into()
            } else {
                good
            }
        });
        fs::write(folder.path().join("told.csv"), told).unwrap();
        let told = &json(folder.path(), &["fit", "told.csv"])["axes"][0];
        assert_eq!(axis["coefficients"], told["coefficients"], "{line}");
    }
    let many = |row, good| if row % 9 == 5 { "nan,3".into() } else { good };
    fs::write(&path, log(many)).unwrap();
    let refused = refusal(folder.path(), &["fit", "log.csv"]);
    assert!(
        refused.starts_with("log.csv:8: ") && refused.contains("222 of 2000 rows hold no sample"),
        "{refused}"
    );
}

#[test]
fn lines_of_blanks_are_no_rows_and_an_ascii_mat_is_text() {
    let folder = TempDir::new().unwrap();
    let samples = |name: &str, text: &str| {
        fs::write(folder.path().join(name), text).unwrap();
        let told = output(folder.path(), &["fit", name]);
        assert!(told.starts_with("gx: 2000 samples "), "{told}");
    };
    let blank = log(|row, good| {
        if row % 3 == 0 {
            format!("{good}\n  ")
        } else {
            good
        }
    });
    samples("blank.csv", &blank);
    samples("ascii.mat", &log(|_, good| good));
    let elapsed = log(|row, good| format!("{:.2},{good}", row as f64 / 100.0));
    let elapsed = elapsed
        .replace("# rate_hz=100 unit", "# unit")
        .replace("gx,gy", "elapsed (s),gx,gy");
    samples("elapsed.csv", &elapsed);
}

#[test]
fn a_pipe_is_read_as_a_file_is() {
    let folder = TempDir::new().unwrap();
    let text = log(|_, good| good);
    fs::write(folder.path().join("log.csv"), &text).unwrap();
    let mut child = piped(&mut command(folder.path(), &["fit", "-"]));
    child
        .stdin
        .take()
        .unwrap()
        .write_all(text.as_bytes())
        .unwrap();
    let piped_output = child.wait_with_output().unwrap();
    assert!(piped_output.status.success());
    let filed = output(folder.path(), &["fit", "log.csv"]);
    assert_eq!(String::from_utf8(piped_output.stdout).unwrap(), filed);
    let child = piped(&mut command(folder.path(), &["fit", "-"]));
    let refused = child.wait_with_output().unwrap();
    let line = String::from_utf8(refused.stderr).unwrap();
    assert!(
        line.starts_with("allanite: -: the file is empty; "),
        "{line}"
    );
}

#[test]
fn a_mistyped_name_gets_the_nearest_one() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("log.csv"), log(|_, good| good)).unwrap();
    for (arguments, nearest) in [
        (
            &["compare", "log.csv", "--with", "sinusiod"][..],
            "did you mean sinusoid?",
        ),
        (&["fit", "log.csv", "--columns", "gxx"], "did you mean gx?"),
        (&["fit", "log.csv", "--colums", "gx"], "'--columns'"),
        (&["fitt", "log.csv"], "'fit'"),
    ] {
        let refused = refusal(folder.path(), arguments);
        assert!(refused.contains(nearest), "{arguments:?}: {refused}");
    }
}
