//! Simulates logs on the command line.

use program::{command, output, refusal};
use std::{fs, path::Path, process::Stdio};
use tempfile::TempDir;

#[test]
fn simulation_depends_on_the_seed_and_nothing_else() {
    let folder = TempDir::new().unwrap();
    let simulate = |more: &[&str]| {
        output(
            folder.path(),
            &[&["simulate", "mems", "--duration", "1"], more].concat(),
        )
    };
    let one = simulate(&[]);
    assert_eq!(one, simulate(&["--seed", "1"]));
    assert_ne!(one, simulate(&["--seed", "2"]));
    assert_eq!(one.lines().count(), 102);
    assert!(one.starts_with("# rate_hz=100 unit=deg/s seed=1 "), "{one}");
    let axes = simulate(&["--axes", "3"]);
    let first = |text: &str| {
        let rows = text.lines().skip(2);
        rows.map(|row| row.split(',').next().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    assert_eq!(
        first(&one),
        first(&axes),
        "the first of several axes equals a single axis"
    );
    let named = output(
        folder.path(),
        &["simulate", "--preset", "mems", "--duration", "1s"],
    );
    assert_eq!(one, named);
    let own = [
        "simulate",
        "fog",
        "--angle-random-walk",
        "0",
        "--bias-instability",
        "0.5",
    ];
    let comment = output(folder.path(), &[&own[..], &["--duration", "1"]].concat());
    let comment = comment.lines().next().unwrap();
    for word in [
        "quantization=0.00002",
        "angle_random_walk=0 ",
        "bias_instability=0.5",
    ] {
        assert!(comment.contains(word), "{comment}");
    }
}

#[test]
fn impossible_simulations_are_refused() {
    let folder = TempDir::new().unwrap();
    for (arguments, expected) in [
        (&[][..], "no preset and no coefficient is given; "),
        (&["mems", "--rate", "0"], "--rate 0 is impossible; "),
        (&["mems", "--rate", "nan"], "--rate NaN is impossible; "),
        (
            &["mems", "--duration", "0"],
            "--duration 0 at 100 Hz is impossible; ",
        ),
        (
            &["mems", "--duration", "-3"],
            "--duration -3 at 100 Hz is impossible; ",
        ),
        (
            &["mems", "--duration", "inf"],
            "--duration inf at 100 Hz is impossible; ",
        ),
        (
            &["mems", "--duration", "long"],
            "--duration \"long\" is not a length of time; ",
        ),
        (&["mems", "--axes", "0"], "--axes 0 is impossible; "),
        (&["mems", "--axes", "4"], "--axes 4 is impossible; "),
        (&["mems", "--scale", "0"], "--scale 0 is impossible; "),
        (
            &["mems", "--rate-ramp", "-1"],
            "--rate-ramp -1 is impossible; ",
        ),
        (
            &["mems", "--output", "a.txt"],
            "a.txt: the file's extension is not that of a log; ",
        ),
        (
            &["mems", "--output", "a.csv", "--scale", "1e-300"],
            "a rate of ",
        ),
    ] {
        let line = refusal(folder.path(), &[&["simulate"], arguments].concat());
        assert!(line.starts_with(expected), "{line}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn reader_that_closes_the_pipe_early_is_no_failure() {
    let mut child = command(Path::new("."), &["simulate", "mems", "--duration", "1d"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}
