//! How often the largest and the smallest value occur, beside their neighbours.

/// One end of a record's range. The lower one is that of the values with the opposite sign.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct End {
    begun: bool,
    value: i64,
    /// How often a value came to the end, to one step from it, and to two. Values that only stay there do not count.
    pub(crate) near: [u64; 3],
    /// The samples at the end, those that stay included.
    pub(crate) samples: u64,
}

impl End {
    pub(super) const NEW: Self = Self {
        begun: false,
        value: 0,
        near: [0; 3],
        samples: 0,
    };

    /// Adds a value that differs from the one before it. `steps` tells how many steps long a distance is.
    #[inline(always)]
    pub(super) fn push(&mut self, value: i64, steps: impl Fn(u32) -> u8) {
        // The distance between values of 32 bits fits into 32 bits.
        let distance = value.abs_diff(self.value) as u32;
        if value > self.value || !self.begun {
            let [first, second, _] = self.near;
            self.near = match steps(distance) {
                1 if self.begun => [1, first, second],
                2 if self.begun => [1, 0, first],
                _ => [1, 0, 0],
            };
            (self.begun, self.value, self.samples) = (true, value, 1);
            return;
        }
        if let Some(near) = self.near.get_mut(usize::from(steps(distance))) {
            *near = near.saturating_add(1);
        }
        self.samples = self.samples.saturating_add(u64::from(distance == 0));
    }

    /// Adds a value that repeats the one before it.
    #[inline(always)]
    pub(super) fn stay(&mut self, value: i64) {
        self.samples = self.samples.saturating_add(u64::from(value == self.value));
    }
}
