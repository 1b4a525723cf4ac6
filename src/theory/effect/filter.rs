//! White noise behind a filter of one to four poles, which all filters of the catalogue with poles share.

use super::{
    Description, Effect, MAX_PARAMETERS, SampledShape, SecondDifferences, Tail,
    angle_random_walk::AngleRandomWalk, pole::Pole,
};
use crate::numerics::real::Real;

/// The largest number of starts of differences after which a tail may be zero, as [`Effect::tail`] says.
const STARTS: Real = 95.0;

/// A filter through which the white noise of the rate passes. The coefficient of the effect is that of the
/// [`AngleRandomWalk`] in front of the filter.
pub(super) trait Filter: Sync {
    /// Name, parameters, unit and relations of the effect.
    const DESCRIPTION: &'static Description;

    /// Whether only a spectrum shows the effect.
    const NEEDS_SPECTRUM: bool = false;

    /// Whether all noise passes the filter.
    const PASSES_ALL: bool = false;

    /// The decay of the slowest pole at which the autocovariance of several poles is as good as gone, as an exponent. A
    /// thousandth is left of poles that lie apart.
    const GONE: Real = 7.0;

    /// The noise behind a filter of this shape.
    fn output(shape: &SampledShape) -> Output;

    /// The nearest shape with the same effect at which it changes with every parameter.
    fn canonical(shape: &SampledShape) -> [Real; MAX_PARAMETERS] {
        shape.parameters
    }
}

/// White noise behind a filter. A filter whose poles come in conjugate pairs has one of each pair here, with twice its
/// weight. The autocovariance is
///
/// ```text
/// r(n) = (N²/τ₀) [ d δ(n) + g Σ Re w zⁿ ]
/// ```
pub(super) struct Output {
    /// The share `d` that is white. It may be negative, because the poles have more than they need at `n = 0`.
    pub(super) white: Real,
    /// The factor `g` of all poles.
    pub(super) gain: Real,
    pub(super) first: Pole,
    pub(super) second: Option<Pole>,
}

impl Output {
    /// The noise of poles alone. The gain gives it the spectral density `N²` at frequency zero.
    pub(super) fn of_poles(first: Pole, second: Option<Pole>) -> Self {
        let mut output = Self {
            white: 0.0,
            gain: 1.0,
            first,
            second,
        };
        output.gain = 1.0 / output.sum(Pole::long_mean);
        output
    }

    /// The sum over the poles.
    fn sum(&self, of: impl Fn(&Pole) -> Real) -> Real {
        of(&self.first) + self.second.as_ref().map_or(0.0, of)
    }

    fn variance(&self, m: Real, interval_s: Real) -> Real {
        (self.white / m + self.gain * self.sum(|pole| pole.variance(m))) / interval_s
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        interval_s: Real,
        each: &mut dyn FnMut(Real),
    ) {
        if self.white == 0.0 && self.second.is_none() {
            let scale = self.gain / interval_s;
            self.first.variances(factors, |value| each(scale * value));
            return;
        }
        for m in factors {
            each(self.variance(m, interval_s));
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
    fn tail(&self, gone: Real, m: Real, interval_s: Real) -> Option<Tail> {
        let scale = self.gain * interval_s;
        let Some(second) = &self.second else {
            // The autocovariance of one real pole has no detail.
            return (!self.first.is_plain()).then(|| self.first.tail(m).scaled(scale));
        };
        let gone = m + gone / self.first.decay().min(second.decay());
        if gone <= STARTS * (0.25 * m).max(1.0) {
            return Some(Tail::none(gone));
        }
        let tail = Tail {
            start: m,
            decays: [&self.first, second].map(|pole| Some(pole.decay_from(m))),
        };
        Some(tail.scaled(scale))
    }

    fn variogram(&self, m: Real, interval_s: Real, values: &mut [Real]) {
        values.fill(self.white / (m * interval_s));
        let scale = self.gain / interval_s;
        self.first.add_variogram(m, scale, values);
        if let Some(second) = &self.second {
            second.add_variogram(m, scale, values);
        }
    }
}

impl<F: Filter> Effect for F {
    fn description(&self) -> &'static Description {
        F::DESCRIPTION
    }

    fn needs_spectrum(&self) -> bool {
        F::NEEDS_SPECTRUM
    }

    fn passes_all(&self) -> bool {
        F::PASSES_ALL
    }

    fn canonical(&self, shape: &SampledShape) -> [Real; MAX_PARAMETERS] {
        F::canonical(shape)
    }

    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        let output = F::output(shape);
        output.white * AngleRandomWalk.kernel(lag, shape)
            + output.gain * shape.interval_s * output.sum(|pole| pole.kernel(lag))
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        let output = F::output(shape);
        output.white * AngleRandomWalk.second_difference(x, m, shape)
            + output.gain * shape.interval_s * output.sum(|pole| pole.second_difference(x, m))
    }

    fn variance(&self, m: Real, shape: &SampledShape) -> Real {
        F::output(shape).variance(m, shape.interval_s)
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        shape: &SampledShape,
        each: &mut dyn FnMut(Real),
    ) {
        F::output(shape).variances(factors, shape.interval_s, each);
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        F::output(shape).add_second_differences(m, weight, shape, sum);
    }

    fn tail(&self, m: Real, shape: &SampledShape) -> Option<Tail> {
        F::output(shape).tail(F::GONE, m, shape.interval_s)
    }

    fn variogram(&self, m: Real, shape: &SampledShape, values: &mut [Real]) {
        F::output(shape).variogram(m, shape.interval_s, values);
    }
}
