//! The whole model as JSON, in radians and seconds, for a filter of one's own.

use super::{
    axis_noise::AxisNoise,
    characterisation::Characterisation,
    filter_states::{Correction, Interval, Oscillation, Process},
    given::Given,
};
use allanite::{Coefficient, fit::State};
use allanite_host::{
    known_filter::Shape,
    overbound::{GaussMarkovProcess, Overbound},
};
use allanite_log::unit::Sensor;
use serde::Serialize;

/// The document.
#[derive(Serialize)]
struct Document<'a> {
    program: String,
    /// Rates are in rad/s, times in seconds; densities are continuous-time and two-sided.
    units: &'static str,
    axes: Vec<Axis<'a>>,
}

#[derive(Serialize)]
struct Axis<'a> {
    axis: &'a str,
    rate_hz: f64,
    samples: u64,
    model: &'a str,
    verdict: &'a str,
    /// Whether the model explains the record; `null` if there are too few octaves to tell.
    adequate: Option<bool>,
    p_value: f64,
    /// White noise for a filter, which is N with the fast processes, and random walk K; `null` if the record does not give them.
    noise_density: Option<f64>,
    noise_density_lower: f64,
    noise_density_upper: Option<f64>,
    random_walk: Option<f64>,
    /// The random walk of a filter that has no state for the processes.
    random_walk_alone: Option<f64>,
    coefficients: Vec<Term>,
    /// The filters that the white noise has passed.
    filters: Vec<Shape>,
    /// States of the bias beside the random walk.
    processes: Vec<GaussMarkov>,
    /// Processes that are white noise to a filter, and that `noise_density` has.
    fast_processes: Vec<GaussMarkov>,
    /// Processes whose sum stands for the bias instability over the times of the record.
    flicker_processes: Vec<State2>,
    /// What a notch takes out.
    notches: Vec<Notch>,
    /// Oscillations that are too slow for a notch: two states each, with the size of one coordinate of a circular process.
    oscillators: Vec<Notch>,
    /// Oscillations that are white noise to a filter, and that `noise_density` has.
    fast_oscillations: Vec<Notch>,
    /// What is subtracted: `slope` times what `kind` makes of the column less the reference.
    subtract: Vec<Subtract<'a>>,
    /// Effects of the model that are in none of these places.
    not_carried: &'a [&'static str],
    /// White noise and random walk above every octave, and the same with a process.
    overbound: Bound,
    overbound_with_process: Bound,
}

#[derive(Serialize)]
struct Term {
    name: &'static str,
    symbol: &'static str,
    unit: &'static str,
    state: &'static str,
    value: f64,
    lower: f64,
    /// `null` if the record does not bound it.
    upper: Option<f64>,
}

#[derive(Serialize)]
struct GaussMarkov {
    sigma: f64,
    sigma_lower: f64,
    sigma_upper: f64,
    correlation_time_s: f64,
    correlation_time_lower_s: f64,
    correlation_time_upper_s: Option<f64>,
}

#[derive(Serialize)]
struct State2 {
    sigma: f64,
    correlation_time_s: f64,
}

#[derive(Serialize)]
struct Notch {
    effect: &'static str,
    frequency_hz: f64,
    frequency_lower_hz: f64,
    frequency_upper_hz: f64,
    size: &'static str,
    value: f64,
    lower: f64,
    upper: f64,
    /// The time in which the phase is lost; `null` for a line.
    correlation_time_s: Option<f64>,
}

#[derive(Serialize)]
struct Subtract<'a> {
    column: &'a str,
    kind: &'static str,
    slope: f64,
    slope_lower: f64,
    slope_upper: f64,
    reference: Option<f64>,
    lag_s: Option<f64>,
}

#[derive(Serialize)]
struct Bound {
    noise_density: f64,
    random_walk: f64,
    process: Option<State2>,
}

