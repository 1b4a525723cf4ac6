//! Tests `watch`: whatever ends a live record, the curve contains what was received.

use allanite_host::{curve_file::CurveFile, live::Live, record::with_evidence};
use allanite_log::{Log, unit::Unit};
use program::{command, piped, refusal, rows, signal};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serialport::{SerialPort, TTYPort};
use std::{
    io::{Read, Write},
    path::Path,
    process::Child,
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst},
    },
    thread,
    time::{Duration, Instant},
};
use tempfile::TempDir;

const AXES: [&str; 2] = ["left", "right"];

/// A line that is sent: counts, or text that is not a count.
#[derive(Clone, Copy)]
pub(crate) enum Sent {
    Sample([i32; 2]),
    Garbled,
}

impl Sent {
    pub(crate) fn line(self) -> String {
        match self {
            Self::Sample([a, b]) => format!("{a},{b}\n"),
            Self::Garbled => "12,\u{1}x\n".into(),
        }
    }
}

pub(crate) fn lines(number: usize, seed: u64) -> Vec<Sent> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let line = |_| match random.random_range(0..1000) {
        0 => Sent::Garbled,
        _ => Sent::Sample([(); 2].map(|()| random.random_range(-30_000..30_000))),
    };
    (0..number).map(line).collect()
}

fn watch(folder: &Path, more: &[&str]) -> Child {
    let arguments = [
        "watch",
        "--rate",
        "100",
        "--scale",
        "0.01",
        "--axes",
        "left,right",
    ];
    piped(
        command(folder, &arguments)
            .args(["--output", "curve.json"])
            .args(more),
    )
}

/// Waits until the curve has been saved for the first time.
fn wait_for_curve(folder: &Path, child: &mut Child) {
    let begun = Instant::now();
    while !folder.join("curve.json").exists() {
        if let Some(status) = child.try_wait().unwrap() {
            let mut errors = String::new();
            child
                .stderr
                .take()
                .unwrap()
                .read_to_string(&mut errors)
                .unwrap();
            panic!("{status}: {errors}");
        }
        assert!(
            begun.elapsed() < Duration::from_secs(60),
            "no curve was saved in time"
        );
        thread::sleep(Duration::from_millis(1));
    }
}

fn saved(folder: &Path) -> CurveFile {
    CurveFile::read(&folder.join("curve.json")).unwrap()
}

/// The curves of the first lines that contain the given number of samples. They must agree to the
/// bit.
fn expected(sent: &[Sent], samples: u64, gaps: u64) -> CurveFile {
    let mut axes = Live::new(AXES.len());
    let mut rest = sent.iter();
    while axes.samples() < samples {
        match rest.next().expect("no more samples than were sent") {
            Sent::Sample(counts) => axes.push(&counts.each_ref().map(std::slice::from_ref)),
            Sent::Garbled => axes.gap(),
        }
    }
    if axes.gaps() < gaps {
        assert!(matches!(rest.next(), Some(Sent::Garbled)));
        axes.gap();
    }
    let curves = with_evidence(&Log {
        rate_hz: 100.0,
        unit: Unit::DegreesPerSecond,
        has_scale: true,
        axes: axes.axes(&AXES.map(String::from), 0.01),
        notes: Vec::new(),
    });
    let curves = curves.unwrap().into_iter();
    CurveFile::new(curves.map(|(curve, _)| curve).collect())
}

/// Asserts that the saved curve is that of a prefix of what was sent, and returns the number of
/// samples in the prefix.
pub(crate) fn check_prefix(file: &Path, sent: &[Sent]) -> u64 {
    let curves = CurveFile::read(file).unwrap();
    let (samples, gaps) = (curves.axes[0].samples, curves.axes[0].gaps);
    assert_eq!(curves, expected(sent, samples, gaps));
    samples
}

