//! One record gets one verdict, whichever way it is judged: by the part of the crate that a device runs, by `fit`, by
//! `diagnose`, through a curve file, as a certificate, in a lot, on a page, and as an export. The records come from a simulator
//! of its own.

use allanite::{
    Axes, Scale,
    axis::{Courses, Moments},
};
use program::{json, output, run};
use rand::{RngExt as _, SeedableRng as _};
use rand_distr::{Distribution as _, StandardNormal, StudentT};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde_json::Value;
use std::{collections::BTreeMap, f64::consts::TAU, fmt::Write as _, fs, path::Path};
use tempfile::TempDir;

const RATE_HZ: f64 = 100.0;
const UNIT: f64 = 0.01;

/// The noise of a gyro at rest, in counts.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Noise {
    White,
    WithWalk,
    HeavyTails,
    LowPass,
    WithLine,
    /// Pulses of an angle since the last sample.
    Pulses,
}

const NOISES: [Noise; 6] = [
    Noise::White,
    Noise::WithWalk,
    Noise::HeavyTails,
    Noise::LowPass,
    Noise::WithLine,
    Noise::Pulses,
];

/// What happens to a record.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
enum Event {
    Nothing,
    Swing,
    HandHeld,
    Vehicle,
    Knock,
    Range(f64),
    Polled(f64),
    Stale(usize),
    Unanswered(i32),
    Unsigned,
    Stuck,
}

const EVENTS: [Event; 15] = [
    Event::Swing,
    Event::HandHeld,
    Event::Vehicle,
    Event::Knock,
    Event::Range(0.125),
    Event::Range(0.5),
    Event::Range(4.0),
    Event::Polled(1.04),
    Event::Polled(2.0),
    Event::Stale(16),
    Event::Stale(64),
    Event::Unanswered(0),
    Event::Unanswered(-1),
    Event::Unsigned,
    Event::Stuck,
];

type Rows = Vec<[i32; 3]>;

/// Axes of this noise, with the size of the noise in counts.
fn at_rest(noise: Noise, samples: usize, random: &mut Xoshiro256PlusPlus) -> ([Vec<f64>; 3], f64) {
    let size = 2.0 * 8_f64.powf(random.random_range(0.0..1.0));
    let line: f64 = random.random_range(5.0..40.0);
    let axes = [(); 3].map(|()| {
        let offset = f64::from(random.random_range(-60..60));
        let own = size * random.random_range(0.7..1.4);
        let pole: f64 = random.random_range(0.3..0.8);
        let turn = random.random_range(0.1..0.9);
        let (mut walk, mut state, mut angle) = (0.0, 0.0, 0.0_f64);
        let tails = StudentT::new(5.0).unwrap();
        let one = |n: usize| {
            let white: f64 = StandardNormal.sample(random);
            match noise {
                Noise::White => own * white,
                Noise::WithWalk => {
                    let step: f64 = StandardNormal.sample(random);
                    walk += 0.01 * own * step;
                    own * white + walk
                }
                Noise::HeavyTails => 0.77 * own * tails.sample(random),
                Noise::LowPass => {
                    state = pole * state + (1.0 - pole * pole).sqrt() * white;
                    own * state
                }
                Noise::WithLine => own * (white + 0.5 * (TAU * line * n as f64 / RATE_HZ).sin()),
                Noise::Pulses => {
                    let before = angle.floor();
                    angle += turn + 0.3 * white;
                    angle.floor() - before
                }
            }
        };
        (0..samples).map(one).map(|value| value + offset).collect()
    });
    (axes, size)
}

