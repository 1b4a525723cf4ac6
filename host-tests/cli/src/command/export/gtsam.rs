//! A function in Python that sets the preintegration parameters of GTSAM.
//!
//! `PreintegrationCombinedParams` has continuous-time covariances: that of the gyro's white noise in rad²/s, which is
//! N² for each axis, and that of the white noise that drives its bias in rad²/s³, which is K². The members have the same
//! names in C++.

use super::{
    arguments::Arguments, axis_noise::AxisNoise, characterisation::Characterisation,
    decimal::decimal, given::Given, summary,
};
use std::fmt::Write;

/// The function.
pub(super) fn python(known: &Characterisation, arguments: &Arguments) -> String {
    let mut text = "import numpy as np\n\n\ndef set_gyro_noise(params):\n    \
         \"\"\"Sets the noise of a gyro in a gtsam.PreintegrationCombinedParams.\"\"\"\n"
        .to_owned();
    let per_axis = |of: &dyn Fn(&AxisNoise) -> Given| -> Vec<Given> {
        match known.axes.len() {
            3 => known.axes.iter().map(of).collect(),
            // One number stands for the three axes of a filter.
            _ => vec![known.common(of)],
        }
    };
    let pairs = [
        (
            "best fit",
            per_axis(&AxisNoise::white),
            per_axis(&AxisNoise::walk),
        ),
        (
            "overbound",
            per_axis(&AxisNoise::overbound_density),
            per_axis(&AxisNoise::overbound_walk),
        ),
    ];
    let is_live = |name: &str| (name == "overbound") == arguments.overbound;
    for (name, density, walk) in &pairs {
        let mark = if is_live(name) { "" } else { "# " };
        let _ = writeln!(text, "    # {name}:");
        let both = [
            ("setGyroscopeCovariance", density, "N^2 in rad^2/s"),
            ("setBiasOmegaCovariance", walk, "K^2 in rad^2/s^3"),
        ];
        for (member, given, unit) in both {
            set(
                &mut text,
                &format!("    {mark}params.{member}"),
                given,
                unit,
            );
        }
    }
    text += "    return params\n";
    text + &summary::below(known, "#")
}

/// Writes the call of a member, or the reason why there is none.
fn set(text: &mut String, call: &str, given: &[Given], unit: &str) {
    let values = given.iter().filter_map(Given::value);
    let squares: Vec<String> = values.map(|value| decimal(value * value)).collect();
    let words = given
        .iter()
        .map(Given::words)
        .filter(|words| !words.is_empty());
    let words = words.collect::<Vec<_>>().join("; ");
    let remark = if words.is_empty() {
        String::new()
    } else {
        format!("; {words}")
    };
    let _ = match squares.as_slice() {
        [one] if given.len() == 1 => {
            writeln!(text, "{call}({one} * np.eye(3))  # {unit}{remark}")
        }
        squares if squares.len() == given.len() => writeln!(
            text,
            "{call}(np.diag([{}]))  # {unit}{remark}",
            squares.join(", ")
        ),
        _ => writeln!(text, "    # {} is not set: {unit}{remark}", call.trim()),
    };
}
