//! Lines for the YAML of odometries: the configurations of VINS-Fusion and FAST-LIO, the settings of ORB-SLAM3 and LIO-SAM's
//! params.yaml.
//!
//! VINS-Fusion's `gyr_n` and `gyr_w` are discrete-time. `IntegrationBase::midPointIntegration` adds to the angle's
//! variance `2 (½ dt gyr_n)²` at each sample, for two ends that it takes for independent, and to the bias `(dt gyr_w)²`.
//! Continuous-time noise adds `N² dt` and `K² dt`, so that they are `N √(2 rate)` in rad/s and `K √rate` in rad/s².
//! FAST-LIO's `gyr_cov` and `b_gyr_cov` are variances: `esekf::predict` adds `dt² gyr_cov` to that of the angle and
//! `dt² b_gyr_cov` to that of the bias, so that they are `N² rate` in (rad/s)² and `K² rate` in (rad/s²)².
//! ORB-SLAM3 multiplies `IMU.NoiseGyro` by the root of `IMU.Frequency` and divides `IMU.GyroWalk` by it: they are N and K.
//! LIO-SAM gives `imuGyrNoise` squared to GTSAM, which takes it for continuous-time, and multiplies `imuGyrBiasN` by the
//! root of the time between two frames: they are N and K.

use super::{
    arguments::Arguments,
    characterisation::{Characterisation, Choice},
    decimal::decimal,
    given::Given,
    summary,
};
use std::fmt::Write;

/// The names and units of a program's configuration.
struct Names {
    indent: &'static str,
    /// The lines in front of the numbers, with `{topic}` and `{rate}` in them.
    head: &'static str,
    /// White noise and random walk of the gyro, then of the accelerometer.
    keys: [Key; 4],
    /// White noise and random walk from the densities and the rate.
    numbers: [fn(f64, f64) -> f64; 2],
    note: &'static str,
}

/// A number of a configuration.
struct Key {
    name: &'static str,
    unit: &'static str,
    /// What the program does if the number is left out.
    without: &'static str,
}

const fn key(name: &'static str, unit: &'static str, without: &'static str) -> Key {
    Key {
        name,
        unit,
        without,
    }
}

const VINS_FUSION: Names = Names {
    indent: "",
    head: "%YAML:1.0\n\nimu_topic: {topic}\n",
    keys: [
        key("gyr_n", "rad/s, N sqrt(2 rate)", "VINS-Fusion then takes 0"),
        key("gyr_w", "rad/s^2, K sqrt(rate)", "VINS-Fusion then takes 0"),
        key(
            "acc_n",
            "m/s^2, density times sqrt(2 rate)",
            "VINS-Fusion then takes 0",
        ),
        key(
            "acc_w",
            "m/s^3, random walk times sqrt(rate)",
            "VINS-Fusion then takes 0",
        ),
    ],
    numbers: [
        |density, rate_hz| density * (2.0 * rate_hz).sqrt(),
        |walk, rate_hz| walk * rate_hz.sqrt(),
    ],
    note: "discrete-time, as VINS-Fusion's integration takes them at this rate",
};

const ORB_SLAM3: Names = Names {
    indent: "",
    head: "%YAML:1.0\n\nIMU.Frequency: {rate}  # Hz\n",
    keys: [
        key("IMU.NoiseGyro", "rad/s/sqrt(Hz)", "ORB-SLAM3 then stops"),
        key("IMU.GyroWalk", "rad/s^2/sqrt(Hz)", "ORB-SLAM3 then stops"),
        key("IMU.NoiseAcc", "m/s^2/sqrt(Hz)", "ORB-SLAM3 then stops"),
        key("IMU.AccWalk", "m/s^3/sqrt(Hz)", "ORB-SLAM3 then stops"),
    ],
    numbers: [|density, _| density, |walk, _| walk],
    note: "continuous-time",
};

