//! One record gets one verdict, whichever way it is judged: by the part of the crate that a device runs, by a product in C on this
//! host and on a Cortex-M in QEMU, by `fit`, by `diagnose`, through a curve file, while it is watched, as a certificate, in a lot, on a page, and as an
//! export.

mod device;
mod simulated;
mod truth;

pub(crate) use truth::Truth;

use device::Products;
use program::{command, json, output, run};
use rand::{RngExt as _, SeedableRng as _};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde_json::Value;
use simulated::{EVENTS, Event, NOISES, Rows, record};
use std::{collections::BTreeMap, fmt::Write as _, fs, fs::File, path::Path};
use tempfile::TempDir;

const RATE_HZ: f64 = 100.0;
const UNIT: f64 = 0.01;

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
    watch(folder);
    output(folder, &about("report", &["--output=page.html", "-q"]));
    let page = fs::read_to_string(folder.join("page.html")).unwrap();
    let on_page = page.split_once("\"reason\":\"").map(|(_, rest)| rest);
    let on_page = on_page.and_then(|rest| rest.split('"').next());
    vec![
        ("fit", axes_of(&about("fit", &[]))),
        ("diagnose", axes_of(&about("diagnose", &[]))),
        ("curve file", axes_of(&["fit", "curve.json"])),
        ("watch", axes_of(&["fit", "live.json"])),
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

/// Watches the rows of the log as they arrive.
fn watch(folder: &Path) {
    let text = fs::read_to_string(folder.join("log.csv")).unwrap();
    let (_, counts) = text.split_once('\n').unwrap();
    fs::write(folder.join("counts.txt"), counts).unwrap();
    let arguments = ["watch", "--rate=100", "--scale=0.01", "--output=live.json"];
    let mut command = command(folder, &arguments);
    let counts = File::open(folder.join("counts.txt")).unwrap();
    let watched = command.stdin(counts).output().unwrap();
    let said = String::from_utf8_lossy(&watched.stderr);
    assert!(watched.status.success(), "{said}");
}

/// Whether the noise of a record is exported for a filter, and whether it should be: each axis is valid, stationary and explained.
fn is_exported(folder: &Path) -> (bool, bool) {
    let output = run(folder, &about("export", &["--format=csv"]));
    let document = json(folder, &about("fit", &[]));
    let mut axes = document["axes"].as_array().unwrap().iter();
    let is_refused = |verdict: &str| ["not_stationary", "unexplained"].contains(&verdict);
    let is_explained = axes.all(|axis| {
        let verdict = axis["verdict"].as_str().unwrap();
        axis["reason"].is_null() && !is_refused(verdict)
    });
    (output.status.success(), is_explained)
}

/// What each door says of a record.
fn verdicts(folder: &Path, rows: &Rows) -> Vec<(&'static str, String)> {
    let mut text = String::from("gx,gy,gz\n");
    for [x, y, z] in rows {
        writeln!(text, "{x},{y},{z}").unwrap();
    }
    fs::write(folder.join("log.csv"), text).unwrap();
    let mut all = vec![("device", device::without_gate(rows).0)];
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
        let mut products = Products::build(folder.path());
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
                let (is_exported, is_explained) = is_exported(folder.path());
                if all.iter().any(|(_, said)| said != fit) || is_exported != is_explained {
                    let unequal = format!("{what}: {all:?}, exported {is_exported}");
                    count.unequal.push(unequal);
                }
                let gated = device::with_gate(&rows);
                let in_c = products.judge(folder.path(), &rows);
                if in_c.iter().any(|said| *said != gated) || !device::is_like(&gated, fit) {
                    let unequal = format!("{what}: {fit}, with a gate {gated:?}, in C {in_c:?}");
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
    // Slight motion of a vehicle has the shape of filtered noise: not all of it is recognised.
    let is_sure = |wrong: &&String| !wrong.starts_with("Vehicle");
    let wrong: Vec<&String> = count.wrong.iter().filter(is_sure).collect();
    assert_eq!(wrong, [""; 0], "{count:?}");
}

#[test]
fn a_device_distinguishes_rest_from_what_happens_to_it() {
    Truth::of(20, 1, 2_000..30_000).assert();
}

#[test]
fn a_small_core_sees_motion_stuck_values_and_repeats() {
    Truth::by_screens(20, 3, 2_000..30_000).assert_screened();
}
