//! A C header with a macro for every number and its unit in a comment.

use super::{
    axis_noise::AxisNoise, characterisation::Characterisation, decimal::decimal,
    filter_states::FilterStates, given::Given, summary,
};
use allanite_host::overbound::{GaussMarkovProcess, Overbound};
use std::fmt::Write;

/// The symbols of the five terms.
const IEEE_952: [&str; 5] = ["Q", "N", "B", "K", "R"];

/// The header.
pub(super) fn header(known: &Characterisation, name: &str) -> String {
    let prefix = identifier(name);
    let mut text = format!(
        "#ifndef {prefix}_NOISE_H\n#define {prefix}_NOISE_H\n\n\
         // *_SIGMA and *_STEP are discrete-time, at {prefix}_RATE_HZ: the standard deviations of a sample and of\n\
         // the change of the bias from one sample to the next. *_ALL_* is the largest of the axes.\n"
    );
    define(
        &mut text,
        &format!("{prefix}_AXES"),
        &known.axes.len().to_string(),
        "",
    );
    let rate = Given::plain(known.rate_hz);
    number(&mut text, &format!("{prefix}_RATE_HZ"), &rate, "Hz");
    let mut taken: Vec<String> = Vec::new();
    for axis in &known.axes {
        let mut own = identifier(&axis.name);
        while taken.contains(&own) {
            own.push('_');
        }
        let _ = writeln!(text, "\n// axis {:?}", axis.name);
        let prefix = format!("{prefix}_AXIS_{own}");
        taken.push(own);
        let of_noise = axis.coefficients.iter();
        for coefficient in of_noise.filter(|one| IEEE_952.contains(&one.symbol)) {
            let symbol = coefficient.symbol;
            let unit = summary::unit(axis.sensor, coefficient.half_seconds);
            let name = match symbol {
                "N" => "NOISE_DENSITY".into(),
                "K" => "RANDOM_WALK".into(),
                _ => coefficient.name.to_uppercase(),
            };
            let given = match symbol {
                "N" => axis.white(),
                _ => axis.best(symbol),
            };
            number(&mut text, &format!("{prefix}_{name}"), &given, unit);
        }
        let (density, walk) = (axis.white(), axis.best("K"));
        discrete(&mut text, &prefix, known.rate_hz, density, walk);
        let alone = format!("{prefix}_RANDOM_WALK_ALONE");
        number(&mut text, &alone, &axis.walk(), "rad/s^2/sqrt(Hz)");
        of_model(&mut text, &prefix, &axis.states);
        if let Some(equivalent) = axis.equivalent {
            process(
                &mut text,
                &format!("{prefix}_EQUIVALENT"),
                equivalent.process,
            );
        }
        let above = format!("{prefix}_OVERBOUND");
        pair(
            &mut text,
            &above,
            known.rate_hz,
            axis.overbound_density(),
            axis.overbound_walk(),
        );
        with_process(&mut text, &above, axis);
    }
    let all = format!("{prefix}_ALL");
    let _ = writeln!(text, "\n// the largest of all axes");
    let (best, above) = (known.best(), known.overbound());
    pair(
        &mut text,
        &all,
        known.rate_hz,
        best.noise_density,
        best.random_walk,
    );
    let overbound = format!("{all}_OVERBOUND");
    pair(
        &mut text,
        &overbound,
        known.rate_hz,
        above.noise_density,
        above.random_walk,
    );
    text += &summary::below(known, "//");
    let _ = writeln!(text, "\n#endif");
    text
}

/// Defines white noise and random walk, continuous-time and discrete-time.
fn pair(text: &mut String, prefix: &str, rate_hz: f64, density: Given, walk: Given) {
    number(
        text,
        &format!("{prefix}_NOISE_DENSITY"),
        &density,
        "rad/s/sqrt(Hz)",
    );
    number(
        text,
        &format!("{prefix}_RANDOM_WALK"),
        &walk,
        "rad/s^2/sqrt(Hz)",
    );
    discrete(text, prefix, rate_hz, density, walk);
}

fn discrete(text: &mut String, prefix: &str, rate_hz: f64, density: Given, walk: Given) {
    let sigma = density.times(rate_hz.sqrt());
    number(
        text,
        &format!("{prefix}_NOISE_SIGMA"),
        &sigma,
        "rad/s, discrete",
    );
    let step = walk.times(1.0 / rate_hz.sqrt());
    number(
        text,
        &format!("{prefix}_RANDOM_WALK_STEP"),
        &step,
        "rad/s, discrete",
    );
}

