//! Snapshots of an accumulator alone: its sums as bytes that survive a restart.
//!
//! The payload of the [envelope](crate::storage::envelope), version 1, as postcard writes it: numbers of more
//! than a byte are varints, seven bits a byte, lowest first. [`Axes`](crate::Axes) write version 2.
//!
//! | content | type |
//! |---|---|
//! | number of octaves | u8 |
//! | samples | u64 |
//! | gaps, one for the end of the snapshot included | u64 |
//! | of each octave, `m = 1, 2, 4, …`: number of differences | u64 |
//! | of each octave, behind its number: Σ D² in counts², lowest limb first | 3 × u64 |

use super::envelope::{self, Kind, OVERHEAD, Writer};
use crate::{
    octave::{Accumulator, OctaveSum},
    square_sum::SquareSum,
    storage::Error,
};
use serde::{Deserialize, Serialize};

/// The version of an accumulator alone.
pub(crate) const VERSION: u8 = 1;

/// Bytes of the longest varint of 64 bits.
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

/// Bytes of a payload with as many octaves at most.
const fn longest(octaves: usize) -> usize {
    1 + 2 * LONGEST + octaves * 4 * LONGEST
}

/// A stored accumulator, checked, of any number of octaves: what it knows can be read without
/// restoring it.
#[derive(Clone, Copy, Debug)]
pub struct Snapshot<'b> {
    octaves: u8,
    samples: u64,
    gaps: u64,
    sums: &'b [u8],
}

impl<'b> Snapshot<'b> {
    /// Opens what [`Accumulator::snapshot`] wrote, and checks all of it.
    ///
    /// # Errors
    /// [`Error::UnknownMagic`], [`Error::WrongLength`], [`Error::Corrupt`], [`Error::WrongKind`],
    /// [`Error::UnknownVersion`]; [`Error::Impossible`] for sums that so many samples cannot have.
    pub fn open(bytes: &'b [u8]) -> Result<Self, Error> {
        let payload = envelope::open(bytes, Kind::Snapshot, VERSION)?;
        let (head, sums) =
            postcard::take_from_bytes::<Head>(payload).map_err(|_| Error::Impossible)?;
        let snapshot = Self {
            octaves: head.octaves,
            samples: head.samples,
            gaps: head.gaps,
            sums,
        };
        let possible = has_possible_gaps(head.samples, head.gaps);
        if !(2..=30).contains(&snapshot.octaves) || !possible {
            return Err(Error::Impossible);
        }
        let mut rest = sums;
        for k in 0..usize::from(snapshot.octaves) {
            let (octave, after) = take(k, rest).ok_or(Error::Impossible)?;
            if !is_possible(head.samples, head.gaps, k, &octave) {
                return Err(Error::Impossible);
            }
            rest = after;
        }
        rest.is_empty().then_some(snapshot).ok_or(Error::Impossible)
    }

    /// Samples of the record.
    pub const fn samples(&self) -> u64 {
        self.samples
    }

    /// Ends of contiguous stretches, that of the snapshot included.
    pub const fn gaps(&self) -> u64 {
        self.gaps
    }

    /// The octaves, shortest averaging time first.
    pub fn octaves(&self) -> impl ExactSizeIterator<Item = OctaveSum> + use<'b> {
        let mut rest = self.sums;
        (0..usize::from(self.octaves)).map(move |k| match take(k, rest) {
            Some((octave, after)) => {
                rest = after;
                octave
            }
            // It was there when the snapshot was opened.
            None => OctaveSum {
                m: 1 << k,
                differences: 0,
                sum: SquareSum::ZERO,
            },
        })
    }
}

/// Whether a record of so many samples can have so many gaps, that at its end included.
pub(crate) const fn has_possible_gaps(samples: u64, gaps: u64) -> bool {
    gaps <= samples && (gaps == 0) == (samples == 0)
}

/// Whether so many samples and gaps can have left this in octave `k`, which is below 30.
pub(crate) fn is_possible(samples: u64, gaps: u64, k: usize, octave: &OctaveSum) -> bool {
    let (level, first) = match k {
        0 => (0, 1),
        1 => (0, 3),
        _ => (k.wrapping_sub(2), 7),
    };
    let most = samples.wrapping_shr(level as u32).saturating_sub(first);
    let possible = match gaps {
        0 | 1 => octave.differences == most,
        // Merged without end, the counters stop at their ends.
        _ => octave.differences <= most || samples == u64::MAX,
    };
    // |D| < 2^32 m: above its lowest limb, a sum is less than differences · m².
    let [low, middle, high] = octave.sum.limbs();
    let above = u128::from(high) << 64 | u128::from(middle);
    let bound = u128::from(octave.differences).wrapping_shl(2 * k as u32);
    possible && (above < bound || (above, low, bound) == (0, 0, 0))
}

/// Octave `k` and what stands behind it.
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
    /// Bytes that a snapshot of any record fits into: 833 for 20 octaves, of which four million samples
    /// of a gyro at rest take 248.
    pub const SNAPSHOT_BYTES: usize = longest(OCTAVES) + OVERHEAD;

    /// Writes the sums to a buffer and returns the part of it that was used. The state is untouched.
    ///
    /// # Errors
    /// [`Error::BufferTooSmall`]; never with [`SNAPSHOT_BYTES`](Self::SNAPSHOT_BYTES).
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
    /// // After a restart: as if a gap lay between.
    /// let restored = Accumulator::<10>::restore(stored)?;
    /// accumulator.gap();
    /// assert_eq!(restored, accumulator);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    pub fn snapshot<'b>(&self, buffer: &'b mut [u8]) -> Result<&'b [u8], Error> {
        let mut writer = Writer::new(buffer, Kind::Snapshot, VERSION, longest(OCTAVES))?;
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
        writer.finish()
    }

    /// The accumulator that a snapshot was taken of, after a [`gap`](Self::gap): what was lost since
    /// then, and no difference spans the moment.
    ///
    /// # Errors
    /// Of [`Snapshot::open`]; [`Error::WrongOctaves`].
    pub fn restore(bytes: &[u8]) -> Result<Self, Error> {
        let snapshot = Snapshot::open(bytes)?;
        let found = usize::from(snapshot.octaves);
        if found != OCTAVES {
            return Err(Error::WrongOctaves {
                found,
                wanted: OCTAVES,
            });
        }
        Ok(Self::ended(
            snapshot.samples,
            snapshot.gaps,
            snapshot.octaves(),
        ))
    }
}
