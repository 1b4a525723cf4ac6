//! Every call of the system that `watch` makes may fail, and it may be killed at any of them: what was received more than a second
//! before is in its record.

use super::injected::{CALLS, FAULTS, traced, was_injected};
use crate::watch::{Sent, check_prefix, lines};
use std::{
    fs,
    io::Write,
    path::{Path, PathBuf},
    process::{Output, Stdio},
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering::Relaxed},
    },
    thread,
    time::{Duration, Instant},
};
use tempfile::TempDir;

/// What was received so long before the end is in the record.
const LONGEST_LOSS: Duration = Duration::from_secs(1);

/// The time that the program has to start, before the first line comes.
const START: Duration = Duration::from_millis(400);

/// The time from one piece of ten lines to the next.
const PIECE: Duration = Duration::from_millis(40);

/// The programs that run at once. They wait most of the time.
const AT_ONCE: usize = 4;

/// A run that a fault came into.
struct Faulty {
    output: Output,
    /// The number of samples that were sent until more than a second before the program ended.
    well_before: u64,
    all: u64,
}

/// Watches what is sent, and injects a fault into the call of this number; `None` if it makes fewer such calls.
fn faulty(folder: &Path, sent: &[Sent], call: &str, fault: &str, number: usize) -> Option<Faulty> {
    fs::create_dir_all(folder.join("out")).unwrap();
    fs::create_dir_all(folder.join("tmp")).unwrap();
    let mut command = traced(folder, call, fault, number);
    command.arg(program::path()).args([
        "watch",
        "--rate",
        "100",
        "--scale",
        "0.01",
        "--axes",
        "left,right",
    ]);
    command
        .args(["--output", "out/curve.json", "--print-every", "0.5"])
        .env("TMPDIR", folder.join("tmp"));
    let piped = [Stdio::piped(), Stdio::piped(), Stdio::piped()];
    let [input, output, errors] = piped;
    let mut child = command
        .stdin(input)
        .stdout(output)
        .stderr(errors)
        .spawn()
        .unwrap();
    let mut pipe = child.stdin.take().unwrap();
    let mut noted = Vec::new();
    let mut all = 0;
    thread::sleep(START);
    for piece in sent.chunks(10) {
        let text: String = piece.iter().map(|line| line.line()).collect();
        if child.try_wait().unwrap().is_some() || pipe.write_all(text.as_bytes()).is_err() {
            break;
        }
        all += piece
            .iter()
            .filter(|line| matches!(line, Sent::Sample(_)))
            .count() as u64;
        noted.push((Instant::now(), all));
        thread::sleep(PIECE);
    }
    drop(pipe);
    let output = child.wait_with_output().unwrap();
    let ended = Instant::now();
    let before = noted
        .iter()
        .rev()
        .find(|(when, _)| *when + LONGEST_LOSS < ended);
    was_injected(folder).then_some(Faulty {
        output,
        well_before: before.map_or(0, |(_, samples)| *samples),
        all,
    })
}

/// The record, in the folder that was asked for or in the second one.
fn record(folder: &Path) -> Option<PathBuf> {
    let of = |name: &str| {
        let entries = fs::read_dir(folder.join(name)).ok()?;
        let mut files = entries.flatten().map(|entry| entry.path());
        files.find(|file| {
            file.extension()
                .is_some_and(|extension| extension == "json")
        })
    };
    of("out").or_else(|| of("tmp"))
}

/// What is wrong with what a fault left.
fn wrong(folder: &Path, sent: &[Sent], run: &Faulty, fault: &str) -> Option<String> {
    let errors = String::from_utf8_lossy(&run.output.stderr);
    if errors.contains("shared libraries") {
        return None;
    }
    let samples = record(folder).map_or(0, |record| check_prefix(&record, sent));
    if samples < run.well_before {
        return Some(format!(
            "{samples} of {} samples: {errors}",
            run.well_before
        ));
    }
    if fault.starts_with("signal") {
        return None;
    }
    match run.output.status.code() {
        Some(0) if samples == run.all => None,
        Some(2) if !errors.is_empty() && errors.lines().all(|line| line.contains("; ")) => None,
        code => Some(format!(
            "{code:?}, {samples} of {} samples: {errors}",
            run.all
        )),
    }
}

#[test]
fn no_failing_call_of_watch_loses_a_record() {
    let sent = lines(450, 5);
    let kinds: Vec<(&str, &str)> = CALLS
        .iter()
        .flat_map(|call| FAULTS.map(|fault| (*call, fault)))
        .collect();
    let (next, faults, found) = (
        AtomicUsize::new(0),
        AtomicUsize::new(0),
        Mutex::new(Vec::new()),
    );
    let work = || {
        while let Some((call, fault)) = kinds.get(next.fetch_add(1, Relaxed)) {
            for number in 1.. {
                let folder = TempDir::new().unwrap();
                let Some(run) = faulty(folder.path(), &sent, call, fault, number) else {
                    break;
                };
                faults.fetch_add(1, Relaxed);
                if let Some(what) = wrong(folder.path(), &sent, &run, fault) {
                    found
                        .lock()
                        .unwrap()
                        .push(format!("{call} {number} {fault}: {what}"));
                }
            }
        }
    };
    thread::scope(|scope| {
        for _ in 0..AT_ONCE {
            scope.spawn(work);
        }
    });
    let (faults, found) = (faults.into_inner(), found.into_inner().unwrap());
    println!("{faults} faults");
    // A piece of ten lines is one call that reads, and there are three faults for each call.
    assert!(faults > 200, "{faults}");
    assert!(
        found.is_empty(),
        "{} of {faults}:\n{}",
        found.len(),
        found.join("\n")
    );
}
