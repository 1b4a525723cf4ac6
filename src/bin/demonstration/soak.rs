//! A long record with gaps, snapshots, power cuts and merges at random, compared with the definition.

mod definition;

use crate::simulated::Random;
use allanite::Accumulator;
use core::fmt;
use definition::Definition;

/// The octaves of the accumulator.
const OCTAVES: usize = 24;

/// The number of samples that are made at a time.
const CHUNK: usize = 64;

/// Stretches of at most `2^COMMON` samples are common, and longer ones up to `2^LONG` samples rare.
const COMMON: u32 = 20;
const LONG: u32 = 28;
/// One stretch in this many is long.
const RARE: u32 = 64;

/// The size of a stored snapshot.
const STORED: usize = Accumulator::<OCTAVES>::SNAPSHOT_BYTES;

/// What is done, as the seed decides it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// The number of samples to make.
    pub samples: u64,
    /// The seed of samples and faults.
    pub seed: u64,
    /// The number of samples before the first fault. From 2^32 on, the accumulator's counter laps.
    pub first: u64,
}

/// What was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Samples that were pushed.
    pub samples: u64,
    /// Samples that a power cut lost again.
    pub lost: u64,
    /// Stretches that ended with a gap.
    pub gaps: u64,
    /// Snapshots that were written and restored at once.
    pub restored: u64,
    /// Restarts from the last stored snapshot, which is older than the record.
    pub power_cuts: u64,
    /// Records that were merged.
    pub merged: u64,
    /// Snapshots with a wrong bit, all of which were refused.
    pub refused: u64,
    /// A digest of the sums, the same wherever they are the same.
    pub digest: u64,
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "samples {} lost {} gaps {} restored {} power_cuts {} merged {} refused {} digest {:016x}",
            self.samples,
            self.lost,
            self.gaps,
            self.restored,
            self.power_cuts,
            self.merged,
            self.refused,
            self.digest
        )
    }
}

/// What was wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The sum or the number of differences of this octave is not that of the definition.
    Sum(usize),
    /// The number of samples or gaps is wrong.
    Counts,
    /// A snapshot could not be written or restored, or is not the accumulator after a gap.
    Snapshot,
    /// A snapshot with a wrong bit was restored.
    Accepted,
    /// The numbers of the definition itself have overflowed.
    Oracle,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sum(octave) => write!(f, "octave {octave} does not follow from the samples"),
            Self::Counts => f.write_str("the number of samples or gaps is wrong"),
            Self::Snapshot => f.write_str("a restored record differs from the one stored"),
            Self::Accepted => f.write_str("a snapshot with a wrong bit was restored"),
            Self::Oracle => f.write_str("the definition's own numbers overflowed"),
        }
    }
}

impl core::error::Error for Failure {}

/// The counts of one stretch.
#[derive(Clone, Copy)]
enum Signal {
    Constant(i32),
    /// White noise of `32 − shift` bits.
    Noise {
        shift: u32,
    },
    /// A square wave of full scale, whose half period is `2^log_half` samples.
    Square {
        log_half: u32,
    },
}

impl Signal {
    fn choose(random: &mut Random, length: u64) -> Self {
        // In a longer stretch, counts of 32 bits would overflow the angles of the definition.
        let is_long = length > 1 << LONG;
        match if is_long {
            1 + random.bits() % 3
        } else {
            random.bits() % 6
        } {
            0 => Self::Constant(random.bits() as i32 >> 8),
            1 => Self::Noise { shift: 31 },
            2 => Self::Noise { shift: 20 },
            3 => Self::Noise { shift: 8 },
            4 => Self::Noise { shift: 0 },
            _ => Self::Square {
                log_half: random.bits() % OCTAVES as u32,
            },
        }
    }

    fn count(self, random: &mut Random, n: u64) -> i32 {
        match self {
            Self::Constant(count) => count,
            Self::Noise { shift } => random.bits() as i32 >> shift,
            Self::Square { log_half } if n >> log_half & 1 == 0 => i32::MIN,
            Self::Square { .. } => i32::MAX,
        }
    }
}

/// The record: what is accumulated now, what waits to be merged, and what they should be together.
struct Record {
    present: Accumulator<OCTAVES>,
    waiting: Accumulator<OCTAVES>,
    expected: Definition,
    stored: [u8; STORED],
    stored_length: usize,
    stored_expected: Definition,
    tally: Tally,
}

