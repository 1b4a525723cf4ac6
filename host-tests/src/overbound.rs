//! A conservative model: simple noise that no octave of a curve exceeds.
//!
//! Navigation filters know white noise, a random walk of the bias and, some of them, a Gauss–Markov
//! process. The best fit of those to a curve lies below it about as often as above, and a filter that
//! believes less noise than there is becomes overconfident. The overbound lies above everywhere.
//!
//! # Definition
//!
//! With `u_k` the upper end of the 95 % interval of octave `k`, and `A_i(τ)` the Allan variance of effect
//! `i` for a coefficient of one, its squared coefficients `β` are those of
//!
//! ```text
//! least  Σ_k (Σ_i β_i A_i(τ_k) / u_k − 1)   subject to   Σ_i β_i A_i(τ_k) ≥ u_k for every k,   β ≥ 0
//! ```
//!
//! the least total relative excess of variance of all models that are above the limit at every octave:
//! a linear program. With a Gauss–Markov process its correlation time is that of a grid, four to the
//! octave from the shortest to the longest averaging time, whose excess is least. Every coefficient
//! above zero is needed: lower any one alone, and some octave's limit is above the model.
//!
//! Above the curve is above the record only: what happens beyond its longest averaging time nobody has
//! seen.

use crate::{confidence::Limits, log::OCTAVES};
use allanite::{
    Curve,
    effect::{AngleRandomWalk, Effect, GaussMarkov, RateRandomWalk, SampledShape},
};
use nalgebra::{Matrix3, Vector3};

/// Most effects of an overbound.
const MOST: usize = 3;

/// Correlation times tried for each factor of two.
const STEPS_PER_OCTAVE: u32 = 4;

/// How far above the limit the model is put, so that rounding its coefficients leaves it above.
const MARGIN: f64 = 1e-12;

/// White noise, a random walk and perhaps a Gauss–Markov process, in rate units and seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overbound {
    /// Angle random walk N: density of the white noise, in rate · √s.
    pub noise_density: f64,
    /// Rate random walk K, in rate / √s; 0 where the curve never needs it.
    pub random_walk: f64,
    /// A Gauss–Markov process, where one was asked for and lowers the excess.
    pub gauss_markov: Option<GaussMarkovProcess>,
}

/// Exponentially correlated noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussMarkovProcess {
    /// Root-mean-square of the process, in rate units.
    pub sigma: f64,
    /// Correlation time T_c, in seconds.
    pub correlation_time_s: f64,
}

impl GaussMarkovProcess {
    /// Allan variance at an averaging factor, in rate units squared.
    pub fn variance(&self, m: u32, interval_s: f64) -> f64 {
        let shape = gauss_markov_shape(self.correlation_time_s, interval_s);
        self.sigma * self.sigma * GaussMarkov.variance(f64::from(m), &shape)
    }
}

impl Overbound {
    /// The least white noise and random walk above a curve's upper limits. `None` without octaves, or
    /// where a limit is not finite.
    pub fn of(curve: &Curve<OCTAVES>, limits: &[Limits]) -> Option<Self> {
        let plain = SampledShape::new(curve.interval_s());
        let effects: [(&dyn Effect, SampledShape); 2] =
            [(&AngleRandomWalk, plain), (&RateRandomWalk, plain)];
        let [white, walk, _] = least(curve, limits, &effects)?.coefficients;
        Some(Self {
            noise_density: white,
            random_walk: walk,
            gauss_markov: None,
        })
    }

    /// The same with a Gauss–Markov process.
    pub fn with_gauss_markov(curve: &Curve<OCTAVES>, limits: &[Limits]) -> Option<Self> {
        let plain = SampledShape::new(curve.interval_s());
        let candidates = correlation_times(curve).filter_map(|time_s| {
            let effects: [(&dyn Effect, SampledShape); MOST] = [
                (&AngleRandomWalk, plain),
                (&RateRandomWalk, plain),
                (&GaussMarkov, gauss_markov_shape(time_s, curve.interval_s())),
            ];
            Some((time_s, least(curve, limits, &effects)?))
        });
        let (correlation_time_s, best) =
            candidates.min_by(|(_, a), (_, b)| a.excess.total_cmp(&b.excess))?;
        let [white, walk, sigma] = best.coefficients;
        Some(Self {
            noise_density: white,
            random_walk: walk,
            gauss_markov: (sigma > 0.0).then_some(GaussMarkovProcess {
                sigma,
                correlation_time_s,
            }),
        })
    }

    /// Allan variance at an averaging factor, in rate units squared.
    pub fn variance(&self, m: u32, interval_s: f64) -> f64 {
        let plain = SampledShape::new(interval_s);
        let m_samples = f64::from(m);
        let of_process = |process: GaussMarkovProcess| process.variance(m, interval_s);
        self.noise_density.powi(2) * AngleRandomWalk.variance(m_samples, &plain)
            + self.random_walk.powi(2) * RateRandomWalk.variance(m_samples, &plain)
            + self.gauss_markov.map_or(0.0, of_process)
    }

