//! An effect behind a filter that all noise passes.

use super::{Description, Effect, SampledShape};
use crate::numerics::real::Real;

/// An effect without a shape behind one that [passes all noise](Effect::passes_all). The shape is the one of the filter.
pub struct Behind<'a> {
    effect: &'a dyn Effect,
    filter: &'a dyn Effect,
}

impl<'a> Behind<'a> {
    /// The effect behind the filter; `None` if its kernel has no [closed form](Effect::kernel_behind) there.
    pub fn new(
        effect: &'a dyn Effect,
        filter: &'a dyn Effect,
        shape: &SampledShape,
    ) -> Option<Self> {
        effect.kernel_behind(filter, 0.0, shape)?;
        Some(Self { effect, filter })
    }
}

impl Effect for Behind<'_> {
    fn description(&self) -> &'static Description {
        self.effect.description()
    }

    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        let kernel = self.effect.kernel_behind(self.filter, lag, shape);
        kernel.unwrap_or(0.0)
    }

    /// Each distance leads to the next one, so that the filter is asked once for each.
    fn variogram(&self, m: Real, shape: &SampledShape, values: &mut [Real]) {
        let tau_s = m * shape.interval_s;
        let per_square = 1.0 / (tau_s * tau_s);
        let (mut before, mut here) = (self.kernel(0.0, shape), self.kernel(m, shape));
        let at_zero = 2.0 * (here - before);
        let mut x = m;
        for value in values {
            x += m;
            let next = self.kernel(x, shape);
            *value = per_square * (next - 2.0 * here + before - at_zero);
            (before, here) = (here, next);
        }
    }
}