/// Sends lines in pieces of any length until the reader is gone. Counts the samples that were
/// flushed.
fn send(
    mut pipe: impl Write + Send + 'static,
    sent: Vec<Sent>,
    seed: u64,
) -> (Arc<AtomicUsize>, thread::JoinHandle<()>) {
    let flushed = Arc::new(AtomicUsize::new(0));
    let counter = flushed.clone();
    let sender = thread::spawn(move || {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut rest = &sent[..];
        while !rest.is_empty() {
            let (piece, behind) = rest.split_at(random.random_range(1..200).min(rest.len()));
            let text: String = piece.iter().map(|line| line.line()).collect();
            // A piece may end in the middle of a line.
            let (start, end) = text.as_bytes().split_at(random.random_range(0..text.len()));
            let written = pipe.write_all(start).and_then(|()| pipe.flush());
            thread::sleep(Duration::from_millis(random.random_range(0..4)));
            let written = written
                .and_then(|()| pipe.write_all(end))
                .and_then(|()| pipe.flush());
            if written.is_err() {
                return;
            }
            let samples = piece
                .iter()
                .filter(|line| matches!(line, Sent::Sample(_)))
                .count();
            counter.fetch_add(samples, SeqCst);
            rest = behind;
        }
    });
    (flushed, sender)
}

#[test]
fn interrupted_record_is_a_prefix_with_all_samples_flushed_before() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(11);
    for (seed, name) in [(1, "INT"), (2, "TERM"), (3, "INT"), (4, "INT")] {
        let folder = TempDir::new().unwrap();
        let sent = lines(2_000_000, seed);
        let mut child = watch(folder.path(), &["--print-every", "0.05"]);
        let (flushed, sender) = send(child.stdin.take().unwrap(), sent.clone(), seed);
        while flushed.load(SeqCst) < 5000 {
            thread::sleep(Duration::from_millis(1));
        }
        thread::sleep(Duration::from_micros(random.random_range(0..300_000)));
        let well_before = flushed.load(SeqCst) as u64;
        thread::sleep(Duration::from_millis(500));
        signal(&child, name);
        let ended = child.wait_with_output().unwrap();
        assert_eq!(
            ended.status.code(),
            Some(0),
            "{}",
            String::from_utf8_lossy(&ended.stderr)
        );
        sender.join().unwrap();
        let samples = check_prefix(&folder.path().join("curve.json"), &sent);
        assert!(samples >= well_before, "{samples} of {well_before}");
        let printed = String::from_utf8(ended.stdout).unwrap();
        assert!(
            printed.contains(&format!("left: {samples} samples at 100 Hz")),
            "{printed}"
        );
        assert!(
            printed
                .lines()
                .filter(|line| line.contains("; right: "))
                .count()
                >= 2
        );
    }
}

#[test]
fn input_that_ends_is_saved_to_its_last_line_even_without_a_line_end() {
    let folder = TempDir::new().unwrap();
    let sent = lines(5000, 7);
    let mut child = watch(folder.path(), &[]);
    let mut pipe = child.stdin.take().unwrap();
    for line in &sent {
        pipe.write_all(line.line().as_bytes()).unwrap();
    }
    pipe.write_all(Sent::Sample([1, 2]).line().trim_end().as_bytes())
        .unwrap();
    drop(pipe);
    let sent = [sent, vec![Sent::Sample([1, 2])]].concat();
    let ended = child.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(0));
    let samples = sent
        .iter()
        .filter(|line| matches!(line, Sent::Sample(_)))
        .count();
    assert_eq!(
        check_prefix(&folder.path().join("curve.json"), &sent),
        samples as u64
    );
    let garbled = sent.len() - samples;
    let errors = String::from_utf8(ended.stderr).unwrap();
    assert!(garbled > 0 && errors.starts_with(&format!("allanite: invalid lines: {garbled}, ")));
    assert!(errors.contains("the last line has no line end"), "{errors}");
}

#[test]
fn fit_is_printed_and_failed_saves_are_announced_if_the_curve_cannot_be_saved() {
    let folder = TempDir::new().unwrap();
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).unwrap();
    let more = ["--save-every", "0.05", "--output", "../inner/curve.json"];
    let arguments = ["watch", "--rate", "100", "--scale", "0.01"];
    let mut command = command(&inner, &[&arguments[..], &more].concat());
    let mut child = piped(command.env("TMPDIR", folder.path()));
    let mut pipe = child.stdin.take().unwrap();
    for line in lines(3000, 11) {
        pipe.write_all(line.line().as_bytes()).unwrap();
    }
    wait_for_curve(&inner, &mut child);
    std::fs::remove_dir_all(&inner).unwrap();
    thread::sleep(Duration::from_millis(500));
    drop(pipe);
    let ended = child.wait_with_output().unwrap();
    let [printed, errors] =
        [ended.stdout, ended.stderr].map(|text| String::from_utf8(text).unwrap());
    assert_eq!(ended.status.code(), Some(2), "{errors}");
    assert!(
        errors.contains("not saved: ") && errors.contains("its folder does not exist"),
        "{errors}"
    );
    assert!(printed.contains("samples at 100 Hz"), "{printed}");
}

