//! The differences of neighbours among some counts, which are judged together.

/// The largest number of counts that are taken together.
pub(super) const MOST: usize = 64;

/// The differences of neighbours among some counts.
pub(super) struct Differences {
    /// Their magnitudes.
    sizes: [u32; MOST],
    pub(super) number: usize,
    /// All bits that are set in any of the magnitudes.
    pub(super) bits: u32,
    /// The sum of their squares.
    pub(super) squares: u64,
    /// How many of them are zero.
    pub(super) repeats: u32,
    /// Whether two in a row are zero.
    pub(super) repeats_twice: bool,
}

impl Differences {
    /// The differences among at most [`MOST`] counts, of which the first one follows `before`.
    #[inline(always)]
    pub(super) fn of(counts: &[i32], before: i32) -> Self {
        let mut sizes = [0; MOST];
        if let (Some(size), Some(&first)) = (sizes.first_mut(), counts.first()) {
            *size = first.abs_diff(before);
        }
        let later = sizes.iter_mut().skip(1);
        for (size, (&before, &count)) in later.zip(counts.iter().zip(counts.iter().skip(1))) {
            *size = count.abs_diff(before);
        }
        let known = sizes.get(..counts.len()).unwrap_or_default();
        let (mut bits, mut squares, mut repeats) = (0, 0_u64, 0_u32);
        for &size in known {
            bits |= size;
            squares = squares.wrapping_add(u64::from(size).wrapping_mul(size.into()));
            repeats = repeats.wrapping_add(u32::from(size == 0));
        }
        let pairs = known.iter().zip(known.iter().skip(1));
        let repeats_twice =
            repeats > 1 && pairs.fold(false, |any, (one, next)| any | (one | next == 0));
        Self {
            number: counts.len(),
            sizes,
            bits,
            squares,
            repeats,
            repeats_twice,
        }
    }

    /// The magnitudes.
    pub(super) fn sizes(&self) -> &[u32] {
        self.sizes.get(..self.number).unwrap_or_default()
    }

    /// Whether the first count repeats the one before it, and whether the last one does.
    pub(super) fn repeats_at_ends(&self) -> (bool, bool) {
        let is_zero = |size: Option<&u32>| size.is_some_and(|&size| size == 0);
        (is_zero(self.sizes().first()), is_zero(self.sizes().last()))
    }
}
