//! A Kalman filter for the angle and the bias of one axis, with a model that `export` wrote.
//!
//! Every second it adds the angle that the gyro shows, less what is to be subtracted, and is told the angle with an error.
//! Its states are the angle, a constant bias that walks, the Gauss–Markov processes of the model, and the errors of the
//! slopes with which it subtracts what follows the temperature.

use super::gyro::{RATE_HZ, Truth};
use allanite_host::{
    confidence::TWO_SIDED_95,
    simulate::{Coefficients, Simulator},
};
use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector2, Vector3};
use serde_json::Value;
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// The time between two updates, in seconds.
const STEP_S: f64 = 1.0;

/// The samples between two updates.
const SAMPLES: usize = 100;

/// The standard deviation of the bias before the first update, in rad/s; far above all biases.
const UNKNOWN: f64 = 0.1;

/// The share of a record in which the filter settles.
const SETTLES: f64 = 0.25;

/// The time over which a temperature is smoothed for its rate of change, in seconds.
const SMOOTH_S: f64 = 1.0;

/// The width of a notch over its frequency.
const NOTCH: f64 = 0.05;

/// The most states: angle, bias and processes. States that a model does not need stay at zero.
const STATES: usize = 16;

/// What the filter takes of a model, in radians and seconds.
#[derive(Clone, Debug, Default)]
pub struct Model {
    noise_density: f64,
    random_walk: f64,
    /// σ and correlation time of each process.
    processes: Vec<(f64, f64)>,
    /// Root-mean-square, frequency and correlation time of slow oscillations.
    oscillators: Vec<(f64, f64, f64)>,
    notches_hz: Vec<f64>,
    subtracted: Vec<Subtracted>,
}

/// A part of the rate that follows the temperature.
#[derive(Clone, Debug)]
struct Subtracted {
    kind: String,
    slope: f64,
    /// The standard error of the slope.
    error: f64,
    reference: f64,
    lag_s: Option<f64>,
}

impl Model {
    /// Takes white noise and the random walk that the formats have which have no other state for the bias.
    pub fn of_format(axis: &Value) -> Self {
        let number = |name: &str| axis[name].as_f64().unwrap_or_default();
        Self {
            noise_density: number("noise_density"),
            random_walk: number("random_walk_alone"),
            ..Self::default()
        }
    }

    /// Takes white noise and random walk of the overbound.
    pub fn of_overbound(axis: &Value) -> Self {
        let number = |name: &str| axis["overbound"][name].as_f64().unwrap_or_default();
        Self {
            noise_density: number("noise_density"),
            random_walk: number("random_walk"),
            ..Self::default()
        }
    }

    /// Takes a model from an axis of the exported JSON. With `alone`, it takes white noise and K. A bound is no
    /// measurement, and is not used.
    pub fn of(axis: &Value, alone: bool) -> Self {
        let all = |name: &str| axis[name].as_array().cloned().unwrap_or_default();
        let number = |value: &Value| value.as_f64().unwrap_or_default();
        let measured = |symbol: &str| {
            let coefficients = all("coefficients");
            let mut found = coefficients
                .iter()
                .filter(|one| one["symbol"] == symbol && one["state"] == "measured");
            found.next().map_or(0.0, |one| number(&one["value"]))
        };
        let mut model = Self {
            noise_density: number(&axis["noise_density"]),
            random_walk: measured("K"),
            ..Self::default()
        };
        if alone {
            return model;
        }
        for list in ["processes", "flicker_processes"] {
            let processes = all(list);
            // What is faster than a step is white noise to the filter, and belongs to the flicker noise's short end.
            let slow = processes
                .iter()
                .map(|one| (number(&one["sigma"]), number(&one["correlation_time_s"])));
            model
                .processes
                .extend(slow.filter(|(_, time_s)| list == "processes" || *time_s >= STEP_S));
        }
        model.oscillators = all("oscillators")
            .iter()
            .map(|one| {
                let rms = match one["size"].as_str() {
                    Some("amplitude") => FRAC_1_SQRT_2,
                    _ => 1.0,
                };
                let time_s = one["correlation_time_s"].as_f64().unwrap_or(f64::INFINITY);
                (
                    rms * number(&one["value"]),
                    number(&one["frequency_hz"]),
                    time_s,
                )
            })
            .collect();
        model.notches_hz = all("notches")
            .iter()
            .map(|one| number(&one["frequency_hz"]))
            .collect();
        model.subtracted = all("subtract")
            .iter()
            .map(|one| Subtracted {
                kind: one["kind"].as_str().unwrap_or_default().to_owned(),
                slope: number(&one["slope"]),
                error: (number(&one["slope_upper"]) - number(&one["slope_lower"]))
                    / (2.0 * TWO_SIDED_95),
                reference: number(&one["reference"]),
                lag_s: one["lag_s"].as_f64(),
            })
            .collect();
        model
    }
}

