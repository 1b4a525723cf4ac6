//! The files of a lot: the table as CSV and as Parquet, and the page.

use super::{
    devices::{Lot, certificate, has_become_noisy, lot, name, truth},
    measured,
};
use allanite::{diagnosis::Verdict, integrity::Reason};
use arrow::array::{Array, Float64Array, RecordBatch, StringArray};
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use program::{json, output, refusal};
use serde_json::Value;
use std::{collections::BTreeMap, fs, fs::File, path::Path};

const DEVICES: u64 = 40;
const BEFORE: u64 = 35;

/// Forty devices, of which 35 were measured before. One record is not valid.
fn written(limits: &[&str], outputs: &[&str]) -> (Lot, Value) {
    let lot = lot(DEVICES, BEFORE, |device, now| {
        let mut one = measured(device, now);
        if device == 3 && now {
            let (hits, samples) = (300, one.conditions.samples);
            one.axes[0].verdict = Some(Verdict::Invalid(Reason::Railed { hits, samples }));
        }
        one
    });
    let mut arguments = vec!["lot"];
    for limit in limits {
        arguments.extend(["--limit", limit]);
    }
    for file in outputs {
        arguments.extend(["--output", file]);
    }
    arguments.extend(lot.now.iter().map(String::as_str));
    arguments.push("--earlier");
    arguments.extend(lot.before.iter().map(String::as_str));
    let judged = json(lot.folder.path(), &arguments);
    (lot, judged)
}

/// The rows of a CSV by the names of their columns.
fn rows(path: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let header = reader.headers().unwrap().clone();
    let row = |record: csv::StringRecord| {
        let cells = header.iter().zip(record.iter());
        cells
            .map(|(name, cell)| (name.to_owned(), cell.to_owned()))
            .collect()
    };
    reader
        .records()
        .map(|record| row(record.unwrap()))
        .collect()
}

fn batch(path: &Path) -> RecordBatch {
    let builder = ParquetRecordBatchReaderBuilder::try_new(File::open(path).unwrap()).unwrap();
    let mut reader = builder.build().unwrap();
    let batch = reader.next().unwrap().unwrap();
    assert!(reader.next().is_none());
    batch
}

#[test]
fn tables_have_a_row_for_each_device_and_axis_and_say_what_the_document_says() {
    let (lot, judged) = written(&["N=0.33°/√h", "B=58°/h"], &["lot.csv", "lot.parquet"]);
    let folder = lot.folder.path();
    let rows = rows(&folder.join("lot.csv"));
    assert_eq!(rows.len(), 40);
    let white = "angle_random_walk_deg_per_s_per_sqrt_hz";
    for (device, row) in rows.iter().enumerate() {
        assert_eq!(row["device"], name(device as u64));
        assert_eq!((&*row["axis"], &*row["source"]), ("x", "certificate"));
        assert_eq!(row["duration_s"].parse::<f64>().unwrap(), 163.84);
        // What is not valid is not judged, and has no numbers.
        let is_valid = device != 3;
        assert_eq!(row[white].is_empty(), !is_valid);
        assert_eq!(row["invalid_because"].is_empty(), is_valid);
        if is_valid {
            // The digits are those that `decode` prints.
            let decoded = json(folder, &["decode", &lot.now[device]]);
            let terms = decoded["records"][0]["axes"][0]["coefficients"]
                .as_array()
                .unwrap();
            let term = terms
                .iter()
                .find(|term| term["effect"] == "angle_random_walk")
                .unwrap();
            assert_eq!(row[white], term["value"].to_string());
        }
        // Only the devices with an earlier certificate have changed, or not.
        let change = &row["angle_random_walk_change_sigma"];
        assert_eq!(
            change.is_empty(),
            !is_valid || device as u64 >= BEFORE,
            "{device}: {change}"
        );
        if has_become_noisy(device as u64) {
            assert!(change.parse::<f64>().unwrap() > 4.0);
        }
    }
    let decided = |effect: &str, decision: &str| {
        let key = format!("{effect}_decision");
        rows.iter().filter(|row| row[&key] == decision).count()
    };
    for limit in judged["limits"].as_array().unwrap() {
        let effect = limit["effect"].as_str().unwrap();
        for (key, decision) in [
            ("passed", "pass"),
            ("guarded", "guard_band"),
            ("failed", "fail"),
        ] {
            assert_eq!(limit[key], decided(effect, decision), "{limit}");
        }
    }
    let outliers = judged["outliers"].as_array().unwrap();
    let listed: usize = rows
        .iter()
        .map(|row| {
            row["outlier_in"]
                .split(';')
                .filter(|one| !one.is_empty())
                .count()
        })
        .sum();
    assert!(!outliers.is_empty());
    assert_eq!(outliers.len(), listed);

    // The Parquet has the same columns with the same contents.
    let batch = batch(&folder.join("lot.parquet"));
    assert_eq!(batch.num_rows(), 40);
    assert_eq!(batch.num_columns(), rows[0].len());
    let (mut numbers, mut texts) = (0, 0);
    for (field, array) in batch.schema().fields().iter().zip(batch.columns()) {
        for (row, cells) in rows.iter().enumerate() {
            let cell = &cells[field.name()];
            assert_eq!(array.is_null(row), cell.is_empty(), "{field}");
            if array.is_null(row) {
                continue;
            }
            if let Some(array) = array.as_any().downcast_ref::<Float64Array>() {
                assert_eq!(array.value(row), cell.parse::<f64>().unwrap());
                numbers += 1;
            } else if let Some(array) = array.as_any().downcast_ref::<StringArray>() {
                assert_eq!(array.value(row), cell);
                texts += 1;
            }
        }
    }
    assert!(numbers > 400 && texts > 400, "{numbers} {texts}");
}

