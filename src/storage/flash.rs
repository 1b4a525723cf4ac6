//! Snapshots in flash.

use super::error::Error;
use crate::record::octave::Accumulator;
use core::ops::Range;
use embedded_storage_async::nor_flash::NorFlash;
use sequential_storage::{
    cache::{Cache, Uncached},
    map::{MapConfig, MapStorage, SerializationError, Value},
};

/// Stores snapshots of several axes in a range of flash, each under its number. It returns the newest
/// snapshot of each axis, or the one before if the power failed while the newest was written.
///
/// It works with every driver that implements `embedded_storage_async::nor_flash::NorFlash`. One line with
/// `embassy_embedded_hal::adapter::BlockingAsync` adapts a driver that blocks. `sequential_storage::map`
/// decides what is written and where: it appends, page after page, and erases a page only after it has copied
/// the snapshots that are the newest of their axis. The range must have at least two pages, and one snapshot
/// of every axis must fit into a page with room to spare. A word whose write was interrupted is overwritten
/// with zeros, which flash with error correction allows too.
///
/// # Example
///
/// ```
/// use allanite::{Accumulator, storage::{SnapshotInterval, SnapshotStore, StoreError}};
/// use embedded_storage_async::nor_flash::NorFlash;
///
/// /// The work of a task at every sample.
/// async fn sample<F: NorFlash>(
///     accumulator: &mut Accumulator<20>,
///     count: i32,
///     interval: &mut SnapshotInterval,
///     store: &mut SnapshotStore<F>,
/// ) -> Result<(), StoreError<F::Error>> {
///     accumulator.push(count);
///     if interval.is_due(accumulator.samples()) {
///         // One more byte for the number of the axis, rounded up to a multiple of the write size.
///         let mut buffer = [0; Accumulator::<20>::SNAPSHOT_BYTES.next_multiple_of(32) + 32];
///         store.save(0, accumulator, &mut buffer).await?;
///     }
///     Ok(())
/// }
/// ```
pub struct SnapshotStore<F: NorFlash> {
    map: MapStorage<u8, F, Cache<Uncached, Uncached, Uncached, u8>>,
}

/// The reason why a snapshot was not stored or not read.
#[derive(Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum StoreError<E> {
    /// The range does not consist of at least two whole pages within the flash.
    InvalidRange,
    /// The flash failed, or it was not used as it must be.
    Flash(sequential_storage::Error<E>),
    /// The snapshot could not be written or restored.
    Snapshot(Error),
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
            Self::Snapshot(error) => error.fmt(f),
        }
    }
}

impl<E: core::fmt::Debug> core::error::Error for StoreError<E> {}

/// The item that the map stores: the bytes that a function writes into a buffer.
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
        // The bytes are read instead, and restored from there.
        Err(SerializationError::InvalidFormat)
    }
}

impl<F: NorFlash> SnapshotStore<F> {
    /// A store in a range of flash, given in bytes from the start of the flash. Erased flash is an empty
    /// store.
    ///
    /// # Errors
    /// [`StoreError::InvalidRange`] if the range is not at least two whole pages of the flash.
    pub fn new(flash: F, range: Range<u32>) -> Result<Self, StoreError<F::Error>> {
        let inside = range.start < range.end && range.end as usize <= flash.capacity();
        let config = inside.then(|| MapConfig::try_new(range).ok()).flatten();
        let config = config.ok_or(StoreError::InvalidRange)?;
        let map = MapStorage::new(flash, config, Cache::new_uncached());
        Ok(Self { map })
    }

    /// Stores the snapshot that `write` puts into a buffer under a number. For [`Axes`](crate::Axes), write
    /// `store.save_with(0, |buffer| axes.snapshot(&tests, buffer), &mut buffer)`. The buffer must be one
    /// byte longer than the snapshot, rounded up to the write size of the flash. The snapshot must fit into
    /// a page of the flash. A [`Certificate`](super::Certificate) is stored in the same way, under a number of its own:
    /// `store.save_with(9, |buffer| certificate.encode(buffer), &mut buffer)`.
    ///
    /// # Errors
    /// [`StoreError::Flash`]; the snapshot stored before is then still there.
    pub async fn save_with(
        &mut self,
        number: u8,
        write: impl for<'b> Fn(&'b mut [u8]) -> Result<&'b [u8], Error>,
        buffer: &mut [u8],
    ) -> Result<(), StoreError<F::Error>> {
        let stored = self.map.store_item(buffer, &number, &Stored(write)).await;
        stored.map_err(StoreError::Flash)
    }

    /// Reads the newest snapshot under a number, for [`Axes::restore`](crate::Axes::restore), or the certificate, for
    /// [`Certificate::decode`](super::Certificate::decode); `None` if no
    /// snapshot was stored. The buffer must be as large as for [`save_with`](Self::save_with).
    ///
    /// # Errors
    /// [`StoreError::Flash`] if the flash cannot be read.
    pub async fn load_bytes<'b>(
        &mut self,
        number: u8,
        buffer: &'b mut [u8],
    ) -> Result<Option<&'b [u8]>, StoreError<F::Error>> {
        let fetched = self.map.fetch_item::<&[u8]>(buffer, &number).await;
        fetched.map_err(StoreError::Flash)
    }

    /// Stores the snapshot of an axis. The buffer must have one byte more than
    /// [`Accumulator::SNAPSHOT_BYTES`], rounded up to the write size of the flash.
    ///
    /// # Errors
    /// [`StoreError::Flash`]; the snapshot stored before is then still there.
    pub async fn save<const OCTAVES: usize>(
        &mut self,
        axis: u8,
        accumulator: &Accumulator<OCTAVES>,
        buffer: &mut [u8],
    ) -> Result<(), StoreError<F::Error>> {
        self.save_with(axis, |buffer| accumulator.snapshot(buffer), buffer)
            .await
    }

    /// Restores the newest snapshot of an axis; `None` if no snapshot was stored. The buffer must be as large
    /// as for [`save`](Self::save).
    ///
    /// # Errors
    /// [`StoreError::Flash`]; [`StoreError::Snapshot`] with the error of [`Accumulator::restore`].
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

    /// Returns the flash for other uses.
    pub fn into_flash(self) -> F {
        self.map.destroy().0
    }
}