/// Defines what the model has beside the five terms: processes, notches, and what is subtracted.
fn of_model(text: &mut String, prefix: &str, states: &FilterStates) {
    // The first of each kind has no number.
    let numbered = |at: usize| match at {
        0 => String::new(),
        at => format!("_{}", at + 1),
    };
    for (at, one) in states.processes.iter().enumerate() {
        process(text, &format!("{prefix}{}", numbered(at)), one.process);
    }
    for (at, one) in states.notched.iter().enumerate() {
        let of = format!("{prefix}_NOTCH{}", numbered(at));
        let frequency = Given::plain(one.frequency_hz.value);
        number(text, &format!("{of}_FREQUENCY_HZ"), &frequency, "Hz");
        let size = format!("{of}_{}", one.size_name.to_uppercase());
        number(text, &size, &Given::plain(one.size.value), "rad/s");
    }
    for (at, one) in states.dependences.iter().enumerate() {
        let of = format!(
            "{prefix}_SUBTRACT{}_{}",
            numbered(at),
            one.kind.name().to_uppercase()
        );
        let column = format!("rad/s per unit of column {:?}", one.column);
        define(
            text,
            &format!("{of}_SLOPE"),
            &decimal(one.slope.value),
            &column,
        );
        if let Some(reference) = one.reference {
            define(text, &format!("{of}_REFERENCE"), &decimal(reference), "");
        }
        if let Some(lag_s) = one.lag_s {
            number(text, &format!("{of}_LAG_S"), &Given::plain(lag_s), "s");
        }
    }
}

fn process(text: &mut String, prefix: &str, process: GaussMarkovProcess) {
    let sigma = Given::plain(process.sigma);
    number(
        text,
        &format!("{prefix}_GAUSS_MARKOV_SIGMA"),
        &sigma,
        "rad/s",
    );
    let time = Given::plain(process.correlation_time_s);
    number(text, &format!("{prefix}_GAUSS_MARKOV_TIME_S"), &time, "s");
}

/// Defines the overbound with a Gauss–Markov process: its three coefficients and its correlation time.
fn with_process(text: &mut String, prefix: &str, axis: &AxisNoise) {
    let Overbound {
        noise_density,
        random_walk,
        gauss_markov: Some(found),
    } = axis.overbound_with_process
    else {
        return;
    };
    let prefix = format!("{prefix}_WITH_PROCESS");
    let needed = |value: f64| match value {
        0.0 => Given::Missing {
            why: "the other terms alone are above the curve".into(),
        },
        value => Given::plain(value),
    };
    let density = needed(noise_density);
    number(
        text,
        &format!("{prefix}_NOISE_DENSITY"),
        &density,
        "rad/s/sqrt(Hz)",
    );
    let walk = needed(random_walk);
    number(
        text,
        &format!("{prefix}_RANDOM_WALK"),
        &walk,
        "rad/s^2/sqrt(Hz)",
    );
    process(text, &prefix, found);
}

fn number(text: &mut String, name: &str, given: &Given, unit: &str) {
    let words = given.words();
    match given.value() {
        Some(value) if words.is_empty() => define(text, name, &decimal(value), unit),
        Some(value) => define(text, name, &decimal(value), &format!("{unit}; {words}")),
        None => {
            let _ = writeln!(text, "// {name} is not defined: {words}");
        }
    }
}

fn define(text: &mut String, name: &str, value: &str, remark: &str) {
    let remark = if remark.is_empty() {
        String::new()
    } else {
        format!("  // {remark}")
    };
    let _ = writeln!(text, "#define {name} {value}{remark}");
}

/// A name as a C identifier: upper-case ASCII letters, digits and underscores, without a leading digit.
fn identifier(name: &str) -> String {
    let letter = |c: char| {
        if c.is_ascii_alphanumeric() {
            c.to_ascii_uppercase()
        } else {
            '_'
        }
    };
    let text: String = name.chars().map(letter).collect();
    if text.is_empty() || text.starts_with(|c: char| c.is_ascii_digit()) {
        format!("N{text}")
    } else {
        text
    }
}
