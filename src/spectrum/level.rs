//! What is kept for one block length.

#[cfg(target_pointer_width = "64")]
use super::transform::add_power;
use super::{transform::Segment, window::bins};

/// The number of blocks that make a block of the next level.
pub(super) const RADIX: usize = 8;

/// The number of bits by which the block length grows from level to level.
pub(super) const RADIX_BITS: u32 = RADIX.trailing_zeros();

/// Kept blocks lie within this limit, so that the difference of any two fits in 32 bits.
const LIMIT: i64 = 1 << 30;

/// The unit of the values that are transformed is this power of two, in counts. With it, neither the square
/// of a power of full scale nor that of a hundredth of a count leaves the range of single precision.
pub(super) const UNIT_BITS: u32 = 16;

/// The number of segments at which the sums are halved.
const MANY: u32 = 1 << 20;

/// The ring of the last blocks of one length, and the sums over their segments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Level<const P: usize> {
    /// Sums of counts over the last blocks, less that of the reference, in units of `2^exponent`. Block `b` is
    /// in slot `b % P`.
    blocks: [i32; P],
    /// The sums over all segments: in the first half the power of every bin, in the second half its square.
    sums: [f32; P],
    exponent: u32,
    segments: u32,
}

impl<const P: usize> Level<P> {
    pub(super) const EMPTY: Self = Self {
        blocks: [0; P],
        sums: [0.0; P],
        exponent: 0,
        segments: 0,
    };

    /// Keeps block `number`, counted from 0. Only the place in the ring matters.
    #[inline]
    pub(super) fn push(&mut self, number: u32, sum: i64) {
        let keeps_all = self.exponent == 0 && (-LIMIT..LIMIT).contains(&sum);
        let block = if keeps_all {
            sum as i32
        } else {
            self.scaled(sum)
        };
        self.blocks[number as usize % P] = block;
    }

    /// Keeps block `number` of a single count, less the reference.
    // Nearly every count needs 32 bits only, which saves a third of the work of a sample.
    #[inline(always)]
    pub(super) fn push_count(&mut self, number: u32, count: i32, reference: i32) {
        let near = -LIMIT as i32..LIMIT as i32;
        match count.checked_sub(reference) {
            Some(difference) if self.exponent == 0 && near.contains(&difference) => {
                self.blocks[number as usize % P] = difference;
            }
            _ => self.push_far_count(number, count, reference),
        }
    }

    /// Keeps blocks of single counts, less the reference, up to the end of a block of the next level.
    #[inline(always)]
    pub(super) fn push_counts(&mut self, number: u32, counts: &[i32], reference: i32) {
        let (groups, _) = self.blocks.as_chunks_mut::<RADIX>();
        let group = groups.get_mut(number as usize % P / RADIX);
        if let (Some(group), Ok(&counts), 0) =
            (group, <&[_; RADIX]>::try_from(counts), self.exponent)
        {
            let differences = counts.map(|count: i32| count.wrapping_sub(reference));
            // The sign tells whether a difference overflows, or whether it is not within the limit.
            let signs = counts.iter().zip(differences).map(|(count, difference)| {
                let overflow = (count ^ reference) & (count ^ difference);
                overflow | difference.wrapping_add(LIMIT as i32)
            });
            if signs.fold(0, |all, sign| all | sign) >= 0 {
                *group = differences;
                return;
            }
        }
        for (i, &count) in (number..=u32::MAX).zip(counts) {
            self.push_count(i, count, reference);
        }
    }

    #[cold]
    #[inline(never)]
    fn push_far_count(&mut self, number: u32, count: i32, reference: i32) {
        self.push(number, i64::from(count).wrapping_sub(i64::from(reference)));
    }

    /// The sum in the unit of the blocks, which becomes larger if needed.
    // Apart, because a shift of 64 bits is a call on a core of 32, which a level that keeps all bits does not need.
    #[cold]
    #[inline(never)]
    fn scaled(&mut self, sum: i64) -> i32 {
        if !(-LIMIT..LIMIT).contains(&sum.wrapping_shr(self.exponent)) {
            self.make_room(sum);
        }
        sum.wrapping_shr(self.exponent) as i32
    }

    /// A sum of blocks in counts.
    #[cold]
    #[inline(never)]
    fn in_counts(&self, sum: i64) -> i64 {
        sum.wrapping_shl(self.exponent)
    }

    /// Makes the unit of the blocks larger, so that this sum can be kept.
    #[cold]
    #[inline(never)]
    fn make_room(&mut self, sum: i64) {
        let mut raised = 0_u32;
        while !(-LIMIT..LIMIT).contains(&sum.wrapping_shr(self.exponent.wrapping_add(raised))) {
            raised = raised.wrapping_add(1);
        }
        for block in &mut self.blocks {
            *block >>= raised.min(i32::BITS - 1);
        }
        self.exponent = self.exponent.wrapping_add(raised);
    }

    /// The sum of the blocks up to block `number` that make a block of the next level.
    #[inline]
    pub(super) fn last(&self, number: u32) -> i64 {
        // Such blocks lie side by side in the ring.
        let (groups, _) = self.blocks.as_chunks::<RADIX>();
        let group = groups.get(number as usize % P / RADIX);
        let blocks = group.unwrap_or(&[0; RADIX]).iter();
        let sum = blocks.fold(0, |sum: i64, &block| sum.wrapping_add(i64::from(block)));
        if self.exponent == 0 {
            sum
        } else {
            self.in_counts(sum)
        }
    }

