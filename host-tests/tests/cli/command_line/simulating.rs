//! Simulates logs on the command line.

use program::{command, output};
use std::{path::Path, process::Stdio};
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
