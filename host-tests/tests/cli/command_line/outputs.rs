//! Outputs that are no regular files, outputs that are inputs, interruptions, and a standard error that
//! nobody reads.

use super::folder;
use program::{command, output, refusal};
use std::{
    fs,
    os::unix::fs::{FileTypeExt, symlink},
    path::Path,
    process::{Command, Stdio},
    thread,
    time::{Duration, Instant},
};

const EXPORT: [&str; 4] = ["export", "--format", "c", "curve.json"];

fn shell(folder: &Path, line: &str) -> std::process::Output {
    let mut shell = Command::new("sh");
    let shell = shell.args(["-c", line]).arg(program::path());
    shell.current_dir(folder).output().unwrap()
}

#[test]
fn devices_pipes_and_links_are_written_through() {
    let folder = folder();
    let path = folder.path();
    let expected = output(path, &EXPORT);
    output(path, &[&EXPORT[..], &["--output", "/dev/null"]].concat());
    assert!(
        fs::metadata("/dev/null")
            .unwrap()
            .file_type()
            .is_char_device()
    );

    fs::write(path.join("old.h"), "old").unwrap();
    symlink("old.h", path.join("link.h")).unwrap();
    symlink("new.h", path.join("dangling.h")).unwrap();
    for (link, file) in [("link.h", "old.h"), ("dangling.h", "new.h")] {
        output(path, &[&EXPORT[..], &["--output", link]].concat());
        assert!(path.join(link).is_symlink(), "{link}");
        assert_eq!(fs::read_to_string(path.join(file)).unwrap(), expected);
    }
    let piped = "mkfifo p; \"$0\" export --format c curve.json --output p & cat p";
    assert_eq!(
        String::from_utf8(shell(path, piped).stdout).unwrap(),
        expected
    );
    assert!(fs::metadata(path.join("p")).unwrap().file_type().is_fifo());
}

#[test]
fn temporary_files_vanish_on_an_interruption() {
    for signal in ["INT", "TERM"] {
        let folder = folder();
        let path = folder.path();
        let files = || fs::read_dir(path).unwrap().count();
        let before = files();
        let simulate = [
            "simulate",
            "mems",
            "--duration",
            "1000d",
            "--output",
            "long.csv",
        ];
        let mut child = command(path, &simulate)
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let begun = Instant::now();
        while files() == before && begun.elapsed() < Duration::from_secs(30) {
            thread::sleep(Duration::from_millis(5));
        }
        assert_eq!(files(), before + 1);
        program::signal(&child, signal);
        assert!(!child.wait().unwrap().success());
        assert_eq!(files(), before, "{signal}");
    }
}

#[test]
fn help_that_cannot_be_printed_says_so() {
    let folder = folder();
    for asked in ["--help", "--version", "fit --help"] {
        let ended = shell(folder.path(), &format!("\"$0\" {asked} >/dev/full"));
        assert_eq!(ended.status.code(), Some(2), "{asked}");
        let line = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert!(line.contains("standard output: "), "{asked}: {line}");
        let closed = shell(folder.path(), &format!("\"$0\" {asked} | true"));
        assert!(closed.stderr.is_empty(), "{asked}");
    }
}

#[test]
fn standard_error_that_is_closed_or_full_changes_nothing() {
    let folder = folder();
    let path = folder.path();
    for errors in ["2>&-", "2>/dev/full"] {
        // The log has notes, and the second file does not exist.
        let line = format!("\"$0\" fit log.csv none.csv {errors}");
        let ended = shell(path, &line);
        assert_eq!(ended.status.code(), Some(2), "{errors}");
        assert!(!ended.stdout.is_empty());
    }
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
