//! What lies far outside the differences of neighbours that a sequence is used to.

/// A sequence of values, the scale of its neighbours' differences, and where it left its level.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Watch {
    /// Running mean of absolute differences, each cut at [`CUT`] times the mean, in 2^−12. While it
    /// is learnt, the least of the blocks' means.
    scale: u64,
    /// Σ of absolute differences in the present block, while the scale is learnt.
    block: u64,
    /// The largest difference until then.
    largest: u64,
    previous: i64,
    /// The last value that was not far from the one before it.
    reference: i64,
    /// Σ D² of all.
    total: u128,
    /// Differences learnt from.
    learnt: u8,
    /// Values since the last ordinary one.
    outside: u8,
    /// Whether `previous` and `reference` are values of this stretch.
    running: bool,
}

/// How a sequence is judged.
pub(super) struct Rule {
    /// Binary logarithm of the differences in a block; four blocks are learnt from.
    block: u32,
    /// Binary logarithm of the differences that the running mean spans.
    span: u32,
    /// What quantisation may hide of the scale, in 2^−12.
    floor: u64,
    /// The scale that is assumed at least, in 2^−12.
    least: u64,
    factor: u16,
    /// Values after which an excursion is the new level.
    patience: u8,
}

/// What has become of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    /// The first of a stretch.
    Start,
    /// The scale is not known yet.
    Learning,
    /// It is now. The square of the largest difference so far, if that was far beyond it.
    Learnt { outlier: u128 },
    /// As usual.
    Ordinary,
    /// Far from the last ordinary one.
    Out { first: bool },
    /// Ordinary again.
    Back,
    /// Outside for so long that this is the level now.
    Accepted,
}

/// Fraction bits of a scale.
const FRACTION: u32 = 12;
/// Blocks learnt from. The quietest counts, so that a disturbance may last for all but one.
const BLOCKS: u8 = 4;
/// No difference counts for more than so many times the usual.
const CUT: u64 = 2;

impl Rule {
    /// Half a count of quantisation: noise may hide for a while in the middle of a quantum.
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

    /// A sixteenth of a count in the mean, so that a quiet level may change by some quanta.
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

    /// The same, and no mean is expected to be steadier than that of clusters `times` shorter.
    pub(super) const fn with_least(self, shorter: &Watch, times: u16) -> Self {
        Self {
            least: shorter.scale.saturating_mul(times as u64),
            ..self
        }
    }
}

impl Watch {
    pub(super) const NEW: Self = Self {
        scale: u64::MAX,
        block: 0,
        largest: 0,
        previous: 0,
        reference: 0,
        total: 0,
        learnt: 0,
        outside: 0,
        running: false,
    };

    /// Adds a value within ±2^41, and returns the square of its difference from the one before.
    #[inline(always)]
    pub(super) fn push(&mut self, value: i64, rule: &Rule) -> (Fate, u128) {
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
        let difference = value.abs_diff(self.previous);
        self.previous = value;
        let square = square(difference);
        self.total = self.total.saturating_add(square);
        if self.is_learning(rule) {
            self.reference = value;
            return (self.learn(difference, rule), square);
        }
        let usual = self.usual(rule);
        let far =
            value.abs_diff(self.reference) << FRACTION > usual.saturating_mul(rule.factor.into());
        let new = (difference << FRACTION).min(usual.saturating_mul(CUT));
        self.scale = self
            .scale
            .saturating_sub(self.scale.wrapping_shr(rule.span))
            .saturating_add(new.wrapping_shr(rule.span));
        (self.judge(value, far, rule.patience), square)
    }

    #[inline(always)]
    fn judge(&mut self, value: i64, far: bool, patience: u8) -> Fate {
        if far && self.outside < patience {
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
        self.scale.max(rule.least).saturating_add(rule.floor)
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
            self.scale = self
                .scale
                .min((self.block << FRACTION).wrapping_shr(rule.block));
            self.block = 0;
        }
        if self.is_learning(rule) {
            return Fate::Learning;
        }
        // The least of four means of four differences lies at two thirds of the mean.
        self.scale = self.scale.saturating_add(self.scale / 2);
        let usual = self.usual(rule);
        let outlying = self.largest << FRACTION > usual.saturating_mul(rule.factor.into());
        Fate::Learnt {
            outlier: if outlying { square(self.largest) } else { 0 },
        }
    }

    /// The next value does not adjoin the last.
    pub(super) fn gap(&mut self) {
        self.running = false;
        self.outside = 0;
    }

    /// Adds the sums of another sequence; its scale is taken by one that knows less.
    pub(super) fn merge(&mut self, other: &Self) {
        let total = self.total.saturating_add(other.total);
        if other.learnt > self.learnt {
            *self = other.clone();
            self.gap();
        }
        self.total = total;
    }

    /// The last ordinary value.
    pub(super) fn reference(&self) -> i64 {
        self.reference
    }

    /// Whether the last value was far from the last ordinary one.
    pub(super) fn is_outside(&self) -> bool {
        self.outside > 0
    }

    /// Σ D² of neighbours.
    pub(super) fn total(&self) -> u128 {
        self.total
    }
}

#[inline(always)]
fn square(difference: u64) -> u128 {
    match u32::try_from(difference) {
        Ok(short) => u128::from(u64::from(short) * u64::from(short)),
        Err(_) => u128::from(difference) * u128::from(difference),
    }
}
