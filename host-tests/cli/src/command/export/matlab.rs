//! JSON for `loadparams` of MATLAB's imuSensor.
//!
//! The file has named parts, each with the properties of `gyroparams` under `Gyroscope`: `NoiseDensity`
//! in (rad/s)/√Hz, `BiasInstability` in rad/s, and `RandomWalk` in (rad/s)·√Hz, which is K. The part
//! with the gyro's name is the best fit, and `NAME_overbound` is the overbound. JSON has no comments, so
//! the remarks are in `NAME_notes`, which loadparams ignores.

use super::{
    arguments::Arguments, axis_noise::AxisNoise, characterisation::Characterisation, given::Given,
    summary,
};
use serde_json::{Map, Value, json};

/// Notes on settings and properties that are easily wrong in MATLAB.
const NOTES: [&str; 3] = [
    "NoiseType must be \"double-sided\", which is the default; set SampleRate of imuSensor by hand.",
    "A property that is left out is zero in MATLAB; the reasons are given below.",
    "BiasInstability is B itself: gyroparams shapes it with BiasInstabilityCoefficients.",
];

/// The file.
pub(super) fn json(known: &Characterisation, arguments: &Arguments) -> String {
    let mut notes: Vec<String> = NOTES.map(str::to_owned).into();
    notes.push(format!("SampleRate {} Hz", known.rate_hz));
    let mut best = Map::new();
    property(
        known,
        &mut best,
        &mut notes,
        "NoiseDensity",
        AxisNoise::white,
    );
    property(known, &mut best, &mut notes, "BiasInstability", |axis| {
        axis.best("B")
    });
    property(
        known,
        &mut best,
        &mut notes,
        "RandomWalk",
        AxisNoise::walk_beside_flicker,
    );
    let mut above = Map::new();
    property(
        known,
        &mut above,
        &mut notes,
        "NoiseDensity",
        AxisNoise::overbound_density,
    );
    property(
        known,
        &mut above,
        &mut notes,
        "RandomWalk",
        AxisNoise::overbound_walk,
    );
    let mut accelerometer = Map::new();
    let pair = &known.accelerometer.pair;
    for (key, given) in [
        ("NoiseDensity", &pair.noise_density),
        ("RandomWalk", &pair.random_walk),
    ] {
        if let Some(value) = given.value() {
            accelerometer.insert(key.into(), value.into());
        }
        if !given.words().is_empty() {
            let left_out = given.value().map_or(" left out", |_| "");
            notes.push(format!("Accelerometer.{key}{left_out}: {}", given.words()));
        }
    }
    notes.extend(summary::lines(known));

    let (live, beside) = if arguments.overbound {
        ((above, ""), (best, "_best_fit"))
    } else {
        ((best, ""), (above, "_overbound"))
    };
    let name = &arguments.name;
    let mut file = Map::new();
    for (part, suffix) in [live, beside] {
        let mut sensors = Map::new();
        sensors.insert("Gyroscope".into(), part.into());
        // The numbers of the accelerometer are those that the part for the filter has.
        if suffix.is_empty() && !accelerometer.is_empty() {
            sensors.insert("Accelerometer".into(), accelerometer.clone().into());
        }
        file.insert(format!("{name}{suffix}"), sensors.into());
    }
    file.insert(format!("{name}_notes"), notes.into());
    let file = Value::from(file);
    format!("{file:#}\n")
}

/// Adds a property and its notes. Three axes make a row of three numbers; for any other number of axes,
/// MATLAB takes one number for all.
fn property(
    known: &Characterisation,
    part: &mut Map<String, Value>,
    notes: &mut Vec<String>,
    key: &str,
    of_axis: impl Fn(&AxisNoise) -> Given,
) {
    let given: Vec<Given> = known.axes.iter().map(&of_axis).collect();
    let values: Vec<f64> = given.iter().filter_map(Given::value).collect();
    let (value, words) = if given.len() == 3 && values.len() == 3 {
        let named = known.axes.iter().zip(&given);
        let said = named.filter(|(_, given)| !given.words().is_empty());
        let said = said.map(|(axis, given)| format!("{:?}: {}", axis.name, given.words()));
        (Some(json!(values)), said.collect::<Vec<_>>().join("; "))
    } else {
        let common = known.common(of_axis);
        (common.value().map(Value::from), common.words().to_owned())
    };
    let missing = value.is_none();
    if let Some(value) = value {
        part.insert(key.into(), value);
    }
    if !words.is_empty() {
        let left_out = if missing { " left out" } else { "" };
        notes.push(format!("{key}{left_out}: {words}"));
    }
}