    /// The same in units of which `factor` make one of these.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            noise_density: factor * self.noise_density,
            random_walk: factor * self.random_walk,
            gauss_markov: self.gauss_markov.map(|process| GaussMarkovProcess {
                sigma: factor * process.sigma,
                ..process
            }),
        }
    }
}

/// Correlation times from the shortest averaging time to the longest.
pub(crate) fn correlation_times(curve: &Curve<OCTAVES>) -> impl Iterator<Item = f64> + use<> {
    let ends = curve.points().first().zip(curve.points().last());
    let (first, octaves) = ends.map_or((1.0, 0), |(first, last)| {
        (first.tau_s, (last.m / first.m).ilog2())
    });
    (0..=octaves * STEPS_PER_OCTAVE)
        .map(move |step| first * (f64::from(step) / f64::from(STEPS_PER_OCTAVE)).exp2())
}

/// Where a Gauss–Markov process is evaluated.
pub(crate) fn gauss_markov_shape(correlation_time_s: f64, interval_s: f64) -> SampledShape {
    let mut shape = SampledShape::new(interval_s);
    shape.parameters[0] = correlation_time_s;
    shape
}

/// A solution of the linear program.
struct Least {
    coefficients: [f64; MOST],
    /// What is minimised, but for a constant.
    excess: f64,
}

/// The least model of these effects above the limits.
fn least(
    curve: &Curve<OCTAVES>,
    limits: &[Limits],
    effects: &[(&dyn Effect, SampledShape)],
) -> Option<Least> {
    // Row k: what each effect reaches of the limit, per squared coefficient; columns scaled to one.
    let mut rows = vec![[0.0; MOST]; curve.points().len().min(limits.len())];
    let mut scales = [1.0; MOST];
    for (i, (effect, shape)) in effects.iter().enumerate() {
        for ((row, point), limit) in rows.iter_mut().zip(curve.points()).zip(limits) {
            row[i] = effect.variance(f64::from(point.m), shape) / limit.upper;
        }
        scales[i] = rows.iter().map(|row| row[i]).fold(0.0, f64::max);
        if !(scales[i].is_finite() && scales[i] > 0.0) {
            return None;
        }
        rows.iter_mut().for_each(|row| row[i] /= scales[i]);
    }
    let (squares, excess) = vertex(&rows, effects.len())?;
    // Just above, where rounding might leave it just below.
    let lowest = rows.iter().map(|row| dot(row, &squares));
    let lift = (1.0 + MARGIN) / lowest.fold(f64::INFINITY, f64::min);
    let coefficients = std::array::from_fn(|i| (lift * squares[i] / scales[i]).sqrt());
    Some(Least {
        coefficients,
        excess,
    })
}

/// The optimum lies in a vertex: as many octaves touch the model as it has coefficients above zero.
/// There are so few vertices that all are tried.
fn vertex(rows: &[[f64; MOST]], effects: usize) -> Option<([f64; MOST], f64)> {
    const ROUNDING: f64 = 1e-9;
    let cost: [f64; MOST] = std::array::from_fn(|i| rows.iter().map(|row| row[i]).sum());
    let mut best: Option<([f64; MOST], f64)> = None;
    for support in 1_u32..1 << effects {
        let count = support.count_ones() as usize;
        each_subset(rows.len(), count, &mut |touching| {
            let Some(squares) = touch(rows, support, touching) else {
                return;
            };
            let total = dot(&cost, &squares);
            let better = best.is_none_or(|(_, least)| total < least);
            if better && rows.iter().all(|row| dot(row, &squares) >= 1.0 - ROUNDING) {
                best = Some((squares, total));
            }
        });
    }
    best
}

/// The coefficients of some effects that touch as many octaves, if none is negative.
fn touch(rows: &[[f64; MOST]], support: u32, octaves: &[usize]) -> Option<[f64; MOST]> {
    let (mut matrix, mut right) = (Matrix3::<f64>::identity(), Vector3::<f64>::zeros());
    let effects: Vec<usize> = (0..MOST).filter(|i| support >> i & 1 == 1).collect();
    for (r, &octave) in octaves.iter().enumerate() {
        for (c, &effect) in effects.iter().enumerate() {
            matrix[(r, c)] = rows[octave][effect];
        }
        right[r] = 1.0;
    }
    let solution = matrix.lu().solve(&right)?;
    let mut squares = [0.0; MOST];
    for (c, &effect) in effects.iter().enumerate() {
        squares[effect] = solution[c];
    }
    let valid = |square: &f64| square.is_finite() && *square >= 0.0;
    squares.iter().all(valid).then_some(squares)
}

fn dot(a: &[f64; MOST], b: &[f64; MOST]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Every set of `count` of the numbers below `end`, ascending.
fn each_subset(end: usize, count: usize, each: &mut impl FnMut(&[usize])) {
    let mut chosen: Vec<usize> = (0..count).collect();
    if count > end {
        return;
    }
    loop {
        each(&chosen);
        // The last that can still go up, and all behind it as low as they can be.
        let Some(i) = (0..count).rev().find(|&i| chosen[i] < end - count + i) else {
            return;
        };
        chosen[i] += 1;
        for j in i + 1..count {
            chosen[j] = chosen[j - 1] + 1;
        }
    }
}
