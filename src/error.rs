//! What can be wrong with an input.

use crate::{numerics::real::Real, record::integrity::Reason};

/// Why a curve could not be made or fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// The record is not one of a gyro at rest, or not of what the sensor sent.
    Invalid(Reason),
    /// The sampling rate is not a positive, finite number of hertz.
    InvalidRate(Real),
    /// The rate per count is not a positive, finite number.
    InvalidScale(Real),
    /// A point of the curve is impossible. Its `m` is not a power of two up to 2^29 or not above the
    /// one before it, or it has no differences, or its variance is negative or not finite.
    InvalidPoint {
        /// The point's averaging factor.
        m: u32,
    },
    /// There are more octaves than the curve has room for.
    TooManyOctaves {
        /// The number of octaves that there is room for.
        capacity: usize,
    },
    /// Segments of a spectrum cannot have this length. It must be a power of two from 32 to 256.
    InvalidSegment {
        /// The number of blocks in a segment.
        length: u32,
    },
    /// A bin of the spectrum is impossible. Its `block` is not a power of 8 up to 8^9, or its index is not
    /// one of the bins that are kept, or it does not come after the bin before it, or it has no segments, or
    /// its density or its kurtosis is negative or not finite.
    InvalidBin {
        /// The number of samples in the bin's blocks.
        block: u32,
        /// The bin's number of periods in a segment.
        index: u32,
    },
    /// There are more bins than the spectrum has room for.
    TooManyBins {
        /// The number of bins that there is room for.
        capacity: usize,
    },
    /// The cosine transform of a course is impossible. It has 32 to 64 blocks, each of a power of two of samples, and one
    /// density less than blocks, none of which is negative or not finite.
    InvalidCourse {
        /// The number of samples in a block.
        block: u32,
        /// The number of blocks.
        blocks: u32,
    },
    /// Fewer octaves have enough differences than the fit needs: record longer.
    TooFewOctaves {
        /// The number of octaves that the curve has.
        found: usize,
        /// The number of octaves that the fit needs.
        needed: usize,
    },
    /// An octave has a variance of zero: the counts never changed, or repeated in a cycle of `m`
    /// samples, so there is no noise to characterise.
    NoNoise {
        /// The averaging factor of the first such octave.
        m: u32,
    },
    /// There are more effects than a model has room for.
    TooManyEffects {
        /// The number of effects that there is room for.
        capacity: usize,
    },
    /// The record does not have the axis that was asked for.
    UnknownAxis {
        /// The axis that was asked for, counted from 0.
        axis: usize,
        /// The number of axes that the record has.
        axes: usize,
    },
    /// The samples came at another rate than the configured one, which would shift the curve along τ.
    RateContradicted {
        /// The configured rate, in Hz.
        configured_hz: Real,
        /// The rate at which the samples came, in Hz.
        measured_hz: Real,
    },
    /// The record has another rate than the one that a self-test was made for.
    OtherRate {
        /// The rate of the record, in Hz.
        record_hz: Real,
        /// The rate that the self-test was made for, in Hz.
        test_hz: Real,
    },
    /// The record has another unit than the one that a self-test was made for.
    OtherScale {
        /// The rate per count of the record.
        record: Real,
        /// The rate per count that the self-test was made for.
        test: Real,
    },
    /// A look is concluded by a test that did not begin it, or has begun another one since, or has concluded it.
    OtherTest,
    /// The fit is one of another model: the effects are not the same ones in the same order.
    OtherModel,
    /// The normal equations have no solution. The model's effects cannot be distinguished, or a column is
    /// not finite.
    Singular,
}

