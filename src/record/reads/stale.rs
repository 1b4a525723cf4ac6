//! Blocks of samples that are there a second time, as a buffer that was not refilled leaves them.

use crate::list::numbered;

/// The samples whose hashes are kept: the longest distance at which a block is recognised, and some before it.
const RING: usize = 144;
/// The longest distance at which a block is recognised, in samples.
const FARTHEST: u16 = 128;
/// Windows that are remembered. One in [`ENTERED`] windows is.
const ENTRIES: usize = 64;
const ENTERED: u32 = 4;
/// The samples before a window that are compared when it is recognised.
const BACK: u32 = 32;
/// The distance at which equal samples are by chance. Slow noise makes them less often equal at longer ones.
const ELSEWHERE: u16 = 11;
/// The shortest distance of a block.
const NEAREST: u16 = 8;
/// The distances that are counted apart from each other.
const DISTANCES: usize = 4;
/// The samples from which it is known how often others are equal by chance.
const LEARNT: u32 = 1000;
/// The surprise, in bits, from which a run of equal samples is not by chance.
const BITS: u32 = 32;

/// The runs of samples that equal those at one distance before them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct AtDistance {
    /// 0 if the place is free.
    pub(crate) distance: u16,
    pub(crate) runs: u32,
    pub(crate) longest: u32,
    /// Samples in all of them.
    pub(crate) samples: u32,
}

/// What is counted of the runs.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Runs {
    /// Samples.
    pub(crate) samples: u32,
    /// Samples that equal the one [`ELSEWHERE`] before.
    pub(crate) elsewhere: u32,
    /// Runs that are too long for chance, and those of them that have the length of a block.
    pub(crate) long: u32,
    pub(crate) whole: u32,
    pub(crate) distances: [AtDistance; DISTANCES],
}

impl Runs {
    const NEW: Self = Self {
        samples: 0,
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

    /// The bits by which a sample that equals another one surprises, at most those of a hash.
    pub(crate) const fn bits(&self) -> u32 {
        match self.samples.checked_div(self.elsewhere.saturating_add(1)) {
            Some(ratio @ 1..) => {
                if ratio.ilog2() < 16 {
                    ratio.ilog2()
                } else {
                    16
                }
            }
            _ => 0,
        }
    }

    /// The length from which a run is not by chance; `None` where nothing can be said.
    pub(crate) fn needed(&self) -> Option<u32> {
        BITS.checked_add(self.bits().saturating_sub(1))?
            .checked_div(self.bits())
            .map(|length| length.max(6))
    }

    /// Counts a run. A buffer of two halves leaves runs of half the distance, one of a single part those of the whole distance, and more
    /// where it is not refilled several times.
    #[cold]
    #[inline(never)]
    fn add(&mut self, distance: u16, length: u32) {
        let Some(needed) = self.needed() else {
            return;
        };
        if self.samples < LEARNT || distance < NEAREST || length < needed {
            return;
        }
        self.long = self.long.saturating_add(1);
        // A sample beside the block may equal by chance.
        let beside = match self.bits() {
            0 | 1 => 3,
            _ => 2,
        };
        let twice = length.saturating_mul(2);
        let is_whole = (1..=4_u32).any(|times| {
            let halves = u32::from(distance).saturating_mul(times);
            twice.abs_diff(halves) <= 2 * beside
        });
        if !is_whole {
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
                && own.longest <= own.samples
                && own.samples <= self.samples;
            is_free || is_taken
        };
        let runs = self.distances.iter().map(|own| own.runs);
        let runs = runs.fold(0, u32::saturating_add);
        self.whole <= self.long && runs <= self.whole && self.distances.iter().all(is_possible)
    }

    pub(crate) fn merge(&mut self, other: &Self) {
        self.samples = self.samples.saturating_add(other.samples);
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

/// A window that was seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Seen {
    tag: u16,
    /// The low bits of the time at which it ended.
    time: u16,
}

/// Finds blocks that are there twice: a hash of the last four samples finds the distance, and the hashes of single samples follow it.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Stale {
    ring: [u16; RING],
    /// The place in the ring of the next sample.
    next: u16,
    /// The samples since a gap, at most as many as the ring holds.
    filled: u16,
    /// The time, in samples.
    time: u16,
    /// The distance that is followed; 0 if none is.
    distance: u16,
    /// The samples of the present run.
    length: u32,
    /// A byte of the hash of each of the last four samples.
    window: u32,
    seen: [Seen; ENTRIES],
    pub(crate) runs: Runs,
}

impl Stale {
    pub(super) const NEW: Self = Self {
        ring: [0; RING],
        next: 0,
        filled: 0,
        time: 0,
        distance: 0,
        length: 0,
        window: 0,
        seen: [Seen { tag: 0, time: 0 }; ENTRIES],
        runs: Runs::NEW,
    };