#[test]
fn the_page_has_pictures_that_can_be_parsed_and_names_what_is_found() {
    let (lot, judged) = written(&["N=0.33°/√h", "B=58°/h"], &["lot.html"]);
    let page = fs::read_to_string(lot.folder.path().join("lot.html")).unwrap();
    for word in ["src=", "url(", "@import", "<script", "href=\"http"] {
        assert!(!page.contains(word), "{word}");
    }
    let mut pictures = 0;
    let mut rest = &page[..];
    while let Some((_, from)) = rest.split_once("<svg") {
        let (inside, after) = from.split_once("</svg>").unwrap();
        let picture = format!("<svg{inside}</svg>");
        let parsed = roxmltree::Document::parse(&picture)
            .unwrap_or_else(|error| panic!("{error}: {picture}"));
        let root = parsed.root_element();
        // Every picture has a name for those who do not see it.
        assert!(root.has_attribute("aria-label") || root.has_attribute("aria-hidden"));
        let places = parsed.descendants().flat_map(|node| node.attributes());
        for place in places.filter(|one| ["x", "y", "x1", "x2", "y1", "y2"].contains(&one.name())) {
            let place: f64 = place.value().parse().unwrap();
            assert!((0.0..=370.0).contains(&place), "{picture}");
        }
        pictures += 1;
        rest = after;
    }
    // The bar of the yield, and three pictures for each limit.
    assert_eq!(pictures, 1 + 3 * 2);
    for list in ["failures", "outliers", "drifted"] {
        for one in judged[list].as_array().unwrap() {
            let row = format!("<th scope=\"row\">{}</th>", one["device"].as_str().unwrap());
            assert!(page.contains(&row), "{list}: {row}");
        }
    }
    let share = 100.0 * judged["yield_share"].as_f64().unwrap();
    assert!(page.contains(&format!("<strong>{share:.1} %</strong>")));
}

#[test]
fn names_of_devices_are_escaped_on_the_page() {
    let folder = tempfile::TempDir::new().unwrap();
    let mut one = certificate(7, truth(7, true), 0.0, 7);
    one.device =
        allanite::storage::Certificate::new(b"<b>&\"x", [1, 0, 0], one.conditions, one.unit)
            .unwrap()
            .device;
    fs::write(folder.path().join("a.bin"), super::encoded(&one)).unwrap();
    output(
        folder.path(),
        &[
            "lot", "a.bin", "--limit", "N=1e-6", "--output", "lot.html", "--output", "lot.csv",
        ],
    );
    let page = fs::read_to_string(folder.path().join("lot.html")).unwrap();
    assert!(
        page.contains("&lt;b&gt;&amp;") && !page.contains("<b>"),
        "{page}"
    );
    assert_eq!(rows(&folder.path().join("lot.csv"))[0]["device"], "<b>&\"x");
}

#[test]
fn outputs_of_other_kinds_are_refused_before_the_work() {
    let folder = tempfile::TempDir::new().unwrap();
    let one = certificate(7, truth(7, true), 0.0, 7);
    fs::write(folder.path().join("a.bin"), super::encoded(&one)).unwrap();
    let lot = ["lot", "a.bin", "--limit", "N=1", "--output"];
    for (file, what) in [
        ("lot.xlsx", "a .csv, a .parquet or an .html"),
        ("nowhere/lot.csv", "its folder does not exist"),
    ] {
        let refusal = refusal(folder.path(), &[&lot[..], &[file]].concat());
        assert!(refusal.contains(what), "{refusal}");
    }
}