/// Does what the plan says, and returns what was done. `progress` is called after each stretch with the number
/// of samples so far.
///
/// # Errors
/// Fails where the accumulator first differs from the definition.
pub fn run(plan: Plan, mut progress: impl FnMut(u64)) -> Result<Tally, Failure> {
    let mut random = Random::new(plan.seed);
    let mut record = Record::new()?;
    let mut next = plan.first;
    while record.tally.samples < plan.samples {
        if next == 0 {
            let rare = random.bits().is_multiple_of(RARE);
            let log = random.bits() % if rare { LONG } else { COMMON };
            next = 1 + u64::from(random.bits() % (2 << log));
        }
        let length = next.min(plan.samples - record.tally.samples);
        record.stretch(length, &mut random);
        next = 0;
        record.fault(&mut random)?;
        progress(record.tally.samples);
    }
    record.tally.digest = record.expected.digest();
    Ok(record.tally)
}

impl Record {
    fn new() -> Result<Self, Failure> {
        let mut record = Self {
            present: Accumulator::new(),
            waiting: Accumulator::new(),
            expected: Definition::new(),
            stored: [0; STORED],
            stored_length: 0,
            stored_expected: Definition::new(),
            tally: Tally::default(),
        };
        record.store()?;
        Ok(record)
    }

    /// Adds counts, one at a time or in slices of any length.
    fn stretch(&mut self, length: u64, random: &mut Random) {
        let signal = Signal::choose(random, length);
        let mut counts = [0; CHUNK];
        let mut done = 0;
        while done < length {
            let chunk = (length - done).min(CHUNK as u64);
            let counts = &mut counts[..chunk as usize];
            for (n, count) in (done..).zip(counts.iter_mut()) {
                *count = signal.count(random, n);
                self.expected.push(*count);
            }
            let (slice, single) = counts.split_at(random.bits() as usize % (counts.len() + 1));
            self.present.push_slice(slice);
            for &count in single {
                self.present.push(count);
            }
            done += chunk;
        }
        self.tally.samples += length;
    }

    /// Everything that was accumulated, as one record after a gap.
    fn whole(&self) -> Accumulator<OCTAVES> {
        let mut whole = self.present.clone();
        whole.gap();
        whole.merge(&self.waiting);
        whole
    }

    fn fault(&mut self, random: &mut Random) -> Result<(), Failure> {
        self.expected.gap();
        self.expected.check(&self.whole())?;
        match random.bits() % 6 {
            0 => {
                self.present.gap();
                self.tally.gaps += 1;
            }
            1 => {
                self.store()?;
                let restored = self.restored()?;
                if restored != self.whole() {
                    return Err(Failure::Snapshot);
                }
                self.replace(restored);
                self.tally.restored += 1;
            }
            2 => {
                self.tally.lost += self.expected.samples - self.stored_expected.samples;
                self.expected = self.stored_expected.clone();
                let restored = self.restored()?;
                self.replace(restored);
                self.tally.power_cuts += 1;
            }
            3 => {
                self.waiting = self.whole();
                self.present.reset();
                self.store()?;
            }
            4 => {
                self.waiting.merge(&self.present);
                let merged = core::mem::take(&mut self.waiting);
                self.replace(merged);
                self.tally.merged += 1;
            }
            _ => {
                self.present.gap();
                let length = self.stored_length;
                let place = random.bits() as usize % length;
                let bit = 1 << (random.bits() % 8);
                self.stored[place] ^= bit;
                if Accumulator::<OCTAVES>::restore(&self.stored[..length]).is_ok() {
                    return Err(Failure::Accepted);
                }
                self.stored[place] ^= bit;
                self.tally.refused += 1;
            }
        }
        self.expected.check(&self.whole())
    }

    fn replace(&mut self, present: Accumulator<OCTAVES>) {
        self.present = present;
        self.waiting.reset();
    }

    fn store(&mut self) -> Result<(), Failure> {
        let whole = self.whole();
        let stored = whole.snapshot(&mut self.stored);
        self.stored_length = stored.map_err(|_| Failure::Snapshot)?.len();
        self.stored_expected = self.expected.clone();
        Ok(())
    }

    fn restored(&self) -> Result<Accumulator<OCTAVES>, Failure> {
        let stored = &self.stored[..self.stored_length];
        let restored = Accumulator::restore(stored).map_err(|_| Failure::Snapshot)?;
        Ok(restored)
    }
}