    /// Adds the segment that ends before block `number`, for blocks of `2^block_bits` samples.
    #[inline(never)]
    pub(super) fn add_segment(&mut self, number: u32, block_bits: u32) {
        let start = number as usize;
        // The transform multiplies by 8.
        let scale = power_of_two(self.exponent, block_bits.wrapping_add(UNIT_BITS + 3));
        let segment = Segment::<P>::new(&self.blocks, start, scale);
        let (powers, squares) = self.begin_segment();
        segment.add_powers(powers, squares);
    }

    /// Counts a segment, and returns the sums that its powers and their squares are added to.
    #[inline(always)]
    fn begin_segment(&mut self) -> (&mut [f32], &mut [f32]) {
        if self.segments >= MANY {
            self.halve();
        }
        self.segments = self.segments.saturating_add(1);
        let (powers, squares) = self.sums.split_at_mut(P / 2);
        (powers, squares.get_mut(..bins(P)).unwrap_or_default())
    }

    /// The values of the segment that ends before block `number`, in the order of its blocks and in the unit of the
    /// transform.
    #[cfg(target_pointer_width = "64")]
    #[inline]
    pub(super) fn segment_values(&self, number: u32, block_bits: u32, values: &mut [f32; P]) {
        let scale = power_of_two(self.exponent, block_bits.wrapping_add(UNIT_BITS + 3));
        let start = number as usize % P;
        let first = self.blocks[start];
        let (late, early) = self.blocks.split_at(start);
        let (to_early, to_late) = values.split_at_mut(early.len().min(P));
        for (from, to) in [(early, to_early), (late, to_late)] {
            for (value, block) in to.iter_mut().zip(from) {
                *value = block.wrapping_sub(first) as f32 * scale;
            }
        }
    }

    /// Adds the segment with these values.
    #[cfg(target_pointer_width = "64")]
    pub(super) fn add_values(&mut self, values: &[f32; P]) {
        let (powers, squares) = self.begin_segment();
        Segment::<P>::of_blocks(|j| values[j % P]).add_powers(powers, squares);
    }

    /// Adds the powers of a segment's bins, as far as they are given.
    #[cfg(target_pointer_width = "64")]
    #[inline]
    pub(super) fn add_powers(&mut self, powers: &[f32]) {
        let (sums, squares) = self.begin_segment();
        for ((sum, square), &power) in sums.iter_mut().zip(squares).zip(powers) {
            add_power(power, sum, square);
        }
    }

    /// Gives everything so far half its weight. A sum in single precision would otherwise stop taking up the
    /// powers of single segments.
    #[cold]
    #[inline(never)]
    fn halve(&mut self) {
        self.segments /= 2;
        for sum in &mut self.sums {
            *sum *= 0.5;
        }
    }

    /// Forgets the blocks.
    pub(super) fn end(&mut self) {
        self.blocks = [0; P];
        self.exponent = 0;
    }

    /// Adds the sums of another record.
    pub(super) fn merge(&mut self, other: &Self) {
        for (own, other) in self.sums.iter_mut().zip(&other.sums) {
            *own += other;
        }
        self.segments = self.segments.saturating_add(other.segments);
        while self.segments > MANY {
            self.halve();
        }
    }

    /// The number of segments that the sums stand for.
    pub(super) const fn segments(&self) -> u32 {
        self.segments
    }

    /// The sums of power and of its square of every bin, in the unit of [`UNIT_BITS`].
    pub(super) fn sums(&self) -> impl Iterator<Item = (f32, f32)> + '_ {
        let squares = self.sums.iter().skip(P / 2);
        let sums = self.sums.iter().zip(squares).take(bins(P));
        sums.map(|(&power, &square)| (power, square))
    }
}

/// Sums that rounding changes stay within this share of each other.
#[cfg(feature = "storage")]
const ROUNDING: f32 = 1.1;

#[cfg(feature = "storage")]
impl<const P: usize> Level<P> {
    /// Takes over stored sums, bin by bin: of powers and of their squares. Returns `None` if no segments can
    /// have such sums.
    pub(super) fn restore(
        &mut self,
        segments: u32,
        mut next: impl FnMut() -> Option<(f32, f32)>,
    ) -> Option<()> {
        if segments > MANY {
            return None;
        }
        self.segments = segments;
        let number = segments as f32;
        let (powers, squares) = self.sums.split_at_mut(P / 2);
        for (power, square) in powers.iter_mut().zip(squares).take(bins(P)) {
            (*power, *square) = next()?;
            let is_number = |x: f32| x.is_finite() && x >= 0.0;
            // The mean of squares is at least the square of the mean.
            let mean = *power / number;
            let is_possible = mean * mean <= *square / number * ROUNDING;
            if !(is_number(*power) && is_number(*square) && is_possible) {
                return None;
            }
        }
        Some(())
    }
}

/// `2^(above − below)`, made from its bits.
fn power_of_two(above: u32, below: u32) -> f32 {
    f32::from_bits(127_u32.wrapping_add(above).saturating_sub(below).max(1) << 23)
}