const LIO_SAM: Names = Names {
    indent: "  ",
    head: "lio_sam:\n  imuTopic: {topic}\n",
    keys: [
        key("imuGyrNoise", "rad/s/sqrt(Hz)", "LIO-SAM then takes 0.001"),
        key("imuGyrBiasN", "rad/s^2/sqrt(Hz)", "LIO-SAM then takes 3e-5"),
        key("imuAccNoise", "m/s^2/sqrt(Hz)", "LIO-SAM then takes 0.01"),
        key("imuAccBiasN", "m/s^3/sqrt(Hz)", "LIO-SAM then takes 2e-4"),
    ],
    numbers: [|density, _| density, |walk, _| walk],
    note: "continuous-time",
};

const FAST_LIO: Names = Names {
    indent: "  ",
    head: "common:\n  imu_topic: {topic}\n\nmapping:\n",
    keys: [
        key("gyr_cov", "rad^2/s^2, N^2 rate", "FAST-LIO then takes 0.1"),
        key(
            "b_gyr_cov",
            "rad^2/s^4, K^2 rate",
            "FAST-LIO then takes 1e-4",
        ),
        key(
            "acc_cov",
            "m^2/s^4, density^2 rate",
            "FAST-LIO then takes 0.1",
        ),
        key(
            "b_acc_cov",
            "m^2/s^6, random walk^2 rate",
            "FAST-LIO then takes 1e-4",
        ),
    ],
    numbers: [|density, rate_hz| density * density * rate_hz; 2],
    note: "variances of a sample, as FAST-LIO's prediction takes them at this rate",
};

/// The lines for VINS-Fusion, in the YAML dialect of OpenCV.
pub(super) fn vins_fusion(known: &Characterisation, arguments: &Arguments) -> String {
    configuration(known, arguments, &VINS_FUSION)
}

/// The lines for ORB-SLAM3, in the YAML dialect of OpenCV.
pub(super) fn orb_slam3(known: &Characterisation, arguments: &Arguments) -> String {
    configuration(known, arguments, &ORB_SLAM3)
}

/// The lines for LIO-SAM.
pub(super) fn lio_sam(known: &Characterisation, arguments: &Arguments) -> String {
    configuration(known, arguments, &LIO_SAM)
}

/// The lines for FAST-LIO.
pub(super) fn fast_lio(known: &Characterisation, arguments: &Arguments) -> String {
    configuration(known, arguments, &FAST_LIO)
}

fn configuration(known: &Characterisation, arguments: &Arguments, names: &Names) -> String {
    let Names {
        indent,
        head,
        keys: [noise, walk, of_accelerometer @ ..],
        numbers,
        note,
    } = names;
    let rate_hz = known.rate_hz;
    let rate = decimal(rate_hz);
    // A JSON string is also a YAML string.
    let topic = serde_json::Value::from(arguments.rostopic.as_str()).to_string();
    let mut text = head.replace("{rate}", &rate).replace("{topic}", &topic);
    let (live, beside) = known.chosen(arguments.overbound);
    for (Choice { name, pair }, mark) in [(live, ""), (beside, "# ")] {
        let _ = writeln!(text, "{indent}# {name}, {note} ({rate} Hz):");
        let both = [(noise, pair.noise_density), (walk, pair.random_walk)];
        for ((key, given), number) in both.into_iter().zip(numbers) {
            let given = given.map(|one| number(one, rate_hz));
            line(&mut text, &format!("{indent}{mark}"), key, given);
        }
    }
    let pair = &known.accelerometer.pair;
    let both = [&pair.noise_density, &pair.random_walk].map(Given::clone);
    for ((key, given), number) in of_accelerometer.iter().zip(both).zip(numbers) {
        let given = given.map(|one| number(one, rate_hz));
        line(&mut text, indent, key, given);
    }
    text + &summary::below(known, "#")
}

/// Writes `key: value  # unit; remark`, or a comment with the reason why there is no value and what the program does.
fn line(text: &mut String, start: &str, key: &Key, given: Given) {
    let Key {
        name,
        unit,
        without,
    } = key;
    let given = given.without(without);
    let remark = match given.words() {
        "" => String::new(),
        words => format!("; {words}"),
    };
    let _ = match given.value() {
        Some(value) => writeln!(text, "{start}{name}: {}  # {unit}{remark}", decimal(value)),
        None => writeln!(text, "# {name}:  # {unit}{remark}"),
    };
}