/// How a filter fared.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// The mean of `eᵀ P⁻¹ e / 2` over the errors of angle and bias: one if the filter knows its errors.
    pub nees: f64,
    /// The root-mean-square error of the angle, in radians.
    pub angle_error: f64,
}

impl Run {
    /// Runs a filter over a record. Every update tells it the angle with this standard deviation, in radians.
    pub fn of(model: &Model, record: &[Truth], reference: f64) -> Self {
        let prepared = Prepared::new(model, record);
        let mut filter = Filter::new(model, reference);
        let steps = record.len() / SAMPLES;
        let settled = (SETTLES * steps as f64) as usize;
        let (mut sum, mut squares) = (0.0, 0.0);
        let mut told = Simulator::new(
            Coefficients {
                angle_random_walk: reference,
                ..Coefficients::default()
            },
            1.0,
            record.first().map_or(0, |one| one.rate.to_bits()),
        );
        for step in 0..steps {
            let block = step * SAMPLES..(step + 1) * SAMPLES;
            let rates = &prepared.rates[block.clone()];
            let angle: f64 = rates.iter().map(|(rate, _)| rate / RATE_HZ).sum();
            let means: Vec<f64> = prepared
                .series
                .iter()
                .map(|series| series[block.clone()].iter().sum::<f64>() / SAMPLES as f64)
                .collect();
            filter.predict(angle, &means);
            filter.update(told.next().unwrap_or_default());
            if step >= settled {
                let last = block.end - 1;
                let now: Vec<f64> = prepared.series.iter().map(|one| one[last]).collect();
                let (nees, error) = filter.compared(prepared.rates[last].1, &now);
                sum += nees;
                squares += error * error;
            }
        }
        let count = (steps - settled) as f64;
        Self {
            nees: sum / count,
            angle_error: (squares / count).sqrt(),
        }
    }
}

/// A record as the filter takes it.
struct Prepared {
    /// The rates without what is subtracted and behind the notches, each with its true bias, in rad/s.
    rates: Vec<(f64, f64)>,
    /// What each slope is multiplied by.
    series: Vec<Vec<f64>>,
}

impl Prepared {
    fn new(model: &Model, record: &[Truth]) -> Self {
        let mut rates: Vec<(f64, f64)> = record
            .iter()
            .map(|one| (one.rate.to_radians(), one.bias.to_radians()))
            .collect();
        let series: Vec<Vec<f64>> = model
            .subtracted
            .iter()
            .map(|part| part.series(record))
            .collect();
        for (part, series) in model.subtracted.iter().zip(&series) {
            for ((rate, bias), x) in rates.iter_mut().zip(series) {
                *rate -= part.slope * x;
                *bias -= part.slope * x;
            }
        }
        for &frequency_hz in &model.notches_hz {
            notch(&mut rates, frequency_hz);
        }
        Self { rates, series }
    }
}

