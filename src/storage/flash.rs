//! Snapshots in flash.

use super::error::Error;
use crate::octave::Accumulator;
use core::ops::Range;
use embedded_storage_async::nor_flash::NorFlash;
use sequential_storage::{
    cache::{Cache, Uncached},
    map::{MapConfig, MapStorage, SerializationError, Value},
};

/// Snapshots of several axes in a range of flash, each by its number: the newest of each axis, and
/// after a power cut the newest or the one before.
///
/// For every driver that implements `embedded_storage_async::nor_flash::NorFlash`; one that blocks
/// becomes one in a line, by `embassy_embedded_hal::adapter::BlockingAsync`. What is written and
/// where is up to `sequential_storage::map`: it appends, page after page, and erases a page only when
/// whatever of it is the newest has been copied. Its range is two pages or more, and
/// one snapshot of every axis fits into a page with room to spare. A word whose write was torn is
/// written over with zeros, which flash with error correction allows too.
///
/// # Example
///
/// ```
/// use allanite::{Accumulator, storage::{SnapshotInterval, SnapshotStore, StoreError}};
/// use embedded_storage_async::nor_flash::NorFlash;
///
/// /// What a task does at every sample.
/// async fn sample<F: NorFlash>(
///     accumulator: &mut Accumulator<20>,
///     count: i32,
///     interval: &mut SnapshotInterval,
///     store: &mut SnapshotStore<F>,
/// ) -> Result<(), StoreError<F::Error>> {
///     accumulator.push(count);
///     if interval.is_due(accumulator.samples()) {
///         // One byte more for the number of the axis, up to a multiple of what the flash writes.
///         let mut buffer = [0; Accumulator::<20>::SNAPSHOT_BYTES.next_multiple_of(32) + 32];
///         store.save(0, accumulator, &mut buffer).await?;
///     }
///     Ok(())
/// }
/// ```
pub struct SnapshotStore<F: NorFlash> {
    map: MapStorage<u8, F, Cache<Uncached, Uncached, Uncached, u8>>,
}

/// Why a snapshot was not stored or not found.
#[derive(Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum StoreError<E> {
    /// The range is not of two whole pages or more, within the flash.
    InvalidRange,
    /// Of the flash, or of how it is used.
    Flash(sequential_storage::Error<E>),
    /// Of the snapshot.
    Snapshot(Error),
}

impl<E: core::fmt::Debug> core::fmt::Display for StoreError<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::InvalidRange => write!(
                f,
                "the range does not suit the flash: give two whole pages of it or more"
            ),
            Self::Flash(error) => write!(f, "flash: {error:?}: check the driver and the range"),
            Self::Snapshot(error) => error.fmt(f),
        }
    }
}

impl<E: core::fmt::Debug> core::error::Error for StoreError<E> {}

/// What the map writes: whatever a function puts into a buffer.
struct Stored<W>(W);

impl<'d, W> Value<'d> for Stored<W>
where
    W: for<'b> Fn(&'b mut [u8]) -> Result<&'b [u8], Error>,
{
    fn serialize_into(&self, buffer: &mut [u8]) -> Result<usize, SerializationError> {
        let bytes = (self.0)(buffer);
        bytes
            .map(<[u8]>::len)
            .map_err(|_| SerializationError::BufferTooSmall)
    }

    fn deserialize_from(_: &'d [u8]) -> Result<(Self, usize), SerializationError> {
        // Bytes are read instead, and restored.
        Err(SerializationError::InvalidFormat)
    }
}

impl<F: NorFlash> SnapshotStore<F> {
    /// A store in a range of flash, in bytes from its start; erased flash is an empty one.
    ///
    /// # Errors
    /// [`StoreError::InvalidRange`].
    pub fn new(flash: F, range: Range<u32>) -> Result<Self, StoreError<F::Error>> {
        let inside = range.start < range.end && range.end as usize <= flash.capacity();
        let config = inside.then(|| MapConfig::try_new(range).ok()).flatten();
        let config = config.ok_or(StoreError::InvalidRange)?;
        let map = MapStorage::new(flash, config, Cache::new_uncached());
        Ok(Self { map })
    }

    /// Writes the snapshot that `write` puts into a buffer, such as that of [`Axes`](crate::Axes), under a
    /// number: `store.save_with(0, |buffer| axes.snapshot(&tests, buffer), &mut buffer)`. The buffer is one
    /// byte longer than the snapshot, rounded up to what the flash writes at once. The snapshot fits into
    /// a page of the flash.
    ///
    /// # Errors
    /// [`StoreError::Flash`]: what was stored before is still there.
    pub async fn save_with(
        &mut self,
        number: u8,
        write: impl for<'b> Fn(&'b mut [u8]) -> Result<&'b [u8], Error>,
        buffer: &mut [u8],
    ) -> Result<(), StoreError<F::Error>> {
        let stored = self.map.store_item(buffer, &number, &Stored(write)).await;
        stored.map_err(StoreError::Flash)
    }

    /// Reads the newest snapshot under a number, for [`Axes::restore`](crate::Axes::restore); `None` where
    /// there never was one. The buffer is as large as to [`save_with`](Self::save_with).
    ///
    /// # Errors
    /// [`StoreError::Flash`].
    pub async fn load_bytes<'b>(
        &mut self,
        number: u8,
        buffer: &'b mut [u8],
    ) -> Result<Option<&'b [u8]>, StoreError<F::Error>> {
        let fetched = self.map.fetch_item::<&[u8]>(buffer, &number).await;
        fetched.map_err(StoreError::Flash)
    }

    /// Writes an axis' snapshot. The buffer takes [`Accumulator::SNAPSHOT_BYTES`] and one byte more,
    /// rounded up to what the flash writes at once.
    ///
    /// # Errors
    /// [`StoreError::Flash`]: what was stored before is still there.
    pub async fn save<const OCTAVES: usize>(
        &mut self,
        axis: u8,
        accumulator: &Accumulator<OCTAVES>,
        buffer: &mut [u8],
    ) -> Result<(), StoreError<F::Error>> {
        self.save_with(axis, |buffer| accumulator.snapshot(buffer), buffer)
            .await
    }

    /// Restores an axis' newest snapshot; `None` where there never was one. The buffer is as large as
    /// to [`save`](Self::save).
    ///
    /// # Errors
    /// [`StoreError::Flash`]; [`StoreError::Snapshot`] with that of [`Accumulator::restore`].
    pub async fn load<const OCTAVES: usize>(
        &mut self,
        axis: u8,
        buffer: &mut [u8],
    ) -> Result<Option<Accumulator<OCTAVES>>, StoreError<F::Error>> {
        let Some(bytes) = self.load_bytes(axis, buffer).await? else {
            return Ok(None);
        };
        let restored = Accumulator::restore(bytes).map_err(StoreError::Snapshot)?;
        Ok(Some(restored))
    }

    /// The flash, for other uses.
    pub fn into_flash(self) -> F {
        self.map.destroy().0
    }
}
