//! What can be wrong with an input.

use crate::real::Real;
/// Why a curve could not be made or fitted, or what is stored not written or read.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// The sampling rate is not a positive, finite number of hertz.
    InvalidRate(Real),
    /// The rate per count is not a positive, finite number.
    InvalidScale(Real),
    /// A curve's point is impossible: `m` is not a power of two up to 2^29, not above the one
    /// before it, without differences, or its variance is negative or not finite.
    InvalidPoint {
        /// The point's averaging factor.
        m: u32,
    },
    /// More octaves than the curve has room for.
    TooManyOctaves {
        /// How many it has room for.
        capacity: usize,
    },
    /// Fewer octaves with enough differences than a fit needs: record longer.
    TooFewOctaves {
        /// Octaves that the curve has.
        found: usize,
        /// Octaves that the fit needs.
        needed: usize,
    },
    /// A variance of zero: the counts never changed, so there is no noise to characterise.
    NoNoise {
        /// The averaging factor of the first such octave.
        m: u32,
    },
    /// More effects in a model than it has room for.
    TooManyEffects {
        /// How many it has room for.
        capacity: usize,
    },
    /// An axis that the record does not have.
    UnknownAxis {
        /// The axis that was asked for, counted from 0.
        axis: usize,
        /// How many axes the record has.
        axes: usize,
    },
    /// Samples came at another rate than the configured one: the curve would be shifted along τ.
    RateContradicted {
        /// The rate that was configured, in Hz.
        configured_hz: Real,
        /// The rate that the samples came at, in Hz.
        measured_hz: Real,
    },
    /// The normal equations have no solution: the model's effects cannot be told apart, or a
    /// column is not finite.
    Singular,
    /// A buffer that what is to be stored may not fit into.
    BufferTooSmall {
        /// Bytes that always suffice.
        needed: usize,
    },
    /// Bytes that this library did not write: they start with another magic number.
    Foreign,
    /// More or fewer bytes than were stored.
    WrongLength {
        /// Bytes that were given.
        found: usize,
        /// Bytes that were stored; the least that can be, where not even the head is there.
        stored: usize,
    },
    /// Stored bytes that have changed: their checksum is wrong.
    Corrupt,
    /// A record where a snapshot was to be read, or the other way round.
    OtherKind {
        /// The kind's code: 1 is a snapshot, 2 a record.
        found: u8,
        /// The code of the kind that was to be read.
        wanted: u8,
    },
    /// Written in a version of the format that this library does not know.
    OtherVersion {
        /// The version that it is of.
        found: u8,
        /// The version that is known.
        known: u8,
    },
    /// A snapshot of an accumulator of another number of octaves.
    OtherOctaves {
        /// Octaves of the snapshot.
        found: usize,
        /// Octaves of the accumulator that was to be restored.
        wanted: usize,
    },
    /// A snapshot of other axes, covariates or parts than those that were to be restored, or of another
    /// number of self-tests.
    OtherParts,
    /// A snapshot of a self-test by another plan.
    OtherPlan,
    /// A device's identity of more bytes than a record has room for.
    DeviceTooLong {
        /// How many it has.
        length: usize,
        /// How many there is room for.
        capacity: usize,
    },
    /// Contents that no record of a gyro has, although the checksum is right.
    Impossible,
}

impl core::fmt::Display for Error {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::InvalidRate(rate) => {
                write!(f, "sampling rate {rate} Hz: pass a positive, finite number")
            }
            Self::InvalidScale(scale) => {
                write!(f, "rate per count {scale}: pass a positive, finite number")
            }
            Self::InvalidPoint { m } => write!(
                f,
                "octave m = {m}: averaging factors must be ascending powers of two up to 2^29, \
                 each with differences and a finite variance that is not negative"
            ),
            Self::TooManyOctaves { capacity } => {
                write!(
                    f,
                    "more than {capacity} octaves: use a curve of larger capacity"
                )
            }
            Self::TooFewOctaves { found, needed } => write!(
                f,
                "{found} octaves with enough differences, {needed} needed: record longer"
            ),
            Self::NoNoise { m } => write!(
                f,
                "no noise at all at m = {m}: the counts never change, check the sensor"
            ),
            Self::TooManyEffects { capacity } => {
                write!(f, "more than {capacity} effects in one model: remove one")
            }
            Self::UnknownAxis { axis, axes } => {
                write!(f, "axis {axis} of {axes}: axes count from 0")
            }
            Self::RateContradicted {
                configured_hz,
                measured_hz,
            } => write!(
                f,
                "samples come at {measured_hz:.2} Hz, {configured_hz:.2} Hz were configured: pass \
                 the measured rate, or check the output rate and that every sample is read"
            ),
            Self::Singular => {
                write!(
                    f,
                    "the model's effects cannot be told apart on this curve: remove one"
                )
            }
            Self::BufferTooSmall { needed } => {
                write!(f, "the buffer is too small: give it {needed} bytes")
            }
            Self::Foreign => write!(
                f,
                "neither a snapshot nor a record of allanite: give the bytes that it wrote"
            ),
            Self::WrongLength { found, stored } => write!(
                f,
                "{found} bytes where {stored} were stored: read all of them and no more"
            ),
            Self::Corrupt => write!(
                f,
                "the bytes have changed since they were stored, by their checksum: read them again \
                 or take an older copy"
            ),
            Self::OtherKind { found, wanted } => {
                let name = |kind: &u8| match kind {
                    1 => "snapshot",
                    2 => "record",
                    _ => "unknown kind",
                };
                let (found, wanted) = (name(found), name(wanted));
                write!(f, "a {found} and not a {wanted}: read it as what it is")
            }
            Self::OtherVersion { found, known } => write!(
                f,
                "version {found} of the format, and version {known} is known: use the allanite that \
                 wrote it"
            ),
            Self::OtherOctaves { found, wanted } => write!(
                f,
                "a snapshot of {found} octaves, not {wanted}: restore it into one of {found} octaves"
            ),
            Self::OtherParts => write!(
                f,
                "a snapshot of other axes, covariates, parts or self-tests: restore it into the type \
                 that stored it"
            ),
            Self::OtherPlan => write!(
                f,
                "a snapshot of a self-test by another plan: start the test again"
            ),
            Self::DeviceTooLong { length, capacity } => write!(
                f,
                "the device's identity has {length} bytes: shorten it to {capacity}"
            ),
            Self::Impossible => write!(
                f,
                "contents that no record of a gyro has: store it again from the gyro"
            ),
        }
    }
}

impl core::error::Error for Error {}
