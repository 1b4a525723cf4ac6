//! A Gauss–Markov process in place of bias instability, for filters that have no model of flicker noise.
//!
//! Flicker noise has no state-space model of finite order, so filters use a Gauss–Markov process. Its
//! Allan deviation has a maximum near one averaging time and falls on both sides. It therefore replaces
//! flicker noise in a limited range of τ. How good the replacement is depends on how far the other
//! effects cover the rest.

use crate::overbound::{GaussMarkovProcess, correlation_times, gauss_markov_shape};
use allanite::{
    Curve, Model,
    effect::{BiasInstability, Effect, GaussMarkov, SampledShape},
};
use allanite_log::OCTAVES;

/// A Gauss–Markov process in place of flicker noise, and how much it changes the model's deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equivalent {
    /// The process, in rate units.
    pub process: GaussMarkovProcess,
    /// Largest change of the deviation over the octaves, in percent.
    pub max_percent: f64,
    /// Root-mean-square change of the deviation over the octaves, in percent.
    pub rms_percent: f64,
}

impl Equivalent {
    /// The process that comes closest to flicker noise with this coefficient of bias instability. It
    /// minimises the sum over the octaves of the squared relative changes of the model's Allan variance.
    /// `squares` are the model's squared coefficients; the one of its flicker noise is not used. `None`
    /// if the model has no flicker noise.
    pub fn of(
        curve: &Curve<OCTAVES>,
        model: &Model,
        squares: &[f64],
        bias_instability: f64,
    ) -> Option<Self> {
        let flicker = model.position(BiasInstability.description().name)?;
        let mut rest = squares.to_vec();
        *rest.get_mut(flicker)? = 0.0;
        let interval_s = curve.interval_s();
        let floor = bias_instability.powi(2)
            * BiasInstability.variance(1.0, &SampledShape::new(interval_s));
        let octaves: Vec<(u32, f64, f64)> = curve
            .points()
            .iter()
            .map(|point| (point.m, floor, model.variance(&rest, point.m, interval_s)))
            .collect();
        let candidates =
            correlation_times(curve).map(|time_s| closest(&octaves, time_s, interval_s));
        let (process, _) = candidates
            .filter(|(process, _)| process.sigma > 0.0)
            .min_by(|(_, a), (_, b)| a.total_cmp(b))?;
        let percent = octaves.iter().map(|&(m, floor, rest)| {
            let replaced = rest + process.variance(m, interval_s);
            100.0 * ((replaced / (rest + floor)).sqrt() - 1.0)
        });
        let percent: Vec<f64> = percent.collect();
        let sum: f64 = percent.iter().map(|x| x * x).sum();
        Some(Self {
            process,
            max_percent: percent.iter().map(|x| x.abs()).fold(0.0, f64::max),
            rms_percent: (sum / percent.len() as f64).sqrt(),
        })
    }
}

/// The best process with this correlation time, and its sum of squared relative differences.
fn closest(
    octaves: &[(u32, f64, f64)],
    correlation_time_s: f64,
    interval_s: f64,
) -> (GaussMarkovProcess, f64) {
    let shape = gauss_markov_shape(correlation_time_s, interval_s);
    let pairs = octaves.iter().map(|&(m, floor, rest)| {
        let total = floor + rest;
        let unit = GaussMarkov.variance(f64::from(m), &shape);
        (unit / total, floor / total)
    });
    let pairs: Vec<(f64, f64)> = pairs.collect();
    let product: f64 = pairs.iter().map(|(unit, wanted)| unit * wanted).sum();
    let norm: f64 = pairs.iter().map(|(unit, _)| unit * unit).sum();
    let square = product / norm;
    let misfit = pairs
        .iter()
        .map(|(unit, wanted)| (square * unit - wanted).powi(2));
    let process = GaussMarkovProcess {
        sigma: square.sqrt(),
        correlation_time_s,
    };
    (process, misfit.sum())
}
