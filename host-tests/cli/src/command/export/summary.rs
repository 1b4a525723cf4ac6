//! The comments of every format, which tell axis by axis where the numbers come from.

use super::{
    accelerometer::Accelerometer, axis_noise::AxisNoise, characterisation::Characterisation,
    decimal::decimal,
};
use allanite::Coefficient;
use allanite_host::{number::number, overbound::Overbound};
use allanite_log::{failure::one_line, unit::Sensor};

/// The lines of the comments, without comment marks. Names are quoted, so that no name can end a
/// comment.
pub(super) fn lines(known: &Characterisation) -> Vec<String> {
    let mut lines = vec![
        format!(
            "Noise of a gyro, by allanite {}.",
            env!("CARGO_PKG_VERSION")
        ),
        "Units are radians and seconds; densities are continuous-time and two-sided.".into(),
    ];
    for axis in &known.axes {
        lines.push(String::new());
        lines.extend(of_axis(axis));
    }
    lines.extend(of_accelerometer(&known.accelerometer));
    lines
}

/// The lines as a block of comments below the numbers, with a blank line before it.
pub(super) fn below(known: &Characterisation, mark: &str) -> String {
    format!("\n{}", comment(known, mark))
}

/// The lines as a block of comments.
fn comment(known: &Characterisation, mark: &str) -> String {
    let lines = lines(known).into_iter();
    lines
        .map(|line| format!("{mark} {line}").trim_end().to_owned() + "\n")
        .collect()
}

/// The record, the verdict and the coefficients of an axis of either sensor.
pub(super) fn of_noise(axis: &AxisNoise) -> Vec<String> {
    let mut lines = vec![format!(
        "Axis {:?}: {} samples at {} Hz; {}",
        axis.name,
        axis.samples,
        decimal(axis.rate_hz),
        axis.model
    )];
    lines.push(format!("  {}", one_line(&axis.verdict)));
    for coefficient in &axis.coefficients {
        lines.push(of_coefficient(axis, coefficient));
    }
    lines
}

fn of_axis(axis: &AxisNoise) -> Vec<String> {
    let mut lines = of_noise(axis);
    lines.extend(axis.states.lines().iter().map(|line| format!("  {line}")));
    if let Some(equivalent) = axis.equivalent {
        lines.push(format!(
            "  B as a Gauss-Markov process: sigma {} rad/s, correlation time {} s; this replacement \
             changes the model's deviation by {:.1} % at most, {:.1} % rms",
            number(equivalent.process.sigma),
            number(equivalent.process.correlation_time_s),
            equivalent.max_percent,
            equivalent.rms_percent
        ));
    }
    lines.push(format!("  overbound: {}", of_overbound(&axis.overbound)));
    let with_process = match axis.overbound_with_process.gauss_markov {
        Some(_) => of_overbound(&axis.overbound_with_process),
        None => "the same, because it needs no such process".into(),
    };
    lines.push(format!(
        "  overbound with a Gauss-Markov process: {with_process}"
    ));
    lines.push("  (both lie above the upper end of the 95 % interval of every octave, notches and subtracted parts aside)".into());
    lines
}

fn of_coefficient(axis: &AxisNoise, coefficient: &Coefficient) -> String {
    let name = coefficient.name.replace('_', " ");
    let unit = unit(axis.sensor, coefficient.half_seconds);
    let symbol = coefficient.symbol;
    let given = axis.best(symbol);
    let what = match given.value() {
        Some(value) if given.words().is_empty() => format!(
            "{} {unit} ({} to {}, 95 %)",
            number(value),
            number(coefficient.lower),
            number(coefficient.upper)
        ),
        Some(value) => format!("below {} {unit} ({})", number(value), given.words()),
        None => given.words().to_owned(),
    };
    format!("  {name} {symbol}: {what}")
}

fn of_overbound(overbound: &Overbound) -> String {
    let mut text = format!(
        "white noise {} rad/s/sqrt(Hz), random walk {} rad/s^2/sqrt(Hz)",
        number(overbound.noise_density),
        number(overbound.random_walk)
    );
    if let Some(process) = overbound.gauss_markov {
        text += &format!(
            ", sigma {} rad/s, correlation time {} s",
            number(process.sigma),
            number(process.correlation_time_s)
        );
    }
    text
}

/// The unit of a coefficient in characters that every format accepts.
pub(super) fn unit(sensor: Sensor, half_seconds: i8) -> &'static str {
    let [gyro, accelerometer] = match half_seconds {
        2 => ["rad", "m/s"],
        1 => ["rad/s/sqrt(Hz)", "m/s^2/sqrt(Hz)"],
        0 => ["rad/s", "m/s^2"],
        -1 => ["rad/s^2/sqrt(Hz)", "m/s^3/sqrt(Hz)"],
        _ => ["rad/s^2", "m/s^3"],
    };
    match sensor {
        Sensor::Gyro => gyro,
        Sensor::Accelerometer => accelerometer,
    }
}

/// What the comments say of the axes of the accelerometer.
pub(super) fn of_accelerometer(accelerometer: &Accelerometer) -> Vec<String> {
    let lines = accelerometer.axes.iter().map(of_noise).map(|lines| {
        let heading = [String::new(), "Accelerometer, in m/s^2 and seconds:".into()];
        heading.into_iter().chain(lines)
    });
    lines.flatten().collect()
}
