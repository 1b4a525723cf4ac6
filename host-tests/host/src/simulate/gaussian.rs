//! Gaussian noise with any autocovariance.

use super::{
    Source,
    kernel::autocovariance,
    random::{Random, normal},
};
use allanite::effect::{Effect, SampledShape};
use rustfft::{Fft, FftPlanner, num_complex::Complex};
use std::sync::Arc;

/// The shortest and the longest moving average, in samples.
const SHORTEST: usize = 1 << 10;
const LONGEST: usize = 1 << 21;

/// The moving average is long enough if the autocovariance changes by less than this share of the
/// variance beyond a fifth of its length. Chosen by hand; no study varies it.
const FORGOTTEN: f64 = 1e-9;

/// Gaussian noise with a given autocovariance: a moving average over white noise.
///
/// The weights are the inverse Fourier transform of the square root of the spectrum, and the
/// spectrum is the transform of the autocovariance on a circle (circulant embedding: Davies & Harte
/// 1987; Dietrich & Newsam 1997). The weights are even and die away before they meet on the far
/// side of the circle. They therefore give the same noise on a line, where it never ends and does
/// not repeat.
///
/// An effect with infinite memory, such as a random walk, has an autocovariance that is known only
/// up to a constant. The constant is chosen so that the autocovariance vanishes at a fifth of the
/// circle, and from there on it is taken as zero. The differences of the noise are therefore right
/// over lags of up to 400 000 samples. A convex function that falls to zero, as for a random walk
/// or flicker noise, remains an autocovariance.
pub(super) struct Gaussian {
    /// The transform of the weights, which are padded with as many zeros.
    transfer: Vec<Complex<f64>>,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
    /// Two blocks of noise, one in the real and one in the imaginary part, followed by what they
    /// contribute to the next block.
    work: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
    carried: Vec<f64>,
    /// The samples that are ready, and the index of the next one.
    ready: Vec<f64>,
    at: usize,
}

impl Gaussian {
    /// The noise of an effect with the given coefficient.
    pub(super) fn new(
        effect: &dyn Effect,
        shape: &SampledShape,
        coefficient: f64,
        random: &mut Random,
    ) -> Self {
        let weights = weights(effect, shape);
        let length = 2 * weights.len();
        let mut planner = FftPlanner::new();
        let (forward, inverse) = (
            planner.plan_fft_forward(length),
            planner.plan_fft_inverse(length),
        );
        let scale = coefficient / length as f64;
        let mut transfer: Vec<Complex<f64>> = weights
            .iter()
            .map(|weight| Complex::new(weight * scale, 0.0))
            .collect();
        transfer.resize(length, Complex::default());
        forward.process(&mut transfer);
        let scratch = forward
            .get_inplace_scratch_len()
            .max(inverse.get_inplace_scratch_len());
        let mut gaussian = Self {
            transfer,
            forward,
            inverse,
            work: vec![Complex::default(); length],
            scratch: vec![Complex::default(); scratch],
            carried: vec![0.0; length / 2],
            ready: Vec::with_capacity(length),
            at: 0,
        };
        // The first block is dropped, because it lacks the contribution of earlier noise.
        gaussian.fill(random);
        // The first of the two blocks lacks the noise before it.
        gaussian.at = gaussian.carried.len();
        gaussian
    }

    /// Makes two blocks of samples.
    fn fill(&mut self, random: &mut Random) {
        let block = self.carried.len();
        let (noise, padding) = self.work.split_at_mut(block);
        for value in noise {
            *value = Complex::new(normal(random), normal(random));
        }
        padding.fill(Complex::default());
        self.forward
            .process_with_scratch(&mut self.work, &mut self.scratch);
        for (value, transfer) in self.work.iter_mut().zip(&self.transfer) {
            *value *= transfer;
        }
        self.inverse
            .process_with_scratch(&mut self.work, &mut self.scratch);
        let (first, second) = self.work.split_at(block);
        self.ready.clear();
        let carried = self.carried.iter();
        self.ready.extend(
            first
                .iter()
                .zip(carried)
                .map(|(own, before)| own.re + before),
        );
        let both = first.iter().zip(second);
        self.ready
            .extend(both.map(|(own, before)| own.im + before.re));
        self.carried.clear();
        self.carried.extend(second.iter().map(|value| value.im));
        self.at = 0;
    }
}

impl Source for Gaussian {
    fn next(&mut self, random: &mut Random) -> f64 {
        if self.at == self.ready.len() {
            self.fill(random);
        }
        self.at += 1;
        self.ready[self.at - 1]
    }
}

/// The weights of the moving average, for a coefficient of one. The largest weight is in the
/// middle.
fn weights(effect: &dyn Effect, shape: &SampledShape) -> Vec<f64> {
    let length = length(effect, shape);
    let end = end(length);
    let least = autocovariance(effect, shape, end);
    let mut circle = vec![Complex::default(); length];
    for lag in 0..end {
        let value = Complex::new(autocovariance(effect, shape, lag) - least, 0.0);
        circle[lag] = value;
        circle[(length - lag) % length] = value;
    }
    let mut planner = FftPlanner::new();
    planner.plan_fft_forward(length).process(&mut circle);
    for value in &mut circle {
        // Rounding makes a spectrum slightly negative where it should be zero.
        *value = Complex::new(value.re.max(0.0).sqrt() / length as f64, 0.0);
    }
    planner.plan_fft_inverse(length).process(&mut circle);
    circle.rotate_right(length / 2);
    // The weights of a random walk do not vanish on the far side of the circle. Subtracting a
    // constant removes the jump there.
    let jump = if length == LONGEST { circle[0].re } else { 0.0 };
    circle.iter().map(|weight| weight.re - jump).collect()
}

