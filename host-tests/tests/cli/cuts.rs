//! Parts of a log that are left out with `--from`, `--to` and `--drop`, and messages that tell which.

use allanite::diagnosis::Verdict;
use program::{json, output, refusal, rows, run};
use serde_json::Value;
use std::{fmt::Write as _, fs, path::Path};
use tempfile::TempDir;

const SAMPLES: usize = 30_000;

/// White noise of three axes at 100 Hz, changed by `change(index, time, rates)`, with stamps that begin at 1000 s and
/// without the samples that `is_lost` names.
fn log(folder: &Path, change: impl Fn(usize, f64, &mut [f64; 3]), is_lost: impl Fn(usize) -> bool) {
    let mut state = 7_u64;
    let mut uniform = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 33) as f64 / (1_u64 << 31) as f64 - 0.5
    };
    let mut text = String::from("time [s],gx [deg/s],gy [deg/s],gz [deg/s]\n");
    for n in 0..SAMPLES {
        let mut rates = [(); 3].map(|()| 0.05 * (0..12).map(|_| uniform()).sum::<f64>());
        change(n, n as f64 / 100.0, &mut rates);
        if !is_lost(n) {
            let [x, y, z] = rates;
            let _ = writeln!(
                text,
                "{:.2},{x:.6},{y:.6},{z:.6}",
                1000.0 + n as f64 / 100.0
            );
        }
    }
    fs::write(folder.join("log.csv"), text).unwrap();
}

/// A blow at this time, which rings in all axes for about a second.
fn knock(at_s: f64) -> impl Fn(usize, f64, &mut [f64; 3]) {
    move |_, time_s, rates| {
        let after_s = time_s - at_s;
        if (0.0..4.0).contains(&after_s) {
            let ringing = (-after_s / 0.25).exp() * (37.0 * after_s).sin();
            for (rate, size) in rates.iter_mut().zip([30.0, 10.0, 0.0]) {
                *rate += size * ringing;
            }
        }
    }
}

fn notes(document: &Value, axis: usize) -> String {
    document["axes"][axis]["notes"].to_string()
}

/// The options that a message offers.
fn offered(text: &str) -> Vec<String> {
    let options = text.split(", or add ").nth(1).expect("an offer");
    let options = options.split(" (").next().unwrap();
    options.split(' ').map(str::to_owned).collect()
}

fn with<'a>(command: &[&'a str], options: &'a [String]) -> Vec<&'a str> {
    command
        .iter()
        .copied()
        .chain(options.iter().map(String::as_str))
        .collect()
}

