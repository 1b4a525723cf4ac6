//! Lost samples of known number: filled values take their place, so that a loss costs only what it touches.
//!
//! A gap ends every octave, and the longest one needs the longest record without gaps. So a few losses would take all the
//! long octaves away. [`Accumulator::lost`] therefore goes on with the mean of 32 samples in front of the gap, up to 64
//! times. Differences of clusters that are short compared with the gap are left out if they touch it. In longer clusters, a
//! filled value counts for little, and the [curve](crate::Curve) takes off what it adds or takes away.

use super::{
    Accumulator, FIRST, LAP, RING,
    bridged::{Bridged, TOUCHED, class, span},
};

/// The number of samples whose mean fills a gap, as a power of two.
const WINDOW_BITS: u32 = 5;

/// The number of samples whose mean fills a gap.
pub(crate) const WINDOW: u32 = 1 << WINDOW_BITS;

/// The number of samples by which the window may end before the gap, and one more. The mean is taken between boundaries of
/// blocks, which levels keep.
pub(crate) const BEFORE: u32 = 1 << LEVEL;

/// The level that keeps the first boundary of the window.
const LEVEL: usize = 3;

/// The last sample number at which a gap is filled, so that no number of a block passes the largest one.
const LAST: u32 = u32::MAX - 1024;

/// The values that fill a gap, as [`Accumulator::filling`] gives them. Each of them is the mean of 32 samples, rounded down
/// after what rounding left of those before is added.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Filling {
    /// The sum over the window.
    sum: i64,
    /// What rounding left, in parts of the window.
    rest: i64,
    left: u32,
}

impl Iterator for Filling {
    type Item = i32;

    #[inline]
    fn next(&mut self) -> Option<i32> {
        self.left = self.left.checked_sub(1)?;
        // The sum of 32 counts has 37 bits, and the mean lies between the counts.
        let all = self.sum.wrapping_add(self.rest);
        self.rest = all & i64::from(WINDOW - 1);
        Some((all >> WINDOW_BITS) as i32)
    }
}

impl<const OCTAVES: usize> Accumulator<OCTAVES> {
    /// Tells that so many samples were lost at this place. Does nothing for 0 samples.
    ///
    /// Up to 64 samples are filled with the mean of 32 samples in front of them, if there are as many since the last
    /// [gap](Self::gap): see [`bridged`](Self::bridged). Differences that touch the filled values are left out where their
    /// clusters are shorter than four samples, or shorter than twice the gap. Otherwise the place is a gap. It also is one
    /// if the longest octave would leave out the differences, and if there are fewer than six octaves.
    ///
    /// A call takes as long as it takes to push so many samples, and to read the octaves that leave out differences.
    pub fn lost(&mut self, samples: u64) {
        if samples == 0 {
            return;
        }
        match self.fill(samples) {
            Some(filling) => filling.for_each(|count| self.push(count)),
            None => self.gap(),
        }
    }

    /// The values that [`lost`](Self::lost) would fill in for so many samples at this place, in counts; `None` if it would
    /// make a gap. What else sums the same record, such as a [spectrum](crate::spectrum::SpectrumAccumulator), goes on with
    /// them.
    pub fn filling(&self, samples: u64) -> Option<Filling> {
        self.touched(samples)?;
        let end = self.number & !(BEFORE - 1);
        let boundary = (end >> LEVEL).wrapping_sub(WINDOW >> LEVEL) as usize % RING;
        let first = self.levels.get(LEVEL)?.ring[boundary];
        let last = self.levels[0].ring[end as usize % RING];
        Some(Filling {
            sum: last.wrapping_sub(first) as i64,
            rest: self.rest.into(),
            left: samples as u32,
        })
    }

    /// The gaps that were filled.
    pub const fn bridged(&self) -> &Bridged {
        &self.bridged
    }

    /// The gaps that were filled in records of which the accumulator was rebuilt.
    #[cfg(feature = "storage")]
    pub(crate) const fn with_bridged(mut self, bridged: Bridged) -> Self {
        self.bridged = bridged;
        self
    }

    /// The number of octaves, from the first one on, that leave out differences across a gap of so many samples at this
    /// place; `None` if the gap is not filled.
    pub(crate) fn touched(&self, samples: u64) -> Option<usize> {
        let class = class(samples)?;
        let first = Bridged::first_octave(class);
        let is_long = self.number >= WINDOW && self.number < LAST && LEVEL + FIRST < OCTAVES;
        let has_room = self.filled < LAST && self.bridged.samples.get(class)? < &LAST;
        (is_long && has_room && first < OCTAVES).then_some(first)
    }

