//! Functions in Python that set the preintegration parameters of GTSAM.
//!
//! `PreintegrationCombinedParams` has continuous-time covariances: that of the gyro's white noise in rad²/s, which is
//! N² for each axis, and that of the white noise that drives its bias in rad²/s³, which is K². The members have the same
//! names in C++. A covariance that is not set is the identity, in which a bias walks by 1 rad/s within a second, so that
//! every function sets what it is for: a number that the record does not give is an argument without a default.

use super::{
    arguments::Arguments, axis_noise::AxisNoise, characterisation::Characterisation,
    decimal::decimal, given::Given, summary,
};
use allanite_log::unit::Sensor;
use std::fmt::Write;

/// A member of the parameters.
struct Member {
    setter: &'static str,
    /// The argument that stands for a number that is not known, and its unit.
    argument: &'static str,
    argument_unit: &'static str,
    unit: &'static str,
}

/// White noise and random walk.
const GYRO: [Member; 2] = [
    Member {
        setter: "setGyroscopeCovariance",
        argument: "noise_density",
        argument_unit: "rad/s/sqrt(Hz)",
        unit: "N^2 in rad^2/s",
    },
    Member {
        setter: "setBiasOmegaCovariance",
        argument: "random_walk",
        argument_unit: "rad/s^2/sqrt(Hz)",
        unit: "K^2 in rad^2/s^3",
    },
];
const ACCELEROMETER: [Member; 2] = [
    Member {
        setter: "setAccelerometerCovariance",
        argument: "noise_density",
        argument_unit: "m/s^2/sqrt(Hz)",
        unit: "N^2 in m^2/s^3",
    },
    Member {
        setter: "setBiasAccCovariance",
        argument: "random_walk",
        argument_unit: "m/s^3/sqrt(Hz)",
        unit: "K^2 in m^2/s^5",
    },
];

/// The functions.
pub(super) fn python(known: &Characterisation, arguments: &Arguments) -> String {
    let per_axis = |of: &dyn Fn(&AxisNoise) -> Given| -> Vec<Given> {
        match known.axes.len() {
            3 => known.axes.iter().map(of).collect(),
            // One number stands for the three axes of a filter.
            _ => vec![known.common(of)],
        }
    };
    let best = [per_axis(&AxisNoise::white), per_axis(&AxisNoise::walk)];
    let above = [
        per_axis(&AxisNoise::overbound_density),
        per_axis(&AxisNoise::overbound_walk),
    ];
    let [best, above] = [("best fit", best), ("overbound", above)];
    let (live, beside) = match arguments.overbound {
        true => (above, best),
        false => (best, above),
    };
    let mut text = "import numpy as np\n\n\n".to_owned();
    function(&mut text, Sensor::Gyro, &GYRO, &live, Some(&beside));
    let pair = &known.accelerometer.pair;
    let of_accelerometer = [&pair.noise_density, &pair.random_walk].map(|one| vec![one.clone()]);
    let live = (live.0, of_accelerometer);
    text += "\n\n";
    function(
        &mut text,
        Sensor::Accelerometer,
        &ACCELEROMETER,
        &live,
        None,
    );
    text + &summary::below(known, "#")
}

/// A name, and white noise and random walk of one axis or of three.
type Choice = (&'static str, [Vec<Given>; 2]);

/// Writes the function of a sensor, and another choice of its numbers as comments.
fn function(
    text: &mut String,
    sensor: Sensor,
    members: &[Member; 2],
    live: &Choice,
    beside: Option<&Choice>,
) {
    let is_missing = |given: &[Given]| given.iter().all(|one| one.value().is_none());
    let both = members.iter().zip(&live.1);
    let missing: Vec<&Member> = both
        .filter(|(_, given)| is_missing(given))
        .map(|(member, _)| member)
        .collect();
    let arguments: String = missing
        .iter()
        .map(|member| format!(", {}", member.argument))
        .collect();
    let (short, name) = match sensor {
        Sensor::Gyro => ("gyro", "a gyro"),
        Sensor::Accelerometer => ("accelerometer", "an accelerometer"),
    };
    let _ = writeln!(
        text,
        "def set_{short}_noise(params{arguments}):\n    \
         \"\"\"Sets the noise of {name} in a gtsam.PreintegrationCombinedParams.\"\"\""
    );
    for ((name, given), mark) in [(Some(live), ""), (beside, "# ")]
        .into_iter()
        .filter_map(|(choice, mark)| Some((choice?, mark)))
    {
        let _ = writeln!(text, "    # {name}:");
        for (member, given) in members.iter().zip(given) {
            set(text, mark, member, given);
        }
    }
    text.push_str("    return params\n");
}

/// Writes the call of a member. An axis without a number gets the largest of the others, and without any number the argument
/// of the function stands for it, or if the call is a comment the reason why there is none.
fn set(text: &mut String, mark: &str, member: &Member, given: &[Given]) {
    let Member {
        setter,
        argument,
        argument_unit,
        unit,
    } = member;
    let words = given
        .iter()
        .map(Given::words)
        .filter(|words| !words.is_empty());
    let mut remarks: Vec<String> = words.map(str::to_owned).collect();
    let values: Vec<f64> = given.iter().filter_map(Given::value).collect();
    let Some(largest) = values.iter().copied().reduce(f64::max) else {
        let why = remarks.join("; ");
        let _ = match mark {
            "" => writeln!(
                text,
                "    # {argument} is in {argument_unit}: {why}; unset, gtsam takes 1\n    \
                 params.{setter}({argument}**2 * np.eye(3))  # {unit}"
            ),
            mark => writeln!(text, "    {mark}params.{setter} is not set: {why}"),
        };
        return;
    };
    let matrix = match Given::three(given) {
        Some((numbers, remark)) => {
            remarks.extend((!remark.is_empty()).then(|| remark.to_owned()));
            let squares = numbers.map(|number| decimal(number.powi(2)));
            format!("np.diag([{}])", squares.join(", "))
        }
        None => format!("{} * np.eye(3)", decimal(largest.powi(2))),
    };
    let remark: String = remarks.iter().map(|one| format!("; {one}")).collect();
    let _ = writeln!(
        text,
        "    {mark}params.{setter}({matrix})  # {unit}{remark}"
    );
}
