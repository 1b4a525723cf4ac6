//! The gaps that were filled, in classes of their lengths.

/// The number of classes of gaps: one lost sample, two, up to 4, 8, 16, 32 and 64.
pub const CLASSES: usize = 7;

/// The number of octaves that leave out differences across some of the gaps that are filled.
pub(super) const TOUCHED: usize = CLASSES;

/// The gaps that were filled, by the number of samples that were lost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub struct Bridged {
    /// The number of gaps of each class: of 1 sample, of 2, of 3 and 4, of 5 to 8, …, of 33 to 64.
    pub gaps: [u32; CLASSES],
    /// The number of samples that were lost in them.
    pub samples: [u32; CLASSES],
}

impl Bridged {
    /// No gap.
    pub const NONE: Self = Self {
        gaps: [0; CLASSES],
        samples: [0; CLASSES],
    };

    /// Whether no gap was filled.
    pub fn is_empty(&self) -> bool {
        self.gaps.iter().all(|&gaps| gaps == 0)
    }

    /// The number of samples that were lost in all gaps.
    pub fn lost(&self) -> u64 {
        self.samples
            .iter()
            .fold(0, |sum, &lost| u64::wrapping_add(sum, lost.into()))
    }

    /// Whether a record can have these gaps.
    pub fn is_possible(&self) -> bool {
        let classes = self.gaps.iter().zip(&self.samples).zip(0_u32..);
        let is_class = |((&gaps, &samples), class): ((&u32, &u32), u32)| {
            let shortest = 1_u64.wrapping_shl(class) / 2 + 1;
            let (gaps, lost) = (u64::from(gaps), u64::from(samples));
            let most = gaps.wrapping_shl(class);
            // Records that are merged without end stay at the largest numbers.
            samples == u32::MAX || (gaps.wrapping_mul(shortest)..=most).contains(&lost)
        };
        classes.into_iter().all(is_class)
    }

    /// The first octave that uses differences across gaps of a class: that of `m = 4` after the loss of a single sample,
    /// and otherwise that of twice the longest gap of the class. Chosen
    /// by hand; no study varies it.
    pub(crate) const fn first_octave(class: usize) -> usize {
        if class < 1 {
            2
        } else {
            class.saturating_add(1)
        }
    }

    pub(super) fn add(&mut self, class: usize, lost: u32) {
        if let (Some(gaps), Some(samples)) = (self.gaps.get_mut(class), self.samples.get_mut(class))
        {
            *gaps = gaps.saturating_add(1);
            *samples = samples.saturating_add(lost);
        }
    }

    /// Adds the gaps of another record.
    pub fn merge(&mut self, other: &Self) {
        for (own, other) in self.gaps.iter_mut().zip(other.gaps) {
            *own = own.saturating_add(other);
        }
        for (own, other) in self.samples.iter_mut().zip(other.samples) {
            *own = own.saturating_add(other);
        }
    }
}

/// The class of a gap of so many samples; `None` if it is too long.
pub(super) const fn class(samples: u64) -> Option<usize> {
    match samples {
        1..=64 => Some((64 - (samples - 1).leading_zeros()) as usize),
        _ => None,
    }
}

/// The number of blocks between the start of a difference and its end.
pub(super) const fn span(k: usize) -> u32 {
    match k {
        0 => 2,
        1 => 4,
        _ => 8,
    }
}
