//! Tests `measure --part`: parts of a record that are rejoined are the record, to the bit.

use program::{output, refusal};
use std::{fmt::Write as _, fs, path::Path};
use tempfile::TempDir;

/// The options that tell about a log of counts.
const ABOUT: [&str; 6] = ["--rate", "100", "--scale", "0.05", "--unit", "deg/s"];

/// Where the record is cut.
const CUTS: [usize; 6] = [0, 7, 4096, 20_011, 33_333, 50_000];

/// The rows of a record whose axes wander.
fn rows() -> Vec<String> {
    let mut random = 1_u32;
    let mut noise = move || {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (random >> 26) as i32
    };
    let mut drift = 0;
    let mut row = |_| {
        drift += noise() % 3 - 1;
        format!("{},{}", noise() + drift, noise() - 7)
    };
    (0..CUTS[CUTS.len() - 1]).map(&mut row).collect()
}

fn write(folder: &Path, name: &str, rows: &[String]) {
    fs::write(folder.join(name), format!("gx,gy\n{}\n", rows.join("\n"))).unwrap();
}

/// Measures a log that begins with a sample of the record.
fn part(folder: &Path, log: &str, first: usize, curve: &str) {
    let first = first.to_string();
    let files = ["measure", log, "--part", &first, "--output", curve];
    output(folder, &[&files[..], &ABOUT].concat());
}

fn merge(folder: &Path, parts: &[&str], all: &str) {
    output(folder, &[&["merge", "--output", all], parts].concat());
}

fn text(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}

/// The record, whole and in parts.
fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let rows = rows();
    write(here, "whole.csv", &rows);
    part(here, "whole.csv", 0, "whole.json");
    for (i, cut) in CUTS.windows(2).enumerate() {
        let (log, curve) = (format!("{i}.csv"), format!("{i}.json"));
        write(here, &log, &rows[cut[0]..cut[1]]);
        // The first part has too few samples for a curve of its own.
        if i > 0 {
            part(here, &log, cut[0], &curve);
        }
    }
    folder
}

#[test]
fn parts_in_any_order_and_in_groups_are_the_record_to_the_bit() {
    let folder = folder();
    let here = folder.path();
    let rows = rows();
    write(here, "rest.csv", &rows[..CUTS[2]]);
    part(here, "rest.csv", 0, "rest.json");
    merge(
        here,
        &["4.json", "rest.json", "3.json", "2.json"],
        "all.json",
    );
    assert_eq!(text(here, "all.json"), text(here, "whole.json"));
    merge(here, &["2.json", "4.json"], "even.json");
    merge(here, &["3.json", "even.json", "rest.json"], "groups.json");
    assert_eq!(text(here, "groups.json"), text(here, "whole.json"));

    // The sums are those of the record that is measured as a whole, which is what a fit takes.
    let files = ["measure", "whole.csv", "--output", "plain.json"];
    output(here, &[&files[..], &ABOUT].concat());
    let octaves = |curve: &str| {
        let document: serde_json::Value = serde_json::from_str(&text(here, curve)).unwrap();
        let axes = document["axes"].as_array().unwrap().iter();
        axes.map(|axis| (axis["octaves"].clone(), axis["short"].clone()))
            .collect::<Vec<_>>()
    };
    assert_eq!(octaves("all.json"), octaves("plain.json"));
    let fit = output(here, &["fit", "all.json"]);
    assert!(fit.contains("50000 samples at 100 Hz"), "{fit}");
}

#[test]
fn what_is_missing_between_parts_is_a_gap() {
    let folder = folder();
    let here = folder.path();
    merge(here, &["4.json", "2.json"], "apart.json");
    let axis: serde_json::Value = serde_json::from_str(&text(here, "apart.json")).unwrap();
    let axis = &axis["axes"][0];
    assert_eq!(
        (&axis["gaps"], &axis["first_sample"]),
        (&1.into(), &4096.into())
    );
    let mut rows = rows();
    rows.truncate(CUTS[5]);
    let gap = format!("# lost {} samples", CUTS[4] - CUTS[3]);
    let with_gap = [&rows[CUTS[2]..CUTS[3]], &[gap], &rows[CUTS[4]..]].concat();
    write(here, "gap.csv", &with_gap);
    part(here, "gap.csv", CUTS[2], "gap.json");
    assert_eq!(text(here, "gap.json"), text(here, "apart.json"));
}

#[test]
fn what_is_wrong_with_the_samples_is_told_of_rejoined_parts_as_of_the_record() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let mut rows = rows();
    rows[15_000..15_900].fill("3,4".into());
    write(here, "whole.csv", &rows);
    write(here, "0.csv", &rows[..15_500]);
    write(here, "1.csv", &rows[15_500..]);
    part(here, "0.csv", 0, "0.json");
    part(here, "1.csv", 15_500, "1.json");
    merge(here, &["1.json", "0.json"], "all.json");
    let whole = output(here, &[&["fit", "whole.csv"][..], &ABOUT].concat());
    let rejoined = output(here, &["fit", "all.json"]);
    for fit in [whole, rejoined] {
        assert!(
            fit.contains("stuck values: up to 900 equal values in a row"),
            "{fit}"
        );
    }
    let rest = output(here, &["fit", "0.json"]);
    assert!(rest.contains("up to 500 equal values"), "{rest}");
}

#[test]
fn what_cannot_be_rejoined_is_refused() {
    let folder = folder();
    let here = folder.path();
    let of = |arguments: &[&str]| refusal(here, &[arguments, &ABOUT].concat());
    let error = refusal(
        here,
        &["merge", "whole.json", "3.json", "--output", "x.json"],
    );
    assert!(
        error.contains("samples 20011 to 33332 come twice"),
        "{error}"
    );
    let error = of(&["measure", "2.csv", "3.csv", "--part", "5", "--output", "."]);
    assert!(error.contains("measure the parts one by one"), "{error}");
    let error = of(&[
        "measure", "2.csv", "--part", "5", "--from", "10s", "--output", "x.json",
    ]);
    assert!(error.contains("--from, --to and --drop cut it"), "{error}");
    let error = of(&[
        "measure",
        "2.csv",
        "--part",
        "1125899906842624",
        "--output",
        "x.json",
    ]);
    assert!(error.contains("exceed 2^50"), "{error}");
    let mut decimals = String::from("gx\n");
    for i in 0..5000_u32 {
        writeln!(
            decimals,
            "{}",
            f64::from(i.wrapping_mul(2_654_435_761) >> 8) / 1e3
        )
        .unwrap();
    }
    fs::write(here.join("decimals.csv"), decimals).unwrap();
    let error = of(&[
        "measure",
        "decimals.csv",
        "--part",
        "0",
        "--output",
        "x.json",
    ]);
    assert!(error.contains("no whole numbers of 32 bits"), "{error}");
    // A curve file whose pieces are of another record.
    let changed = text(here, "2.json").replacen("\"end\": 20011", "\"end\": 20010", 1);
    fs::write(here.join("changed.json"), changed).unwrap();
    let error = refusal(here, &["fit", "changed.json"]);
    assert!(error.contains("the pieces contradict the curve"), "{error}");
}