    /// Begins to fill a gap with values, which the caller pushes at once. Sums what is pending in the octaves that leave
    /// out differences. `None` if the gap is not filled.
    pub(crate) fn fill(&mut self, samples: u64) -> Option<Filling> {
        let (touched, class) = (self.touched(samples)?, class(samples)?);
        let filling = self.filling(samples)?;
        let lost = filling.left;
        let end = self.number.wrapping_add(lost);
        for k in 0..touched {
            let octave = self.read(k);
            *self.sum_mut(k) = octave.sum;
            self.set_counted(k, octave.differences);
            if let Some(from) = self.from.get_mut(k) {
                let level = k.saturating_sub(FIRST);
                // Rounded up to the next boundary.
                *from = end.wrapping_add((1 << level) - 1) >> level;
            }
        }
        // An octave of level 0 may still have to wait for an earlier, longer gap.
        let late = end.wrapping_sub(if touched > FIRST { 0 } else { RING as u32 / 2 });
        self.late = self.late.max(late);
        let all = filling.sum.wrapping_mul(lost.into());
        self.rest = (all.wrapping_add(filling.rest) & i64::from(WINDOW - 1)) as u32;
        self.bridged.add(class, lost);
        self.filled = self.filled.wrapping_add(lost);
        Some(filling)
    }

    /// Whether no difference of the next samples touches a filled value in an octave that leaves it out.
    pub(super) fn is_clear(&self) -> bool {
        self.from.iter().zip(0_u32..).all(|(&from, k)| {
            let block = self.number.wrapping_shr(k.saturating_sub(FIRST as u32));
            from == 0 || block >= from.wrapping_add(RING as u32)
        })
    }

    /// The block from which on the differences of an octave start.
    #[inline(always)]
    pub(super) fn from(&self, k: usize) -> u32 {
        self.from.get(k).copied().unwrap_or(0)
    }

    /// Counts the differences so far of the octaves that may leave out some, before the sample number goes on from
    /// [`LAP`]. The last one of them counts as the first one of those to come.
    pub(super) fn lap_touched(&mut self) {
        for k in 0..TOUCHED.min(OCTAVES) {
            let level = k.saturating_sub(FIRST);
            let behind = LAP >> level;
            // The sample number is 2^32.
            let running = self.running(k, u64::from(behind) << 1);
            let from = match running.checked_sub(1) {
                Some(before) => {
                    let counted = self.counted(k).saturating_add(before);
                    self.set_counted(k, counted);
                    behind.wrapping_sub(span(k))
                }
                None => self.from(k).wrapping_sub(behind),
            };
            if let Some(own) = self.from.get_mut(k) {
                *own = from;
            }
        }
        self.late = self.late.saturating_sub(LAP);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A record of 2^32 samples would take minutes. So one goes on from shortly before.
    #[test]
    fn octaves_that_left_out_differences_go_on_counting_past_the_largest_sample_number() {
        let mut random = 1_u32;
        let mut next = move || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 24) as i32
        };
        for lost in [0, 1, 5, 64] {
            for before in [1100, 1300, 2000] {
                let mut lapped = Accumulator::<10>::new();
                let mut early = lapped.clone();
                lapped.number = 0_u32.wrapping_sub(4096);
                lapped.from = core::array::from_fn(|k| {
                    (lapped.number >> k.saturating_sub(FIRST)).wrapping_sub(1 << 5)
                });
                let start: [_; 10] = core::array::from_fn(|k| lapped.read(k).differences);
                let sums = |one: &Accumulator<10>| -> [u128; 10] {
                    core::array::from_fn(|k| one.read(k).sum.to_u128().unwrap())
                };
                let (mut lapped_sums, mut early_sums) = ([0; 10], [0; 10]);
                for n in 0..9000 {
                    if n == 2000 {
                        // By now, the rings hold the same counts.
                        (lapped_sums, early_sums) = (sums(&lapped), sums(&early));
                    }
                    if n == 4096 - before {
                        lapped.lost(lost);
                        early.lost(lost);
                    }
                    let count = next();
                    lapped.push(count);
                    early.push(count);
                }
                assert_eq!(lapped.laps, 1);
                assert_eq!(lapped.bridged, early.bridged);
                assert_eq!(early.bridged.lost(), lost);
                let more = |one: &Accumulator<10>, before: [u128; 10]| -> [u128; 10] {
                    let now = sums(one);
                    core::array::from_fn(|k| now[k] - before[k])
                };
                assert_eq!(more(&lapped, lapped_sums), more(&early, early_sums));
                for (k, start) in start.iter().enumerate().take(TOUCHED) {
                    let (one, other) = (lapped.read(k), early.read(k));
                    // The differences of the first samples, whose ring was not full.
                    let more = one.differences - start - other.differences;
                    assert_eq!(more, u64::from(span(k)) - 1, "octave {k}, {lost} lost");
                }
            }
        }
    }
}