/// The lag at which the autocovariance ends, for a given number of weights. The weights have kinks
/// at its multiples. Half the circle is not a multiple of it, because the weights should be smooth
/// there.
fn end(length: usize) -> usize {
    length / 5
}

/// The number of weights: a power of two, beyond a fifth of which the autocovariance no longer
/// changes.
fn length(effect: &dyn Effect, shape: &SampledShape) -> usize {
    let variance = autocovariance(effect, shape, 0) - autocovariance(effect, shape, LONGEST / 2);
    let forgets = |&length: &usize| {
        let last = autocovariance(effect, shape, length / 2);
        // The step is odd, so that the lags sample an oscillation at many phases.
        let mut lags = (end(length)..length / 2).step_by((length / 512) | 1);
        lags.all(|lag| {
            (autocovariance(effect, shape, lag) - last).abs() <= FORGOTTEN * variance.abs()
        })
    };
    let mut lengths = std::iter::successors(Some(SHORTEST), |length| Some(2 * length));
    lengths
        .find(|length| *length >= LONGEST || forgets(length))
        .unwrap_or(LONGEST)
}

#[cfg(test)]
mod tests {
    use super::{super::filtered::Filtered, *};
    use allanite::effect::{Distribution, EXPLAINED, GaussMarkov, IEEE_952};
    use rand::SeedableRng;

    /// The autocovariance of the moving average.
    fn of(weights: &[f64], lag: usize) -> f64 {
        let pairs = weights.iter().zip(&weights[lag..]);
        pairs.map(|(one, other)| one * other).sum()
    }

    /// `σ² = Σ_{|i|<m} (m − |i|) [r(i) − r(i + m)]/m²`.
    fn allan_variance(autocovariance: &[f64], m: usize) -> f64 {
        let at = |lag: isize| autocovariance[lag.unsigned_abs()];
        let m = m as isize;
        let sum: f64 = (1 - m..m)
            .map(|i| (m - i.abs()) as f64 * (at(i) - at(i + m)))
            .sum();
        sum / (m * m) as f64
    }

    /// Wherever a record is looked at: at its beginning, and on both sides of where blocks meet.
    #[test]
    fn noise_is_stationary_from_the_first_sample_on() {
        const SEEDS: u64 = 1000;
        let shape = SampledShape::known(0.01, [0.1]);
        let block = weights(&GaussMarkov, &shape).len();
        let places = [0, 1, block - 1, block, 2 * block, 3 * block - 1, 3 * block];
        let mut squares = [0.0; 7];
        let mut steps = [0.0; 7];
        for seed in 0..SEEDS {
            let mut random = Random::seed_from_u64(seed);
            let mut gaussian = Gaussian::new(&GaussMarkov, &shape, 2.0, &mut random);
            let record: Vec<f64> = (0..=3 * block + 1)
                .map(|_| gaussian.next(&mut random))
                .collect();
            for (i, &place) in places.iter().enumerate() {
                squares[i] += record[place].powi(2) / SEEDS as f64;
                steps[i] += (record[place + 1] - record[place]).powi(2) / SEEDS as f64;
            }
        }
        // Mean squares of 1000 normal numbers scatter by 4.5 %.
        let step = 2.0 * 4.0 * (1.0 - (-0.1_f64).exp());
        for (i, place) in places.iter().enumerate() {
            assert!(
                (squares[i] / 4.0 - 1.0).abs() < 0.2,
                "at {place}: {squares:?}"
            );
            assert!((steps[i] / step - 1.0).abs() < 0.2, "at {place}: {steps:?}");
        }
    }

    #[test]
    fn every_gaussian_effect_is_simulated_with_its_own_allan_variance() {
        let mut tried = 0;
        for effect in EXPLAINED {
            if effect.description().distribution != Distribution::Gaussian {
                continue;
            }
            let has_recursion = |parameters| {
                let shape = SampledShape {
                    interval_s: 0.01,
                    parameters,
                };
                Filtered::new(effect, &shape, 1.0, &mut Random::seed_from_u64(1)).is_some()
            };
            if effect.typical_shapes().iter().copied().any(has_recursion) {
                continue;
            }
            for &parameters in effect.typical_shapes() {
                let shape = SampledShape {
                    interval_s: 0.01,
                    parameters,
                };
                let effect: &dyn Effect = effect;
                let weights = weights(effect, &shape);
                let autocovariance: Vec<f64> = (0..256).map(|lag| of(&weights, lag)).collect();
                for m in [1_usize, 2, 8, 100] {
                    let simulated = allan_variance(&autocovariance, m);
                    let expected = effect.variance(m as f64, &shape);
                    // Where the memory is infinite, it is cut off here. The simulator uses other
                    // sources for those of the five terms of which this is true.
                    let is_cut = weights.len() == LONGEST;
                    let is_term = IEEE_952.iter().any(|term| term.name() == effect.name());
                    let tolerance = if is_term || is_cut { 1e-3 } else { 1e-6 };
                    assert!(
                        (simulated / expected - 1.0).abs() < tolerance,
                        "{} {parameters:?}, m = {m}: {simulated:e}, expected {expected:e}",
                        effect.name()
                    );
                    tried += 1;
                }
            }
        }
        assert!(tried >= 40, "{tried}");
    }
}
