//! Tests `merge`: curves of parts of a record are those of the whole, in any order.

use program::{output, refusal, rows};
use serde_json::Value;
use std::{fmt::Write as _, fs, path::Path};
use tempfile::TempDir;

/// The lengths of the parts. The last one is too short for the octaves of the others.
const PARTS: [usize; 4] = [20_000, 33_333, 8_192, 700];

/// The options that tell about a log of counts.
const ABOUT: [&str; 6] = ["--rate", "100", "--scale", "0.05", "--unit", "deg/s"];

/// Writes a log of each part, and one of all with a gap between the parts. The counts of both axes wander.
fn write_logs(folder: &Path) {
    let mut whole = String::from("gx,gy\n");
    let mut random = 1_u32;
    let mut noise = || {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (random >> 26) as i32
    };
    let mut drift = 0;
    for (i, &length) in PARTS.iter().enumerate() {
        let mut part = String::new();
        for _ in 0..length {
            drift += noise() % 3 - 1;
            writeln!(part, "{},{}", noise() + drift, noise() - 7).unwrap();
        }
        if i > 0 {
            whole += "# lost 500 samples\n";
        }
        whole += &part;
        fs::write(
            folder.join(format!("part{i}.csv")),
            format!("gx,gy\n{part}"),
        )
        .unwrap();
    }
    fs::write(folder.join("whole.csv"), whole).unwrap();
}

fn measure(folder: &Path, log: &str, curve: &str) {
    let files = ["measure", log, "--output", curve];
    output(folder, &[&files[..], &ABOUT].concat());
}

fn merge(folder: &Path, parts: &[&str], all: &str) -> String {
    output(folder, &[&["merge", "--output", all], parts].concat())
}

fn axes(folder: &Path, curve: &str) -> Vec<Value> {
    let text = fs::read_to_string(folder.join(curve)).unwrap();
    let document: Value = serde_json::from_str(&text).unwrap();
    document["axes"].as_array().unwrap().clone()
}

fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    write_logs(folder.path());
    for i in 0..PARTS.len() {
        measure(
            folder.path(),
            &format!("part{i}.csv"),
            &format!("part{i}.json"),
        );
    }
    folder
}

#[test]
fn parts_in_any_order_and_in_groups_give_the_curve_of_the_whole() {
    let folder = folder();
    let here = folder.path();
    measure(here, "whole.csv", "whole.json");
    let parts = ["part0.json", "part1.json", "part2.json", "part3.json"];
    let printed = merge(here, &parts, "all.json");
    assert!(
        printed.contains("gx: 62225 samples at 100 Hz, "),
        "{printed}"
    );
    let bytes = |name: &str| fs::read(here.join(name)).unwrap();
    merge(
        here,
        &["part2.json", "part0.json", "part3.json", "part1.json"],
        "other.json",
    );
    assert!(bytes("all.json") == bytes("other.json"), "another order");
    merge(here, &["part3.json", "part1.json"], "one.json");
    merge(here, &["part2.json", "part0.json"], "two.json");
    merge(here, &["one.json", "two.json"], "grouped.json");

    for name in ["all.json", "grouped.json"] {
        for (whole, merged) in axes(here, "whole.json").iter().zip(axes(here, name)) {
            for field in ["axis", "samples", "gaps", "octaves", "short"] {
                assert_eq!(merged[field], whole[field], "{name}, {field}");
            }
            // The levels of the whole record that a part is too short for are missing there.
            let levels = |axis: &Value| axis["spectrum"]["levels"].as_array().unwrap().clone();
            let (whole, merged) = (levels(whole), levels(&merged));
            assert!(merged.len() >= 2, "{name}");
            for (whole, merged) in whole.iter().zip(&merged) {
                let few = whole["segments"].as_u64().unwrap();
                let segments = merged["segments"].as_u64().unwrap();
                assert!(segments <= few && segments + 20 > few, "{few} {segments}");
                for field in ["density", "kurtosis"] {
                    let numbers = |level: &Value| level[field].as_array().unwrap().clone();
                    for (whole, merged) in numbers(whole).iter().zip(numbers(merged)) {
                        let (whole, merged) = (whole.as_f64().unwrap(), merged.as_f64().unwrap());
                        let most = if few == segments { 1e-5 } else { 0.6 };
                        assert!((merged - whole).abs() <= most * whole.max(0.1), "{field}");
                    }
                }
            }
        }
    }
    // What is merged is a curve file like any other.
    let fitted = output(here, &["fit", "all.json"]);
    assert!(fitted.contains("gx: 62225 samples"), "{fitted}");
}

