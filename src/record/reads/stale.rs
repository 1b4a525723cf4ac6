//! Blocks of samples that are there a second time, as a buffer that was not refilled leaves them.

use crate::list::numbered;

/// The samples whose hashes are kept: the longest distance at which a block is recognised, and some before it.
const RING: usize = 256;
/// The longest distance at which a block is recognised, in samples.
const FARTHEST: u16 = 128;
/// Windows that are remembered. One in [`ENTERED`] windows is.
const ENTRIES: usize = 32;
const ENTERED: u32 = 8;
/// The samples before a window that are compared when it is recognised.
const BACK: u32 = 48;
/// The distance at which equal samples are by chance. Slow noise makes them less often equal at longer ones.
const ELSEWHERE: u16 = 11;
/// The shortest distance of a block.
const NEAREST: u16 = 8;
/// The distances that are counted apart from each other.
const DISTANCES: usize = 4;
/// The windows from which it is known how often others are equal by chance.
const LEARNT: u32 = 120;
/// The surprise, in bits, from which a run of equal samples is not by chance.
const BITS: u32 = 32;

/// The runs of samples that equal those at one distance before them, which have the length of a block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub struct AtDistance {
    /// The distance in samples; 0 if the place is free.
    pub distance: u16,
    /// The number of runs.
    pub runs: u32,
    /// The samples of the longest one.
    pub longest: u32,
    /// The samples in all of them.
    pub samples: u32,
}

/// What is counted of samples that equal others a fixed distance before them: a part of [`Reads`](super::Reads), or made from counts of
/// parts of a record.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub struct StaleRuns {
    /// Samples of which it is known whether they equal the one 11 before, where equal samples are chance.
    pub looked: u32,
    /// Those of them that do.
    pub elsewhere: u32,
    /// Runs that are too long for chance.
    pub long: u32,
    /// Those of them that have the [length of a block](Self::is_whole).
    pub whole: u32,
    /// The same by their distances, of which there are some.
    pub distances: [AtDistance; DISTANCES],
}

impl StaleRuns {
    /// The shortest and the longest distance at which a block is recognised, in samples.
    pub const DISTANCES: core::ops::RangeInclusive<u16> = NEAREST..=FARTHEST;

    /// The distance at which equal samples are chance.
    pub const ELSEWHERE: u16 = ELSEWHERE;

    /// Nothing counted.
    pub const NEW: Self = Self {
        looked: 0,
        elsewhere: 0,
        long: 0,
        whole: 0,
        distances: [AtDistance {
            distance: 0,
            runs: 0,
            longest: 0,
            samples: 0,
        }; DISTANCES],
    };

    /// The bits by which a sample that equals another one surprises, at most those of a hash, which are 8.
    pub const fn bits(&self) -> u32 {
        match self.looked.checked_div(self.elsewhere.saturating_add(1)) {
            Some(ratio @ 1..) => {
                if ratio.ilog2() < 8 {
                    ratio.ilog2()
                } else {
                    8
                }
            }
            _ => 0,
        }
    }

    /// The length from which a run is not by chance, in samples: 6, 7, 8, 11 or 16, and 32 at one bit; `None` where nothing can be said.
    pub fn needed(&self) -> Option<u32> {
        BITS.checked_add(self.bits().saturating_sub(1))?
            .checked_div(self.bits())
            .map(|length| length.max(6))
    }

    /// The byte by which a sample of one axis is compared with others.
    pub const fn hash(count: i32) -> u8 {
        byte(mix(0, count))
    }

    /// A hash of the last four of these bytes, of which the last one is the lowest, if such a window is remembered. One in eight is.
    #[inline]
    pub const fn window(bytes: u32) -> Option<u32> {
        let mixed = mixed(bytes);
        match is_entered(mixed) {
            true => Some(mixed),
            false => None,
        }
    }

