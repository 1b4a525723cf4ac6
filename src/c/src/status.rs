//! What functions return, as codes that never change their meaning.

use allanite::{Error, self_test::InvalidPlan, storage};
use core::ffi::{CStr, c_char};

/// What a function returns. A code never changes its meaning.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AllaniteStatus {
    /// All is well.
    Ok = 0,
    /// A pointer is null.
    NullPointer = 1,
    /// A pointer is not aligned as its type wants.
    Misaligned = 2,
    /// The size that was passed is not that of this library: compile with its header and with the same octaves.
    WrongSize = 3,
    /// The memory holds no such value: call the function that makes it.
    NotInitialised = 4,
    /// An argument is outside of its range.
    InvalidArgument = 5,
    /// There is no such axis.
    UnknownAxis = 6,
    /// The record is too short for a fit.
    TooShort = 7,
    /// An octave has no noise: the counts do not change.
    NoNoise = 8,
    /// The effects of a model cannot be distinguished.
    Singular = 9,
    /// A buffer is too small.
    BufferTooSmall = 10,
    /// The stored bytes are not of this library, or damaged, or of something else.
    Corrupt = 11,
    /// The stored bytes have an unknown version.
    UnknownVersion = 12,
    /// The snapshot is of a record with other octaves, axes or parts, or of a self-test with another plan.
    OtherParts = 13,
    /// The plan of a self-test cannot be carried out.
    InvalidPlan = 14,
    /// Any other error, of a later version.
    Other = 15,
    /// The look is not the last one that the self-test began, or was concluded before.
    OtherTest = 16,
    /// The noise of the other record is not that of this one: it is of another sensor, scale or filter.
    OtherSensor = 17,
    /// The record is not one of a gyro at rest: `allanite_record_summary` gives the reason.
    InvalidRecord = 18,
}

impl From<Error> for AllaniteStatus {
    fn from(error: Error) -> Self {
        match error {
            Error::InvalidRate(_)
            | Error::InvalidScale(_)
            | Error::OtherRate { .. }
            | Error::OtherScale { .. }
            | Error::OtherModel => Self::InvalidArgument,
            Error::UnknownAxis { .. } => Self::UnknownAxis,
            Error::TooFewOctaves { .. } => Self::TooShort,
            Error::NoNoise { .. } => Self::NoNoise,
            Error::Singular => Self::Singular,
            Error::OtherTest => Self::OtherTest,
            Error::Invalid(_) => Self::InvalidRecord,
            _ => Self::Other,
        }
    }
}

impl From<storage::Error> for AllaniteStatus {
    fn from(error: storage::Error) -> Self {
        match error {
            storage::Error::BufferTooSmall { .. } => Self::BufferTooSmall,
            storage::Error::UnknownMagic
            | storage::Error::WrongLength { .. }
            | storage::Error::Corrupt
            | storage::Error::WrongKind { .. } => Self::Corrupt,
            storage::Error::UnknownVersion { .. } => Self::UnknownVersion,
            storage::Error::WrongOctaves { .. }
            | storage::Error::OtherParts
            | storage::Error::OtherPlan => Self::OtherParts,
            storage::Error::DeviceTooLong { .. } | storage::Error::Impossible => {
                Self::InvalidArgument
            }
            _ => Self::Other,
        }
    }
}

impl From<InvalidPlan> for AllaniteStatus {
    fn from(_: InvalidPlan) -> Self {
        Self::InvalidPlan
    }
}

/// What a status means, as a sentence that ends with NUL. An unknown number gives "unknown status".
#[unsafe(no_mangle)]
pub extern "C" fn allanite_status_text(status: i32) -> *const c_char {
    // One axis alone has no use for the others, which would take half a kilobyte.
    let text: &CStr = match status {
        0 => c"all is well",
        1 => c"a pointer is null",
        2 => c"a pointer is not aligned as its type wants",
        3 => {
            c"a size is not that of this library: compile with its header and with the same octaves"
        }
        4 => c"the memory holds no such value: call the function that makes it",
        5 => c"an argument is outside of its range",
        #[cfg(feature = "whole")]
        6 => c"there is no such axis: count them from 0",
        7 => c"the record is too short: record longer",
        8 => c"there is no noise, because the counts do not change: check the sensor",
        #[cfg(feature = "whole")]
        9 => c"the effects of a model cannot be told apart",
        10 => c"the buffer is too small",
        #[cfg(feature = "whole")]
        11 => c"the stored bytes are damaged or of something else",
        #[cfg(feature = "whole")]
        12 => c"the stored bytes have an unknown version",
        #[cfg(feature = "whole")]
        13 => c"the stored bytes are of a record with other parts or of another plan",
        #[cfg(feature = "whole")]
        14 => c"the plan of the self-test cannot be carried out",
        #[cfg(feature = "whole")]
        15 => c"another error",
        #[cfg(feature = "whole")]
        16 => c"the look is not the one that the self-test has begun: conclude each look once, by its own test",
        #[cfg(feature = "whole")]
        17 => c"the other record has another noise: merge records of one sensor, read with one scale and filter",
        _ => c"unknown status",
    };
    text.as_ptr()
}
