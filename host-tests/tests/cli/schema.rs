//! The JSON schemas of the manual: real outputs are valid, and every property of them is described.

use program::{ADIS16405, output, run};
use serde_json::Value;
use std::{fs, path::Path};
use tempfile::TempDir;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../doc/schema");

fn schema(name: &str) -> Value {
    let text = fs::read(format!("{FOLDER}/{name}.schema.json")).unwrap();
    serde_json::from_slice(&text).unwrap()
}

/// A schema, in the keywords of JSON Schema 2020-12 that those of the manual have.
struct Validator {
    schema: Value,
    /// Whether a property that is not described is wrong. Programs that read the outputs skip it; the schemas leave nothing
    /// out.
    is_closed: bool,
}

impl Validator {
    fn of(name: &str, is_closed: bool) -> Self {
        Self {
            schema: schema(name),
            is_closed,
        }
    }

    fn is_valid(&self, document: &Value) -> bool {
        self.wrong(document).is_none()
    }

    /// The first thing that makes a document not valid.
    fn wrong(&self, document: &Value) -> Option<String> {
        self.wrong_in(&self.schema, document, "")
    }

    fn wrong_in(&self, schema: &Value, value: &Value, at: &str) -> Option<String> {
        let schema = schema.as_object().expect("a schema");
        schema.iter().find_map(|(keyword, argument)| {
            let is_kept = match keyword.as_str() {
                "$schema" | "$defs" | "title" | "description" => true,
                "type" => match argument {
                    Value::Array(types) => types.iter().any(|one| is_of_type(one, value)),
                    one => is_of_type(one, value),
                },
                "enum" => argument.as_array().expect("values").contains(value),
                "minimum" => limit(argument, value, |value, least| value >= least),
                "maximum" => limit(argument, value, |value, most| value <= most),
                "exclusiveMinimum" => limit(argument, value, |value, least| value > least),
                "exclusiveMaximum" => limit(argument, value, |value, most| value < most),
                "minItems" => length(argument, value, |length, least| length >= least),
                "maxItems" => length(argument, value, |length, most| length <= most),
                "required" => {
                    let names = argument.as_array().expect("names");
                    let mut missing = names.iter().filter(|name| {
                        let name = name.as_str().expect("a name");
                        value.is_object() && value.get(name).is_none()
                    });
                    return missing
                        .next()
                        .map(|name| format!("{at}: {name} is missing"));
                }
                "$ref" => {
                    let pointer = argument.as_str().and_then(|text| text.strip_prefix('#'));
                    let target = self.schema.pointer(pointer.expect("a place in the schema"));
                    return self.wrong_in(target.expect("a definition"), value, at);
                }
                "oneOf" => {
                    let all = argument.as_array().expect("schemas").iter();
                    let wrong: Vec<Option<String>> =
                        all.map(|one| self.wrong_in(one, value, at)).collect();
                    if wrong.iter().filter(|one| one.is_none()).count() == 1 {
                        return None;
                    }
                    return Some(format!("{at}: of the alternatives {wrong:?}"));
                }
                "items" => {
                    let all = value.as_array().into_iter().flatten().enumerate();
                    return { all }
                        .find_map(|(i, one)| self.wrong_in(argument, one, &format!("{at}/{i}")));
                }
                "properties" => return self.wrong_property(schema, value, at),
                "additionalProperties" if schema.contains_key("properties") => true,
                "additionalProperties" => {
                    let all = value.as_object().into_iter().flatten();
                    return { all }.find_map(|(name, one)| {
                        self.wrong_in(argument, one, &format!("{at}/{name}"))
                    });
                }
                other => panic!("this test does not know the keyword {other}"),
            };
            (!is_kept).then(|| format!("{at}: {value} against {keyword} {argument}"))
        })
    }

    fn wrong_property(
        &self,
        schema: &serde_json::Map<String, Value>,
        value: &Value,
        at: &str,
    ) -> Option<String> {
        let mut all = value.as_object()?.iter();
        all.find_map(|(name, one)| {
            let own = schema["properties"].get(name);
            match own.or(schema.get("additionalProperties")) {
                Some(own) => self.wrong_in(own, one, &format!("{at}/{name}")),
                None => self
                    .is_closed
                    .then(|| format!("{at}: {name} is not described")),
            }
        })
    }
}

fn is_of_type(name: &Value, value: &Value) -> bool {
    match name.as_str().expect("the name of a type") {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        "number" => value.is_number(),
        "integer" => value.is_u64() || value.is_i64(),
        other => panic!("there is no type {other}"),
    }
}

/// Whether a number keeps a limit. Other values have none.
fn limit(limit: &Value, value: &Value, keeps: fn(f64, f64) -> bool) -> bool {
    let limit = limit.as_f64().expect("a number");
    value.as_f64().is_none_or(|value| keeps(value, limit))
}

/// Whether the length of an array keeps a limit.
fn length(limit: &Value, value: &Value, keeps: fn(u64, u64) -> bool) -> bool {
    let limit = limit.as_u64().expect("a number");
    value
        .as_array()
        .is_none_or(|all| keeps(all.len() as u64, limit))
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
        let validator = Validator::of(command, true);
        for document in documents(folder.path(), command) {
            assert_eq!(validator.wrong(&document), None, "{command}");
        }
    }
}

#[test]
fn outputs_of_lot_are_as_its_schema_describes() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/lot");
    let validator = Validator::of("lot", true);
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
        assert_eq!(validator.wrong(&document), None, "{files:?}");
    }
}

/// A schema that every document keeps would say nothing.
#[test]
fn documents_without_a_property_or_with_another_type_are_not_valid() {
    let folder = TempDir::new().unwrap();
    simulated(folder.path());
    for command in ["fit", "diagnose"] {
        let validator = Validator::of(command, false);
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
