//! Parameter files of autopilots.
//!
//! The noise parameters of PX4's EKF2 and of ArduPilot's EKF3 are discrete-time, although their units
//! do not show it. A prediction over an interval dt adds these terms to the variances:
//!
//! ```text
//! (dt · gyro noise)²  of the angle,    (dt · gyro bias noise)²  of the bias
//! ```
//!
//! The code is `Ekf::predictCovariance` in PX4, where dt is about `EKF2_PREDICT_US`, and
//! `NavEKF3_core::CovariancePrediction` in ArduPilot, where dt is about `EKF_TARGET_DT` and the bias is
//! an angle per dt. Continuous-time noise adds `N² dt` and `K² dt`, so the parameters are `N/√dt` in
//! rad/s and `K/√dt` in rad/s². The defaults of both autopilots are far larger than any gyro's own
//! noise, because they also cover vibration and the errors of the filter's model.

use super::{
    arguments::Arguments, characterisation::Characterisation, decimal::decimal, given::Given,
    summary,
};
use std::fmt::Write;

/// A parameter of an autopilot.
struct Parameter {
    name: &'static str,
    /// What it is before it is set.
    default: f64,
}

/// The parameters of an autopilot and the syntax of its files.
struct Autopilot {
    /// White noise and random walk of the gyro, then of the accelerometer.
    parameters: [Parameter; 4],
    interval_s: f64,
    interval: &'static str,
    /// Writes a line of the file from a name and a value.
    line: fn(&str, f64) -> String,
    notes: [&'static str; 2],
}

const fn parameter(name: &'static str, default: f64) -> Parameter {
    Parameter { name, default }
}

/// A line for QGroundControl has vehicle, component, name, value and type, separated by tabs.
const PX4: Autopilot = Autopilot {
    parameters: [
        parameter("EKF2_GYR_NOISE", 0.015),
        parameter("EKF2_GYR_B_NOISE", 1e-3),
        parameter("EKF2_ACC_NOISE", 0.35),
        parameter("EKF2_ACC_B_NOISE", 3e-3),
    ],
    interval_s: 0.01,
    interval: "EKF2_PREDICT_US, 10000 us unless changed",
    // Type 9 of MAVLink is a float of 32 bits.
    line: |name, value| format!("1\t1\t{name}\t{}\t9", decimal(value)),
    notes: [
        "PX4's default EKF2_GYR_NOISE of 0.015 rad/s also covers vibration: lower it with care.",
        "Vehicle-Id\tComponent-Id\tName\tValue\tType",
    ],
};

/// A line for Mission Planner and MAVProxy has name and value, separated by a comma.
const ARDUPILOT: Autopilot = Autopilot {
    parameters: [
        parameter("EK3_GYRO_P_NSE", 0.015),
        parameter("EK3_GBIAS_P_NSE", 1e-3),
        parameter("EK3_ACC_P_NSE", 0.35),
        parameter("EK3_ABIAS_P_NSE", 0.02),
    ],
    interval_s: 0.012,
    interval: "EKF_TARGET_DT, 0.012 s, or the period of a slower main loop",
    line: |name, value| format!("{name},{}", decimal(value)),
    notes: [
        "ArduPilot's default EK3_GYRO_P_NSE of 0.015 rad/s also covers vibration: lower it with care.",
        "name,value",
    ],
};

/// The parameter file for PX4.
pub(super) fn px4(known: &Characterisation, arguments: &Arguments) -> String {
    parameters(known, arguments, &PX4)
}

/// The parameter file for ArduPilot.
pub(super) fn ardupilot(known: &Characterisation, arguments: &Arguments) -> String {
    parameters(known, arguments, &ARDUPILOT)
}

fn parameters(known: &Characterisation, arguments: &Arguments, of: &Autopilot) -> String {
    let interval_s = arguments.prediction_interval.unwrap_or(of.interval_s);
    let per_step = 1.0 / interval_s.sqrt();
    let mut text = String::new();
    let set = |text: &mut String, mark: &str, parameter: &Parameter, given: Given| {
        let Parameter { name, default } = parameter;
        let without = format!("its default is {default}");
        let given = given.times(per_step).without(&without);
        // Remarks have lines of their own, because not every reader accepts a comment after a value.
        if !given.words().is_empty() {
            let _ = writeln!(text, "# {name}: {}", given.words());
        }
        if let Some(value) = given.value() {
            let _ = writeln!(text, "{mark}{}", (of.line)(name, value));
        }
    };
    let [noise, walk, of_accelerometer @ ..] = &of.parameters;
    let (live, beside) = known.chosen(arguments.overbound);
    for (choice, mark) in [(live, ""), (beside, "# ")] {
        let _ = writeln!(text, "# {}:", choice.name);
        set(&mut text, mark, noise, choice.pair.noise_density);
        set(&mut text, mark, walk, choice.pair.random_walk);
    }
    let pair = &known.accelerometer.pair;
    let both = [&pair.noise_density, &pair.random_walk].map(Given::clone);
    for (parameter, given) in of_accelerometer.iter().zip(both) {
        set(&mut text, "", parameter, given);
    }
    let _ = writeln!(
        text,
        "#\n# Discrete-time, for a prediction every {} s ({}):\n\
         # {} = N/sqrt(dt) in rad/s, {} = K/sqrt(dt) in rad/s^2.",
        decimal(interval_s),
        of.interval,
        noise.name,
        walk.name
    );
    for note in of.notes {
        let _ = writeln!(text, "# {note}");
    }
    text + &summary::below(known, "#")
}
