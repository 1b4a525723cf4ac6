//! Runs the program as a user does, for the tests of the command line.

use serde_json::Value;
use std::{
    ffi::OsString,
    path::Path,
    process::{Child, Command, Output, Stdio},
};

/// A list of tuples whose rows stand on a line each, as in a table.
#[macro_export]
macro_rules! rows {
    ($($($cell:expr),+;)*) => {
        [$(($($cell),+)),*]
    };
}

/// Curves of a real gyro.
pub const ADIS16405: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/adis16405.json");

/// The path of the program: where cargo put it for a test, or otherwise a program on the search path.
pub fn path() -> OsString {
    std::env::var_os("CARGO_BIN_EXE_allanite").unwrap_or_else(|| "allanite".into())
}

/// A command with its arguments, to be run in a folder.
pub fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(path());
    command.current_dir(folder).args(arguments);
    command
}

/// Sends a signal such as `INT` to a program.
///
/// # Panics
/// When the shell cannot send it.
pub fn signal(child: &Child, name: &str) {
    let kill = format!("kill -{name} {}", child.id());
    let status = Command::new("sh").args(["-c", &kill]).status();
    assert!(status.is_ok_and(|status| status.success()), "{kill}");
}

/// Starts a command whose input and outputs are pipes.
///
/// # Panics
/// When the program cannot be started.
pub fn piped(command: &mut Command) -> Child {
    let command = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command.spawn().expect("the program starts")
}

/// Runs a command and returns its output and exit status.
///
/// # Panics
/// When the program cannot be started.
pub fn run(folder: &Path, arguments: &[&str]) -> Output {
    let run = command(folder, arguments).output();
    run.unwrap_or_else(|error| panic!("{}: {error}", path().display()))
}

/// The standard output of a command that succeeds.
///
/// # Panics
/// When the command fails.
pub fn output(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// The JSON document that a command prints with `--json`.
///
/// # Panics
/// When the command fails or prints something else.
pub fn json(folder: &Path, arguments: &[&str]) -> Value {
    serde_json::from_str(&output(folder, &[arguments, &["--json"]].concat())).expect("JSON")
}

/// A number of a JSON document.
///
/// # Panics
/// When it is something else.
pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// The line on standard error of a command that refuses its input.
///
/// # Panics
/// When the command does anything else than to print one line with a remedy and end with exit status 2.
pub fn refusal(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    let errors = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {errors}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    let line = errors.strip_suffix('\n').expect("a line");
    assert!(
        !line.contains('\n') && line.contains("; "),
        "{arguments:?}: {line}"
    );
    line.strip_prefix("allanite: ").expect("a name").to_owned()
}

/// Measures a log into `curve.json` in the same folder, with nothing beside its octaves, as older versions did.
pub fn measure_without_spectrum(folder: &Path, log: &str) {
    output(folder, &["measure", log, "--output", "curve.json"]);
    let path = folder.join("curve.json");
    let text = std::fs::read(&path).expect("a curve file");
    let mut curve: Value = serde_json::from_slice(&text).expect("JSON");
    for axis in curve["axes"].as_array_mut().expect("axes") {
        let axis = axis.as_object_mut().expect("an axis");
        assert!(axis.remove("spectrum").is_some() && axis.remove("course").is_some());
    }
    std::fs::write(&path, curve.to_string()).expect("a curve file");
}
