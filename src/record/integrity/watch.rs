//! Detects values that deviate from their neighbours by far more than is usual in their sequence.

use super::differences::{Differences, MOST};

/// A sequence of values, the scale of the differences of its neighbours, and its departures from its level.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Watch {
    /// The running mean of absolute differences, each limited to [`CUT`] times the mean, in units of
    /// 2^−12. While the scale is learnt, it is the smallest of the blocks' means. It stays below 2^55,
    /// because a difference stays below 2^42.
    scale: u64,
    /// The sum of absolute differences in the present block, while the scale is learnt.
    block: u64,
    /// The largest difference while the scale is learnt.
    largest: u64,
    previous: i64,
    /// The last value that was not far from the one before it.
    reference: i64,
    /// Σ D² of all differences of neighbours, lower limb first. A carry between the limbs is rare.
    total: [u64; 2],
    /// The number of differences that the scale was learnt from.
    learnt: u8,
    /// The number of values since the last ordinary one.
    outside: u8,
    /// Whether `previous` and `reference` belong to the present stretch, without a gap after them.
    running: bool,
    /// Whether the scale is known and the last value was ordinary. Then `previous` is the reference, and
    /// `reference` is out of date.
    steady: bool,
}

/// The rule by which a sequence is judged.
pub(super) struct Rule {
    /// The binary logarithm of the number of differences in a block. The scale is learnt from four blocks.
    block: u32,
    /// The binary logarithm of the number of differences that the running mean covers.
    span: u32,
    /// The part of the scale that quantisation may hide, in units of 2^−12.
    floor: u64,
    /// The smallest scale that is assumed, in units of 2^−12.
    least: u64,
    factor: u16,
    /// The number of values after which an excursion is taken for the new level.
    patience: u8,
}

/// The judgement of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    /// It is the first value of a stretch.
    Start,
    /// The scale is not known yet.
    Learning,
    /// The scale is known from this value on. `outlier` is the square of the largest difference so far if
    /// that exceeds the limit, and 0 otherwise.
    Learnt { outlier: u128 },
    /// The value is as usual.
    Ordinary,
    /// The value is far from the last ordinary one.
    Out { first: bool },
    /// The value is ordinary again after an excursion.
    Back,
    /// Values were outside for so long that this is the new level.
    Accepted,
}

/// The number of fraction bits of a scale.
const FRACTION: u32 = 12;
/// The number of blocks that the scale is learnt from. The quietest block counts, so that a disturbance
/// may last for all blocks but one. Chosen by hand; no study varies it.
const BLOCKS: u8 = 4;
/// A difference enters the scale with at most this multiple of the usual difference. Chosen by hand, so
/// that a spike of any size raises the scale of samples by 1 %.
const CUT: u64 = 2;

/// The integer in which usual values are judged: what the core computes with at once.
#[cfg(target_pointer_width = "64")]
type Word = u64;
#[cfg(not(target_pointer_width = "64"))]
type Word = u32;

/// The scales below which usual values are judged in a [`Word`]. Records that were rounded from floats have scales
/// beyond 2^30; their limit of 64 bits is far below the overflow of its product with a factor of 16 bits.
const USUAL_BELOW: u64 = 1 << if Word::BITS == 64 { 46 } else { 30 };

impl Rule {
    /// The rule for neighbouring samples. Its floor is half a count, because noise may be hidden for a while
    /// in the middle of a quantum. Its other numbers are chosen by hand; no study varies them.
    pub(super) const fn neighbours(factor: u16) -> Self {
        Self {
            block: 4,
            span: 8,
            floor: 1 << (FRACTION - 1),
            least: 0,
            factor,
            patience: 3,
        }
    }

    /// The rule for clusters of the given length. Its floor is a sixteenth of a count in the mean, so that a
    /// quiet level may change by some quanta. Its other numbers are chosen by hand; no study varies them.
    pub(super) const fn clusters(factor: u16, length: u16) -> Self {
        Self {
            block: 2,
            span: 7,
            floor: (length as u64) << (FRACTION - 4),
            least: 0,
            factor,
            patience: 64,
        }
    }

    /// The same rule with a smallest scale: the scale of clusters `times` shorter, multiplied by `times`.
    /// The mean of a longer cluster is not expected to be steadier than that of a shorter one.
    pub(super) const fn with_least(self, shorter: &Watch, times: u16) -> Self {
        Self {
            least: shorter.scale.wrapping_mul(times as u64),
            ..self
        }
    }
}