/// A record in which something happens.
fn record(noise: Noise, event: Event, samples: usize, random: &mut Xoshiro256PlusPlus) -> Rows {
    let (mut axes, size) = at_rest(noise, samples, random);
    let at = random.random_range(0.2..0.8) * samples as f64;
    let phases = [(); 3].map(|()| random.random_range(0.0..TAU));
    let large = 30.0 * size;
    let slow: Vec<[f64; 3]> = {
        // Motion of a hand and of a vehicle: noise with a memory of a second, and of a tenth.
        let memory = if event == Event::Vehicle { 10.0 } else { 100.0 };
        let keep = (-1.0_f64 / memory).exp();
        let mut state = [0.0; 3];
        let step = |_| {
            state = state.map(|value| {
                let white: f64 = StandardNormal.sample(random);
                keep * value + (1.0 - keep * keep).sqrt() * white
            });
            state
        };
        (0..samples).map(step).collect()
    };
    for (axis, values) in axes.iter_mut().enumerate() {
        for (n, value) in values.iter_mut().enumerate() {
            let time_s = n as f64 / RATE_HZ;
            match event {
                Event::Swing => *value += large * (TAU * 0.4 * time_s + phases[axis]).sin(),
                Event::HandHeld | Event::Vehicle => *value += large * slow[n][axis],
                Event::Knock if (0.0..200.0).contains(&(n as f64 - at)) => {
                    *value += 100.0 * large * (-(n as f64 - at) / 40.0).exp();
                }
                Event::Range(factor) if n as f64 > at => *value *= factor,
                _ => {}
            }
        }
    }
    let mut rows: Rows = (0..samples)
        .map(|n| axes.each_ref().map(|axis| axis[n].round() as i32))
        .collect();
    let fresh = rows.clone();
    match event {
        Event::Polled(factor) => {
            for (n, row) in rows.iter_mut().enumerate() {
                *row = fresh[(n as f64 / factor) as usize];
            }
        }
        Event::Stale(length) => {
            for block in 2..samples / length {
                if random.random_range(0..15) == 0 {
                    let (from, to) = ((block - 2) * length, block * length);
                    rows[to..to + length].copy_from_slice(&fresh[from..from + length]);
                }
            }
        }
        Event::Unanswered(value) => {
            for row in &mut rows {
                if random.random_range(0..150) == 0 {
                    *row = [value; 3];
                }
            }
        }
        // Counts about zero.
        Event::Unsigned => {
            for row in &mut rows {
                *row = row.map(|count| (count - count.signum() * 60) & 0xffff);
            }
        }
        Event::Stuck => {
            let until = samples.min(at as usize + samples / 8);
            rows[at as usize..until].fill(fresh[at as usize]);
        }
        _ => {}
    }
    rows
}

/// Why the record is not valid, by what a device keeps of it without a gate.
fn on_device(rows: &Rows) -> String {
    let mut axes = Axes::<20, 0, (), Moments, 3, (), Courses>::new();
    rows.iter().for_each(|&row| axes.push(row));
    let scale = Scale::new(UNIT as _, RATE_HZ as _).unwrap();
    let reasons = [0, 1, 2].map(|axis| axes.record(axis, scale).unwrap().invalid);
    // The first axis in which something is wrong.
    let reason = reasons.into_iter().flatten().next();
    reason.map_or("-", |reason| reason.name()).into()
}

/// The arguments of a command about the log, with more of them behind.
fn about<'a>(command: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let options = [
        "--rate=100",
        "--scale=0.01",
        "--unit=deg/s",
        "--repeats=keep",
    ];
    [&[command, "log.csv"], &options[..], more].concat()
}

/// The first reason among the axes of a document.
fn first_reason(axes: &Value) -> String {
    let mut axes = axes.as_array().unwrap().iter();
    let reason = axes.find_map(|axis| axis["reason"].as_str());
    reason.unwrap_or("-").into()
}

/// Why the record is not valid, by each command of the program that says so.
fn by_commands(folder: &Path) -> Vec<(&'static str, String)> {
    let axes_of = |arguments: &[&str]| first_reason(&json(folder, arguments)["axes"]);
    output(folder, &about("measure", &["--output=curve.json", "-q"]));
    let written = ["--output=device.bin", "--device=one", "-q"];
    output(folder, &about("certify", &written));
    let decoded = json(folder, &["decode", "device.bin"]);
    output(folder, &about("report", &["--output=page.html", "-q"]));
    let page = fs::read_to_string(folder.join("page.html")).unwrap();
    let on_page = page.split_once("\"reason\":\"").map(|(_, rest)| rest);
    let on_page = on_page.and_then(|rest| rest.split('"').next());
    vec![
        ("fit", axes_of(&about("fit", &[]))),
        ("diagnose", axes_of(&about("diagnose", &[]))),
        ("curve file", axes_of(&["fit", "curve.json"])),
        ("certificate", first_reason(&decoded["records"][0]["axes"])),
        (
            "lot",
            first_reason(&json(folder, &about("lot", &["--limit=N=1"]))["invalid"]),
        ),
        (
            "lot of certificates",
            first_reason(&json(folder, &["lot", "device.bin", "--limit=N=1"])["invalid"]),
        ),
        ("page", on_page.unwrap_or("-").into()),
    ]
}

