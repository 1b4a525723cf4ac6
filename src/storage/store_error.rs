//! Why a store in flash failed.

use super::error::Error;
use sequential_storage::map::SerializationError;

/// The reason why a snapshot was not stored or not read.
#[derive(Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum StoreError<E> {
    /// The range does not consist of at least two whole pages within the flash.
    InvalidRange,
    /// The driver of the flash failed.
    Flash(E),
    /// A load did not find all of a snapshot, because the flash was damaged or something else wrote into the range. A save
    /// did not read back what it wrote, even after it had erased the range: the flash is worn.
    Damaged,
    /// The range has too few pages.
    Full,
    /// The snapshot has more than a hundred pieces.
    TooLong {
        /// Its length in bytes.
        found: usize,
        /// The largest length.
        longest: usize,
    },
    /// The buffer is too small.
    BufferTooSmall {
        /// The number of bytes that it must have.
        needed: usize,
    },
    /// The snapshot could not be written or restored.
    Snapshot(Error),
}

impl<E> From<sequential_storage::Error<E>> for StoreError<E> {
    fn from(error: sequential_storage::Error<E>) -> Self {
        use sequential_storage::Error as Map;
        match error {
            Map::Storage { value, .. } => Self::Flash(value),
            Map::FullStorage | Map::ItemTooBig => Self::Full,
            Map::BufferTooSmall(needed) => Self::BufferTooSmall { needed },
            Map::SerializationError(SerializationError::BufferTooSmall) => {
                Self::BufferTooSmall { needed: 0 }
            }
            _ => Self::Damaged,
        }
    }
}

impl<E: core::fmt::Debug> core::fmt::Display for StoreError<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::InvalidRange => write!(
                f,
                "the range does not suit the flash: give two whole pages of it or more"
            ),
            Self::Flash(error) => write!(
                f,
                "the flash reports {error:?}: check the driver and the range"
            ),
            Self::Damaged => write!(
                f,
                "the stored snapshot is damaged: save it again; if that fails too, replace the flash or keep other code out of the range"
            ),
            Self::Full => write!(
                f,
                "the range has too few pages: give as many as `SnapshotStore::pages` says"
            ),
            Self::TooLong { found, longest } => write!(
                f,
                "a snapshot of {found} bytes is longer than {longest}: leave out a part, or use a flash of larger pages"
            ),
            Self::BufferTooSmall { needed } => write!(
                f,
                "the buffer is too small: give {needed} bytes or more, or as many as `SnapshotStore::buffer` says"
            ),
            Self::Snapshot(error) => error.fmt(f),
        }
    }
}

impl<E: core::fmt::Debug> core::error::Error for StoreError<E> {}