impl Subtracted {
    /// What the slope is multiplied by, sample by sample.
    fn series(&self, record: &[Truth]) -> Vec<f64> {
        let first = record.first().map_or(0.0, |one| one.temperature);
        // A rate of change is that of a smooth temperature: the thermometer's noise has a large one.
        let lag_s = match self.kind.as_str() {
            "rate_of_change" => Some(SMOOTH_S),
            _ => self.lag_s,
        };
        let mut behind = first;
        let one = |truth: &Truth| {
            let before = behind;
            behind = match lag_s {
                Some(lag_s) => behind + (truth.temperature - behind) / (lag_s * RATE_HZ),
                None => truth.temperature,
            };
            match self.kind.as_str() {
                "rate_of_change" => (behind - before) * RATE_HZ,
                "square" => (behind - self.reference).powi(2),
                _ => behind - self.reference,
            }
        };
        record.iter().map(one).collect()
    }
}

/// Takes out a frequency (Bristow-Johnson, Cookbook formulae for audio equalizer biquad filter coefficients, notch).
fn notch(rates: &mut [(f64, f64)], frequency_hz: f64) {
    let angle = TAU * frequency_hz / RATE_HZ;
    let alpha = 0.5 * NOTCH * angle.sin();
    let (gain, middle) = (1.0 / (1.0 + alpha), -2.0 * angle.cos());
    let first = rates.first().map_or(0.0, |(rate, _)| *rate);
    let (mut x, mut y) = ([first; 2], [first; 2]);
    for (rate, _) in rates {
        let out = gain * (*rate + middle * x[0] + x[1] - middle * y[0] - (1.0 - alpha) * y[1]);
        x = [*rate, x[0]];
        y = [out, y[0]];
        *rate = out;
    }
}

/// The filter: angle, constant bias, processes, and errors of slopes.
struct Filter {
    /// The places of the states that are parts of the bias.
    biases: Vec<usize>,
    /// The place of the first error of a slope.
    slopes: usize,
    state: SVector<f64, STATES>,
    covariance: SMatrix<f64, STATES, STATES>,
    transition: SMatrix<f64, STATES, STATES>,
    noise: SMatrix<f64, STATES, STATES>,
    /// The standard deviation of the angle that it is told, in radians.
    reference: f64,
}

impl Filter {
    fn new(model: &Model, reference: f64) -> Self {
        let mut transition = SMatrix::<f64, STATES, STATES>::identity();
        let mut noise = SMatrix::<f64, STATES, STATES>::zeros();
        let mut covariance = SMatrix::<f64, STATES, STATES>::zeros();
        let h = STEP_S;
        // The angle loses what the biases add to the rate.
        transition[(0, 1)] = -h;
        let walk = model.random_walk.powi(2);
        noise[(0, 0)] = model.noise_density.powi(2) * h + walk * h.powi(3) / 3.0;
        noise[(1, 1)] = walk * h;
        noise[(0, 1)] = -0.5 * walk * h * h;
        noise[(1, 0)] = noise[(0, 1)];
        covariance[(0, 0)] = reference * reference;
        covariance[(1, 1)] = UNKNOWN * UNKNOWN;
        for (at, &(sigma, time_s)) in model.processes.iter().enumerate().take(STATES - 2) {
            let at = at + 2;
            // The exact integral of a first-order process over a step (Gelb, Applied Optimal Estimation, 1974, 3.6).
            let kept = (-h / time_s).exp();
            let square = sigma * sigma;
            transition[(at, at)] = kept;
            transition[(0, at)] = -time_s * (1.0 - kept);
            noise[(at, at)] = square * (1.0 - kept * kept);
            noise[(0, at)] = -square * time_s * (1.0 - kept).powi(2);
            noise[(at, 0)] = noise[(0, at)];
            noise[(0, 0)] +=
                square * time_s * (2.0 * h - time_s * (3.0 - 4.0 * kept + kept * kept));
            covariance[(at, at)] = square;
        }
        let mut next = 2 + model.processes.len().min(STATES - 2);
        // The places of the biases: every oscillation adds its first coordinate.
        let mut biases: Vec<usize> = (1..next).collect();
        for &oscillator in &model.oscillators {
            if next + 2 <= STATES {
                oscillate(&mut transition, &mut noise, next, oscillator);
                covariance[(next, next)] = oscillator.0.powi(2);
                covariance[(next + 1, next + 1)] = oscillator.0.powi(2);
                biases.push(next);
                next += 2;
            }
        }
        let slopes = next;
        for (part, at) in model.subtracted.iter().zip(slopes..STATES) {
            covariance[(at, at)] = part.error * part.error;
        }
        Self {
            biases,
            slopes,
            state: SVector::zeros(),
            covariance,
            transition,
            noise,
            reference,
        }
    }

