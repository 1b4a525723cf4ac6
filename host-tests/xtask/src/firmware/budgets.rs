//! Budgets for the cost of the library on each core, in `host-tests/budgets.json`, and their check.
//!
//! The file holds detailed figures of the Cortex-M4F and a few figures of every core, all of them built with rustup's
//! toolchain. With Debian's, the images are built and run, and agree with the host to the bit, but cost other numbers.

use super::{CORTEX_M4F, Core, Precision, image, measure, workspace};
use anyhow::{Context as _, Result, ensure};
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use std::path::PathBuf;

/// The relative amount by which a figure may exceed its budget. Chosen by hand.
const TOLERANCE: f64 = 0.05;

/// The remedy: how to bring the file in line with the measurement.
const UPDATE: &str =
    "if the cost is worth it, `cargo xtask bench --update-budgets` writes what is measured now";

/// Measures the detailed figures of the Cortex-M4F in single and double precision, and the figures
/// of every core.
///
/// # Errors
/// Fails if an image cannot be built or run.
pub fn measured() -> Result<Value> {
    let cores: Vec<Core> = Core::all().collect();
    let large: Vec<Core> = cores.iter().copied().filter(|core| !core.small).collect();
    let detailed = Precision::ALL.map(|precision| CORTEX_M4F.with(precision));
    image::build_all(&image::ON_EVERY_CORE, &cores, "firmware")?;
    image::build_all(&image::ON_LARGE_CORES, &large, "firmware")?;
    image::build_all(&image::ON_THE_MEASURED_CORE, &detailed, "firmware")?;
    // They run in parallel, because instructions are counted and not timed.
    let figures = cores.par_iter().map(measure::figures);
    let figures = figures.collect::<Result<Vec<_>>>()?;
    let mut measured = json!({});
    let mut entries = Vec::new();
    for (core, mut figures) in cores.iter().zip(figures) {
        entries.push(measure::entry(core, &figures)?);
        if core.name == CORTEX_M4F.name {
            // They stand in the list of cores.
            figures.remove("parts");
            figures.append(&mut measure::flash_by_part(core)?);
            measured[target(core.precision)] = figures.into();
        }
    }
    measured["cores"] = entries.into();
    Ok(measured)
}

/// Measures one core in both precisions, as far as it is used in them.
///
/// # Errors
/// Fails if there is no such core, or if an image cannot be built or run.
pub fn of_core(name: &str, measure: fn(&Core) -> Result<Value>) -> Result<Value> {
    let cores: Vec<Core> = Core::all().filter(|core| core.name == name).collect();
    let names: Vec<&str> = Core::all().map(|core| core.name).collect();
    ensure!(
        !cores.is_empty(),
        "there is no core {name}; give one of {}",
        names.join(", ")
    );
    let large: Vec<Core> = cores.iter().copied().filter(|core| !core.small).collect();
    image::build_all(&image::ON_EVERY_CORE, &cores, "firmware")?;
    image::build_all(&image::ON_LARGE_CORES, &large, "firmware")?;
    let entries: Result<Vec<Value>> = cores.par_iter().map(measure).collect();
    Ok(entries?.into())
}

/// The key of the Cortex-M4F's detailed figures.
pub fn target(precision: Precision) -> &'static str {
    match precision {
        Precision::Single => "target",
        Precision::Double => "target_double",
    }
}

/// The path of the file of budgets.
pub fn path() -> PathBuf {
    workspace().join("host-tests/budgets.json")
}

/// The committed budgets.
///
/// # Errors
/// Fails if the file cannot be read.
pub fn committed() -> Result<Value> {
    let path = path();
    let read = || -> Result<Value> { Ok(serde_json::from_slice(&std::fs::read(&path)?)?) };
    read().with_context(|| format!("reading {}: {UPDATE}", path.display()))
}

/// Replaces the budgets.
///
/// # Errors
/// Fails if the file cannot be written.
pub fn update(measured: &Value) -> Result<()> {
    let path = path();
    std::fs::write(&path, format!("{measured:#}\n"))
        .with_context(|| format!("writing {}", path.display()))
}

/// Compares a measurement with the budgets.
///
/// # Errors
/// Lists every figure that exceeds its budget by more than 5 %, that has no budget, or that was not
/// measured.
pub fn check(measured: &Value, budgets: &Value) -> Result<()> {
    let mut complaints = Vec::new();
    compare("", measured, budgets, &mut complaints);
    ensure!(complaints.is_empty(), "{}\n{UPDATE}", complaints.join("\n"));
    Ok(())
}

