//! The rails: the values at which a converter clips.

/// The bits of the counts of gyros.
const FORMATS: [u8; 5] = [16, 18, 19, 20, 24];

/// The extremes of the record, and the number of samples at each of them if it is a rail.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Rails {
    /// Whether there was a count, so that `lowest` and `highest` are valid.
    begun: bool,
    lowest: i32,
    highest: i32,
    lowest_hits: u64,
    highest_hits: u64,
}

impl Rails {
    pub(super) const NEW: Self = Self {
        begun: false,
        lowest: 0,
        highest: 0,
        lowest_hits: 0,
        highest_hits: 0,
    };

    /// Whether the count lies strictly between the record's extremes, so that it cannot be at a rail. This
    /// is false for every count while the record is empty, because both extremes are zero then.
    #[inline(always)]
    pub(super) fn is_between(&self, count: i32) -> bool {
        count > self.lowest && count < self.highest
    }

    /// Whether the count is a rail and an extreme of the record.
    pub(super) fn push(&mut self, count: i32, rails: &[i32]) -> bool {
        if self.is_between(count) {
            return false;
        }
        let hit = rails.contains(&count);
        if count < self.lowest || !self.begun {
            (self.lowest, self.lowest_hits) = (count, 0);
        }
        if count > self.highest || !self.begun {
            (self.highest, self.highest_hits) = (count, 0);
        }
        self.begun = true;
        if hit && count == self.lowest {
            self.lowest_hits = self.lowest_hits.saturating_add(1);
        }
        if hit && count == self.highest {
            self.highest_hits = self.highest_hits.saturating_add(1);
        }
        hit
    }

    pub(super) fn hits(&self) -> u64 {
        if self.lowest == self.highest {
            self.lowest_hits
        } else {
            self.lowest_hits.saturating_add(self.highest_hits)
        }
    }

    /// The bits of a range of integers whose ends the extremes are near, and whether it is that of integers without a
    /// sign.
    pub(super) fn range(&self) -> Option<(u8, bool)> {
        let (lowest, highest) = (i64::from(self.lowest), i64::from(self.highest));
        FORMATS.into_iter().find_map(|bits| {
            let whole = 1_i64.wrapping_shl(bits.into());
            let near = whole / 16;
            let unsigned = (0..near).contains(&lowest) && (whole - near..whole).contains(&highest);
            let half = whole / 2;
            let signed =
                (-half..near - half).contains(&lowest) && (half - near..half).contains(&highest);
            (unsigned || signed).then_some((bits, unsigned))
        })
    }

    /// The distance of the extremes.
    pub(super) fn span(&self) -> u32 {
        self.highest.abs_diff(self.lowest)
    }

    pub(super) fn merge(&mut self, other: &Self) {
        if !other.begun {
            return;
        }
        if !self.begun {
            *self = other.clone();
            return;
        }
        if other.lowest < self.lowest {
            (self.lowest, self.lowest_hits) = (other.lowest, other.lowest_hits);
        } else if other.lowest == self.lowest {
            self.lowest_hits = self.lowest_hits.saturating_add(other.lowest_hits);
        }
        if other.highest > self.highest {
            (self.highest, self.highest_hits) = (other.highest, other.highest_hits);
        } else if other.highest == self.highest {
            self.highest_hits = self.highest_hits.saturating_add(other.highest_hits);
        }
    }
}