    /// Whether a run at a distance has the length of a block, where samples surprise by so many bits: half a distance, a whole one, or
    /// one and a half, or two. A sample or two at its ends may equal by chance.
    pub fn is_whole(distance: u16, length: u32, bits: u32) -> bool {
        let at_an_end = match bits {
            0 | 1 => 3,
            _ => 2,
        };
        let twice = length.saturating_mul(2);
        (1..=4_u32).any(|times| {
            let halves = u32::from(distance).saturating_mul(times);
            twice.abs_diff(halves) <= 2 * at_an_end
        })
    }

    /// Counts a run. A buffer of two halves leaves runs of half the distance, one of a single part those of the whole distance, and more
    /// where it is not refilled several times.
    #[cold]
    #[inline(never)]
    fn add(&mut self, distance: u16, length: u32) {
        let Some(needed) = self.needed() else {
            return;
        };
        if self.looked < LEARNT || distance < NEAREST || length < needed {
            return;
        }
        self.long = self.long.saturating_add(1);
        if !Self::is_whole(distance, length, self.bits()) {
            return;
        }
        self.whole = self.whole.saturating_add(1);
        let same = |own: &&mut AtDistance| own.distance == distance;
        let place = match self.distances.iter_mut().find(same) {
            Some(place) => Some(place),
            None => self.distances.iter_mut().find(|own| own.distance == 0),
        };
        if let Some(place) = place {
            place.distance = distance;
            place.add(1, length, length);
        }
    }

    /// Whether a record can have left these counts.
    #[cfg(feature = "storage")]
    pub(super) fn is_possible(&self) -> bool {
        let is_possible = |own: &AtDistance| {
            let is_free = own.distance == 0 && *own == AtDistance::default();
            let is_taken = (NEAREST..=FARTHEST).contains(&own.distance)
                && own.runs > 0
                && own.longest <= own.samples;
            is_free || is_taken
        };
        let runs = self.distances.iter().map(|own| own.runs);
        let runs = runs.fold(0, u32::saturating_add);
        self.elsewhere <= self.looked
            && self.whole <= self.long
            && runs <= self.whole
            && self.distances.iter().all(is_possible)
    }

    pub(crate) fn merge(&mut self, other: &Self) {
        self.looked = self.looked.saturating_add(other.looked);
        self.elsewhere = self.elsewhere.saturating_add(other.elsewhere);
        self.long = self.long.saturating_add(other.long);
        self.whole = self.whole.saturating_add(other.whole);
        for theirs in other.distances.iter().filter(|theirs| theirs.distance > 0) {
            let fits = |own: &&mut AtDistance| [0, theirs.distance].contains(&own.distance);
            if let Some(own) = self.distances.iter_mut().find(fits) {
                own.distance = theirs.distance;
                own.add(theirs.runs, theirs.longest, theirs.samples);
            }
        }
    }
}

impl AtDistance {
    fn add(&mut self, runs: u32, longest: u32, samples: u32) {
        self.runs = self.runs.saturating_add(runs);
        self.longest = self.longest.max(longest);
        self.samples = self.samples.saturating_add(samples);
    }
}

/// The byte of a hash by which samples are compared. Its bits depend on all bits of the counts.
const fn byte(hash: u32) -> u8 {
    (hash >> 24) as u8
}

/// The hash of a window of four such bytes.
const fn mixed(window: u32) -> u32 {
    window.wrapping_mul(0x2C1B_3C6D)
}

/// The hash of some counts and another one.
#[inline(always)]
pub(super) const fn mix(hash: u32, count: i32) -> u32 {
    hash.wrapping_add(count as u32).wrapping_mul(0x9E37_79B1)
}

/// Whether a window with this hash is remembered.
const fn is_entered(mixed: u32) -> bool {
    mixed.wrapping_shr(16).is_multiple_of(ENTERED)
}

/// A window that was seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Seen {
    tag: u16,
    /// The low bits of the time of its last sample.
    time: u16,
}

/// Finds blocks that are there twice: a hash of the last four samples finds the distance, and the hashes of single samples follow it.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Stale {
    /// A byte of the hash of each sample, at the low bits of its time.
    ring: [u8; RING],
    /// The same of the last four samples.
    window: u32,
    /// The distance that is followed; 0 if none is.
    distance: u16,
    /// The samples of the present run.
    length: u32,
    seen: [Seen; ENTRIES],
    pub(crate) runs: StaleRuns,
}

