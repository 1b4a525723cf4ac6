//! The density of the noise between the bins of a level, and how far sums of bins scatter.

use super::{WHITE_DENSITY, density::Bin, expected::densities_from, overlap::Lags, window::places};
use crate::{
    limits::MAX_SEGMENT,
    list::numbered,
    numerics::real::{Real, real},
    theory::effect::{Effect, SampledShape},
};

/// The number of places between a bin and the next one.
const PER_BIN: usize = 4;

/// The first place. The window of the longer segments spreads a constant to their bins 0 and 1.
const FIRST: usize = 2;

/// The number of places within which a bin sees noise, on either side.
const REACH: usize = 2 * PER_BIN;

/// The transform of the Hann window in its main lobe, at distances of 0, ¼, … of a bin, relative to its largest value:
/// `sin(πx)/(πx(1 − x²))`. Beyond two bins it is below 3 %, and taken for zero.
const LOBE: [Real; REACH] = [
    1.0, 0.960_338, 0.848_826, 0.686_005, 0.5, 0.320_136, 0.169_765, 0.062_364,
];

/// The sum of the squares of the [`LOBE`] over whole bins, at any place between them.
const LOBE_SQUARED: Real = 1.5;

/// The factor of [`Fine::variance`]: `2 (P/2)⁴/(P²(Σw²)²)` with `Σw² = 3P/8`.
const SCALE: Real = 8.0 / 9.0;

/// The density of the noise of a level, four times as fine as its bins.
///
/// It is the [expected one](super::expected_densities) of segments four times as long, so that a resonance that is
/// narrower than a bin keeps most of its height. Where there are no segments as long, it is interpolated.
pub(crate) struct Fine {
    length: usize,
    densities: [Real; PLACES],
}

/// The places up to half the rate of the blocks.
const PLACES: usize = PER_BIN * MAX_SEGMENT / 2 + 1;

impl Fine {
    /// No noise yet, for segments of `length` blocks.
    pub(crate) const fn new(length: usize) -> Self {
        Self {
            length,
            densities: [0.0; PLACES],
        }
    }

    /// Adds a random effect with this squared coefficient, for blocks of `block` samples.
    #[inline(never)]
    pub(crate) fn add(
        &mut self,
        effect: &dyn Effect,
        shape: &SampledShape,
        block: u32,
        square: Real,
    ) {
        let long = self.length.saturating_mul(PER_BIN).min(MAX_SEGMENT);
        let mut coarse = [0.0; MAX_SEGMENT / 2];
        densities_from(2, effect, shape, long, block, &mut coarse);
        let at = |k: usize| {
            let last = (long / 2).saturating_sub(3);
            coarse
                .get(k.saturating_sub(2).min(last))
                .copied()
                .unwrap_or(0.0)
        };
        let ratio = (self.length.saturating_mul(PER_BIN) / long.max(1)).max(1);
        for (place, density) in numbered(self.densities.iter_mut()).skip(FIRST) {
            let (k, share) = (place / ratio, real(place % ratio));
            let (one, next) = (at(k), at(k.saturating_add(1)));
            *density += square * (one + (next - one) * share / real(ratio.max(1)));
        }
    }

    /// Lets the noise pass a filter, which leaves this density of white noise with a coefficient of one.
    pub(crate) fn pass(&mut self, filter: &Self) {
        for (density, filter) in self.densities.iter_mut().zip(&filter.densities) {
            *density *= filter / Real::from(WHITE_DENSITY);
        }
    }

    /// Adds other noise of the same level.
    pub(crate) fn add_all(&mut self, other: &Self) {
        for (density, other) in self.densities.iter_mut().zip(&other.densities) {
            *density += other;
        }
    }

    /// The density at a place. Above half the rate of the blocks, it is that of the mirrored place.
    fn density(&self, place: usize) -> Real {
        let whole = self.length.saturating_mul(PER_BIN);
        let place = place.min(whole.saturating_sub(place));
        self.densities.get(place).copied().unwrap_or(0.0)
    }

    /// The places that a bin can see.
    fn places(&self) -> impl Iterator<Item = usize> + use<> {
        let half = self.length.saturating_mul(PER_BIN / 2);
        FIRST..half.saturating_add(REACH)
    }

