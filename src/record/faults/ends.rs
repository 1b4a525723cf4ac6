//! How often the largest and the smallest value occur, compared with their neighbours.

/// One end of a record's range. The lower one is that of the values with the opposite sign.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct End {
    begun: bool,
    value: i64,
    /// The samples at the end, one step from it, and two.
    pub(crate) near: [u64; 3],
    /// How often a value came to the end from another one.
    pub(crate) entries: u64,
}

impl End {
    pub(super) const NEW: Self = Self {
        begun: false,
        value: 0,
        near: [0; 3],
        entries: 0,
    };

    /// The end, whose sign is the opposite one at the lower end.
    pub(crate) const fn value(&self) -> i64 {
        self.value
    }

    /// Whether there was a value.
    pub(super) const fn has_begun(&self) -> bool {
        self.begun
    }

    /// Adds a value, which repeats the one before it or not. `steps` tells how many steps long a distance is.
    #[inline(always)]
    pub(super) fn push(&mut self, value: i64, repeats: bool, steps: impl Fn(u32) -> u8) {
        // The distance between values of 32 bits fits into 32 bits.
        let distance = value.abs_diff(self.value) as u32;
        if value > self.value || !self.begun {
            let [first, second, _] = self.near;
            self.near = match steps(distance) {
                1 if self.begun => [1, first, second],
                2 if self.begun => [1, 0, first],
                _ => [1, 0, 0],
            };
            (self.begun, self.value, self.entries) = (true, value, 1);
            return;
        }
        if let Some(near) = self.near.get_mut(usize::from(steps(distance))) {
            *near = near.saturating_add(1);
        }
        let enters = distance == 0 && !repeats;
        self.entries = self.entries.saturating_add(u64::from(enters));
    }
}