impl Stale {
    pub(super) const NEW: Self = Self {
        ring: [0; RING],
        window: 0,
        distance: 0,
        length: 0,
        seen: [Seen { tag: 0, time: 0 }; ENTRIES],
        runs: StaleRuns::NEW,
    };

    /// Adds the hash of a sample of all axes. `time` is the number of samples before it since a gap.
    #[inline(always)]
    pub(super) fn push(&mut self, time: u32, hash: u32) {
        let hash = byte(hash);
        if let Some(place) = self.ring.get_mut(time as usize % RING) {
            *place = hash;
        }
        self.window = self.window << 8 | u32::from(hash);
        let mixed = mixed(self.window);
        if self.distance > 0 || is_entered(mixed) {
            self.look(time, mixed);
        }
    }

    /// The hash of the sample at a time, one of the last [`RING`] samples.
    fn at(&self, time: u32) -> u8 {
        self.ring.get(time as usize % RING).copied().unwrap_or(0)
    }

    /// Whether a sample equals the one so far before it. There is none before a gap.
    fn is_again(&self, time: u32, distance: u16) -> bool {
        let before = time.checked_sub(distance.into());
        before.is_some_and(|before| self.at(before) == self.at(time))
    }

    /// Follows a run, looks whether the last four samples were there before, and remembers them.
    #[inline(never)]
    fn look(&mut self, time: u32, mixed: u32) {
        if self.distance > 0 {
            if self.is_again(time, self.distance) {
                self.length = self.length.saturating_add(1);
            } else {
                self.runs.add(self.distance, self.length);
                (self.distance, self.length) = (0, 0);
            }
        }
        if !is_entered(mixed) {
            return;
        }
        self.runs.looked = self.runs.looked.saturating_add(1);
        let again = self.is_again(time, ELSEWHERE);
        self.runs.elsewhere = self.runs.elsewhere.saturating_add(again.into());
        let now = Seen {
            tag: mixed as u16,
            time: time as u16,
        };
        let Some(seen) = self.seen.get_mut((mixed >> 27) as usize) else {
            return;
        };
        let before = core::mem::replace(seen, now);
        let distance = now.time.wrapping_sub(before.time);
        let is_same = before.tag == now.tag && (1..=FARTHEST).contains(&distance);
        if is_same && self.distance == 0 {
            self.begin(time, distance);
        }
    }

    /// Begins a run, with the samples that belong to it already.
    #[cold]
    #[inline(never)]
    fn begin(&mut self, time: u32, distance: u16) {
        let mut length = 0;
        while length < BACK && self.is_again(time.wrapping_sub(length), distance) {
            length = length.saturating_add(1);
        }
        if length > 0 {
            (self.distance, self.length) = (distance, length);
        }
    }

    /// The next sample does not adjoin the last one.
    pub(super) fn gap(&mut self) {
        *self = Self::with_runs(self.runs_at_gap());
    }

    /// What is counted after a gap at this place, which ends the present run.
    pub(super) fn runs_at_gap(&self) -> StaleRuns {
        let mut runs = self.runs.clone();
        runs.add(self.distance, self.length);
        runs
    }

    pub(super) fn with_runs(runs: StaleRuns) -> Self {
        Self { runs, ..Self::NEW }
    }
}

impl StaleRuns {
    /// The distance with most runs, and the runs of it, of half and of twice of it.
    pub(crate) fn most(&self) -> Option<(u16, AtDistance)> {
        let most = self.distances.iter().max_by_key(|own| own.runs)?;
        let distance = most.distance;
        let mut all = AtDistance::default();
        for (_, own) in numbered(self.distances.iter()) {
            let is_like = own.distance == distance
                || own.distance == distance.saturating_mul(2)
                || own.distance.saturating_mul(2) == distance;
            if own.distance > 0 && is_like {
                all.add(own.runs, own.longest, own.samples);
            }
        }
        (distance > 0).then_some((distance, all))
    }
}
