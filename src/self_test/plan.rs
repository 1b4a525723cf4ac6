//! What a gyro has to meet, and how long the test may take.

use crate::{
    curve::{Curve, Scale},
    effect::IEEE_952,
    limits::MAX_EFFECTS,
    real::Real,
};
use heapless::Vec;

/// The most that a coefficient may be.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Limit {
    /// One of the five IEEE-952 terms, by name: `angle_random_walk`.
    pub effect: &'static str,
    /// In the coefficient's unit: rate unit · s^(half_seconds/2).
    pub most: Real,
}

/// What a self-test asks of a gyro.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Plan {
    /// Limits of coefficients, each at most once.
    pub limits: Vec<Limit, MAX_EFFECTS>,
    /// A gyro fails whose five-term fit has a lower p-value, which is then divided among the looks;
    /// 0 asks for nothing.
    pub least_p: Real,
    /// Probability that a gyro at one of its limits passes, at most; below 0.5.
    pub false_pass: Real,
    /// Probability that a gyro at all of its limits fails, at most; below 0.5.
    pub false_fail: Real,
    /// Length of the record at the first look, in seconds.
    pub shortest_s: Real,
    /// Length of the record at the last, in seconds.
    pub longest_s: Real,
}

/// Why a plan is none.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum InvalidPlan {
    /// Neither a limit nor a least p-value.
    NothingAsked,
    /// A limit of something else than the five terms.
    UnknownEffect(&'static str),
    /// Two limits of one coefficient.
    TwoLimits(&'static str),
    /// A limit that is not a positive, finite number.
    InvalidLimit(Limit),
    /// A probability of false pass or false fail outside 0 to 0.5, or a least p-value that is no
    /// probability.
    InvalidProbability(Real),
    /// The shortest length takes fewer samples than a fit of two octaves, the longest is shorter than the
    /// shortest, or takes more samples than 2³⁰ or than the octaves have a use for.
    InvalidLength {
        /// As planned, in seconds.
        shortest_s: Real,
        /// As planned, in seconds.
        longest_s: Real,
        /// The longest of any use, in seconds.
        most_s: Real,
    },
}

impl Plan {
    /// Samples at the first and the last look of a test with so many octaves.
    pub(super) fn check(&self, scale: Scale, octaves: usize) -> Result<(u64, u64), InvalidPlan> {
        if self.limits.is_empty() && self.least_p == 0.0 {
            return Err(InvalidPlan::NothingAsked);
        }
        for (i, limit) in self.limits.iter().enumerate() {
            if !IEEE_952.iter().any(|effect| effect.name() == limit.effect) {
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
        // Beyond it no octave is added.
        let most = (8_u64 << octaves.min(MAX_SAMPLES.ilog2() as usize - 3)).min(MAX_SAMPLES);
        let samples = |seconds: Real| (seconds * scale.rate_hz()) as u64;
        let (first, last) = (samples(self.shortest_s), samples(self.longest_s));
        // Two octaves, of one and of two samples.
        let least = Curve::<2>::MIN_DIFFERENCES + 4;
        if first < least || last < first || last > most {
            return Err(InvalidPlan::InvalidLength {
                shortest_s: self.shortest_s,
                longest_s: self.longest_s,
                most_s: most as Real / scale.rate_hz(),
            });
        }
        Ok((first, last))
    }
}

const MAX_SAMPLES: u64 = 1 << 30;

impl core::fmt::Display for InvalidPlan {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NothingAsked => write!(f, "a self-test without limits: give one, or least_p"),
            Self::UnknownEffect(name) => write!(
                f,
                "limit of {name}: name one of the five IEEE-952 terms, such as angle_random_walk"
            ),
            Self::TwoLimits(name) => write!(f, "two limits of {name}: keep the lower one"),
            Self::InvalidLimit(Limit { effect, most }) => {
                write!(
                    f,
                    "{effect} of at most {most}: give a positive, finite number"
                )
            }
            Self::InvalidProbability(p) => {
                write!(f, "probability {p}: choose above 0 and below 0.5")
            }
            Self::InvalidLength {
                shortest_s,
                longest_s,
                most_s,
            } => write!(
                f,
                "a self-test of {shortest_s} s to {longest_s} s: at least ten samples, the longest last, \
                 and no longer than {most_s} s, or with more octaves"
            ),
        }
    }
}

impl core::error::Error for InvalidPlan {}
