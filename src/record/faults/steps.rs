//! Differences of neighbours in steps of the numbers: how many are zero, one, two and three steps long.

/// The number of counts that are taken together.
pub(super) const CHUNK: usize = 64;

/// The number of differences from which the usual one is learnt.
const LEARNT: u16 = 256;

/// The number of steps from which a difference is no longer counted.
pub(crate) const FAR: u8 = 4;

/// The differences of neighbours. The step is the smallest one that is not zero: 1 for counts, more for numbers that
/// were rounded before they became counts.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Steps {
    /// 0 as long as all differences are zero.
    step: u32,
    /// The differences since the step is known.
    pub(crate) pairs: u64,
    /// How many of these are 0, 1, 2 and 3 steps long.
    pub(crate) near: [u64; FAR as usize],
    learnt: u16,
    /// The sum of the differences from which the usual one is learnt.
    usual: u64,
    /// The differences behind the learnt ones, how many of them are zero, and how many others are at most a 64th of the
    /// usual one.
    pub(crate) later: u64,
    pub(crate) zero: u64,
    pub(crate) small: u64,
}

impl Steps {
    pub(super) const NEW: Self = Self {
        step: 0,
        pairs: 0,
        near: [0; FAR as usize],
        learnt: 0,
        usual: 0,
        later: 0,
        zero: 0,
        small: 0,
    };

    /// The size of a step in counts.
    pub(crate) const fn step(&self) -> u32 {
        self.step
    }

    /// A 64th of the usual difference, in counts. Where it is 0, counts are coarser than that.
    pub(crate) const fn window(&self) -> u64 {
        if self.learnt < LEARNT {
            return 0;
        }
        self.usual >> 14
    }

    /// How many steps long a difference is, at most [`FAR`].
    #[inline(always)]
    pub(super) fn class(&self, difference: u32) -> u8 {
        let (twice, step) = (u64::from(difference) << 1, u64::from(self.step));
        match twice {
            0 => 0,
            twice if twice >= 7 * step => FAR,
            twice if twice < 3 * step => 1,
            twice if twice < 5 * step => 2,
            _ => 3,
        }
    }

    /// Adds the magnitude of a difference, and returns how many steps long it is.
    #[inline(always)]
    pub(super) fn push(&mut self, difference: u32) -> u8 {
        if difference > 0 && (difference < self.step || self.step == 0) {
            self.shorten(difference);
        }
        let class = self.class(difference);
        self.pairs = self.pairs.saturating_add(1);
        if let Some(near) = self.near.get_mut(usize::from(class)) {
            *near = near.saturating_add(1);
        }
        if self.learnt < LEARNT {
            self.learnt = self.learnt.saturating_add(1);
            self.usual = self.usual.saturating_add(difference.into());
        } else {
            self.later = self.later.saturating_add(1);
            self.zero = self.zero.saturating_add(u64::from(difference == 0));
            let is_small = difference > 0 && u64::from(difference) <= self.usual >> 14;
            self.small = self.small.saturating_add(u64::from(is_small));
        }
        class
    }

    /// Adds the differences of a chunk, writes how many steps each of them has, and returns how many are zero. If one is shorter
    /// than a step, or if it is not yet known which are usual, it does nothing and returns `None`.
    pub(super) fn push_chunk(
        &mut self,
        differences: &[u32; CHUNK],
        classes: &mut [u8; CHUNK],
    ) -> Option<u32> {
        let step = self.step;
        if self.learnt < LEARNT || step == 0 || step > u32::MAX / 7 {
            return None;
        }
        // The shortest differences of two, three and four steps: 2 d ≥ 3 s, 5 s and 7 s.
        let [two, three, four] = [3, 5, 7].map(|halves| (step * halves).div_ceil(2));
        let small = u32::try_from(self.usual >> 14).unwrap_or(u32::MAX);
        let mut shorter = 0;
        let mut numbers = [0_u32; 5];
        for (class, &difference) in classes.iter_mut().zip(differences) {
            let is = [
                difference == 0,
                difference >= two,
                difference >= three,
                difference >= four,
                difference.wrapping_sub(1) < small,
            ]
            .map(u32::from);
            shorter |= u32::from(difference.wrapping_sub(1) < step.wrapping_sub(1));
            for (number, is) in numbers.iter_mut().zip(is) {
                *number = number.wrapping_add(is);
            }
            let [zero, two, three, four, _] = is;
            *class = (1 - zero + two + three + four) as u8;
        }
        if shorter > 0 {
            return None;
        }
        let chunk = CHUNK as u32;
        let [zero, two, three, four, small] = numbers;
        let near = [
            zero,
            chunk.wrapping_sub(zero).wrapping_sub(two),
            two.wrapping_sub(three),
            three.wrapping_sub(four),
        ];
        self.pairs = self.pairs.saturating_add(chunk.into());
        for (own, number) in self.near.iter_mut().zip(near) {
            *own = own.saturating_add(number.into());
        }
        self.later = self.later.saturating_add(chunk.into());
        self.zero = self.zero.saturating_add(zero.into());
        self.small = self.small.saturating_add(small.into());
        Some(zero)
    }

    /// Takes a shorter step. What was counted in one that is far too long is forgotten; rounding to counts makes steps
    /// of the same length differ a little.
    #[cold]
    #[inline(never)]
    fn shorten(&mut self, step: u32) {
        if u64::from(step) * 4 < u64::from(self.step) * 3 {
            (self.pairs, self.near) = (0, [0; FAR as usize]);
        }
        self.step = step;
    }
}