/// The document as text.
pub(super) fn text(known: &Characterisation) -> String {
    let document = Document {
        program: format!("allanite {}", env!("CARGO_PKG_VERSION")),
        units: "rad, s",
        axes: known.axes.iter().map(axis).collect(),
    };
    // Numbers, strings and lists always serialise.
    serde_json::to_string_pretty(&document).unwrap_or_default() + "\n"
}

fn axis(axis: &AxisNoise) -> Axis<'_> {
    let states = &axis.states;
    let white = axis.white_interval();
    Axis {
        axis: &axis.name,
        rate_hz: axis.rate_hz,
        samples: axis.samples,
        model: &axis.model,
        verdict: &axis.verdict,
        adequate: axis.is_adequate,
        p_value: axis.p_value,
        noise_density: axis.white().value(),
        noise_density_lower: white.lower,
        noise_density_upper: white.upper.is_finite().then_some(white.upper),
        random_walk: axis.best("K").value(),
        random_walk_alone: axis.walk().value(),
        coefficients: axis.coefficients.iter().map(term).collect(),
        filters: states.filters.iter().map(Shape::of).collect(),
        processes: states.processes.iter().map(gauss_markov).collect(),
        fast_processes: states.fast.iter().map(gauss_markov).collect(),
        flicker_processes: axis.flicker().into_iter().map(state).collect(),
        notches: states.notched.iter().map(notch).collect(),
        oscillators: states.slow.iter().map(notch).collect(),
        fast_oscillations: states.damped.iter().map(notch).collect(),
        subtract: states.dependences.iter().map(subtract).collect(),
        not_carried: &states.left,
        overbound: bound(
            &axis.overbound,
            axis.overbound_density(),
            axis.overbound_walk(),
        ),
        overbound_with_process: bound(
            &axis.overbound_with_process,
            Given::plain(axis.overbound_with_process.noise_density),
            Given::plain(axis.overbound_with_process.random_walk),
        ),
    }
}

fn term(one: &Coefficient) -> Term {
    Term {
        name: one.name,
        symbol: one.symbol,
        unit: super::summary::unit(Sensor::Gyro, one.half_seconds),
        state: match one.state {
            State::Measured => "measured",
            State::UpperBound => "upper_bound",
            State::NotObservable { .. } => "not_observable",
        },
        value: one.value,
        lower: one.lower,
        upper: one.upper.is_finite().then_some(one.upper),
    }
}

fn gauss_markov(one: &Process) -> GaussMarkov {
    GaussMarkov {
        sigma: one.sigma.value,
        sigma_lower: one.sigma.lower,
        sigma_upper: one.sigma.upper,
        correlation_time_s: one.time_s.value,
        correlation_time_lower_s: one.time_s.lower,
        correlation_time_upper_s: one.time_s.upper.is_finite().then_some(one.time_s.upper),
    }
}

const fn state(process: GaussMarkovProcess) -> State2 {
    State2 {
        sigma: process.sigma,
        correlation_time_s: process.correlation_time_s,
    }
}

fn notch(one: &Oscillation) -> Notch {
    let Interval {
        value,
        lower,
        upper,
    } = one.frequency_hz;
    Notch {
        effect: one.effect,
        frequency_hz: value,
        frequency_lower_hz: lower,
        frequency_upper_hz: upper,
        size: one.size_name,
        value: one.size.value,
        lower: one.size.lower,
        upper: one.size.upper,
        correlation_time_s: one.time_s(),
    }
}

fn subtract(one: &Correction) -> Subtract<'_> {
    Subtract {
        column: &one.column,
        kind: one.kind.name(),
        slope: one.slope.value,
        slope_lower: one.slope.lower,
        slope_upper: one.slope.upper,
        reference: one.reference,
        lag_s: one.lag_s,
    }
}

fn bound(overbound: &Overbound, density: Given, walk: Given) -> Bound {
    Bound {
        noise_density: density.value().unwrap_or(overbound.noise_density),
        random_walk: walk.value().unwrap_or(overbound.random_walk),
        process: overbound.gauss_markov.map(state),
    }
}
