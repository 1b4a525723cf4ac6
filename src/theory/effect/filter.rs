//! White noise behind a filter of one to four poles, which all filters of the catalogue with poles share.

use super::{
    Effect, SampledShape, SecondDifferences, Tail, angle_random_walk::AngleRandomWalk, pole::Pole,
    stationary::Process,
};
use crate::numerics::real::Real;

/// The largest number of starts of differences after which a tail may be zero, as [`Effect::tail`] says.
const STARTS: Real = 95.0;

/// The decay of the slowest pole at which the autocovariance of several poles is as good as gone, as an exponent. A
/// thousandth is left of poles that lie apart.
const GONE: Real = 7.0;

/// White noise behind a filter. The coefficient of the effect is that of the [`AngleRandomWalk`] in front of the filter.
/// A filter whose poles come in conjugate pairs has one of each pair here, with twice its
/// weight. The autocovariance is
///
/// ```text
/// r(n) = (N²/τ₀) [ d δ(n) + g Σ Re w zⁿ ]
/// ```
pub(super) struct Output {
    /// The share `d` that is white. It may be negative, because the poles have more than they need at `n = 0`.
    white: Real,
    /// The factor `g` of all poles.
    gain: Real,
    /// The decay of the slowest pole, as an exponent, from which on the tail is zero.
    pub(super) gone: Real,
    first: Pole,
    second: Option<Pole>,
}

impl Output {
    /// The noise of poles and a share that is white, with a gain of one.
    pub(super) fn new(white: Real, first: Pole, second: Option<Pole>) -> Self {
        Self {
            white,
            gain: 1.0,
            gone: GONE,
            first,
            second,
        }
    }

    /// The noise of poles alone. The gain gives it the spectral density `N²` at frequency zero.
    pub(super) fn of_poles(first: Pole, second: Option<Pole>) -> Self {
        let mut output = Self::new(0.0, first, second);
        output.gain = 1.0 / output.sum(Pole::long_mean);
        output
    }

    /// The sum over the poles.
    fn sum(&self, of: impl Fn(&Pole) -> Real) -> Real {
        of(&self.first) + self.second.as_ref().map_or(0.0, of)
    }
}

impl Process for Output {
    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        self.white * AngleRandomWalk.kernel(lag, shape)
            + self.gain * shape.interval_s * self.sum(|pole| pole.kernel(lag))
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        self.white * AngleRandomWalk.second_difference(x, m, shape)
            + self.gain * shape.interval_s * self.sum(|pole| pole.second_difference(x, m))
    }

    fn variance(&self, m: Real, shape: &SampledShape) -> Real {
        (self.white / m + self.gain * self.sum(|pole| pole.variance(m))) / shape.interval_s
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        shape: &SampledShape,
        each: &mut dyn FnMut(Real),
    ) {
        if self.white == 0.0 && self.second.is_none() {
            let scale = self.gain / shape.interval_s;
            self.first.variances(factors, |value| each(scale * value));
            return;
        }
        for m in factors {
            each(self.variance(m, shape));
        }
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        if self.white != 0.0 {
            AngleRandomWalk.add_second_differences(m, weight * self.white, shape, sum);
        }
        let weight = weight * self.gain * shape.interval_s;
        self.first.add_second_differences(m, weight, sum);
        if let Some(second) = &self.second {
            second.add_second_differences(m, weight, sum);
        }
    }

    /// White noise has no second differences from `m` on.
    fn tail(&self, m: Real, shape: &SampledShape) -> Option<Tail> {
        let scale = self.gain * shape.interval_s;
        let Some(second) = &self.second else {
            // The autocovariance of one real pole has no detail.
            return (!self.first.is_plain()).then(|| self.first.tail(m).scaled(scale));
        };
        let gone = m + self.gone / self.first.decay().min(second.decay());
        if gone <= STARTS * (0.25 * m).max(1.0) {
            return Some(Tail::none(gone));
        }
        let tail = Tail {
            start: m,
            decays: [&self.first, second].map(|pole| Some(pole.decay_from(m))),
        };
        Some(tail.scaled(scale))
    }

    fn variogram(&self, m: Real, shape: &SampledShape, values: &mut [Real]) {
        values.fill(self.white / (m * shape.interval_s));
        let scale = self.gain / shape.interval_s;
        self.first.add_variogram(m, scale, values);
        if let Some(second) = &self.second {
            second.add_variogram(m, scale, values);
        }
    }
}
