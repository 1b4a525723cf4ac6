//! The values of a shape parameter that a search tries first.

use crate::{
    numerics::{
        math,
        real::{Real, real},
    },
    theory::effect::{Effect, SearchRange, Span},
};

/// Values of a shape parameter, at equal distances of the logarithm or at whole numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    pub(crate) low: Real,
    pub(crate) high: Real,
    /// The distance between the logarithms of neighbouring values; zero for whole numbers.
    pub(super) log_step: Real,
    pub(crate) steps: u32,
}

impl Grid {
    /// The grid of a single value.
    pub(super) const fn only(value: Real) -> Self {
        Self {
            low: value,
            high: value,
            log_step: 0.0,
            steps: 1,
        }
    }

    /// The grid of a parameter. It has a single step if the effect does not have the parameter.
    pub(super) fn of(effect: &dyn Effect, parameter: usize, span: &Span) -> Self {
        let Some(range) = effect.search_range(parameter, span) else {
            return Self::only(0.0);
        };
        if effect.is_whole(parameter) {
            return Self {
                low: range.low,
                high: range.high,
                log_step: 0.0,
                steps: ((range.high - range.low) as u32).saturating_add(1),
            };
        }
        Self::new(range)
    }

    /// The grid of a parameter with no more than so many values for each factor of two.
    pub(crate) fn coarse(effect: &dyn Effect, parameter: usize, span: &Span, most: Real) -> Self {
        match effect.search_range(parameter, span) {
            Some(range) if !effect.is_whole(parameter) => Self::new(SearchRange {
                steps_per_octave: range.steps_per_octave.min(most),
                ..range
            }),
            _ => Self::of(effect, parameter, span),
        }
    }

    fn new(range: SearchRange) -> Self {
        let high = range.high.max(range.low);
        let octaves = math::log2_roughly(high / range.low);
        // One step more or less does not matter, because the last step is held at the upper end.
        let steps = ((octaves * range.steps_per_octave) as u32).saturating_add(2);
        Self {
            low: range.low,
            high,
            log_step: math::log(high / range.low) / real(steps.saturating_sub(1)),
            steps,
        }
    }

    /// The value after `step` steps.
    pub(crate) fn at(&self, step: u32) -> Real {
        if step == 0 {
            return self.low;
        }
        if self.log_step == 0.0 {
            return self.low + real(step);
        }
        (self.low * math::exp(self.log_step * real(step))).min(self.high)
    }

    /// A value moved into the grid's range.
    pub(super) fn clamp(&self, value: Real) -> Real {
        value.max(self.low).min(self.high)
    }
}
