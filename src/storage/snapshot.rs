//! Snapshots of an accumulator alone: its sums, as bytes that survive a restart.
//!
//! This table describes version 7 of the payload of the [`envelope`]. The payload is
//! in postcard's encoding: numbers longer than one byte are varints of seven bits per byte, lowest bits
//! first, and signed numbers are zigzag-encoded. A record with gaps that were filled has version 8. Versions 1 and 6, which lack
//! the sum of the counts, are read as well. [`Axes`](crate::Axes) writes [other versions](super::axes).
//!
//! | content | type |
//! |---|---|
//! | number of octaves | u8 |
//! | samples | u64 |
//! | gaps, including one at the end of the snapshot | u64 |
//! | for each octave, `m = 1, 2, 4, …`: number of differences | u64 |
//! | for each octave, after its number of differences: Σ D² in counts², lowest limb first | 3 × u64 |
//! | in version 8: gaps that were filled and samples lost in them, of each class of [`Bridged`] | 7 × u32, 7 × u32 |
//! | the sum of all counts and filled values; −2^63 if it is not known | i64 |

use super::envelope::{self, Kind, OVERHEAD, Writer, take as take_part};
use crate::{
    record::{
        octave::{Accumulator, Bridged, CLASSES, OctaveSum, UNKNOWN},
        square_sum::SquareSum,
    },
    storage::Error,
};
use serde::{Deserialize, Serialize};

/// The version of the format for an accumulator alone.
pub(crate) const VERSION: u8 = 7;

/// The version of the format for an accumulator of a record with gaps that were filled.
pub(crate) const BRIDGED_VERSION: u8 = 8;

/// Earlier versions, without and with gaps that were filled. They lack the sum of the counts.
pub(crate) const EARLIER: [u8; 2] = [1, 6];

/// The number of bytes of the longest varint of 64 bits.
pub(crate) const LONGEST: usize = 10;

#[derive(Serialize, Deserialize)]
struct Head {
    octaves: u8,
    samples: u64,
    gaps: u64,
}

#[derive(Serialize, Deserialize)]
struct Octave {
    differences: u64,
    sum: [u64; 3],
}

/// The largest number of bytes of a payload with this many octaves.
const fn longest(octaves: usize) -> usize {
    1 + 3 * LONGEST + octaves * 4 * LONGEST + LONGEST_BRIDGED
}

/// The largest number of bytes of the gaps that were filled.
pub(crate) const LONGEST_BRIDGED: usize = 2 * CLASSES * 5;

/// A stored accumulator of any number of octaves, which has been checked. Its contents can be read without
/// restoring it.
#[derive(Clone, Copy, Debug)]
pub struct Snapshot<'b> {
    octaves: u8,
    samples: u64,
    gaps: u64,
    sums: &'b [u8],
    bridged: Bridged,
    total: i64,
}

impl<'b> Snapshot<'b> {
    /// Opens the bytes that [`Accumulator::snapshot`] wrote, and checks all of them.
    ///
    /// # Errors
    /// [`Error::UnknownMagic`], [`Error::WrongLength`], [`Error::Corrupt`], [`Error::WrongKind`],
    /// [`Error::UnknownVersion`]; [`Error::Impossible`] if no record of that many samples has such sums.
    pub fn open(bytes: &'b [u8]) -> Result<Self, Error> {
        let (version, payload) = envelope::open_any(bytes, Kind::Snapshot)?;
        let is_bridged = [BRIDGED_VERSION, EARLIER[1]].contains(&version);
        let is_summed = !EARLIER.contains(&version);
        if !is_bridged && ![VERSION, EARLIER[0]].contains(&version) {
            return Err(Error::UnknownVersion {
                found: version,
                known: VERSION,
            });
        }
        let (head, sums) =
            postcard::take_from_bytes::<Head>(payload).map_err(|_| Error::Impossible)?;
        let mut snapshot = Self {
            octaves: head.octaves,
            samples: head.samples,
            gaps: head.gaps,
            sums,
            bridged: Bridged::NONE,
            total: UNKNOWN,
        };
        let possible = has_possible_gaps(head.samples, head.gaps);
        if !(2..=30).contains(&snapshot.octaves) || !possible {
            return Err(Error::Impossible);
        }
        let mut rest = sums;
        for k in 0..usize::from(snapshot.octaves) {
            (_, rest) = take(k, rest).ok_or(Error::Impossible)?;
        }
        if is_bridged {
            snapshot.bridged = take_bridged(&mut rest).ok_or(Error::Impossible)?;
        }
        if is_summed {
            snapshot.total = take_part(&mut rest).ok_or(Error::Impossible)?;
        }
        let is_possible = |(k, octave): (usize, OctaveSum)| {
            is_possible((head.samples, head.gaps), &snapshot.bridged, k, &octave)
        };
        if !snapshot.octaves().enumerate().all(is_possible) {
            return Err(Error::Impossible);
        }
        rest.is_empty().then_some(snapshot).ok_or(Error::Impossible)
    }

    /// The number of samples in the record.
    pub const fn samples(&self) -> u64 {
        self.samples
    }

    /// The number of ends of contiguous stretches, including the end of the snapshot.
    pub const fn gaps(&self) -> u64 {
        self.gaps
    }

    /// The gaps that were filled.
    pub const fn bridged(&self) -> &Bridged {
        &self.bridged
    }

