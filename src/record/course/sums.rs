//! The exact sums of one block of a course.

/// The exact sums of one block. A block spans at most 2^31 samples of time.
///
/// The sum of counts is at most 2^62. A squared difference of two counts is below 2^64, so that the sum of
/// squares is below 2^95. Nothing can overflow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Sums<const COVARIATES: usize> {
    counts: i64,
    /// The lower 64 bits of the sum of squared differences of neighbouring counts.
    squares: u64,
    /// The upper bits of that sum.
    squares_high: u32,
    /// Samples of time that are missing.
    missing: u32,
    /// Samples that have no difference, because a gap lies before them.
    starts: u32,
    covariates: [i64; COVARIATES],
}

impl<const COVARIATES: usize> Sums<COVARIATES> {
    pub(crate) const ZERO: Self = Self {
        counts: 0,
        squares: 0,
        squares_high: 0,
        missing: 0,
        starts: 0,
        covariates: [0; COVARIATES],
    };

    /// Adds a count and the covariates' counts.
    #[inline(always)]
    pub(crate) fn add(&mut self, count: i32, covariates: &[i32; COVARIATES]) {
        self.counts = self.counts.wrapping_add(i64::from(count));
        for (sum, &covariate) in self.covariates.iter_mut().zip(covariates) {
            *sum = sum.wrapping_add(i64::from(covariate));
        }
    }

    /// Adds the squared difference of two neighbouring counts.
    #[inline(always)]
    pub(crate) fn add_difference(&mut self, count: i32, before: i32) {
        let (difference, is_wide) = count.overflowing_sub(before);
        let square = if is_wide {
            wide_square(count, before)
        } else {
            i64::from(difference).wrapping_mul(i64::from(difference)) as u64
        };
        let (squares, carry) = self.squares.overflowing_add(square);
        self.squares = squares;
        self.squares_high = self.squares_high.wrapping_add(u32::from(carry));
    }

    /// Adds counts that follow each other and the one before, and the squares of their differences.
    pub(crate) fn add_slice(&mut self, counts: &[i32], before: i32) {
        let sum = counts.iter().map(|&count| i64::from(count));
        self.counts = self.counts.wrapping_add(sum.fold(0, i64::wrapping_add));
        let mut squares = u128::from(self.squares_high) << 64 | u128::from(self.squares);
        let mut before = before;
        for &count in counts {
            let difference = count.abs_diff(before);
            let square = u64::from(difference).wrapping_mul(difference.into());
            squares = squares.wrapping_add(square.into());
            before = count;
        }
        self.squares = squares as u64;
        self.squares_high = (squares >> 64) as u32;
    }

    /// Counts a sample that has no difference.
    #[inline(always)]
    pub(crate) fn add_start(&mut self) {
        self.starts = self.starts.wrapping_add(1);
    }

    /// Counts samples of time that are missing.
    pub(crate) fn add_missing(&mut self, samples: u32) {
        self.missing = self.missing.saturating_add(samples);
    }

    /// The sums of two blocks together.
    pub(crate) fn merged(&self, other: &Self) -> Self {
        let (squares, carry) = self.squares.overflowing_add(other.squares);
        let mut merged = Self {
            counts: self.counts.wrapping_add(other.counts),
            squares,
            squares_high: self
                .squares_high
                .wrapping_add(other.squares_high)
                .wrapping_add(u32::from(carry)),
            missing: self.missing.saturating_add(other.missing),
            starts: self.starts.saturating_add(other.starts),
            covariates: self.covariates,
        };
        for (sum, other) in merged.covariates.iter_mut().zip(&other.covariates) {
            *sum = sum.wrapping_add(*other);
        }
        merged
    }

    /// The number of samples in a block that spans `time` samples of time.
    pub(crate) const fn samples(&self, time: u32) -> u32 {
        time.saturating_sub(self.missing)
    }

    /// The number of differences in a block that spans `time` samples of time.
    pub(crate) const fn differences(&self, time: u32) -> u32 {
        self.samples(time).saturating_sub(self.starts)
    }

    /// The sum of counts.
    pub(crate) const fn counts(&self) -> i64 {
        self.counts
    }

    /// What is stored beside the covariates: the sum of the counts, the lower and the upper part of that of the
    /// squares, and the numbers of samples that are missing and of those without a difference.
    #[cfg(feature = "storage")]
    pub(crate) const fn parts(&self) -> (i64, u64, u32, u32, u32) {
        let Self {
            counts,
            squares,
            squares_high,
            missing,
            starts,
            ..
        } = *self;
        (counts, squares, squares_high, missing, starts)
    }

    /// The sums of a block that spans `time` samples of time, from what was stored; `None` if no block can have them.
    #[cfg(feature = "storage")]
    pub(crate) fn from_parts(
        (counts, squares, squares_high, missing, starts): (i64, u64, u32, u32, u32),
        covariates: [i64; COVARIATES],
        time: u32,
    ) -> Option<Self> {
        let samples = time.checked_sub(missing)?;
        let differences = samples.checked_sub(starts)?;
        let most = i64::from(samples).wrapping_shl(31);
        let fits = |sum: &i64| (most.wrapping_neg()..=most).contains(sum);
        // A square is below 2^64.
        let possible = squares_high < differences || (squares_high, squares) == (0, 0);
        (fits(&counts) && covariates.iter().all(fits) && possible).then_some(Self {
            counts,
            squares,
            squares_high,
            missing,
            starts,
            covariates,
        })
    }

    /// The sum of squared differences.
    pub(crate) const fn squares(&self) -> u128 {
        (self.squares_high as u128) << 64 | self.squares as u128
    }

    /// The sums of the covariates' counts.
    pub(crate) const fn covariates(&self) -> &[i64; COVARIATES] {
        &self.covariates
    }
}

/// The square of a difference of 32 bits and a sign, which is below 2^64.
#[cold]
#[inline(never)]
fn wide_square(count: i32, before: i32) -> u64 {
    let size = u64::from(count.abs_diff(before));
    size.wrapping_mul(size)
}
