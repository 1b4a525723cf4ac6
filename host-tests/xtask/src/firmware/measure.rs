//! Measures the cost of the library on a core.

use super::{CORTEX_M4F, Core, Image, run_with};
use anyhow::{Context as _, Result, bail};
use serde_json::{Map, Number, Value, json};

/// The part of the library that each image contains besides the start-up code, and the name of the
/// figure for it.
const PARTS: [(&str, &str); 8] = [
    ("footprint_accumulator", "flash_bytes_accumulator"),
    ("footprint_five_terms", "flash_bytes_with_five_terms"),
    ("footprint_self_test", "flash_bytes_with_self_test"),
    ("footprint_fit", "flash_bytes_with_fit"),
    ("footprint_diagnosis", "flash_bytes_with_diagnosis"),
    ("footprint_spectrum", "flash_bytes_with_spectrum"),
    ("footprint_everything", "flash_bytes_with_everything"),
    ("footprint_words", "flash_bytes_with_explanations"),
];

/// The stack of a diagnosis of the largest number of octaves.
const DEEP: &str = "stack_of_diagnosis_30";

/// The figures that the images `bench` and `bench_parts` measure on a core. The image measures many more on a
/// Cortex-M4F than on the others.
///
/// # Errors
/// Fails if an image cannot be built or run, or if it ends with a failure.
pub fn figures(core: &Core) -> Result<Map<String, Value>> {
    let extent = match core {
        _ if core.name == CORTEX_M4F.name => "full",
        Core { small: true, .. } => "small",
        _ => "usual",
    };
    let mut figures = logged("bench", core, extent)?;
    if !core.small {
        let mut parts = logged("bench_parts", core, extent)?;
        if let Some(stack) = parts.remove(DEEP) {
            figures.insert(DEEP.into(), stack);
        }
        figures.insert("parts".into(), by_part(&parts).into());
    }
    let worst = largest(&figures, "instructions_worst_sample_");
    figures.insert("instructions_worst_sample".into(), worst.into());
    let flash = Image::build_for("footprint_fit", core)?.flash_bytes()?;
    figures.insert("flash_bytes".into(), flash.into());
    let small = Image::build_for("footprint_five_terms", core)?.flash_bytes()?;
    figures.insert("flash_bytes_five_terms".into(), small.into());
    let tested = Image::build_for("footprint_self_test", core)?.flash_bytes()?;
    figures.insert("flash_bytes_self_test".into(), tested.into());
    Ok(figures)
}

/// The entry of a core in the list of cores.
///
/// # Errors
/// Fails if an image cannot be built or run, or if a figure was not measured.
pub fn measured(core: &Core) -> Result<Value> {
    entry(core, &figures(core)?)
}

/// The mean, the most and the number of the costliest one, in instructions, of a thousand fits of the five terms and of as
/// many looks.
///
/// # Errors
/// Fails if the image cannot be built or run.
pub fn worst(core: &Core) -> Result<Value> {
    let mut figures = logged("bench", core, "worst")?;
    figures.insert("core".into(), core.name.into());
    figures.insert("precision".into(), core.precision.name().into());
    Ok(figures.into())
}

/// The numbers that an image logs on a core.
fn logged(image: &str, core: &Core, extent: &str) -> Result<Map<String, Value>> {
    let run = run_with(&Image::build_for(image, core)?, &[extent])?;
    let (status, lines) = (run.status, run.lines);
    if !status.success() {
        bail!("{image} on {} ended with {status}: {lines:?}", core.name);
    }
    named_numbers(lines.iter().filter_map(|line| line.strip_prefix("info ")))
}