/// Measures a core and compares it with its budgets.
///
/// # Errors
/// Fails if an image cannot be built or run, or if a figure exceeds its budget.
pub fn check_core(core: &Core) -> Result<()> {
    let measured = measure::measured(core)?;
    let committed = committed()?;
    let is_it = |entry: &&Value| {
        entry["core"] == measured["core"] && entry["precision"] == measured["precision"]
    };
    let budgets = committed["cores"]
        .as_array()
        .and_then(|cores| cores.iter().find(is_it));
    let budgets = budgets.with_context(|| format!("{core} has no budgets: {UPDATE}"))?;
    check(&measured, budgets)
}

/// Compares two values of the same shape. A number may exceed its budget by [`TOLERANCE`].
fn compare(place: &str, measured: &Value, budget: &Value, complaints: &mut Vec<String>) {
    match (measured, budget) {
        (Value::Object(figures), Value::Object(budgets)) => {
            let forgotten = budgets.keys().filter(|name| !figures.contains_key(*name));
            for name in figures.keys().chain(forgotten) {
                let place = format!("{place} {name}");
                let of = |map: &Map<String, Value>| map.get(name).cloned();
                match (of(figures), of(budgets)) {
                    (Some(figure), Some(budget)) => compare(&place, &figure, &budget, complaints),
                    (None, _) => complaints.push(format!("{place}: was not measured")),
                    (_, None) => complaints.push(format!("{place}: has no budget")),
                }
            }
        }
        (Value::Array(cores), Value::Array(budgets)) => {
            if cores.len() != budgets.len() {
                let (here, there) = (cores.len(), budgets.len());
                complaints.push(format!("{place}: {here} entries, {there} budgets"));
            }
            for (core, budget) in cores.iter().zip(budgets) {
                let word = |name: &str| core[name].as_str().unwrap_or("?").to_owned();
                let place = format!("{place}: {} {}", word("core"), word("precision"));
                compare(&place, core, budget, complaints);
            }
        }
        (Value::Number(_), Value::Number(_)) => {
            let [figure, limit] = [measured, budget].map(|one| one.as_f64().unwrap_or(f64::NAN));
            // The comparison is false for NaN, so that it does not pass.
            let kept = figure <= limit * (1.0 + TOLERANCE);
            if !kept {
                complaints.push(format!("{place}: {figure}, the budget is {limit}"));
            }
        }
        _ if measured == budget => {}
        _ => complaints.push(format!("{place}: {measured}, the budget is {budget}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn complaints(figure: Value, budget: Value) -> String {
        let cores = |figure| json!({ "cores": [{ "core": "M4F", "precision": "single", "flash_bytes": figure }] });
        let checked = check(&cores(figure), &cores(budget));
        checked
            .err()
            .map_or(String::new(), |error| error.to_string())
    }

    #[test]
    fn figures_up_to_5_percent_above_the_budget_pass() {
        assert_eq!(complaints(json!(105), json!(100)), "");
        assert_eq!(complaints(json!(50), json!(100)), "");
        let said = complaints(json!(106), json!(100));
        assert!(
            said.starts_with(" cores: M4F single flash_bytes: 106, the budget is 100\n"),
            "{said}"
        );
        assert!(said.ends_with(UPDATE), "{said}");
    }

    #[test]
    fn empty_figures_and_budgets_are_refused() {
        assert!(complaints(Value::Null, json!(100)).contains("null, the budget is 100"));
        assert!(complaints(json!(100), Value::Null).contains("100, the budget is null"));
        assert_eq!(complaints(Value::Null, Value::Null), "");
        let core = |core| json!({ "cores": core });
        let none = check(&core(json!([{"core": "M0"}])), &core(json!([])));
        assert!(
            none.unwrap_err()
                .to_string()
                .contains("1 entries, 0 budgets")
        );
        let missing = check(&json!({"flash_bytes": 1}), &json!({}));
        assert!(
            missing
                .unwrap_err()
                .to_string()
                .contains("flash_bytes: has no budget")
        );
        let not_measured = check(&json!({}), &json!({"flash_bytes": 1}));
        assert!(
            not_measured
                .unwrap_err()
                .to_string()
                .contains("flash_bytes: was not measured")
        );
    }
}
