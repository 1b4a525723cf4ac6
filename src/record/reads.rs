//! What a reader, and not the sensor, made of the samples: repeats, reads without an answer, and blocks of a buffer that was not
//! refilled.

pub(crate) mod stale;
#[cfg(feature = "storage")]
mod stored;

use super::faults::{JointRepeats, steps::FAR};
use stale::Stale;

/// Counts, in fixed memory and integers, what shows that samples of a sensor were made by its reader.
///
/// *Repeats* are those of [`JointRepeats`], in steps of one count. *Reads without an answer* have one number on all axes: 0, −1, or what
/// else the bus holds, far from the samples before. How often all axes are 0 or −1 by chance is shown by each axis while another one is
/// not. *Stale blocks* are samples that equal those of a fixed distance before, as a buffer that a DMA or a FIFO did not refill leaves
/// them: a hash of four samples finds the distance, and hashes of single samples follow it up to its end.
///
/// [`Axes`](crate::Axes) have one, whose verdict is part of that of their record. The state takes at most 800 bytes. Repeats and reads
/// without an answer are seen in three axes only.
///
/// ```
/// use allanite::{faults::Reads, integrity::Reason};
///
/// let (mut reads, mut random) = (Reads::new(), 1_u32);
/// for n in 0..20_000 {
///     let mut noise = || {
///         random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///         (random >> 26) as i32 - 40
///     };
///     let counts = [noise(), noise(), noise()];
///     reads.push(if n % 300 == 0 { [-1; 3] } else { counts });
/// }
/// assert!(matches!(reads.verdict(), Some(Reason::Unanswered { .. })));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reads<const AXES: usize = 3> {
    last: [i32; AXES],
    /// The sample before the last one, where [`Sampled`] needs it.
    before: [i32; AXES],
    /// The samples since a gap, and the time at which all axes repeated for the last time.
    time: u32,
    repeated_at: u32,
    pub(crate) earlier: Earlier,
    repeats: JointRepeats,
    pub(crate) equal: EqualAxes,
    pub(crate) stale: Stale,
}

/// What lies before the last gap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Earlier {
    samples: u32,
    /// Neighbours without a gap between them.
    pairs: u32,
}

/// Samples whose axes may have no answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct EqualAxes {
    /// Samples whose axes are all 0, and all −1.
    pub(crate) all: [u32; 2],
    /// Samples whose axes are all equal, and lie far from those before.
    pub(crate) far: u32,
    /// One sample in [`SAMPLED`], by the axes that are 0, and by those that are −1: the bits of the place. Samples without any are not
    /// counted.
    pub(crate) at: [[u32; 8]; 2],
    /// Samples from which the usual step was learnt, and the sum of the longest steps of each.
    learnt: u16,
    usual: u64,
}

/// One sample in so many is looked at for what is frequent.
pub(crate) const SAMPLED: u32 = 8;

/// Whether the sample behind the one at a time is looked at. The multiples of the golden ratio have no period that a vibration may have
/// (Knuth 1998, 6.4).
#[inline(always)]
const fn is_sampled(time: u32) -> bool {
    time.wrapping_mul(0x9E37_79B1) < u32::MAX / SAMPLED
}

/// The number of samples from which the usual step is learnt.
const LEARNT: u16 = 32;
/// A step is far if it is longer than so many usual ones.
const FAR_STEPS: u64 = 6;

impl EqualAxes {
    const NEW: Self = Self {
        all: [0; 2],
        far: 0,
        at: [[0; 8]; 2],
        learnt: 0,
        usual: 0,
    };

    /// Learns the usual step.
    #[cold]
    #[inline(never)]
    fn learn(&mut self, counts: [i32; 3], last: [i32; 3]) {
        self.learnt = self.learnt.saturating_add(1);
        let longest = longest_step(counts, last);
        self.usual = self.usual.saturating_add(longest.into());
    }

    /// Counts the axes that have one of the values: 0 for the first, and −1 for the second.
    fn count(&mut self, [x, y, z]: [i32; 3], place: usize, value: i32) {
        let cell =
            usize::from(x == value) | usize::from(y == value) << 1 | usize::from(z == value) << 2;
        if cell > 0
            && let Some(cell) = self.at.get_mut(place).and_then(|cells| cells.get_mut(cell))
        {
            *cell = cell.saturating_add(1);
        }
    }

    /// Notes a sample whose axes are all equal, and the axes of the sample before. Single numbers pass in registers.
    #[cold]
    #[inline(never)]
    fn equal(&mut self, count: i32, x1: i32, y1: i32, z1: i32) {
        let [zeros, ones] = &mut self.all;
        match count {
            0 => *zeros = zeros.saturating_add(1),
            -1 => *ones = ones.saturating_add(1),
            _ => {}
        }
        let longest = u64::from(longest_step([count; 3], [x1, y1, z1]));
        let usual = self.usual.saturating_mul(FAR_STEPS);
        // A level that is hidden in a count may move by one.
        let usual = usual.saturating_add(2 * u64::from(LEARNT));
        if self.learnt >= LEARNT && longest.saturating_mul(LEARNT.into()) > usual {
            self.far = self.far.saturating_add(1);
        }
    }

    fn merge(&mut self, other: &Self) {
        let cells = self.at.as_flattened_mut().iter_mut();
        let cells = cells.zip(other.at.as_flattened());
        for (own, theirs) in cells.chain(self.all.iter_mut().zip(&other.all)) {
            *own = own.saturating_add(*theirs);
        }
        self.far = self.far.saturating_add(other.far);
        if other.learnt > self.learnt {
            (self.learnt, self.usual) = (other.learnt, other.usual);
        }
    }
}

