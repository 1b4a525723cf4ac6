//! The covariance of ROS messages `sensor_msgs/Imu`, as YAML.
//!
//! `angular_velocity_covariance` is a row-major 3×3 matrix in rad²/s². Filters take every message for a sample with
//! independent noise, so that the variance that adds up to the right angle is N² times the rate. The message has no
//! place for the bias.

use super::{
    arguments::Arguments, axis_noise::AxisNoise, characterisation::Characterisation,
    decimal::decimal, given::Given, summary,
};
use std::fmt::Write;

/// The matrix and its roots.
pub(super) fn yaml(known: &Characterisation, arguments: &Arguments) -> String {
    let mut text = String::new();
    for is_overbound in [arguments.overbound, !arguments.overbound] {
        let (name, mark) = match (is_overbound, is_overbound == arguments.overbound) {
            (true, true) => ("overbound", ""),
            (true, false) => ("overbound", "# "),
            (false, true) => ("best fit", ""),
            (false, false) => ("best fit", "# "),
        };
        let density = |axis: &AxisNoise| match is_overbound {
            true => axis.overbound_density(),
            false => axis.white(),
        };
        let _ = writeln!(text, "# {name}, at {} Hz:", decimal(known.rate_hz));
        let given: Vec<Given> = match known.axes.len() {
            3 => known.axes.iter().map(density).collect(),
            _ => vec![known.common(density); 3],
        };
        matrix(&mut text, mark, &given, known.rate_hz);
    }
    text + &summary::below(known, "#")
}

/// Writes the matrix with the squares on its diagonal, or the reason why there is none.
fn matrix(text: &mut String, mark: &str, given: &[Given], rate_hz: f64) {
    let Some((densities, remark)) = Given::three(given) else {
        let words: Vec<&str> = given.iter().map(Given::words).collect();
        let _ = writeln!(
            text,
            "# angular_velocity_covariance: {}; zeros in a message mean that it is unknown",
            words.join("; ")
        );
        return;
    };
    let row = |row: usize, sigma: f64| {
        let entry = |column: usize| {
            if column == row { sigma * sigma } else { 0.0 }
        };
        [0, 1, 2].map(|column| decimal(entry(column))).join(", ")
    };
    let [x, y, z] = densities.map(|density| density * rate_hz.sqrt());
    let rows = [row(0, x), row(1, y), row(2, z)];
    let remark = match remark {
        "" => String::new(),
        remark => format!("; {remark}"),
    };
    let _ = writeln!(
        text,
        "{mark}angular_velocity_covariance: [{}]  # rad^2/s^2, row-major{remark}",
        rows.join(", ")
    );
    let roots = [x, y, z].map(decimal).join(", ");
    let _ = writeln!(text, "{mark}angular_velocity_stdev: [{roots}]  # rad/s");
}