    /// The variance of a sum of the level's densities, each times its weight, for noise that is not the same over the width
    /// of a bin.
    ///
    /// A segment's amplitude in bin `k` is the noise at the frequencies `x` around it, each times the window's transform
    /// `W(k − x)`. The segments follow each other by half, so that the noise at frequencies that are two bins apart
    /// varies together in the mean of `n` segments, and no other one does:
    ///
    /// ```text
    /// Var(Σ a_k P_k) = (8/9n) Σ_q ∫ s(x) s(x + 2q) [Σ_k a_k W(k − x) W(k − x − 2q)]² dx,     q = −1, 0, 1
    /// ```
    ///
    /// with the density `s` and `W(0) = 1`: the variance of a quadratic form of Gaussian noise (Isserlis 1918), in which
    /// the sum over pairs of segments leaves these frequencies alone.
    #[inline(never)]
    pub(crate) fn variance(&self, weights: &Sum, segments: u32) -> Real {
        let mut sum = 0.0;
        for place in self.places() {
            let here = self.density(place);
            let own = weights.product(place, place) * here;
            sum += own * own;
            let below = place.saturating_sub(REACH);
            if below >= FIRST {
                let beside = weights.product(place, below);
                sum += 2.0 * here * self.density(below) * (beside * beside);
            }
        }
        SCALE / real(PER_BIN) * sum / real(segments)
    }

    /// What a sum of the level's densities, each times its weight, has in common with any other sum: see
    /// [`Lags::covariance`].
    #[inline(never)]
    pub(crate) fn lags(&self, weights: &Sum) -> Lags {
        // Half the places are enough for the distances within a segment, if the table has their angles.
        let step = if 2 * self.length <= MAX_SEGMENT {
            PER_BIN / 2
        } else {
            PER_BIN
        };
        let turn = places(self.length.saturating_mul(PER_BIN) / step);
        let scale = real(step) / real(PER_BIN) / LOBE_SQUARED;
        let mut lags = Lags::ZEROS;
        for place in self.places().step_by(step) {
            let here = self.density(place);
            let both = scale * weights.product(place, place) * here * here;
            lags.add(both, self.length, (place / step).wrapping_mul(turn));
        }
        lags
    }
}

/// A weighted sum of the densities of a level.
pub(crate) struct Sum {
    weights: [Real; MAX_SEGMENT / 2],
}

impl Sum {
    /// The sum of these bins, each times its weight.
    pub(crate) fn new(level: &[Bin], weight: impl Fn(usize) -> Real) -> Self {
        let mut weights = [0.0; MAX_SEGMENT / 2];
        for (b, bin) in numbered(level.iter()) {
            if let Some(place) = weights.get_mut(bin.index as usize) {
                *place = weight(b);
            }
        }
        Self { weights }
    }

    /// `Σ_k a_k W(k − x) W(k − x')` for two places.
    fn product(&self, place: usize, other: usize) -> Real {
        let lobe = |k: usize, place: usize| {
            let distance = k.wrapping_mul(PER_BIN).abs_diff(place);
            LOBE.get(distance).copied().unwrap_or(0.0)
        };
        let first = place.saturating_sub(REACH) / PER_BIN;
        let near = numbered(self.weights.iter()).skip(first).take(5);
        near.map(|(k, &weight)| weight * lobe(k, place) * lobe(k, other))
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{limits::MAX_PARAMETERS, numerics::real::double, theory::effect::AngleRandomWalk};

    const SHAPE: SampledShape = SampledShape {
        interval_s: 0.01,
        parameters: [0.0; MAX_PARAMETERS],
    };

    fn bins(indices: core::ops::Range<u32>) -> std::vec::Vec<Bin> {
        let bin = |index| Bin {
            block: 1,
            index,
            frequency_hz: 0.0,
            density: 1.0,
            segments: 100,
            spectral_kurtosis: 1.0,
        };
        indices.map(bin).collect()
    }

    extern crate std;

    /// White noise has the variances and covariances of Welch's estimate, for segments of every length.
    #[test]
    fn white_noise_scatters_as_the_bins_covariance_says() {
        for length in [32_usize, 64, 128, 256] {
            let mut fine = Fine::new(length);
            fine.add(&AngleRandomWalk, &SHAPE, 1, 1.0);
            // The one-sided density of white noise is 2 N².
            let unit = 4.0 / 100.0;
            let level = bins(2..12);
            let one = Sum::new(&level, |b| if b == 4 { 1.0 } else { 0.0 });
            let variance = double(fine.variance(&one, 100) / unit);
            assert!(
                (variance - 19.0 / 18.0).abs() < 0.01,
                "{length}: {variance}"
            );
            let two = Sum::new(&level, |b| if b == 4 || b == 5 { 1.0 } else { 0.0 });
            let variance = double(fine.variance(&two, 100) / unit);
            let expected = 19.0 / 18.0 * 2.0 * (1.0 + 0.459);
            assert!((variance - expected).abs() < 0.02, "{length}: {variance}");
            let lags = fine.lags(&one);
            let zero = double(lags.at(0)) / 4.0;
            assert!((zero - 1.0).abs() < 0.01, "{length}: {zero}");
        }
    }
}
