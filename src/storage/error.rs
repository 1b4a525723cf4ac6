//! The errors of storing and of reading what is stored.

/// The reason why something could not be stored, or why stored bytes could not be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// The buffer may be too small for what is to be stored.
    BufferTooSmall {
        /// The number of bytes that always suffices.
        needed: usize,
    },
    /// This library did not write the bytes: they do not begin with its magic number.
    UnknownMagic,
    /// There are more or fewer bytes than were stored.
    WrongLength {
        /// The number of bytes given.
        found: usize,
        /// The number of bytes stored; the smallest possible number if the bytes do not even hold the head.
        stored: usize,
    },
    /// The stored bytes have changed: their checksum is wrong.
    Corrupt,
    /// The bytes hold a certificate where a snapshot was expected, or the other way round.
    WrongKind {
        /// The code of the kind found: 1 is a snapshot, 2 a certificate.
        found: u8,
        /// The code of the kind expected.
        wanted: u8,
    },
    /// The bytes have a version of the format that this library does not know.
    UnknownVersion {
        /// The version found.
        found: u8,
        /// The version that this library knows.
        known: u8,
    },
    /// The snapshot has another number of octaves than the accumulator.
    WrongOctaves {
        /// The number of octaves in the snapshot.
        found: usize,
        /// The number of octaves of the accumulator.
        wanted: usize,
    },
    /// The snapshot has other axes, covariates or parts, or another number of self-tests, than the values
    /// that are to be restored.
    OtherParts,
    /// The snapshot holds a self-test with another plan.
    OtherPlan,
    /// The identity of a device has more bytes than a certificate has room for.
    DeviceTooLong {
        /// The number of bytes of the identity.
        length: usize,
        /// The number of bytes that fit.
        capacity: usize,
    },
    /// The checksum is right, but no record of a gyro can have these contents.
    Impossible,
}

impl Error {
    /// What to do about it, as the last words of the message. The alternate form `{:#}` leaves them out.
    pub const fn remedy(&self) -> &'static str {
        match self {
            Self::BufferTooSmall { .. } => "give it as many",
            Self::UnknownMagic => "read the place where it stored one",
            Self::WrongLength { .. } => "read exactly these",
            Self::Corrupt => "read them again or take an older copy",
            Self::WrongKind { .. } => "give the bytes of what is expected",
            Self::UnknownVersion { .. } => "use the allanite that stored them",
            Self::WrongOctaves { .. } => {
                "restore it into an accumulator of as many octaves as the snapshot has"
            }
            Self::OtherParts => "restore it into the type that stored it",
            Self::OtherPlan => "start the test again",
            Self::DeviceTooLong { .. } => "shorten it",
            Self::Impossible => "store them again from the gyro",
        }
    }
}

impl core::fmt::Display for Error {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::BufferTooSmall { needed } => {
                write!(f, "the buffer is too small for {needed} bytes")
            }
            Self::UnknownMagic => write!(
                f,
                "the bytes are neither a snapshot nor a certificate of allanite"
            ),
            Self::WrongLength { found, stored } => {
                write!(f, "{found} bytes were given, but {stored} were stored")
            }
            Self::Corrupt => write!(
                f,
                "the checksum is wrong, because the bytes have changed since they were stored"
            ),
            Self::WrongKind { found, wanted } => {
                let name = |kind: &u8| match kind {
                    1 => "a snapshot",
                    2 => "a certificate",
                    _ => "something unknown",
                };
                let (found, wanted) = (name(found), name(wanted));
                write!(f, "the bytes hold {found} where {wanted} is expected")
            }
            Self::UnknownVersion { found, known } => write!(
                f,
                "the bytes have version {found} of the format, but this allanite reads version {known}"
            ),
            Self::WrongOctaves { found, wanted } => write!(
                f,
                "the snapshot has {found} octaves, but the accumulator has {wanted}"
            ),
            Self::OtherParts => write!(
                f,
                "the snapshot has other axes, covariates, parts or self-tests"
            ),
            Self::OtherPlan => write!(f, "the snapshot holds a self-test with another plan"),
            Self::DeviceTooLong { length, capacity } => write!(
                f,
                "the device's identity has {length} bytes, but there is room for {capacity}"
            ),
            Self::Impossible => write!(
                f,
                "the checksum is right, but no gyro can have stored these contents"
            ),
        }?;
        match f.alternate() {
            true => Ok(()),
            false => write!(f, ": {}", self.remedy()),
        }
    }
}

impl core::error::Error for Error {}