#[test]
fn a_knock_a_pick_up_and_a_spike_are_told_with_the_options_that_leave_them_out() {
    let folder = TempDir::new().unwrap();
    let pick_up = |n: usize, time_s: f64, rates: &mut [f64; 3]| {
        let angle = if n < 600 {
            time_s * 9.0
        } else if n > 29_300 {
            time_s * 5.0
        } else {
            return;
        };
        rates[1] += 20.0 * angle.sin();
    };
    let spike =
        |n: usize, _: f64, rates: &mut [f64; 3]| rates[0] += if n == 12_345 { 40.0 } else { 0.0 };
    type Change<'a> = &'a dyn Fn(usize, f64, &mut [f64; 3]);
    let cases: [(Change<'_>, &[&str]); 3] = [
        (&knock(111.2), &["a knock at 111.", "--drop 11"]),
        (
            &pick_up,
            &[
                "motion until 6.",
                "--from ",
                "motion from 293.",
                "to the end",
                "--to -",
            ],
        ),
        (&spike, &["a spike at 123.", "--drop 123"]),
    ];
    for (change, expected) in cases {
        log(folder.path(), change, |n| (700..720).contains(&n));
        let document = json(folder.path(), &["fit", "log.csv"]);
        let told = notes(&document, 0);
        assert!(expected.iter().all(|words| told.contains(words)), "{told}");
        let options = offered(&told);
        // Every command says the same, and with the options that it offers, no axis is disturbed.
        for command in ["diagnose", "measure"] {
            let arguments = [
                &[command, "log.csv"][..],
                match command {
                    "measure" => &["--output", "curve.json"],
                    _ => &[],
                },
            ];
            let run = run(folder.path(), &arguments.concat());
            let said = [run.stdout, run.stderr].concat();
            assert!(
                String::from_utf8_lossy(&said).contains(&options.join(" ")),
                "{command}"
            );
        }
        output(
            folder.path(),
            &["report", "log.csv", "--output", "page.html"],
        );
        let page = fs::read_to_string(folder.path().join("page.html")).unwrap();
        assert!(page.contains(&options.join(" ")));
        let document = json(folder.path(), &with(&["fit", "log.csv"], &options));
        for axis in 0..3 {
            assert!(!notes(&document, axis).contains("not valid"));
            assert!(
                !notes(&document, axis).contains("or add"),
                "{}",
                notes(&document, axis)
            );
        }
        let diagnosed = json(folder.path(), &with(&["diagnose", "log.csv"], &options));
        assert_eq!(
            diagnosed["axes"][0]["verdict"],
            Verdict::Adequate.name(),
            "{options:?}"
        );
    }
}

#[test]
fn times_are_those_of_the_log_whatever_is_left_out_or_missing() {
    let folder = TempDir::new().unwrap();
    // Ten seconds are lost before the knock.
    log(folder.path(), knock(211.2), |n| (5000..6000).contains(&n));
    for options in [
        &[][..],
        &["--from", "40s"],
        &["--drop", "60s..100s", "--to", "-10s"],
    ] {
        let arguments = [&["fit", "log.csv"], options].concat();
        let told = notes(&json(folder.path(), &arguments), 0);
        assert!(
            told.contains("(a knock at 211.") && told.contains("first at 211."),
            "{told}"
        );
    }
}

#[test]
fn what_is_left_out_is_what_the_options_say() {
    let folder = TempDir::new().unwrap();
    log(folder.path(), |_, _, _| {}, |_| false);
    let text = fs::read_to_string(folder.path().join("log.csv")).unwrap();
    let rate = "# rate_hz=100\ngx [deg/s],gy [deg/s],gz [deg/s]\n".to_owned();
    let rows = text
        .lines()
        .skip(1)
        .map(|row| row.split_once(',').unwrap().1);
    fs::write(
        folder.path().join("rate.csv"),
        rate + &rows.collect::<Vec<_>>().join("\n") + "\n",
    )
    .unwrap();
    let samples = |log: &str, options: &[&str]| {
        let arguments = [&["fit", log], options].concat();
        let told = output(folder.path(), &arguments);
        let samples = told
            .split(": ")
            .nth(1)
            .and_then(|rest| rest.split(' ').next());
        samples.unwrap().parse::<u64>().unwrap()
    };
    for log in ["log.csv", "rate.csv"] {
        for (options, left) in [
            (&["--from", "10s"][..], 29_000),
            (&["--to", "1min"], 6000),
            (&["--to", "-12s"], 28_799),
            (&["--from", "-2min", "--to", "-1min"], 6000),
            (
                &["--drop", "11s..13s", "--drop", "12s..14s", "--from=1000ms"],
                29_600,
            ),
            (&["--drop", "-10s..-5s"], 29_500),
        ] {
            assert_eq!(samples(log, options), left, "{log} {options:?}");
        }
    }
    let note = run(folder.path(), &["fit", "log.csv", "--drop", "11s..13s"]);
    let note = String::from_utf8_lossy(&note.stderr).into_owned();
    assert!(
        note.contains("200 rows left out, 2 s of 299.99 s"),
        "{note}"
    );
}

#[test]
fn cuts_that_make_no_sense_are_refused_in_a_line() {
    let folder = TempDir::new().unwrap();
    log(folder.path(), |_, _, _| {}, |_| false);
    output(
        folder.path(),
        &["measure", "log.csv", "--output", "curve.json"],
    );
    for (options, expected) in rows! {
        &["log.csv", "--drop", "900s..950s"][..], "lies behind the end of the log";
        &["log.csv", "--from", "900s"], "all rows are left out";
        &["log.csv", "--to", "-900s"], "leaves nothing";
        &["log.csv", "--from", "20s", "--to", "10s"], "--to 10s is not behind --from 20s";
        &["log.csv", "--from", "10"], "write a time with its unit";
        &["log.csv", "--drop", "10s"], "write FROM..TO";
        &["curve.json", "--from", "10s"], "drop the options about logs";
        &["curve.json", "--drop", "1s..2s"], "drop the options about logs";
    } {
        let refused = refusal(folder.path(), &[&["fit"], options].concat());
        assert!(refused.contains(expected), "{options:?}: {refused}");
    }
}
