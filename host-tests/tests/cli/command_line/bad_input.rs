//! Bad input ends with one line, and no existing output is lost.

use super::folder;
use allanite_host::curve_file::VERSION;
use program::refusal;
use std::fs;

#[test]
fn bad_input_ends_with_one_line_and_no_output_file() {
    let folder = folder();
    let path = folder.path();
    let good = fs::read_to_string(path.join("log.csv")).unwrap();
    let curve = fs::read_to_string(path.join("curve.json")).unwrap();
    let write = |name: &str, bytes: &[u8]| fs::write(path.join(name), bytes).unwrap();
    // Of many rows, a single bad one would be a lost sample.
    let few: String = good.split_inclusive('\n').take(10).collect();
    write("ragged.csv", format!("{few}1,2\n").as_bytes());
    write("text.csv", format!("{few}1,2,many\n").as_bytes());
    write("nan.csv", format!("{few}nan,2,3\n").as_bytes());
    write("empty.csv", b"");
    write("bare.csv", b"# rate_hz=100\ngx\n");
    write("short.csv", b"# rate_hz=100\ngx\n1\n2\n4\n");
    write(
        "stuck.csv",
        ["# rate_hz=100\ngx\n", &"7\n".repeat(99)]
            .concat()
            .as_bytes(),
    );
    write("rate.csv", b"# rate_hz=0\ngx\n1\n2\n4\n");
    write("silent.csv", b"gx\n1\n2\n4\n");
    write("LOG00001.BBL", b"H Product:Blackbox\n");
    write(
        "old.json",
        curve
            .replace(&format!("\"version\": {VERSION}"), "\"version\": 0")
            .as_bytes(),
    );
    write(
        "odd.json",
        curve.replacen("\"m\": 2", "\"m\": 3", 1).as_bytes(),
    );
    for (input, more, expected) in [
        (
            "ragged.csv",
            &[][..],
            "ragged.csv:11: 2 values where the first row has 3; ",
        ),
        (
            "text.csv",
            &[],
            "text.csv:11: axis gz: \"many\" is not a number; ",
        ),
        (
            "nan.csv",
            &[],
            "nan.csv:11: axis gx: \"nan\" is not a finite number; ",
        ),
        ("empty.csv", &[], "empty.csv: the file is empty; "),
        ("bare.csv", &[], "bare.csv: no rows; "),
        (
            "short.csv",
            &[],
            "short.csv: 3 samples are too few: two octaves need 9; record longer",
        ),
        (
            "stuck.csv",
            &[],
            "stuck.csv: axis gx never changes its value; ",
        ),
        (
            "rate.csv",
            &[],
            "rate.csv:1: rate_hz=\"0\" is not a positive, finite number; ",
        ),
        (
            "silent.csv",
            &[],
            "silent.csv: the sampling rate is not known: none of the columns gx is named like a time; \
             give it with --rate HZ, or name a column of time stamps with --time",
        ),
        ("LOG00001.BBL", &[], "LOG00001.BBL: no log with numbers; "),
        ("none.csv", &[], "none.csv: no such file; check the path"),
        (".", &[], "empty.csv: the file is empty; "),
        ("log.csv", &["--rate", "0"], "--rate 0 is impossible; "),
        ("log.csv", &["--rate", "-5"], "--rate -5 is impossible; "),
        ("log.csv", &["--rate", "nan"], "--rate NaN is impossible; "),
        ("log.csv", &["--scale", "-1"], "--scale -1 is impossible; "),
        (
            "log.csv",
            &["--columns", "gx,gw"],
            "log.csv: there is no column \"gw\"; ",
        ),
    ] {
        for command in [&["fit"][..], &["measure", "--output", "new.json"]] {
            let line = refusal(path, &[command, &[input], more].concat());
            assert!(line.contains(expected), "{line}\nis not\n{expected}");
        }
        assert!(!path.join("new.json").exists(), "{input}");
    }
    for (input, expected) in [
        (
            "old.json",
            "old.json: the format has version 0, but this program reads versions 1 to 5; ",
        ),
        ("odd.json", "odd.json: axis \"gx\": octave m = 3: "),
        ("none.json", "none.json: no such file; "),
    ] {
        let line = refusal(path, &["fit", input]);
        assert!(line.starts_with(expected), "{line}");
    }
    let line = refusal(path, &["fit", "curve.json", "--rate", "100"]);
    assert!(
        line.starts_with("curve.json: a curve file contains its rate"),
        "{line}"
    );
}

#[test]
fn failure_leaves_an_earlier_output_unchanged() {
    let folder = folder();
    let path = folder.path();
    let before = fs::read(path.join("curve.json")).unwrap();
    fs::write(path.join("bad.csv"), "# rate_hz=1\ngx\n1\n2\nx\n").unwrap();
    refusal(path, &["measure", "bad.csv", "--output", "curve.json"]);
    assert_eq!(before, fs::read(path.join("curve.json")).unwrap());
    assert_eq!(
        fs::read_dir(path).unwrap().count(),
        3,
        "no temporary file remains"
    );
    let line = refusal(path, &["measure", "log.csv", "--output", "log.csv"]);
    assert_eq!(
        line,
        "log.csv: a curve file must end in .json; rename the output"
    );
    let line = refusal(path, &["measure", "log.csv", "--output", "none/curve.json"]);
    assert_eq!(
        line,
        "none/curve.json: its folder does not exist; create the folder first"
    );
}
