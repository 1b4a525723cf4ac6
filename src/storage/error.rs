//! What can be wrong with what is stored.

/// Why something could not be stored, or why stored bytes could not be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// A buffer that what is to be stored may not fit into.
    BufferTooSmall {
        /// Bytes that always suffice.
        needed: usize,
    },
    /// Bytes that this library did not write: they start with another magic number.
    UnknownMagic,
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
    WrongKind {
        /// The kind's code: 1 is a snapshot, 2 a record.
        found: u8,
        /// The code of the kind that was to be read.
        wanted: u8,
    },
    /// Written in a version of the format that this library does not know.
    UnknownVersion {
        /// The version that it is of.
        found: u8,
        /// The version that is known.
        known: u8,
    },
    /// A snapshot of an accumulator of another number of octaves.
    WrongOctaves {
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
            Self::BufferTooSmall { needed } => {
                write!(f, "the buffer is too small: give it {needed} bytes")
            }
            Self::UnknownMagic => write!(
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
            Self::WrongKind { found, wanted } => {
                let name = |kind: &u8| match kind {
                    1 => "snapshot",
                    2 => "record",
                    _ => "unknown kind",
                };
                let (found, wanted) = (name(found), name(wanted));
                write!(f, "a {found} and not a {wanted}: read it as what it is")
            }
            Self::UnknownVersion { found, known } => write!(
                f,
                "version {found} of the format, and version {known} is known: use the allanite that \
                 wrote it"
            ),
            Self::WrongOctaves { found, wanted } => write!(
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
