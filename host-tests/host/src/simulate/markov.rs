//! Exponentially correlated noise, sample by sample.

use super::{
    Source,
    random::{Random, normal},
};
use allanite::effect::{Effect, SampledShape};

/// A Gauss–Markov process of first order, by its recursion, which is exact for any correlation time: a moving average
/// would have to be longer than the record.
pub(super) struct Markov {
    rate: f64,
    /// What is left of the rate after a sample.
    decay: f64,
    /// The standard deviation of what is new in a sample.
    innovation: f64,
}

impl Markov {
    /// The noise of [`GaussMarkov`](allanite::effect::GaussMarkov); `None` for any other effect. The first sample is
    /// drawn from the stationary distribution.
    pub(super) fn new(
        effect: &dyn Effect,
        shape: &SampledShape,
        coefficient: f64,
        random: &mut Random,
    ) -> Option<Self> {
        if effect.name() != "gauss_markov" {
            return None;
        }
        let steps = shape.interval_s / shape.parameters[0];
        Some(Self {
            rate: coefficient * normal(random),
            decay: (-steps).exp(),
            // 1 − e^(−2τ₀/T_c), without the cancellation of a long correlation time.
            innovation: coefficient * (-(-2.0 * steps).exp_m1()).sqrt(),
        })
    }
}

impl Source for Markov {
    fn next(&mut self, random: &mut Random) -> f64 {
        let rate = self.rate;
        self.rate = self.decay * rate + self.innovation * normal(random);
        rate
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use allanite::effect::GaussMarkov;
    use rand::SeedableRng;

    /// Over many correlation times, and where a correlation time is longer than any moving average.
    #[test]
    fn the_autocovariance_is_exponential_at_any_correlation_time() {
        const SEEDS: u64 = 4000;
        for (time_s, lag) in [(0.02, 2_u64), (5.0, 700), (600.0, 120_000)] {
            let interval_s = 0.01;
            let shape = SampledShape::known(interval_s, [time_s]);
            // A lag is jumped over in one step, whose recursion is that of as many samples.
            let jumped = SampledShape::known(lag as f64 * interval_s, [time_s]);
            let [mut first, mut next, mut later] = [0.0; 3];
            for seed in 0..SEEDS {
                let mut random = Random::seed_from_u64(seed);
                let mut markov = Markov::new(&GaussMarkov, &shape, 2.0, &mut random).unwrap();
                let [a, b] = [markov.next(&mut random), markov.next(&mut random)];
                first += a * a;
                next += (b - a).powi(2);
                let mut markov = Markov::new(&GaussMarkov, &jumped, 2.0, &mut random).unwrap();
                later += markov.next(&mut random) * markov.next(&mut random);
            }
            // Means of as many squares scatter by the root of two over their number; eight deviations are allowed.
            let n = SEEDS as f64;
            let scatter = 8.0 * (2.0 / n).sqrt();
            let (variance, change) = (first / n / 4.0, next / n / -(-interval_s / time_s).exp_m1());
            let product = later / n / 4.0 - (-(lag as f64) * interval_s / time_s).exp();
            assert!((variance - 1.0).abs() < scatter, "{time_s} s: {variance}");
            assert!((change / 8.0 - 1.0).abs() < scatter, "{time_s} s: {change}");
            assert!(product.abs() < scatter, "{time_s} s, lag {lag}: {product}");
        }
    }
}
