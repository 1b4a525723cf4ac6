//! Several segments that are transformed at once.

use super::{
    lanes::{LANES, segment_powers},
    level::Level,
};

/// Segments of any level that wait to be transformed together, in the order in which they were completed.
pub(super) struct Several<const P: usize> {
    values: [[f32; P]; LANES],
    levels: [usize; LANES],
    number: usize,
}

impl<const P: usize> Several<P> {
    pub(super) const fn new() -> Self {
        Self {
            values: [[0.0; P]; LANES],
            levels: [0; LANES],
            number: 0,
        }
    }

    /// Adds the segment of a level that ends before block `end`, for blocks of `2^block_bits` samples.
    pub(super) fn push(&mut self, levels: &mut [Level<P>], i: usize, block_bits: u32, end: u32) {
        let places = self.values.get_mut(self.number);
        if let (Some(values), Some(place), Some(level)) =
            (places, self.levels.get_mut(self.number), levels.get(i))
        {
            level.segment_values(end, block_bits, values);
            *place = i;
            self.number = self.number.wrapping_add(1);
        }
        if self.number >= LANES {
            self.transform(levels);
        }
    }

    /// Transforms as many segments as there are lanes.
    fn transform(&mut self, levels: &mut [Level<P>]) {
        segment_powers(&mut self.values);
        for (powers, &level) in self.values.iter().zip(&self.levels) {
            if let Some(level) = levels.get_mut(level) {
                level.add_powers(powers);
            }
        }
        self.number = 0;
    }

    /// Transforms the segments that still wait, one by one.
    pub(super) fn finish(&mut self, levels: &mut [Level<P>]) {
        for (values, &level) in self.values.iter().zip(&self.levels).take(self.number) {
            if let Some(level) = levels.get_mut(level) {
                level.add_values(values);
            }
        }
        self.number = 0;
    }
}
