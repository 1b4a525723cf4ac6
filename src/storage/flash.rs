//! Snapshots in flash.

use super::{envelope::CRC, error::Error, page_ring::PageRing, store_error::StoreError};
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
/// the snapshots that are the newest of their axis. A word whose write was interrupted is overwritten
/// with zeros, which flash with error correction allows too.
///
/// A snapshot that is longer than [`PIECE`](Self::PIECE), a third of a page, is stored in pieces, next to those of the
/// snapshot before it: the last write decides which of the two counts. The range must therefore have as many
/// pages as [`pages`](Self::pages) says.
///
/// # Damage
///
/// Flipped bits, pages that were erased or overwritten by something else, and bytes that look erased and are not: the store
/// puts its pages in order before it reads or writes, and each save reads back what it wrote. What was not damaged stays,
/// also the newest snapshots under other numbers. What was damaged is lost: the snapshot before it is then found, if the
/// store still has it, or none. Of a page whose words were erased in the middle, what lies behind them is lost too, and if
/// the ends of all pages are damaged, so may be the order of the pages, and the snapshots of a page that is then taken for an
/// erased one. Only if a save still cannot read back what it wrote after it was repeated
/// three times, it erases the whole range and is repeated once more. An error of the driver never leads to that.
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
///         // As much as `SnapshotStore::<F>::buffer` says of a flash with words of up to 32 bytes.
///         let mut buffer = [0; Accumulator::<20>::SNAPSHOT_BYTES.next_multiple_of(32) + 96];
///         store.save(0, accumulator, &mut buffer).await?;
///     }
///     Ok(())
/// }
/// ```
pub struct SnapshotStore<F: NorFlash> {
    map: MapStorage<Key, F, Cache<Uncached, Uncached, Uncached, Key>>,
}

/// The number of a snapshot, and which part of it is stored there: [`HEAD`], or a piece of one of two snapshots.
type Key = [u8; 2];

/// The part that is written last.
const HEAD: u8 = 255;

/// The largest number of pieces.
const PIECES: usize = 100;

/// How often a store repairs its pages for one snapshot before it erases all of them.
const REPAIRS: u8 = 3;

/// The first byte of a head: the snapshot follows, or its length and its place.
const WHOLE: u8 = 0;
const IN_PIECES: u8 = 1;

/// What a head adds to a snapshot that follows it: the key, and the first byte.
const BEFORE: usize = size_of::<Key>() + 1;

/// The head of a snapshot in pieces: the first byte, which of the two places has the pieces, the length, and the checksum
/// of all of them, because damage may bring an older piece back.
const HEAD_BYTES: usize = 10;

/// A snapshot as a function writes it, behind the first byte of a head.
#[derive(Clone, Copy)]
struct Stored<'w>(&'w Write<'w>);

type Write<'w> = dyn for<'b> Fn(&'b mut [u8]) -> Result<&'b [u8], Error> + 'w;

impl<'d> Value<'d> for Stored<'_> {
    fn serialize_into(&self, buffer: &mut [u8]) -> Result<usize, SerializationError> {
        let (first, rest) = buffer
            .split_first_mut()
            .ok_or(SerializationError::BufferTooSmall)?;
        *first = WHOLE;
        let bytes = (self.0)(rest);
        bytes
            .map(|bytes| bytes.len().saturating_add(1))
            .map_err(|_| SerializationError::BufferTooSmall)
    }

    fn deserialize_from(_: &'d [u8]) -> Result<(Self, usize), SerializationError> {
        // The bytes are read instead, and restored from there.
        Err(SerializationError::InvalidFormat)
    }
}

/// What tells one snapshot from another. A checksum of all bytes would be the same for all, because they end with theirs.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Fingerprint {
    length: usize,
    front: u32,
    end: [u8; 4],
}

impl Fingerprint {
    fn of(bytes: &[u8]) -> Self {
        let length = bytes.len();
        let (front, end) = bytes.split_last_chunk().unwrap_or((bytes, &[0; 4]));
        let front = CRC.checksum(front);
        Self {
            length,
            front,
            end: *end,
        }
    }
}

/// What a head says.
#[derive(Clone, Copy)]
enum Head {
    /// The snapshot lies there in the buffer.
    Whole { start: usize, length: usize },
    /// The pieces have one of two places.
    Pieces {
        place: u8,
        length: usize,
        checksum: u32,
    },
}

impl<F: NorFlash> SnapshotStore<F> {
    /// The longest piece of a snapshot, in bytes. Three of them fit into a page.
    pub const PIECE: usize = {
        assert!(
            F::ERASE_SIZE >= 256,
            "the pages of the flash have fewer than 256 bytes"
        );
        F::ERASE_SIZE / 3 - 8 * F::WRITE_SIZE - BEFORE
    };

