//! Every call of the system that a command makes may fail, and the command may be killed at any of them: its output is then the
//! file that was there or the new one, and never anything else.

use program::{command, rows};
use std::{
    collections::BTreeSet,
    fs,
    path::Path,
    process::{Command, Output},
};
use tempfile::TempDir;

/// The commands that write a file, and the file.
const COMMANDS: [(&[&str], &str); 8] = rows! {
    &["measure", "log.csv", "-o", "out.json"], "out.json";
    &["merge", "one.json", "other.json", "-o", "out.json"], "out.json";
    &["report", "one.json", "--plain", "-o", "out.html"], "out.html";
    &["plot", "one.json", "-o", "out.svg"], "out.svg";
    &["plot", "one.json", "-o", "out.png"], "out.png";
    &["export", "one.json", "--format", "csv", "--model", "five-terms", "-o", "out.csv"], "out.csv";
    &["simulate", "mems", "--duration", "30s", "-o", "out.csv"], "out.csv";
    &["certify", "one.json", "-o", "out.bin"], "out.bin";
};

/// The calls that a file is read and written by.
pub(crate) const CALLS: [&str; 14] = [
    "write",
    "openat",
    "rename",
    "renameat",
    "renameat2",
    "linkat",
    "unlink",
    "fsync",
    "fchmod",
    "ftruncate",
    "close",
    "statx",
    "lseek",
    "read",
];

/// What happens at a call.
pub(crate) const FAULTS: [&str; 3] = ["error=ENOSPC", "error=EIO", "signal=KILL"];

/// The start of a command line that injects a fault into the call of this number of each thread.
pub(crate) fn traced(folder: &Path, call: &str, fault: &str, number: usize) -> Command {
    let mut traced = Command::new("strace");
    traced
        .current_dir(folder)
        .args(["-f", "-qq", "-o", "trace"]);
    traced.args([
        "-e",
        &format!("trace={call}"),
        "-e",
        &format!("inject={call}:{fault}:when={number}"),
    ]);
    traced
}

/// Whether the fault came.
pub(crate) fn was_injected(folder: &Path) -> bool {
    let trace = fs::read(folder.join("trace")).unwrap();
    let trace = String::from_utf8_lossy(&trace).into_owned();
    trace.contains("INJECTED") || trace.contains("killed by SIGKILL")
}

/// Runs a command whose call of this number and its fault are these; `None` if it makes fewer such calls.
fn faulty(
    folder: &Path,
    arguments: &[&str],
    call: &str,
    fault: &str,
    number: usize,
) -> Option<Output> {
    let program = command(folder, &[]);
    let mut traced = traced(folder, call, fault, number);
    let output = traced
        .arg(program.get_program())
        .arg("--quiet")
        .args(arguments)
        .output()
        .unwrap();
    was_injected(folder).then_some(output)
}

fn names(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).unwrap();
    entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect()
}

#[test]
fn every_failing_call_leaves_the_old_file_or_the_new_one() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let run = |arguments: &[&str]| {
        let output = command(folder, &[&["--quiet"], arguments].concat())
            .output()
            .unwrap();
        assert!(output.status.success(), "{arguments:?}: {output:?}");
    };
    for (log, seed, curve) in [
        ("log.csv", "3", "one.json"),
        ("second.csv", "4", "other.json"),
    ] {
        let simulated = [
            "simulate",
            "mems",
            "--duration",
            "30s",
            "--seed",
            seed,
            "--scale",
            "0.001",
        ];
        run(&[&simulated[..], &["-o", log]].concat());
        run(&["measure", log, "-o", curve]);
    }
    let mut faults = 0;
    for (arguments, name) in COMMANDS {
        run(arguments);
        let place = folder.join(name);
        let new = fs::read(&place).unwrap();
        let mut expected = names(folder);
        expected.insert("trace".into());
        for (call, fault) in CALLS
            .iter()
            .flat_map(|call| FAULTS.map(|fault| (*call, fault)))
        {
            for number in 1.. {
                fs::write(&place, "old").unwrap();
                let Some(output) = faulty(folder, arguments, call, fault, number) else {
                    break;
                };
                let here = format!("{arguments:?}: {call} {number} {fault}");
                let errors = String::from_utf8_lossy(&output.stderr).into_owned();
                // The system could not start the program.
                if errors.contains("shared libraries") {
                    continue;
                }
                faults += 1;
                let left = fs::read(&place).unwrap_or_default();
                assert!(
                    left == b"old" || left == new,
                    "{here}: {} bytes",
                    left.len()
                );
                let beside = names(folder);
                for name in beside.difference(&expected) {
                    fs::remove_file(folder.join(name)).unwrap();
                }
                if fault.starts_with("signal") {
                    continue;
                }
                match output.status.code() {
                    Some(0) => assert!(left == new, "{here}"),
                    // Each input that cannot be read has its line.
                    Some(2) => assert!(
                        !errors.is_empty() && errors.lines().all(|line| line.contains("; ")),
                        "{here}: {errors}"
                    ),
                    other => panic!("{here}: {other:?}: {errors}"),
                }
                assert!(
                    beside.is_subset(&expected) || call == "unlink",
                    "{here}: {beside:?}"
                );
            }
        }
    }
    println!("{faults} faults");
    assert!(faults > 500, "{faults}");
}
