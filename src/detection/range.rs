//! Limits of neighbouring shapes, put together.

use super::limit::Limit;
use crate::{numerics::real::Real, theory::effect::Effect};
use heapless::Vec;

/// The number of ranges that [`Ranges`] has room for: three of each of six effects.
pub const MAX_RANGES: usize = 18;

/// The largest ratio of the ends of a range. An effect whose search covers four decades then has three
/// ranges. Chosen by hand.
const WIDEST: Real = 25.0;
/// The largest ratio of neighbouring shapes without a gap between them. The grid has four values for each
/// factor of two.
const NEIGHBOURS: Real = 1.6;

/// The largest limit of an effect over a range of shapes.
#[derive(Clone, Copy)]
pub struct Range {
    /// The effect.
    pub effect: &'static dyn Effect,
    /// The ends of the range of its first shape parameter; 0 and 0 if the effect has none or if the limit is
    /// that of this parameter.
    pub ends: (Real, Real),
    /// The limit: a coefficient, or the first shape parameter of a filter.
    pub size: Real,
    /// Whether the limit is one of the first shape parameter.
    pub is_of_shape: bool,
}

impl Range {
    /// Whether the limit of a shape is one of those that the range puts together.
    pub fn has(&self, limit: &Limit) -> bool {
        let (low, high) = self.ends;
        let shape = low..=high;
        self.effect.name() == limit.term.effect.name()
            && (self.is_of_shape || shape.contains(&limit.term.parameter(0)))
    }
}

impl core::fmt::Debug for Range {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let (low, high) = self.ends;
        write!(f, "{} {} at {low}..={high}", self.effect.name(), self.size)
    }
}

/// The limits of all effects, as few ranges.
#[derive(Clone, Debug, Default)]
pub struct Ranges {
    ranges: Vec<Range, MAX_RANGES>,
}

impl Ranges {
    /// Adds the next limit that a [`Detection`](super::Detection) hands out. A limit that needs a range for
    /// which there is no room is left out.
    pub fn push(&mut self, limit: &Limit) {
        let at = limit.term.parameter(0);
        let is_of_shape = limit.is_of_shape();
        if let Some(last) = self.ranges.last_mut()
            && !is_of_shape
            && last.effect.name() == limit.term.effect.name()
            && at < NEIGHBOURS * last.ends.1
            && at < WIDEST * last.ends.0
        {
            last.ends.1 = at;
            last.size = last.size.max(limit.size());
            return;
        }
        let _ = self.ranges.push(Range {
            effect: limit.term.effect,
            ends: if is_of_shape { (0.0, 0.0) } else { (at, at) },
            size: limit.size(),
            is_of_shape,
        });
    }

    /// The ranges, in the order of the effects and of their shapes.
    pub fn as_slice(&self) -> &[Range] {
        &self.ranges
    }
}