    /// Adds a sample of all axes.
    #[inline(always)]
    pub(super) fn push<const AXES: usize>(&mut self, counts: [i32; AXES]) {
        let mixed =
            |hash: u32, count: i32| hash.wrapping_add(count as u32).wrapping_mul(0x9E37_79B1);
        let hash = counts.into_iter().fold(0, mixed);
        // The upper bits depend on all bits of the counts.
        let hash = hash >> 16;
        self.runs.samples = self.runs.samples.saturating_add(1);
        if self.before(ELSEWHERE) == hash as u16 && self.filled >= ELSEWHERE {
            self.runs.elsewhere = self.runs.elsewhere.saturating_add(1);
        }
        if self.distance > 0 {
            self.follow(hash as u16);
        }
        if let Some(place) = self.ring.get_mut(usize::from(self.next)) {
            *place = hash as u16;
        }
        self.next = self.next.wrapping_add(1);
        if usize::from(self.next) >= RING {
            self.next = 0;
        }
        self.filled = self
            .filled
            .saturating_add(u16::from(usize::from(self.filled) < RING));
        self.time = self.time.wrapping_add(1);
        self.window = self.window << 8 | hash & 0xff;
        let mixed = self.window.wrapping_mul(0x2C1B_3C6D);
        if mixed.wrapping_shr(8).is_multiple_of(ENTERED) {
            self.look(mixed);
        }
    }

    /// The hash of the sample that lies so far before the next one.
    #[inline(always)]
    fn before(&self, distance: u16) -> u16 {
        let place = match self.next.checked_sub(distance) {
            Some(place) => place,
            None => self.next.wrapping_add(RING as u16).wrapping_sub(distance),
        };
        self.ring.get(usize::from(place)).copied().unwrap_or(0)
    }

    /// Whether a sample goes on with the present run.
    #[inline(never)]
    fn follow(&mut self, hash: u16) {
        if self.before(self.distance) == hash {
            self.length = self.length.saturating_add(1);
        } else {
            self.runs.add(self.distance, self.length);
            (self.distance, self.length) = (0, 0);
        }
    }

    /// Looks whether the last four samples were there before, and remembers them.
    #[inline(never)]
    fn look(&mut self, mixed: u32) {
        let (tag, time) = (mixed as u16, self.time);
        let Some(seen) = self.seen.get_mut((mixed >> 26) as usize) else {
            return;
        };
        let distance = time.wrapping_sub(seen.time);
        let is_same = seen.tag == tag;
        *seen = Seen { tag, time };
        if is_same && self.distance == 0 && (1..=FARTHEST).contains(&distance) {
            self.begin(distance);
        }
    }

    /// Begins a run, with the samples that belong to it already.
    #[cold]
    #[inline(never)]
    fn begin(&mut self, distance: u16) {
        let reach = u32::from(self.filled.saturating_sub(distance)).min(BACK);
        let mut length = 0;
        let mut back = 1;
        while length < reach && self.before(back) == self.before(back.saturating_add(distance)) {
            length = length.saturating_add(1);
            back = back.saturating_add(1);
        }
        if length > 0 {
            (self.distance, self.length) = (distance, length);
        }
    }

    /// The next sample does not adjoin the last one.
    pub(super) fn gap(&mut self) {
        if self.filled > 0 {
            *self = Self::with_runs(self.runs_at_gap());
        }
    }

    /// What is counted after a gap at this place, which ends the present run.
    pub(super) fn runs_at_gap(&self) -> Runs {
        let mut runs = self.runs.clone();
        runs.add(self.distance, self.length);
        runs
    }

    pub(super) fn with_runs(runs: Runs) -> Self {
        Self { runs, ..Self::NEW }
    }
}

impl Runs {
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