impl Watch {
    pub(super) const NEW: Self = Self {
        scale: 0,
        block: 0,
        largest: 0,
        previous: 0,
        reference: 0,
        total: [0; 2],
        learnt: 0,
        outside: 0,
        running: false,
        steady: false,
    };

    /// Adds a value if it is as usual, and returns whether it was added. Nearly every sample takes this path,
    /// which computes in a [`Word`]. If the value may be odd or a number does not fit, nothing is added, and
    /// [`push`](Self::push) decides.
    #[allow(
        clippy::cast_lossless,
        clippy::unnecessary_cast,
        reason = "a Word is a u64 on some cores and a u32 on others"
    )]
    #[inline(always)]
    pub(super) fn push_usual(&mut self, value: i32, rule: &Rule) -> bool {
        let scale = self.scale as Word;
        if !self.steady || self.scale >= USUAL_BELOW {
            return false;
        }
        let difference = value.abs_diff(self.previous as i32);
        let usual = scale.wrapping_add(rule.floor as Word);
        let long = u64::from(difference) << FRACTION;
        if long > (usual as u64).wrapping_mul(rule.factor.into()) {
            return false;
        }
        let [low, _] = &mut self.total;
        let Some(sum) = low.checked_add(u64::from(difference) * u64::from(difference)) else {
            return false;
        };
        *low = sum;
        // The result is at most twice the largest scale.
        let new = long.min(usual.wrapping_mul(CUT as Word) as u64) as Word;
        let scale = scale.wrapping_sub(scale.wrapping_shr(rule.span));
        self.scale = scale.wrapping_add(new.wrapping_shr(rule.span)) as u64;
        self.previous = value.into();
        true
    }

    /// Whether the scale is known, and the last value was this one and ordinary.
    pub(super) fn is_steady_at(&self, value: i32) -> bool {
        self.steady && self.scale < USUAL_BELOW && self.previous == i64::from(value)
    }

    /// Adds values if all of them are as usual for certain, and returns whether they were added. `last` is the last
    /// one. The watch is [steady](Self::is_steady_at).
    #[inline(always)]
    pub(super) fn push_usual_slice(
        &mut self,
        differences: &Differences,
        last: i32,
        rule: &Rule,
    ) -> bool {
        // A value lowers the scale by a 256th at most. So 64 of them leave three quarters of it.
        const { assert!(MOST <= 64) };
        let least = self
            .scale
            .wrapping_sub(self.scale / 4)
            .wrapping_add(rule.floor);
        let largest = u64::from(differences.bits) << FRACTION;
        if rule.span < 8 || largest > least.wrapping_mul(rule.factor.into()) {
            return false;
        }
        let [low, _] = &mut self.total;
        let Some(sum) = low.checked_add(differences.squares) else {
            return false;
        };
        *low = sum;
        // This is the arithmetic of `push_usual`, in an order in which a value waits for the one before it as briefly as
        // possible.
        let mut usual = self.scale.wrapping_add(rule.floor);
        for &difference in differences.sizes() {
            let new = (u64::from(difference) << FRACTION).wrapping_shr(rule.span);
            let most = usual.wrapping_mul(CUT).wrapping_shr(rule.span);
            let faded = usual.wrapping_sub(rule.floor).wrapping_shr(rule.span);
            usual = usual.wrapping_sub(faded).wrapping_add(new.min(most));
        }
        self.scale = usual.wrapping_sub(rule.floor);
        self.previous = last.into();
        true
    }

    /// Notes that this value repeated the one before it and was ordinary.
    pub(super) fn repeat(&mut self, value: i32) {
        self.reference = value.into();
    }

    /// Adds a value within ±2^41, and returns the magnitude of its difference from the one before.
    #[inline(always)]
    pub(super) fn push(&mut self, value: i64, rule: &Rule) -> (Fate, u64) {
        if !self.running {
            self.running = true;
            (self.previous, self.reference) = (value, value);
            let fate = if self.is_learning(rule) {
                Fate::Learning
            } else {
                Fate::Start
            };
            return (fate, 0);
        }
        if self.steady {
            self.reference = self.previous;
        }
        let difference = value.abs_diff(self.previous);
        self.previous = value;
        self.add_to_total(difference);
        if self.is_learning(rule) {
            self.reference = value;
            return (self.learn(difference, rule), difference);
        }
        // `usual` is below 2^56, so that the product is below 2^64 for the largest factor.
        let usual = self.usual(rule);
        let limit = usual.wrapping_mul(rule.factor.into());
        let far = value.abs_diff(self.reference) << FRACTION > limit;
        let new = (difference << FRACTION).min(usual.wrapping_mul(CUT));
        self.scale = self
            .scale
            .wrapping_sub(self.scale.wrapping_shr(rule.span))
            .wrapping_add(new.wrapping_shr(rule.span));
        (self.judge(value, far, rule.patience), difference)
    }

    #[inline(always)]
    fn add_to_total(&mut self, difference: u64) {
        let short = difference as u32;
        if u64::from(short) == difference {
            let [low, _] = &mut self.total;
            if let Some(sum) = low.checked_add(u64::from(short) * u64::from(short)) {
                *low = sum;
                return;
            }
        }
        self.add_long_to_total(difference);
    }

    #[cold]
    #[inline(never)]
    fn add_long_to_total(&mut self, difference: u64) {
        self.set_total(self.total().saturating_add(square(difference)));
    }

    fn set_total(&mut self, total: u128) {
        self.total = [total as u64, (total >> 64) as u64];
    }

    #[inline(always)]
    fn judge(&mut self, value: i64, far: bool, patience: u8) -> Fate {
        self.steady = !far || self.outside >= patience;
        if !self.steady {
            self.outside = self.outside.saturating_add(1);
            return Fate::Out {
                first: self.outside == 1,
            };
        }
        let fate = match (far, self.outside) {
            (true, _) => Fate::Accepted,
            (false, 0) => Fate::Ordinary,
            (false, _) => Fate::Back,
        };
        self.outside = 0;
        self.reference = value;
        fate
    }

    fn usual(&self, rule: &Rule) -> u64 {
        self.scale.max(rule.least).wrapping_add(rule.floor)
    }

    fn is_learning(&self, rule: &Rule) -> bool {
        self.learnt < BLOCKS.wrapping_shl(rule.block)
    }

    #[cold]
    #[inline(never)]
    fn learn(&mut self, difference: u64, rule: &Rule) -> Fate {
        self.largest = self.largest.max(difference);
        self.block = self.block.saturating_add(difference);
        self.learnt = self.learnt.saturating_add(1);
        if self.learnt.trailing_zeros() >= rule.block {
            let mean = (self.block << FRACTION).wrapping_shr(rule.block);
            let is_first = self.learnt == 1_u8.wrapping_shl(rule.block);
            self.scale = if is_first { mean } else { self.scale.min(mean) };
            self.block = 0;
        }
        if self.is_learning(rule) {
            return Fate::Learning;
        }
        // The smallest of four means of four differences is about two thirds of the mean.
        self.scale = self.scale.saturating_add(self.scale / 2);
        let usual = self.usual(rule);
        let outlying = self.largest << FRACTION > usual.saturating_mul(rule.factor.into());
        Fate::Learnt {
            outlier: if outlying { square(self.largest) } else { 0 },
        }
    }

    /// Notes that the next value does not adjoin the last one.
    pub(super) fn gap(&mut self) {
        (self.running, self.steady) = (false, false);
        self.outside = 0;
        (self.previous, self.reference) = (0, 0);
    }

    /// Adds the sums of another sequence, and takes over its scale if that was learnt from more differences.
    pub(super) fn merge(&mut self, other: &Self) {
        let total = self.total().saturating_add(other.total());
        if other.learnt > self.learnt {
            *self = other.clone();
            self.gap();
        }
        self.set_total(total);
    }

    /// The last ordinary value.
    pub(super) fn reference(&self) -> i64 {
        if self.steady {
            self.previous
        } else {
            self.reference
        }
    }

    /// Whether the last value was far from the last ordinary one.
    pub(super) fn is_outside(&self) -> bool {
        self.outside > 0
    }

    /// Σ D² of neighbours.
    pub(super) const fn total(&self) -> u128 {
        let [low, high] = self.total;
        low as u128 | (high as u128) << 64
    }

    /// Whether a sequence that ended with a gap can have left this state.
    #[cfg(feature = "storage")]
    pub(super) const fn is_possible(&self) -> bool {
        let quiet = !self.running && !self.steady && self.outside == 0;
        quiet && self.learnt <= 64 && self.scale < 1 << 55 && self.block < 1 << 48
    }
}

pub(super) fn square(difference: u64) -> u128 {
    u128::from(difference) * u128::from(difference)
}