fn longest_step([x, y, z]: [i32; 3], [x1, y1, z1]: [i32; 3]) -> u32 {
    x.abs_diff(x1).max(y.abs_diff(y1)).max(z.abs_diff(z1))
}

impl<const AXES: usize> Reads<AXES> {
    /// No samples yet.
    pub const fn new() -> Self {
        Self {
            last: [0; AXES],
            before: [0; AXES],
            time: 0,
            repeated_at: 0,
            earlier: Earlier {
                samples: 0,
                pairs: 0,
            },
            repeats: JointRepeats::NEW,
            equal: EqualAxes::NEW,
            stale: Stale::NEW,
        }
    }

    /// Adds the counts of the axes at one time.
    #[inline]
    pub fn push(&mut self, counts: [i32; AXES]) {
        match (&counts[..], &mut self.last[..]) {
            (&[x, y, z], &mut [x1, y1, z1]) => {
                self.push_three([x, y, z], [x1, y1, z1], || {
                    let step = |one: i32, other: i32| one.abs_diff(other).min(FAR.into()) as u8;
                    [step(x, x1), step(y, y1), step(z, z1)]
                });
            }
            (others, _) => {
                let hash = others
                    .iter()
                    .fold(0, |hash, count| stale::mix(hash, *count));
                self.stale.push(self.time, hash);
            }
        }
        self.last = counts;
        self.time = self.time.wrapping_add(1);
    }

    /// What three axes show together.
    #[inline(always)]
    fn push_three(&mut self, counts: [i32; 3], last: [i32; 3], steps: impl Fn() -> [u8; 3]) {
        let ([x, y, z], [x1, y1, z1]) = (counts, last);
        if (x == x1 || y == y1 || z == z1) && self.time > 0 {
            self.repeat(steps());
        }
        if x == y && y == z && self.time > 0 {
            self.equal.equal(x, x1, y1, z1);
        }
        if is_sampled(self.time) || is_sampled(self.time.wrapping_sub(1)) {
            self.sample(x, y, z, x1, y1, z1);
        }
        let hash = stale::mix(stale::mix(stale::mix(0, x), y), z);
        self.stale.push(self.time, hash);
    }

    /// Adds the steps of a sample in which an axis repeats. Those in which none does are known from the others.
    #[inline(never)]
    fn repeat(&mut self, steps: [u8; 3]) {
        if self.repeated_at != self.time {
            self.repeats.end_run();
        }
        if self.repeats.push(steps) {
            self.repeated_at = self.time.wrapping_add(1);
        }
    }

    /// Looks at the sample behind a [sampled](is_sampled) time, and keeps the one before such a time for it.
    #[inline(never)]
    fn sample(&mut self, x: i32, y: i32, z: i32, x1: i32, y1: i32, z1: i32) {
        let Some(before) = self.before.first_chunk_mut::<3>() else {
            return;
        };
        let (counts, last) = ([x, y, z], [x1, y1, z1]);
        if is_sampled(self.time.wrapping_sub(1)) && self.time > 1 {
            self.repeats.compare(counts, last, *before);
            self.equal.count(counts, 0, 0);
            self.equal.count(counts, 1, -1);
            if self.equal.learnt < LEARNT {
                self.equal.learn(counts, last);
            }
        }
        *before = last;
    }

    /// The repeats of all axes at once.
    pub fn joint(&self) -> JointRepeats {
        self.repeats.of(self.pairs().into())
    }

    /// Samples.
    pub(crate) fn samples(&self) -> u32 {
        self.earlier.samples.saturating_add(self.time)
    }

    fn pairs(&self) -> u32 {
        let pairs = self.time.saturating_sub(1);
        self.earlier.pairs.saturating_add(pairs)
    }

    /// Marks a place where the next sample does not adjoin the one before.
    pub fn gap(&mut self) {
        self.earlier = Earlier {
            samples: self.samples(),
            pairs: self.pairs(),
        };
        self.repeats.end_run();
        self.stale.gap();
        (self.time, self.repeated_at) = (0, 0);
        (self.last, self.before) = ([0; AXES], [0; AXES]);
    }

    /// Adds what was counted in another record.
    pub(crate) fn merge(&mut self, other: &Self) {
        let mut other = other.clone();
        other.gap();
        self.gap();
        let (own, theirs) = (&mut self.earlier, other.earlier);
        own.samples = own.samples.saturating_add(theirs.samples);
        own.pairs = own.pairs.saturating_add(theirs.pairs);
        self.repeats.merge(&other.repeats);
        self.equal.merge(&other.equal);
        self.stale.runs.merge(&other.stale.runs);
    }
}

impl Reads {
    /// Adds the counts of three axes at one time, whose steps may be longer than one count: with what
    /// [`SampleFaults::push`](super::faults::SampleFaults::push) returned for each axis.
    #[inline]
    pub fn push_steps(&mut self, counts: [i32; 3], steps: [Option<u8>; 3]) {
        self.push_three(counts, self.last, || steps.map(|step| step.unwrap_or(FAR)));
        self.last = counts;
        self.time = self.time.wrapping_add(1);
    }
}

impl<const AXES: usize> Default for Reads<AXES> {
    /// No samples yet.
    fn default() -> Self {
        Self::new()
    }
}