    /// Adds the angle that the gyro shows over a step, in which what the slopes are multiplied by has these means.
    fn predict(&mut self, angle: f64, means: &[f64]) {
        for (mean, at) in means.iter().zip(self.slopes..STATES) {
            self.transition[(0, at)] = -STEP_S * mean;
        }
        self.state = self.transition * self.state;
        self.state[0] += angle;
        self.covariance =
            self.transition * self.covariance * self.transition.transpose() + self.noise;
    }

    /// Takes an angle that has this error: the gyro does not turn.
    fn update(&mut self, angle: f64) {
        let variance = self.covariance[(0, 0)] + self.reference * self.reference;
        let gain: SVector<f64, STATES> = self.covariance.column(0) / variance;
        let innovation = angle - self.state[0];
        self.state += gain * innovation;
        self.covariance -= gain * gain.transpose() * variance;
    }

    /// The normalised error squared of angle and bias, over two, and the error of the angle. `bias` is the true one, and
    /// `series` is what the slopes are multiplied by.
    fn compared(&self, bias: f64, series: &[f64]) -> (f64, f64) {
        // The bias is the sum of the states behind the angle, the errors of slopes times their series.
        let mut sums = SMatrix::<f64, 2, STATES>::zeros();
        sums[(0, 0)] = 1.0;
        for &at in &self.biases {
            sums[(1, at)] = 1.0;
        }
        for (x, at) in series.iter().zip(self.slopes..STATES) {
            sums[(1, at)] = *x;
        }
        let error = sums * self.state - Vector2::new(0.0, bias);
        let covariance: Matrix2<f64> = sums * self.covariance * sums.transpose();
        let inverse = covariance.try_inverse().unwrap_or_else(Matrix2::zeros);
        (0.5 * error.dot(&(inverse * error)), error[0])
    }
}

/// The parts of a step into which that of an oscillation is divided.
const PARTS: usize = 50;

/// Enters a circular process that decays and turns, whose first coordinate adds to the rate, at a place of the state.
fn oscillate(
    transition: &mut SMatrix<f64, STATES, STATES>,
    noise: &mut SMatrix<f64, STATES, STATES>,
    at: usize,
    (rms, frequency_hz, time_s): (f64, f64, f64),
) {
    let h = STEP_S / PARTS as f64;
    let kept = (-h / time_s).exp();
    let (sine, cosine) = (TAU * frequency_hz * h).sin_cos();
    // The angle and the two coordinates over a part of a step.
    let turn = Matrix3::new(
        1.0,
        -0.5 * h * (1.0 + kept * cosine),
        0.5 * h * kept * sine,
        0.0,
        kept * cosine,
        -kept * sine,
        0.0,
        kept * sine,
        kept * cosine,
    );
    let driven = rms * rms * (1.0 - kept * kept);
    let input = Matrix3::from_diagonal(&Vector3::new(0.0, driven, driven));
    let (mut whole, mut sum) = (Matrix3::identity(), Matrix3::zeros());
    for _ in 0..PARTS {
        whole = turn * whole;
        sum = turn * sum * turn.transpose() + input;
    }
    let places = [0, at, at + 1];
    for (i, &row) in places.iter().enumerate() {
        for (j, &column) in places.iter().enumerate() {
            if row == 0 && column == 0 {
                noise[(0, 0)] += sum[(0, 0)];
            } else {
                transition[(row, column)] = whole[(i, j)];
                noise[(row, column)] = sum[(i, j)];
            }
        }
    }
}