    /// The octaves, in order of increasing averaging time.
    pub fn octaves(&self) -> impl ExactSizeIterator<Item = OctaveSum> + use<'b> {
        let mut rest = self.sums;
        (0..usize::from(self.octaves)).map(move |k| match take(k, rest) {
            Some((octave, after)) => {
                rest = after;
                octave
            }
            // The octave was there when the snapshot was opened.
            None => OctaveSum {
                m: 1 << k,
                differences: 0,
                sum: SquareSum::ZERO,
            },
        })
    }
}

/// Whether a record of this many samples can have this many gaps, including the gap at its end.
pub(crate) const fn has_possible_gaps(samples: u64, gaps: u64) -> bool {
    gaps <= samples && (gaps == 0) == (samples == 0)
}

/// Whether a record of this many samples and gaps can have this octave `k`, with `k` below 30.
pub(crate) fn is_possible(
    (samples, gaps): (u64, u64),
    bridged: &Bridged,
    k: usize,
    octave: &OctaveSum,
) -> bool {
    let samples = samples.saturating_add(bridged.lost());
    let (level, first) = match k {
        0 => (0, 1),
        1 => (0, 3),
        _ => (k.wrapping_sub(2), 7),
    };
    let most = samples.wrapping_shr(level as u32).saturating_sub(first);
    let possible = match gaps {
        0 | 1 if bridged.is_empty() => octave.differences == most,
        // The counters of records that are merged without end stay at their largest value.
        _ => octave.differences <= most || samples == u64::MAX,
    };
    // |D| is below 2^32 m. Therefore the sum without its lowest limb is less than differences · m².
    let [low, middle, high] = octave.sum.limbs();
    let above = u128::from(high) << 64 | u128::from(middle);
    let bound = u128::from(octave.differences).wrapping_shl(2 * k as u32);
    possible && (above < bound || (above, low, bound) == (0, 0, 0))
}

/// Reads the gaps that were filled, of a record that has some.
pub(crate) fn take_bridged(rest: &mut &[u8]) -> Option<Bridged> {
    let bridged: Bridged = take_part(rest)?;
    (bridged.is_possible() && !bridged.is_empty()).then_some(bridged)
}

/// Reads octave `k`, and returns it with the bytes after it.
fn take(k: usize, bytes: &[u8]) -> Option<(OctaveSum, &[u8])> {
    let (octave, rest) = postcard::take_from_bytes::<Octave>(bytes).ok()?;
    let octave = OctaveSum {
        m: 1 << k,
        differences: octave.differences,
        sum: SquareSum::from_limbs(octave.sum)?,
    };
    Some((octave, rest))
}

impl<const OCTAVES: usize> Accumulator<OCTAVES> {
    /// The size in bytes of a buffer that holds a snapshot of any record: 913 for 20 octaves. Four million
    /// samples of a gyro at rest take 252 of these.
    pub const SNAPSHOT_BYTES: usize = longest(OCTAVES) + OVERHEAD;

    /// Writes the sums to a buffer and returns the part of it that was used. The accumulator does not change.
    ///
    /// # Errors
    /// [`Error::BufferTooSmall`], which never occurs with [`SNAPSHOT_BYTES`](Self::SNAPSHOT_BYTES).
    ///
    /// # Example
    ///
    /// ```
    /// use allanite::Accumulator;
    ///
    /// let mut accumulator = Accumulator::<10>::new();
    /// accumulator.push_slice(&[3, 1, -2, 4, 0, 7, 2, 2]);
    /// let mut buffer = [0; Accumulator::<10>::SNAPSHOT_BYTES];
    /// let stored = accumulator.snapshot(&mut buffer)?;
    ///
    /// // After a restart, the restored accumulator equals one that had a gap at this moment.
    /// let restored = Accumulator::<10>::restore(stored)?;
    /// accumulator.gap();
    /// assert_eq!(restored, accumulator);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    pub fn snapshot<'b>(&self, buffer: &'b mut [u8]) -> Result<&'b [u8], Error> {
        let version = match self.bridged().is_empty() {
            true => VERSION,
            false => BRIDGED_VERSION,
        };
        let mut writer = Writer::new(buffer, Kind::Snapshot, version, longest(OCTAVES))?;
        writer.push(&Head {
            octaves: OCTAVES as u8,
            samples: self.samples(),
            gaps: self.ended_gaps(),
        })?;
        for octave in self.octaves() {
            writer.push(&Octave {
                differences: octave.differences,
                sum: octave.sum.limbs(),
            })?;
        }
        if version == BRIDGED_VERSION {
            writer.push(self.bridged())?;
        }
        writer.push(&self.total())?;
        writer.finish()
    }

    /// Restores an accumulator from its snapshot, as it is after a [`gap`](Self::gap). The samples since the
    /// snapshot are lost, and no difference spans that moment.
    ///
    /// # Errors
    /// The errors of [`Snapshot::open`]; [`Error::WrongOctaves`].
    pub fn restore(bytes: &[u8]) -> Result<Self, Error> {
        let snapshot = Snapshot::open(bytes)?;
        let found = usize::from(snapshot.octaves);
        if found != OCTAVES {
            return Err(Error::WrongOctaves {
                found,
                wanted: OCTAVES,
            });
        }
        let sums = (snapshot.samples, snapshot.total);
        Ok(Self::ended(sums, snapshot.gaps, snapshot.octaves()).with_bridged(snapshot.bridged))
    }
}
