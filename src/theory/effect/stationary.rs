//! Effects whose rate is a stationary process: one that the shape determines, and that computes all the rest.

use super::{
    Description, Effect, MAX_PARAMETERS, SampledShape, SecondDifferences, Tail, pole::Pole,
};
use crate::numerics::real::Real;

/// An effect that names its process instead of every function of [`Effect`].
pub(super) trait Stationary: Sync {
    /// Name, parameters, unit and relations of the effect.
    const DESCRIPTION: &'static Description;

    /// Whether only a spectrum shows the effect.
    const NEEDS_SPECTRUM: bool = false;

    /// Whether all noise passes what the effect describes.
    const PASSES_ALL: bool = false;

    /// The type of the process.
    type Process: Process;

    /// The process of this shape.
    fn process(shape: &SampledShape) -> Self::Process;

    /// The nearest shape with the same effect at which it changes with every parameter.
    fn canonical(shape: &SampledShape) -> [Real; MAX_PARAMETERS] {
        shape.parameters
    }
}

/// A stationary process of known shape. The functions are those of [`Effect`] with the same names; of the shape that
/// the process was made for, they use the sample interval.
pub(super) trait Process {
    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real;

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real;

    fn variance(&self, m: Real, shape: &SampledShape) -> Real;

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        shape: &SampledShape,
        each: &mut dyn FnMut(Real),
    ) {
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
    );

    fn tail(&self, m: Real, shape: &SampledShape) -> Option<Tail>;

    fn variogram(&self, m: Real, shape: &SampledShape, values: &mut [Real]);
}

impl<S: Stationary> Effect for S {
    fn description(&self) -> &'static Description {
        S::DESCRIPTION
    }

    fn needs_spectrum(&self) -> bool {
        S::NEEDS_SPECTRUM
    }

    fn passes_all(&self) -> bool {
        S::PASSES_ALL
    }

    fn canonical(&self, shape: &SampledShape) -> [Real; MAX_PARAMETERS] {
        S::canonical(shape)
    }

    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        S::process(shape).kernel(lag, shape)
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        S::process(shape).second_difference(x, m, shape)
    }

    fn variance(&self, m: Real, shape: &SampledShape) -> Real {
        S::process(shape).variance(m, shape)
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        shape: &SampledShape,
        each: &mut dyn FnMut(Real),
    ) {
        S::process(shape).variances(factors, shape, each);
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        S::process(shape).add_second_differences(m, weight, shape, sum);
    }

    fn tail(&self, m: Real, shape: &SampledShape) -> Option<Tail> {
        S::process(shape).tail(m, shape)
    }

    fn variogram(&self, m: Real, shape: &SampledShape, values: &mut [Real]) {
        S::process(shape).variogram(m, shape, values);
    }
}

/// A pole alone, with a mean square of one. The pole itself leaves the factor τ₀² out.
impl Process for Pole {
    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        square(shape) * self.kernel(lag)
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        square(shape) * self.second_difference(x, m)
    }

    fn variance(&self, m: Real, _: &SampledShape) -> Real {
        self.variance(m)
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        _: &SampledShape,
        each: &mut dyn FnMut(Real),
    ) {
        self.variances(factors, each);
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        self.add_second_differences(m, weight * square(shape), sum);
    }

    /// The autocovariance of a real pole has no detail.
    fn tail(&self, m: Real, shape: &SampledShape) -> Option<Tail> {
        (!self.is_plain()).then(|| self.tail(m).scaled(square(shape)))
    }

    fn variogram(&self, m: Real, _: &SampledShape, values: &mut [Real]) {
        self.variogram(m, 1.0, values);
    }
}

/// τ₀².
fn square(shape: &SampledShape) -> Real {
    shape.interval_s * shape.interval_s
}
