//! A model of SDFormat with an IMU, for Gazebo.
//!
//! `GaussianNoiseModel::ApplyImpl` of gz-sensors adds white noise with `stddev` to each sample, so that it is N times the
//! root of the rate. Its dynamic bias is a Gauss–Markov process with `dynamic_bias_correlation_time` T, of which
//! `dynamic_bias_stddev` is not the standard deviation: that is `dynamic_bias_stddev √(T/2)`. The number is the density of
//! the white noise that drives the bias, which is K for a random walk and `σ √(2/T)` for a process of σ. Either element
//! alone gives no bias. Gazebo has one such process for each axis.

use super::{
    arguments::Arguments, axis_noise::AxisNoise, characterisation::Characterisation,
    decimal::decimal, given::Given, summary,
};
use allanite_host::overbound::GaussMarkovProcess;
use std::fmt::Write;

/// What Gazebo does if an element is left out.
const WITHOUT: &str = "Gazebo then takes 0";

/// White noise and the process of the bias for an axis of the simulator.
struct Noise {
    density: Given,
    /// The process, and where it comes from or why there is none.
    process: (Option<GaussMarkovProcess>, &'static str),
}

/// The model.
pub(super) fn xml(known: &Characterisation, arguments: &Arguments) -> String {
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n<sdf version=\"1.7\">\n  <model name=\"{}\">\n    <link name=\"link\">\n      \
         <sensor name=\"imu\" type=\"imu\">\n        <update_rate>{}</update_rate>\n        <imu>\n",
        escaped(&arguments.name),
        decimal(known.rate_hz)
    );
    let is_overbound = arguments.overbound;
    let name = if is_overbound {
        "overbound"
    } else {
        "best fit"
    };
    let _ = writeln!(text, "          <!-- {name} -->");
    let gyro = of_axes(&known.axes, is_overbound);
    sensor(&mut text, "angular_velocity", known.rate_hz, &gyro);
    let of_accelerometer = &known.accelerometer;
    let mut accelerometer = of_axes(&of_accelerometer.axes, is_overbound);
    if accelerometer.is_empty() {
        let time_s = known.axes.first().map_or(f64::NAN, AxisNoise::duration_s);
        let walk = of_accelerometer.pair.random_walk.value();
        accelerometer.push(Noise {
            density: of_accelerometer.pair.noise_density.clone(),
            process: match walk {
                Some(walk) => (Some(GaussMarkovProcess::of_walk(walk, time_s)), ""),
                None => (None, "its random walk is not known"),
            },
        });
    }
    sensor(
        &mut text,
        "linear_acceleration",
        known.rate_hz,
        &accelerometer,
    );
    text.push_str("        </imu>\n      </sensor>\n    </link>\n  </model>\n</sdf>\n\n");
    for line in summary::lines(known) {
        let _ = writeln!(text, "{}", comment(&line));
    }
    text
}

/// The noise of three axes. That of the strongest stands for them if there are not three.
fn of_axes(axes: &[AxisNoise], is_overbound: bool) -> Vec<Noise> {
    let of_axis = |axis: &AxisNoise| Noise {
        density: match is_overbound {
            true => Given::plain(axis.overbound_with_process.noise_density),
            false => axis.white(),
        },
        process: process(axis, is_overbound),
    };
    let mut noise: Vec<Noise> = axes.iter().map(of_axis).collect();
    if noise.len() != 3 {
        let strength = |one: &Noise| one.density.value().unwrap_or(0.0);
        noise.sort_by(|one, other| strength(other).total_cmp(&strength(one)));
        noise.truncate(1);
    }
    noise
}

/// The process that comes nearest to what the bias does: the strongest of the model's, of the one in the place of the bias
/// instability, and of K as a process as long as the record.
fn process(axis: &AxisNoise, is_overbound: bool) -> (Option<GaussMarkovProcess>, &'static str) {
    if is_overbound {
        return match axis.overbound_with_process.gauss_markov {
            None => (None, "the overbound needs no such process"),
            process => (process, ""),
        };
    }
    let own = axis.states.processes.iter().map(|one| (one.process, ""));
    let flicker = axis.measured("B").and(axis.equivalent);
    let flicker = flicker.map(|one| (one.process, "in the place of the bias instability"));
    let walk = axis.measured("K").map(|walk| {
        let process = GaussMarkovProcess::of_walk(walk, axis.duration_s());
        (process, "K as a process as long as the record")
    });
    let all = own.chain(flicker).chain(walk);
    match all.max_by(|(one, _), (other, _)| one.sigma.total_cmp(&other.sigma)) {
        Some((process, words)) => (Some(process), words),
        None => (None, "the record shows no change of the bias"),
    }
}

/// Writes the three axes of a sensor, of which there are three noises, or one for all.
fn sensor(text: &mut String, element: &str, rate_hz: f64, noise: &[Noise]) {
    let _ = writeln!(text, "          <{element}>");
    for (axis, Noise { density, process }) in ["x", "y", "z"].into_iter().zip(noise.iter().cycle())
    {
        let _ = writeln!(
            text,
            "            <{axis}>\n              <noise type=\"gaussian\">"
        );
        let stddev = density.clone().times(rate_hz.sqrt());
        number(text, "stddev", &stddev);
        let (process, words) = process;
        let of_process = |of: fn(GaussMarkovProcess) -> f64| match *process {
            Some(process) => Given::Number {
                value: of(process),
                remark: (*words).to_owned(),
            },
            None => Given::Missing {
                why: (*words).to_owned(),
            },
        };
        let driving = of_process(GaussMarkovProcess::driving);
        number(text, "dynamic_bias_stddev", &driving);
        let time_s = of_process(|process| process.correlation_time_s);
        number(text, "dynamic_bias_correlation_time", &time_s);
        let _ = writeln!(text, "              </noise>\n            </{axis}>");
    }
    let _ = writeln!(text, "          </{element}>");
}

/// Writes an element, or a comment with the reason why there is none.
fn number(text: &mut String, element: &str, given: &Given) {
    const INDENT: &str = "                ";
    let given = given.clone().without(WITHOUT);
    let words = given.words();
    let _ = match given.value() {
        Some(value) => {
            let remark = match words {
                "" => String::new(),
                words => format!(" {}", comment(words)),
            };
            writeln!(
                text,
                "{INDENT}<{element}>{}</{element}>{remark}",
                decimal(value)
            )
        }
        None => writeln!(
            text,
            "{INDENT}{}",
            comment(&format!("no {element}: {words}"))
        ),
    };
}

/// Text as a comment, in which XML forbids two hyphens and a hyphen at the end.
fn comment(words: &str) -> String {
    let mut safe = String::new();
    for c in words.chars() {
        if c == '-' && safe.ends_with('-') {
            safe.push(' ');
        }
        safe.push(c);
    }
    format!("<!-- {safe} -->")
}

/// A text as the value of an attribute.
fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}