#[test]
fn a_single_curve_stays_as_it_is() {
    let folder = folder();
    merge(folder.path(), &["part1.json"], "same.json");
    let [before, after] = ["part1.json", "same.json"].map(|name| axes(folder.path(), name));
    for (before, after) in before.iter().zip(&after) {
        for field in ["octaves", "short", "samples", "gaps"] {
            assert_eq!(before[field], after[field], "{field}");
        }
    }
}

#[test]
fn quanta_that_differ_by_a_power_of_two_are_merged_exactly() {
    let folder = folder();
    let here = folder.path();
    // The same counts, of a quantum that is four times as large.
    let text = fs::read_to_string(here.join("part0.csv")).unwrap();
    let coarse: String = text
        .lines()
        .map(|line| match line.split_once(',') {
            Some((x, y)) if x != "gx" => format!(
                "{},{}\n",
                4 * x.parse::<i32>().unwrap(),
                4 * y.parse::<i32>().unwrap()
            ),
            _ => format!("{line}\n"),
        })
        .collect();
    fs::write(here.join("fine.csv"), coarse).unwrap();
    let arguments = [
        "measure",
        "fine.csv",
        "--output",
        "fine.json",
        "--rate",
        "100",
    ];
    output(
        here,
        &[&arguments[..], &["--scale", "0.0125", "--unit", "deg/s"]].concat(),
    );
    merge(here, &["part0.json", "fine.json"], "both.json");
    let (one, both) = (axes(here, "part0.json"), axes(here, "both.json"));
    let octave = |axes: &[Value], field: &str| axes[0]["octaves"][3][field].as_f64().unwrap();
    assert_eq!(octave(&both, "sum"), 32.0 * octave(&one, "sum"));
    assert_eq!(octave(&both, "variance"), octave(&one, "variance"));
    assert_eq!(both[0]["rate_per_count"].as_f64(), Some(0.0125));
}

#[test]
fn curves_that_do_not_belong_together_are_refused() {
    let folder = folder();
    let here = folder.path();
    let measure = |options: &[&str], curve: &str| {
        let files = ["measure", "part1.csv", "--output", curve];
        output(here, &[&files[..], options].concat());
    };
    let scaled = |rate, scale, unit| ["--rate", rate, "--scale", scale, "--unit", unit];
    measure(&scaled("200", "0.05", "deg/s"), "fast.json");
    measure(&scaled("100", "0.05", "rad/s"), "radians.json");
    measure(&scaled("100", "0.06", "deg/s"), "scaled.json");
    measure(
        &[&ABOUT[..], &["--columns", "gy"]].concat(),
        "one-axis.json",
    );
    let loud: String = fs::read_to_string(here.join("part1.csv"))
        .unwrap()
        .lines()
        .skip(1)
        .map(|row| {
            let twice = row
                .split(',')
                .map(|count| 2 * count.parse::<i32>().unwrap());
            let [x, y] = twice.collect::<Vec<_>>()[..] else {
                panic!("{row}")
            };
            format!("{x},{y}\n")
        })
        .collect();
    fs::write(here.join("loud.csv"), format!("gx,gy\n{loud}")).unwrap();
    output(
        here,
        &[
            &["measure", "loud.csv", "--output", "other-sensor.json"],
            &ABOUT[..],
        ]
        .concat(),
    );
    fs::write(here.join("broken.json"), "{").unwrap();
    fs::copy(here.join("part0.json"), here.join("copy.json")).unwrap();
    for (other, what) in rows! {
        "fast.json", "the rate is 200 Hz, and that of the first file 100 Hz";
        "radians.json", "the unit is rad/s, and that of the first file deg/s";
        "scaled.json", "rate_per_count 0.06 is not 0.05 times a power of two";
        "one-axis.json", "axis \"gx\" is in one of this file";
        "other-sensor.json", "times that of the first file, as of another sensor, range or filter";
        "copy.json", "it has the same record as \"part0.json\"";
        "broken.json", "not a curve file";
        "absent.json", "no such file";
    } {
        let line = refusal(
            here,
            &["merge", "part0.json", other, "--output", "all.json"],
        );
        assert!(line.contains(what) && line.contains(other), "{line}");
        assert!(!here.join("all.json").exists(), "{other}");
    }
    let line = refusal(here, &["merge", "part0.json", "--output", "part0.json"]);
    assert!(line.contains("part0.json"), "{line}");
}