#[test]
fn constant_input_ends_with_a_word() {
    let folder = TempDir::new().unwrap();
    let mut child = watch(folder.path(), &[]);
    let mut pipe = child.stdin.take().unwrap();
    pipe.write_all("5,5\n".repeat(500).as_bytes()).unwrap();
    drop(pipe);
    let ended = child.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(2));
    let errors = String::from_utf8(ended.stderr).unwrap();
    assert!(
        errors.contains("axis left: its values never change"),
        "{errors}"
    );
}

#[test]
fn curve_is_saved_regularly_and_complete_at_every_moment() {
    let folder = TempDir::new().unwrap();
    let sent = lines(2_000_000, 5);
    let mut child = watch(folder.path(), &["--save-every", "0.05"]);
    let (_, sender) = send(child.stdin.take().unwrap(), sent.clone(), 5);
    wait_for_curve(folder.path(), &mut child);
    let mut last = 0;
    for _ in 0..40 {
        let samples = check_prefix(&folder.path().join("curve.json"), &sent);
        assert!(samples >= last);
        last = samples;
        thread::sleep(Duration::from_millis(7));
    }
    // Even a kill loses only what came since the last save.
    child.kill().unwrap();
    child.wait().unwrap();
    sender.join().unwrap();
    assert!(check_prefix(&folder.path().join("curve.json"), &sent) >= last);
}

#[test]
fn serial_port_is_read_from_the_first_whole_line() {
    let folder = TempDir::new().unwrap();
    let (mut device, port) = TTYPort::pair().unwrap();
    let name = port.name().unwrap();
    // A port can have only one owner.
    drop(port);
    let sent: Vec<Sent> = lines(100_000, 9)
        .into_iter()
        .filter(|line| matches!(line, Sent::Sample(_)))
        .collect();
    let mut child = watch(folder.path(), &["--port", &name, "--save-every", "0.05"]);
    let ended = Arc::new(AtomicBool::new(false));
    let (flag, counts) = (ended.clone(), sent.clone());
    let sender = thread::spawn(move || {
        let mut sent = counts.iter();
        while let (false, Some(line)) = (flag.load(SeqCst), sent.next()) {
            if device.write_all(line.line().as_bytes()).is_err() {
                thread::sleep(Duration::from_millis(5));
            }
            thread::sleep(Duration::from_micros(200));
        }
        device
    });
    wait_for_curve(folder.path(), &mut child);
    thread::sleep(Duration::from_millis(300));
    signal(&child, "INT");
    let output = child.wait_with_output().unwrap();
    ended.store(true, SeqCst);
    sender.join().unwrap();
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let curves = saved(folder.path());
    let (samples, gaps) = (curves.axes[0].samples, curves.axes[0].gaps);
    assert!(samples > 20 && gaps == 0, "{samples} {gaps}");
    // The record begins at the line during which the port was opened or a later one.
    let start = (0..sent.len() - samples as usize)
        .find(|&start| curves == expected(&sent[start..], samples, gaps));
    assert!(start.is_some());
}

#[test]
fn impossible_options_are_refused_before_anything_is_read() {
    let folder = TempDir::new().unwrap();
    for (more, expected) in rows! {
        &["--rate", "0"][..], "--rate 0 is impossible; ";
        &["--rate", "9", "--scale", "nan"], "--scale NaN is impossible; ";
        &["--rate", "9", "--axes", "a,a"], "--axes: a name is empty or repeated; ";
        &["--rate", "9", "--save-every", "0"], "--save-every 0 is impossible; ";
        &["--rate", "9", "--output", "a.csv"], "a.csv: a curve file must end in .json; ";
        &["--rate", "9", "--output", "no/a.json"], "no/a.json: its folder does not exist; ";
        &["--rate", "9", "--port", "/dev/none"], "--port /dev/none: ";
    } {
        let line = refusal(folder.path(), &[&["watch"], more].concat());
        assert!(line.starts_with(expected), "{line}\nis not\n{expected}");
    }
}