/// The entry of a core in the list of cores. The diagnosis is null if the core has no room for it.
///
/// # Errors
/// Fails if another figure was not measured.
pub fn entry(core: &Core, figures: &Map<String, Value>) -> Result<Value> {
    let measured = |value: Option<u64>, of: &str| {
        value.with_context(|| format!("{}: {of} was not measured", core.name))
    };
    let whole = |name: &str| measured(figures.get(name).and_then(Value::as_u64), name);
    let stack = measured(largest(figures, "stack_bytes_"), "stack_bytes")?;
    let fit = measured(largest(figures, "instructions_fit_"), "instructions_fit")?;
    Ok(json!({
        "core": core.name,
        "precision": core.precision.name(),
        "octaves": whole("octaves")?,
        "instructions_per_sample": figures["instructions_per_sample"],
        "instructions_worst_sample": whole("instructions_worst_sample")?,
        "instructions_fit": fit,
        "instructions_five_terms": largest(figures, "instructions_five_terms_"),
        "flash_bytes_five_terms": whole("flash_bytes_five_terms")?,
        "stack_bytes_five_terms": largest(figures, "stack_of_five_terms_"),
        "flash_bytes_self_test": whole("flash_bytes_self_test")?,
        "stack_bytes_look": largest(figures, "stack_of_look_"),
        "instructions_worst_five_terms": whole("instructions_worst_five_terms")?,
        "instructions_worst_look": whole("instructions_worst_look")?,
        "instructions_look": largest(figures, "instructions_of_look_"),
        "instructions_diagnosis": largest(figures, "instructions_diagnosis_"),
        "flash_bytes": whole("flash_bytes")?,
        "parts": figures.get("parts"),
        "ram_bytes": whole("ram_bytes_axis_and_curve")? + stack,
        "stack_bytes": stack,
    }))
}

/// What axes with one part each take: figures by the name of the part.
fn by_part(figures: &Map<String, Value>) -> Map<String, Value> {
    let mut parts = Map::new();
    for (name, value) in figures {
        let ends = ["_bytes_", "_instructions_"].map(|kind| name.find(kind));
        if let Some(end) = ends.into_iter().flatten().next() {
            let (part, figure) = name.split_at(end);
            let entry = parts.entry(part).or_insert_with(|| json!({}));
            entry[&figure[1..]] = value.clone();
        }
    }
    parts
}

/// The largest of the figures whose names begin with `start`.
fn largest(figures: &Map<String, Value>, start: &str) -> Option<u64> {
    let named = figures.iter().filter(|(name, _)| name.starts_with(start));
    named.filter_map(|(_, value)| value.as_u64()).max()
}

/// The flash that each part of the library takes on a core: the size of its image less that of an
/// empty one.
///
/// # Errors
/// Fails if an image cannot be built.
pub fn flash_by_part(core: &Core) -> Result<Map<String, Value>> {
    let nothing = Image::build_for("footprint_nothing", core)?.flash_bytes()?;
    let mut figures = Map::new();
    figures.insert("flash_bytes_start_up".into(), nothing.into());
    for (image, figure) in PARTS {
        let flash = Image::build_for(image, core)?.flash_bytes()?;
        figures.insert(figure.into(), flash.saturating_sub(nothing).into());
    }
    Ok(figures)
}

/// Parses lines that consist of a name and a number.
///
/// # Errors
/// Fails if a line is anything else.
pub fn named_numbers<'a>(lines: impl Iterator<Item = &'a str>) -> Result<Map<String, Value>> {
    let figure = |line: &str| {
        let (name, number) = line.split_once(' ')?;
        let number: Number = number.parse().ok()?;
        Some((name.to_owned(), rounded(number)))
    };
    lines
        .map(|line| figure(line).with_context(|| format!("{line:?} is not a name and a number")))
        .collect()
}

/// A number of instructions measured by a clock, without the digits below the clock's resolution.
fn rounded(number: Number) -> Value {
    match number.as_f64() {
        Some(float) if float >= 1e5 => (float.round() as u64).into(),
        Some(float) if number.is_f64() => ((float * 100.0).round() / 100.0).into(),
        _ => number.into(),
    }
}