impl Error {
    /// What to do about it, as the last words of the message. The alternate form `{:#}` leaves them out.
    pub const fn remedy(&self) -> &'static str {
        match self {
            Self::Invalid(_) => "or fit its curve alone",
            Self::InvalidRate(_) | Self::InvalidScale(_) => "pass a positive, finite number",
            Self::InvalidPoint { .. } => {
                "give ascending powers of two up to 2^29, each with differences and a finite variance that is not negative"
            }
            Self::TooManyOctaves { .. } => "use a curve of larger capacity",
            Self::InvalidSegment { .. } => "give a power of two from 32 to 256",
            Self::InvalidBin { .. } => {
                "give ascending bins of powers of 8 up to 8^9, each with segments and a finite density that is not negative"
            }
            Self::TooManyBins { .. } => "use a spectrum of larger capacity",
            Self::InvalidCourse { .. } => {
                "give 32 to 64 blocks of a power of two, and one finite density less that is not negative"
            }
            Self::TooFewOctaves { .. } => "record longer",
            Self::NoNoise { .. } => "check the sensor",
            Self::TooManyEffects { .. } | Self::Singular => "remove one",
            Self::UnknownAxis { .. } => "count them from 0",
            Self::OtherRate { .. } | Self::OtherScale { .. } => {
                "make the test with the scale of the record"
            }
            Self::OtherTest => "conclude each look once, by the test that began it",
            Self::OtherModel => "compare a fit with the model that was fitted",
            Self::RateContradicted { .. } => {
                "pass the measured rate, or check the output rate and that every sample is read"
            }
        }
    }
}

impl core::fmt::Display for Error {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Invalid(reason) => write!(f, "the record is not valid: {reason}"),
            Self::InvalidRate(rate) => write!(f, "a sampling rate of {rate} Hz is impossible"),
            Self::InvalidScale(scale) => write!(f, "a rate per count of {scale} is impossible"),
            Self::InvalidPoint { m } => write!(f, "the octave at m = {m} is impossible"),
            Self::TooManyOctaves { capacity } => {
                write!(f, "there are more than {capacity} octaves")
            }
            Self::InvalidSegment { length } => {
                write!(f, "segments of {length} blocks are impossible")
            }
            Self::InvalidBin { block, index } => write!(
                f,
                "the bin {index} of blocks of {block} samples is impossible"
            ),
            Self::TooManyBins { capacity } => write!(f, "there are more than {capacity} bins"),
            Self::InvalidCourse { block, blocks } => write!(
                f,
                "a course of {blocks} blocks of {block} samples, or its densities, are impossible"
            ),
            Self::TooFewOctaves { found, needed } => write!(
                f,
                "only {found} of the {needed} octaves that a fit needs have enough differences"
            ),
            Self::NoNoise { m: 1 } => write!(
                f,
                "there is no noise at m = 1, because the counts never change"
            ),
            Self::NoNoise { m } => write!(
                f,
                "there is no noise at m = {m}, because the counts repeat in a cycle"
            ),
            Self::TooManyEffects { capacity } => {
                write!(f, "the model would have more than {capacity} effects")
            }
            Self::UnknownAxis { axis, axes } => {
                write!(f, "there is no axis {axis} among {axes} axes")
            }
            Self::RateContradicted {
                configured_hz,
                measured_hz,
            } => write!(
                f,
                "samples come at {measured_hz:.2} Hz, but {configured_hz:.2} Hz are configured"
            ),
            Self::OtherRate { record_hz, test_hz } => write!(
                f,
                "the record has {record_hz:.2} Hz, but the self-test was made for {test_hz:.2} Hz"
            ),
            Self::OtherScale { record, test } => write!(
                f,
                "a count of the record is {record}, but the self-test was made for {test}"
            ),
            Self::OtherTest => write!(f, "the look is not the one that the test has begun"),
            Self::OtherModel => write!(f, "the fit is one of another model"),
            Self::Singular => write!(f, "the model's effects cannot be told apart on this curve"),
        }?;
        match f.alternate() {
            true => Ok(()),
            false => write!(f, ": {}", self.remedy()),
        }
    }
}

impl core::error::Error for Error {}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::Error;
    use std::string::ToString as _;

    #[test]
    fn messages_end_with_their_remedies() {
        for error in [
            Error::Invalid(crate::integrity::Reason::Misread { bits: 16 }),
            Error::InvalidRate(-1.0),
            Error::TooFewOctaves {
                found: 1,
                needed: 2,
            },
            Error::NoNoise { m: 1 },
            Error::NoNoise { m: 4 },
            Error::OtherRate {
                record_hz: 100.0,
                test_hz: 200.0,
            },
            Error::OtherScale {
                record: 1.0,
                test: 2.0,
            },
            Error::OtherTest,
            Error::OtherModel,
            Error::Singular,
        ] {
            let parts = std::format!("{error:#}: {}", error.remedy());
            assert_eq!(error.to_string(), parts);
        }
    }
}