/// Whether the noise of a record is exported for a filter, and whether it should be: no axis is one of a mixture.
fn is_exported(folder: &Path) -> (bool, bool) {
    let output = run(folder, &about("export", &["--format=csv"]));
    let document = json(folder, &about("fit", &[]));
    let mut axes = document["axes"].as_array().unwrap().iter();
    let is_steady =
        axes.all(|axis| axis["reason"].is_null() && axis["verdict"] != "not_stationary");
    (output.status.success(), is_steady)
}

/// What each door says of a record.
fn verdicts(folder: &Path, rows: &Rows) -> Vec<(&'static str, String)> {
    let mut text = String::from("gx,gy,gz\n");
    for [x, y, z] in rows {
        writeln!(text, "{x},{y},{z}").unwrap();
    }
    fs::write(folder.join("log.csv"), text).unwrap();
    let mut all = vec![("device", on_device(rows))];
    all.extend(by_commands(folder));
    all
}

/// What was counted of some records.
#[derive(Debug, Default)]
pub(crate) struct Count {
    pub(crate) records: usize,
    /// Records of which the doors say different things, and what.
    pub(crate) unequal: Vec<String>,
    /// Records in which an event is not seen, and sound ones in which one is.
    pub(crate) wrong: Vec<String>,
    /// Records that are called invalid, of each event.
    pub(crate) found: BTreeMap<String, [usize; 2]>,
}

impl Count {
    /// Judges so many records of each event, and as many sound ones of each noise.
    pub(crate) fn of(each: usize, seed: u64, samples: std::ops::Range<usize>) -> Self {
        let folder = TempDir::new().unwrap();
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut count = Self::default();
        for number in 0..each {
            let disturbed = EVENTS.iter().enumerate().map(|(place, &event)| {
                // Pulses hide what is done to single samples.
                (NOISES[(place + number) % (NOISES.len() - 1)], event)
            });
            let sound = NOISES.map(|noise| (noise, Event::Nothing));
            for (noise, event) in disturbed.chain(sound) {
                let samples = random.random_range(samples.clone());
                let rows = record(noise, event, samples, &mut random);
                let all = verdicts(folder.path(), &rows);
                let fit = all[1].1.as_str();
                count.records += 1;
                let what = format!("{event:?} in {noise:?}, {samples} samples");
                let (is_exported, is_steady) = is_exported(folder.path());
                if all.iter().any(|(_, said)| said != fit) || is_exported != is_steady {
                    let unequal = format!("{what}: {all:?}, exported {is_exported}");
                    count.unequal.push(unequal);
                }
                if (fit == "-") != (event == Event::Nothing) {
                    count.wrong.push(format!("{what}: {fit}"));
                }
                let [found, all] = count.found.entry(format!("{event:?}")).or_default();
                *found += usize::from(fit != "-");
                *all += 1;
            }
        }
        count
    }
}

#[test]
fn a_record_is_judged_alike_by_every_door() {
    let count = Count::of(1, 1, 6_000..30_000);
    assert_eq!(count.unequal, [""; 0], "{count:?}");
    // Motion of hands and vehicles has the shape of filtered noise: not all of it is recognised.
    let is_sure = |wrong: &&String| {
        !["HandHeld", "Vehicle"]
            .iter()
            .any(|one| wrong.starts_with(one))
    };
    let wrong: Vec<&String> = count.wrong.iter().filter(is_sure).collect();
    assert_eq!(wrong, [""; 0], "{count:?}");
}