    /// The number of pages that a range must have for snapshots of so many numbers, of which none is longer than
    /// `longest` bytes.
    pub const fn pages(longest: usize, numbers: usize) -> usize {
        let pieces = if longest <= Self::PIECE {
            1
        } else {
            // Those of two snapshots, and the head.
            longest
                .div_ceil(Self::PIECE)
                .saturating_mul(2)
                .saturating_add(1)
        };
        // One page is always empty, and another one may be full of older snapshots.
        pieces.saturating_mul(numbers).div_ceil(3).saturating_add(2)
    }

    /// The number of bytes that a buffer must have for snapshots of up to `longest` bytes.
    pub const fn buffer(longest: usize) -> usize {
        let beside = if longest <= Self::PIECE {
            0
        } else {
            Self::PIECE
        };
        let word = if F::WRITE_SIZE > F::READ_SIZE {
            F::WRITE_SIZE
        } else {
            F::READ_SIZE
        };
        longest
            .saturating_add(beside)
            .saturating_add(2 * BEFORE)
            .saturating_add(HEAD_BYTES)
            .next_multiple_of(word)
            .saturating_add(word)
    }

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
    /// `store.save_with(0, |buffer| axes.snapshot(&tests, buffer), &mut buffer)`. The size of the buffer is
    /// [`buffer`](Self::buffer)` (longest snapshot)`. What was stored is read back. A [`Certificate`](super::Certificate) is stored in the same way,
    /// under a number of its own: `store.save_with(9, |buffer| certificate.encode(buffer), &mut buffer)`.
    ///
    /// # Errors
    /// [`StoreError::Flash`], [`StoreError::Damaged`], [`StoreError::Full`], [`StoreError::TooLong`],
    /// [`StoreError::BufferTooSmall`], and [`StoreError::Snapshot`] if `write` fails. The snapshot stored before is then still
    /// there, except after [`StoreError::Damaged`].
    pub async fn save_with(
        &mut self,
        number: u8,
        write: impl for<'b> Fn(&'b mut [u8]) -> Result<&'b [u8], Error>,
        buffer: &mut [u8],
    ) -> Result<(), StoreError<F::Error>> {
        // One function for every `write`.
        self.save_stored(number, Stored(&write), buffer).await
    }

    async fn save_stored(
        &mut self,
        number: u8,
        snapshot: Stored<'_>,
        buffer: &mut [u8],
    ) -> Result<(), StoreError<F::Error>> {
        let mut attempts = 0;
        loop {
            let written = Fingerprint::of((snapshot.0)(buffer).map_err(StoreError::Snapshot)?);
            let stored = self.store(number, snapshot, written, buffer).await;
            let error = match stored {
                Err(error @ (StoreError::Damaged | StoreError::Full | StoreError::Flash(_))) => {
                    error
                }
                other => return other,
            };
            match (attempts, &error) {
                (0, _) | (1..REPAIRS, StoreError::Damaged | StoreError::Flash(_)) => {
                    self.ring().turn().await.map_err(StoreError::Flash)?;
                }
                (REPAIRS, StoreError::Damaged) => self.reset().await?,
                _ => return Err(error),
            }
            attempts += 1;
        }
    }

    /// Stores a snapshot, and reads it back.
    async fn store(
        &mut self,
        number: u8,
        snapshot: Stored<'_>,
        written: Fingerprint,
        buffer: &mut [u8],
    ) -> Result<(), StoreError<F::Error>> {
        self.ring().prepare().await.map_err(StoreError::Flash)?;
        if written.length <= Self::PIECE {
            self.map
                .store_item(buffer, &[number, HEAD], &snapshot)
                .await?;
        } else {
            self.store_pieces(number, written.length, buffer).await?;
        }
        match self.load_bytes(number, buffer).await? {
            Some(bytes) if Fingerprint::of(bytes) == written => Ok(()),
            _ => Err(StoreError::Damaged),
        }
    }

    /// Stores the snapshot at the start of a buffer in pieces.
    async fn store_pieces(
        &mut self,
        number: u8,
        length: usize,
        buffer: &mut [u8],
    ) -> Result<(), StoreError<F::Error>> {
        let longest = Self::PIECE.saturating_mul(PIECES);
        if length > longest {
            let found = length;
            return Err(StoreError::TooLong { found, longest });
        }
        let needed = Self::buffer(length);
        if buffer.len() < needed {
            return Err(StoreError::BufferTooSmall { needed });
        }
        let (snapshot, beside) = buffer.split_at_mut(length);
        // What a damaged head says does not matter: the new one takes its place.
        let place = match self.head(number, beside).await {
            Ok(Some(Head::Pieces { place: 0, .. })) => 1,
            Err(StoreError::Flash(error)) => return Err(StoreError::Flash(error)),
            _ => 0,
        };
        for (piece, bytes) in (0..PIECES).zip(snapshot.chunks(Self::PIECE)) {
            let key = key(number, place, piece);
            self.map.store_item(beside, &key, &bytes).await?;
        }
        let [a, b, c, d] = (length as u32).to_le_bytes();
        let [e, f, g, h] = CRC.checksum(snapshot).to_le_bytes();
        let head: [u8; HEAD_BYTES] = [IN_PIECES, place, a, b, c, d, e, f, g, h];
        self.map
            .store_item(beside, &[number, HEAD], &&head[..])
            .await?;
        Ok(())
    }

    fn ring(&mut self) -> PageRing<'_, F> {
        let range = self.map.flash_range();
        PageRing::new(self.map.flash(), range)
    }

    /// Reads a head into a buffer.
    async fn head(
        &mut self,
        number: u8,
        buffer: &mut [u8],
    ) -> Result<Option<Head>, StoreError<F::Error>> {
        let start = buffer.as_ptr().addr();
        let Some(bytes) = self
            .map
            .fetch_item::<&[u8]>(buffer, &[number, HEAD])
            .await?
        else {
            return Ok(None);
        };
        match bytes {
            &[IN_PIECES, place, a, b, c, d, e, f, g, h] => Ok(Some(Head::Pieces {
                place,
                length: u32::from_le_bytes([a, b, c, d]) as usize,
                checksum: u32::from_le_bytes([e, f, g, h]),
            })),
            [WHOLE, snapshot @ ..] => Ok(Some(Head::Whole {
                start: snapshot.as_ptr().addr().wrapping_sub(start),
                length: snapshot.len(),
            })),
            _ => Err(StoreError::Damaged),
        }
    }

    /// Reads the newest snapshot under a number, for [`Axes::restore`](crate::Axes::restore), or the certificate, for
    /// [`Certificate::decode`](super::Certificate::decode); `None` if no
    /// snapshot was stored. The buffer must be as large as for [`save_with`](Self::save_with).
    ///
    /// # Errors
    /// [`StoreError::Flash`], [`StoreError::BufferTooSmall`], and [`StoreError::Damaged`] if a part of it is not there.
    pub async fn load_bytes<'b>(
        &mut self,
        number: u8,
        buffer: &'b mut [u8],
    ) -> Result<Option<&'b [u8]>, StoreError<F::Error>> {
        self.ring().order().await.map_err(StoreError::Flash)?;
        let (place, length, checksum) = match self.head(number, buffer).await? {
            None => return Ok(None),
            Some(Head::Whole { start, length }) => {
                let whole = buffer.get(start..start.saturating_add(length));
                return whole.map(Some).ok_or(StoreError::Damaged);
            }
            Some(Head::Pieces {
                place,
                length,
                checksum,
            }) => (place, length, checksum),
        };
        let needed = Self::buffer(length);
        if buffer.len() < needed {
            return Err(StoreError::BufferTooSmall { needed });
        }
        let mut filled = 0;
        for piece in 0..PIECES {
            if filled >= length {
                break;
            }
            let rest = buffer.get_mut(filled..).ok_or(StoreError::Damaged)?;
            let start = rest.as_ptr().addr();
            let key = key(number, place, piece);
            let fetched = self.map.fetch_item::<&[u8]>(rest, &key).await;
            let bytes = fetched?.ok_or(StoreError::Damaged)?;
            let (start, size) = (bytes.as_ptr().addr().wrapping_sub(start), bytes.len());
            if size != length.saturating_sub(filled).min(Self::PIECE) {
                return Err(StoreError::Damaged);
            }
            rest.copy_within(start..start.saturating_add(size), 0);
            filled = filled.saturating_add(size);
        }
        let snapshot = buffer.get(..length).ok_or(StoreError::Damaged)?;
        if CRC.checksum(snapshot) == checksum {
            Ok(Some(snapshot))
        } else {
            Err(StoreError::Damaged)
        }
    }

    /// Stores the snapshot of an axis. The size of the buffer is [`buffer`](Self::buffer)`
    /// (`[`Accumulator::SNAPSHOT_BYTES`]`)`.
    ///
    /// # Errors
    /// As of [`save_with`](Self::save_with).
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
    /// As of [`load_bytes`](Self::load_bytes); [`StoreError::Snapshot`] with the error of [`Accumulator::restore`].
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

    /// Erases the whole range, and all that is stored in it, for a new start. [Damage](Self#damage) does not need it.
    ///
    /// # Errors
    /// [`StoreError::Flash`].
    pub async fn reset(&mut self) -> Result<(), StoreError<F::Error>> {
        Ok(self.map.erase_all().await?)
    }

    /// Returns the flash for other uses.
    pub fn into_flash(self) -> F {
        self.map.destroy().0
    }
}

/// The key of a piece in one of two places.
const fn key(number: u8, place: u8, piece: usize) -> Key {
    let first = if place == 0 { 0 } else { PIECES };
    [number, first.saturating_add(piece) as u8]
}
