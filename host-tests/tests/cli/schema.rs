//! The JSON schemas of the manual: real outputs are valid, and every property of them is described.

use host_tests::program::{ADIS16405, output, run};
use jsonschema::Validator;
use serde_json::Value;
use std::{fs, path::Path};
use tempfile::TempDir;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/doc/schema");

fn schema(name: &str) -> Value {
    let text = fs::read(format!("{FOLDER}/{name}.schema.json")).unwrap();
    serde_json::from_slice(&text).unwrap()
}

/// Forbids what a schema does not describe. Programs that read the outputs skip it; the schemas leave nothing out.
fn close(schema: &mut Value) {
    match schema {
        Value::Object(object) => {
            if object.contains_key("properties") && !object.contains_key("additionalProperties") {
                object.insert("additionalProperties".into(), false.into());
            }
            object.values_mut().for_each(close);
        }
        Value::Array(all) => all.iter_mut().for_each(close),
        _ => {}
    }
}

fn closed(name: &str) -> Validator {
    let mut schema = schema(name);
    close(&mut schema);
    jsonschema::validator_for(&schema).unwrap()
}

/// The first thing that makes a document not valid.
fn wrong(validator: &Validator, document: &Value) -> Option<String> {
    let error = validator.iter_errors(document).next()?;
    Some(format!("{}: {error}", error.instance_path()))
}

/// The documents of commands about a log with a line and a temperature, a log without them, a curve file, and no file.
fn documents(folder: &Path, command: &str) -> Vec<Value> {
    let more: &[&[&str]] = match command {
        "fit" => &[
            &[ADIS16405],
            &["line.csv", "--limit", "N=1", "--limit", "K=1e-9"],
            &["mems.csv", "--method", "ordinary"],
            &["mems.csv", "missing.csv", "line.csv"],
        ],
        _ => &[
            &[ADIS16405],
            &["line.csv"],
            &["mems.csv", "missing.csv", "line.csv"],
            &["step.csv"],
        ],
    };
    let document = |arguments: &&[&str]| {
        let all = [&["-q", command, "--json"], *arguments].concat();
        let run = run(folder, &all);
        serde_json::from_slice(&run.stdout).unwrap_or_else(|error| panic!("{all:?}: {error}"))
    };
    more.iter().map(document).collect()
}

fn simulated(folder: &Path) {
    let mems = ["simulate", "mems", "--duration", "200", "--output"];
    output(folder, &[&mems[..], &["mems.csv", "--seed", "2"]].concat());
    let line = [
        "line.csv",
        "--seed",
        "3",
        "--effect",
        "sinusoid:frequency_hz=7.7,amplitude=0.05",
    ];
    output(folder, &[&mems[..], &line].concat());
    // A step of the mean in the middle is an event.
    let log = fs::read_to_string(folder.join("mems.csv")).unwrap();
    let stepped = log
        .lines()
        .enumerate()
        .map(|(i, line)| match line.parse::<f64>() {
            Ok(rate) if i > 10_000 => format!("{}\n", rate + 0.03),
            _ => format!("{line}\n"),
        });
    fs::write(folder.join("step.csv"), stepped.collect::<String>()).unwrap();
}

#[test]
fn outputs_of_fit_and_diagnose_are_as_their_schemas_describe() {
    let folder = TempDir::new().unwrap();
    simulated(folder.path());
    for command in ["fit", "diagnose"] {
        let validator = closed(command);
        for document in documents(folder.path(), command) {
            assert_eq!(wrong(&validator, &document), None, "{command}");
        }
    }
}

#[test]
fn outputs_of_lot_are_as_its_schema_describes() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/data/lot");
    let validator = closed("lot");
    let lot = [
        "lot",
        "--json",
        "--limit",
        "N=0.33°/√h",
        "--limit",
        "B=58°/h",
    ];
    for files in [
        &["now", "--earlier", "before"][..],
        &["now/SN-0001.bin"],
        &["now"],
    ] {
        let printed = output(Path::new(folder), &[&lot[..], files].concat());
        let document: Value = serde_json::from_str(&printed).unwrap();
        assert_eq!(wrong(&validator, &document), None, "{files:?}");
    }
}

/// A schema that every document keeps would say nothing.
#[test]
fn documents_without_a_property_or_with_another_type_are_not_valid() {
    let folder = TempDir::new().unwrap();
    simulated(folder.path());
    for command in ["fit", "diagnose"] {
        let validator = jsonschema::validator_for(&schema(command)).unwrap();
        let document = documents(folder.path(), command).swap_remove(1);
        assert!(validator.is_valid(&document), "{command}");
        let axis = document["axes"][0].as_object().unwrap();
        let needed = schema(command)["$defs"]["axis"]["required"]
            .as_array()
            .unwrap()
            .clone();
        assert!(needed.len() > 5);
        for name in axis
            .keys()
            .filter(|name| needed.contains(&Value::from(name.as_str())))
        {
            let mut less = document.clone();
            less["axes"][0].as_object_mut().unwrap().remove(name);
            assert!(!validator.is_valid(&less), "{command} without {name}");
            let mut other = document.clone();
            other["axes"][0][name] = serde_json::json!({"another": "type"});
            assert!(!validator.is_valid(&other), "{command} with another {name}");
        }
    }
}
