//! The plan of a self-test: what a gyro must meet, and how long the test may take.

use crate::{
    curve::{Curve, Scale},
    ieee_952,
    ieee_952::TERMS,
    numerics::real::Real,
    record::axis::gate::HELD,
};
use heapless::Vec;

/// The name of the limit of the mean rate.
pub const BIAS: &str = "bias";

/// The largest value that a coefficient or the mean rate may have.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Limit {
    /// The name of one of the five IEEE-952 terms, such as `angle_random_walk`, or [`BIAS`].
    pub effect: &'static str,
    /// The largest value, in the coefficient's unit: rate unit · s^(half_seconds/2). That of the bias is the largest mean rate,
    /// of either sign, in rate units; the rate of the earth is a part of what is measured.
    pub most: Real,
}

impl Limit {
    /// Whether a short record can show that it is kept. Slow noise shows in long records only.
    pub(super) fn passes_early(&self) -> bool {
        ["quantization", "angle_random_walk", BIAS].contains(&self.effect)
    }
}

/// The requirements of a self-test.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Plan {
    /// The limits of coefficients and of the bias, at most one for each.
    pub limits: Vec<Limit, { TERMS + 1 }>,
    /// The smallest p-value of the five-term fit, 0 ≤ `least_p` < 1. It is divided among the looks, and a
    /// gyro with a smaller p-value fails. 0 requires nothing: a gyro with a vibration passes as long as no coefficient
    /// that stands for it is above its limit.
    pub least_p: Real,
    /// The largest probability that a gyro at one of its limits passes; above 0 and below 0.5.
    pub false_pass: Real,
    /// The largest probability that a gyro at all of its limits fails; above 0 and below 0.5.
    pub false_fail: Real,
    /// The length of the record at the first look, in seconds.
    pub shortest_s: Real,
    /// The length of the record at the last look, in seconds. The look is due up to 128 samples, or a sixteenth of the record,
    /// before: a gate holds back the last samples, and a station that stops after this time must have a verdict.
    pub longest_s: Real,
}

/// The reason why a plan is not valid.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum InvalidPlan {
    /// The plan has neither a limit nor a smallest p-value.
    NothingAsked,
    /// A limit names something other than one of the five terms or the bias.
    UnknownEffect(&'static str),
    /// Two limits name the same coefficient.
    TwoLimits(&'static str),
    /// A limit is not a positive, finite number.
    InvalidLimit(Limit),
    /// A probability of false pass or false fail is not between 0 and 0.5, or the smallest p-value is not
    /// a probability.
    InvalidProbability(Real),
    /// The shortest length has fewer samples than a fit of two octaves needs, or the longest length is
    /// shorter than the shortest, or it has more than 2³⁰ samples, or more than the octaves can use.
    InvalidLength {
        /// The shortest length of the plan, in seconds.
        shortest_s: Real,
        /// The longest length of the plan, in seconds.
        longest_s: Real,
        /// The longest length that the octaves can use, in seconds.
        most_s: Real,
    },
}

impl Plan {
    /// Returns the numbers of samples at the first and the last look of a test with this many octaves.
    pub(super) fn check(&self, scale: Scale, octaves: usize) -> Result<(u64, u64), InvalidPlan> {
        if self.limits.is_empty() && self.least_p == 0.0 {
            return Err(InvalidPlan::NothingAsked);
        }
        for (i, limit) in self.limits.iter().enumerate() {
            if limit.effect != BIAS && ieee_952::place(limit.effect).is_none() {
                return Err(InvalidPlan::UnknownEffect(limit.effect));
            }
            let mut others = self.limits.iter().take(i);
            if others.any(|other| other.effect == limit.effect) {
                return Err(InvalidPlan::TwoLimits(limit.effect));
            }
            if !(limit.most.is_finite() && limit.most > 0.0) {
                return Err(InvalidPlan::InvalidLimit(*limit));
            }
        }
        for probability in [self.false_pass, self.false_fail] {
            if !(probability > 0.0 && probability < 0.5) {
                return Err(InvalidPlan::InvalidProbability(probability));
            }
        }
        if !(0.0..1.0).contains(&self.least_p) {
            return Err(InvalidPlan::InvalidProbability(self.least_p));
        }
        // A longer record adds no octave.
        let most = (8_u64 << octaves.min(MAX_SAMPLES.ilog2() as usize - 3)).min(MAX_SAMPLES);
        // Beyond 32 bits, a record is too long in any case.
        let samples = |seconds: Real| u64::from((seconds * scale.rate_hz()) as u32);
        let (first, last) = (samples(self.shortest_s), samples(self.longest_s));
        // The number of samples that two octaves need, those of one and of two samples.
        let least = Curve::<2>::MIN_DIFFERENCES + 4;
        if first < least || last < first || last > most {
            return Err(InvalidPlan::InvalidLength {
                shortest_s: self.shortest_s,
                longest_s: self.longest_s,
                most_s: most as Real / scale.rate_hz(),
            });
        }
        let last = last.saturating_sub(last.wrapping_shr(4).min(HELD as u64));
        Ok((first.min(last), last))
    }
}

/// The largest number of samples of a test: two of the longest clusters, of 2^29 samples each.
const MAX_SAMPLES: u64 = 1 << 30;

impl core::fmt::Display for InvalidPlan {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NothingAsked => write!(
                f,
                "the self-test requires nothing: give it a limit or least_p"
            ),
            Self::UnknownEffect(name) => write!(
                f,
                "a limit of {name} cannot be tested: name one of the five IEEE-952 terms, such as \
                 angle_random_walk, or bias"
            ),
            Self::TwoLimits(name) => write!(f, "{name} has two limits: keep the lower one"),
            Self::InvalidLimit(Limit { effect, most }) => {
                write!(
                    f,
                    "the limit {most} of {effect} is impossible: give a positive, finite number"
                )
            }
            Self::InvalidProbability(p) => {
                write!(
                    f,
                    "a probability of {p} is impossible: choose false_pass and false_fail above 0 and \
                     below 0.5, and least_p from 0 to below 1"
                )
            }
            Self::InvalidLength {
                shortest_s,
                longest_s,
                most_s,
            } => write!(
                f,
                "a self-test of {shortest_s} s to {longest_s} s is impossible: begin with at least ten \
                 samples, and end between then and {most_s} s, or use more octaves"
            ),
        }
    }
}

impl core::error::Error for InvalidPlan {}
