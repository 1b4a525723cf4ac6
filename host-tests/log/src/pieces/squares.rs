//! Angles of a chunk, and sums of their squared differences.

use super::sizes::Together;

/// An angle, which may wrap.
pub(super) trait Angle: Copy + Default {
    /// The angle after a count.
    fn after(self, count: i64) -> Self;

    /// The angle in 64 bits.
    fn wide(self) -> i64;

    /// The second differences of neighbouring angles together. There are at most [`BLOCK`] of them.
    fn together(angles: &[Self]) -> Together;

    /// The blocks between neighbouring angles without the first block, as floats times a factor.
    fn blocks(angles: &[Self], factor: f32, blocks: &mut [f32]);

    /// The sum of the squares of the second differences at a distance of `lag` angles. It stays at the largest number if 128
    /// bits do not hold it.
    fn squares(angles: &[Self], lag: usize) -> u128;
}

/// An angle of a chunk whose angles all lie within [`NEAR`] of zero.
#[derive(Clone, Copy, Default)]
pub(super) struct Near(i32);

/// Second differences of such angles have 28 bits, and the squares of 256 of them fit in 64.
pub(super) const NEAR: i64 = 1 << 26;

/// The number of squares that are added before the sum needs more bits.
const BLOCK: usize = 256;

impl Angle for Near {
    #[inline(always)]
    fn after(self, count: i64) -> Self {
        Self(self.0.wrapping_add(count as i32))
    }

    #[inline(always)]
    fn wide(self) -> i64 {
        self.0.into()
    }

    fn together(angles: &[Self]) -> Together {
        let (oldest, middle, newest) = differences(angles, 1);
        let (mut bits, mut squares) = (0_u32, 0_u64);
        for ((oldest, middle), newest) in oldest.iter().zip(middle).zip(newest) {
            let late = newest.0.wrapping_sub(middle.0);
            let size = late
                .wrapping_sub(middle.0.wrapping_sub(oldest.0))
                .unsigned_abs();
            bits |= size;
            squares = squares.wrapping_add(u64::from(size).wrapping_mul(size.into()));
        }
        Together {
            bits: bits.into(),
            squares: squares.into(),
        }
    }

    fn blocks(angles: &[Self], factor: f32, blocks: &mut [f32]) {
        let pairs = || angles.iter().zip(angles.iter().skip(1));
        let block = |(before, after): (&Self, &Self)| after.0.wrapping_sub(before.0);
        let first = pairs().next().map_or(0, block);
        for (value, pair) in blocks.iter_mut().zip(pairs()) {
            // 29 bits hold it.
            *value = block(pair).wrapping_sub(first) as f32 * factor;
        }
    }

    fn squares(angles: &[Self], lag: usize) -> u128 {
        let differences = differences(angles, lag);
        let (oldest, middle, newest) = differences;
        let mut all = 0;
        let blocks = oldest.chunks(BLOCK).zip(middle.chunks(BLOCK));
        for ((oldest, middle), newest) in blocks.zip(newest.chunks(BLOCK)) {
            let mut sum = 0_u64;
            for ((oldest, middle), newest) in oldest.iter().zip(middle).zip(newest) {
                let late = newest.0.wrapping_sub(middle.0);
                let difference = late.wrapping_sub(middle.0.wrapping_sub(oldest.0));
                let magnitude = u64::from(difference.unsigned_abs());
                sum = sum.wrapping_add(magnitude.wrapping_mul(magnitude));
            }
            all += u128::from(sum);
        }
        all
    }
}

impl Angle for i64 {
    #[inline(always)]
    fn after(self, count: i64) -> Self {
        self.wrapping_add(count)
    }

    #[inline(always)]
    fn wide(self) -> i64 {
        self
    }

    fn together(angles: &[Self]) -> Together {
        let (oldest, middle, newest) = differences(angles, 1);
        let all = oldest.iter().zip(middle).zip(newest);
        let sizes = all
            .map(|((&oldest, &middle), &newest)| difference(oldest, middle, newest).unsigned_abs());
        let none = Together {
            bits: 0,
            squares: 0,
        };
        sizes.fold(none, |together, size| Together {
            bits: together.bits | size,
            squares: together
                .squares
                .saturating_add(u128::from(size) * u128::from(size)),
        })
    }

    fn blocks(angles: &[Self], factor: f32, blocks: &mut [f32]) {
        let pairs = || angles.iter().zip(angles.iter().skip(1));
        let block = |(&before, &after): (&Self, &Self)| after.wrapping_sub(before);
        let first = pairs().next().map_or(0, block);
        for (value, pair) in blocks.iter_mut().zip(pairs()) {
            *value = block(pair).wrapping_sub(first) as f32 * factor;
        }
    }

    fn squares(angles: &[Self], lag: usize) -> u128 {
        let (oldest, middle, newest) = differences(angles, lag);
        let differences = oldest.iter().zip(middle).zip(newest);
        let squares = differences.map(|((&oldest, &middle), &newest)| {
            let magnitude = u128::from(difference(oldest, middle, newest).unsigned_abs());
            magnitude * magnitude
        });
        squares.fold(0, u128::saturating_add)
    }
}

/// The angles at the begin, the middle and the end of every difference.
fn differences<A>(angles: &[A], lag: usize) -> (&[A], &[A], &[A]) {
    let number = angles.len().saturating_sub(2 * lag);
    let from = |start: usize| angles.get(start..start + number).unwrap_or_default();
    (from(0), from(lag), from(2 * lag))
}

/// `newest − 2 middle + oldest`, which is exact although the angles wrap.
#[inline]
pub(super) fn difference(oldest: i64, middle: i64, newest: i64) -> i64 {
    let late = newest.wrapping_sub(middle);
    late.wrapping_sub(middle.wrapping_sub(oldest))
}
