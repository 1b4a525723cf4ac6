//! The overbound: a conservative model of simple noise that no octave of a curve exceeds.
//!
//! Navigation filters have models of white noise, of a random walk of the bias and, some of them, of a
//! Gauss–Markov process. The best fit of these to a curve lies below it about as often as above. A
//! filter that assumes too little noise becomes overconfident. The overbound lies above the curve
//! everywhere.
//!
//! # Definition
//!
//! Let `u_k` be the upper end of the 95 % interval of octave `k`, and `A_i(τ)` the Allan variance of
//! effect `i` for a coefficient of one. The squared coefficients `β` of the overbound solve the linear
//! program
//!
//! ```text
//! minimise  Σ_k (Σ_i β_i A_i(τ_k) / u_k − 1)   subject to   Σ_i β_i A_i(τ_k) ≥ u_k for every k,   β ≥ 0
//! ```
//!
//! The overbound is the model above the limit at every octave that has the smallest total relative
//! excess of variance. The correlation time of a Gauss–Markov process is taken from a grid with four
//! values per octave, from the shortest to the longest averaging time; the value with the smallest
//! excess is used. Every coefficient above zero is needed: if any one of them were lower, the limit of
//! some octave would be above the model.
//!
//! The overbound says nothing about averaging times beyond the longest one of the record.

use crate::confidence::Limits;
use allanite::{
    Curve,
    effect::{AngleRandomWalk, Effect, GaussMarkov, RateRandomWalk, SampledShape},
};
use allanite_log::OCTAVES;
use nalgebra::{Matrix3, Vector3};

/// Largest number of effects in an overbound.
const MOST: usize = 3;

/// Number of correlation times tried for each factor of two. Chosen by hand; no study varies it.
const STEPS_PER_OCTAVE: u32 = 4;

/// Relative margin of the model above the limit, so that rounding its coefficients leaves it above.
/// Chosen by hand: it is some thousand times the rounding of a sum of three terms.
const MARGIN: f64 = 1e-12;

/// White noise, a random walk and perhaps a Gauss–Markov process, in rate units and seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overbound {
    /// Angle random walk N, the density of the white noise, in rate units · √s.
    pub noise_density: f64,
    /// Rate random walk K, in rate units / √s; 0 if the curve does not need it.
    pub random_walk: f64,
    /// A Gauss–Markov process, if one was requested and lowers the excess.
    pub gauss_markov: Option<GaussMarkovProcess>,
}

/// A Gauss–Markov process: exponentially correlated noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussMarkovProcess {
    /// Root-mean-square of the process, in rate units.
    pub sigma: f64,
    /// Correlation time T_c, in seconds.
    pub correlation_time_s: f64,
}

impl GaussMarkovProcess {
    /// A process with this correlation time that over shorter times is a random walk, given in rate units/√s.
    pub fn of_walk(walk: f64, correlation_time_s: f64) -> Self {
        Self {
            sigma: walk * (0.5 * correlation_time_s).sqrt(),
            correlation_time_s,
        }
    }

    /// The density of the white noise that drives the process, `σ √(2/T)`, in rate units/√s.
    pub fn driving(self) -> f64 {
        self.sigma * (2.0 / self.correlation_time_s).sqrt()
    }

    /// Allan variance at an averaging factor, in rate units squared.
    pub fn variance(&self, m: u32, interval_s: f64) -> f64 {
        let shape = gauss_markov_shape(self.correlation_time_s, interval_s);
        self.sigma * self.sigma * GaussMarkov.variance(f64::from(m), &shape)
    }
}

impl Overbound {
    /// The smallest white noise and random walk above the upper limits of a curve. `None` if there are
    /// no octaves or a limit is not finite.
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

    /// The overbound with white noise, a random walk and a Gauss–Markov process. `None` as for
    /// [`of`](Self::of).
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

    /// The overbound in another rate unit; `factor` is the size of the present unit in that unit.
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

/// The grid of correlation times, from the shortest averaging time to the longest.
pub(crate) fn correlation_times(curve: &Curve<OCTAVES>) -> impl Iterator<Item = f64> + use<> {
    let ends = curve.points().first().zip(curve.points().last());
    let (first, octaves) = ends.map_or((1.0, 0), |(first, last)| {
        (first.tau_s, (last.m / first.m).ilog2())
    });
    (0..=octaves * STEPS_PER_OCTAVE)
        .map(move |step| first * (f64::from(step) / f64::from(STEPS_PER_OCTAVE)).exp2())
}

/// The shape at which a Gauss–Markov process is evaluated.
pub(crate) fn gauss_markov_shape(correlation_time_s: f64, interval_s: f64) -> SampledShape {
    let mut shape = SampledShape::new(interval_s);
    shape.parameters[0] = correlation_time_s;
    shape
}

/// A solution of the linear program.
struct Least {
    coefficients: [f64; MOST],
    /// The minimised sum, except for a constant.
    excess: f64,
}

/// The smallest model of these effects above the limits.
fn least(
    curve: &Curve<OCTAVES>,
    limits: &[Limits],
    effects: &[(&dyn Effect, SampledShape)],
) -> Option<Least> {
    // Row k has the variance of each effect relative to the limit, for a squared coefficient of one.
    // Each column is scaled so that its maximum is one.
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
    // The model is lifted just above the limit, because rounding might leave it just below.
    let lowest = rows.iter().map(|row| dot(row, &squares));
    let lift = (1.0 + MARGIN) / lowest.fold(f64::INFINITY, f64::min);
    let coefficients = std::array::from_fn(|i| (lift * squares[i] / scales[i]).sqrt());
    Some(Least {
        coefficients,
        excess,
    })
}

/// The optimal vertex and its cost. The optimum of a linear program is at a vertex, where the model
/// touches as many octaves as it has coefficients above zero. There are so few vertices that all of them
/// are tried.
fn vertex(rows: &[[f64; MOST]], effects: usize) -> Option<([f64; MOST], f64)> {
    // The relative error that is allowed to an octave on which the model lies; chosen by hand.
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

/// The squared coefficients of the effects in `support` for which the model touches these octaves, or
/// `None` if one is negative or they are not unique. There are as many octaves as effects.
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

/// Calls `each` with every set of `count` numbers below `end`, in ascending order.
fn each_subset(end: usize, count: usize, each: &mut impl FnMut(&[usize])) {
    let mut chosen: Vec<usize> = (0..count).collect();
    if count > end {
        return;
    }
    loop {
        each(&chosen);
        // The last number that can still rise is raised, and all behind it are set as low as possible.
        let Some(i) = (0..count).rev().find(|&i| chosen[i] < end - count + i) else {
            return;
        };
        chosen[i] += 1;
        for j in i + 1..count {
            chosen[j] = chosen[j - 1] + 1;
        }
    }
}
