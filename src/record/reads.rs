//! What a reader, and not the sensor, made of the samples: repeats, reads without an answer, and blocks of a buffer that
//! was not refilled.

mod stale;
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
/// [`Axes`](crate::Axes) have one, whose verdict is part of that of their record. The state takes at most 1000 bytes. Repeats and reads
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
    /// How many samples before the next one adjoin it, at most two.
    adjoining: u8,
    last: [i32; AXES],
    before: [i32; AXES],
    pub(crate) repeats: JointRepeats,
    pub(crate) equal: EqualAxes,
    pub(crate) stale: Stale,
}

/// Samples whose axes may have no answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct EqualAxes {
    /// The number of axes that are 0, and that are −1: samples in which those axes are whose bits are set in the place. Those without any
    /// are not counted.
    pub(crate) at: [[u32; 8]; 2],
    /// Samples whose axes are all equal, and lie far from those before.
    pub(crate) far: u32,
    /// Samples from which the usual step was learnt, and the sum of the longest steps of each.
    learnt: u16,
    usual: u64,
}

/// The number of samples from which the usual step is learnt.
const LEARNT: u16 = 256;
/// A step is far if it is longer than so many usual ones.
const FAR_STEPS: u64 = 6;

impl EqualAxes {
    const NEW: Self = Self {
        at: [[0; 8]; 2],
        far: 0,
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

    /// Notes a sample whose axes are all equal.
    #[inline(never)]
    fn equal(&mut self, counts: [i32; 3], last: [i32; 3]) {
        let longest = u64::from(longest_step(counts, last));
        // A level that is hidden in a count may move by one.
        let usual = self
            .usual
            .saturating_mul(FAR_STEPS)
            .saturating_add(2 * u64::from(LEARNT));
        if self.learnt >= LEARNT && longest.saturating_mul(LEARNT.into()) > usual {
            self.far = self.far.saturating_add(1);
        }
    }

    /// Notes a sample with an axis at 0 or −1.
    #[inline(never)]
    fn none(&mut self, counts: [i32; 3]) {
        for (value, cells) in [0, -1].into_iter().zip(&mut self.at) {
            let [x, y, z] = counts.map(|count| usize::from(count == value));
            if let Some(cell @ 1..) = Some(x | y << 1 | z << 2)
                && let Some(cell) = cells.get_mut(cell)
            {
                *cell = cell.saturating_add(1);
            }
        }
    }

    fn merge(&mut self, other: &Self) {
        let cells = self.at.as_flattened_mut().iter_mut();
        for (own, theirs) in cells.zip(other.at.as_flattened()) {
            *own = own.saturating_add(*theirs);
        }
        self.far = self.far.saturating_add(other.far);
        if other.learnt > self.learnt {
            (self.learnt, self.usual) = (other.learnt, other.usual);
        }
    }
}

const fn pairs([x, y, z]: [i32; 3], [x1, y1, z1]: [i32; 3]) -> [[i32; 2]; 3] {
    [[x, x1], [y, y1], [z, z1]]
}

fn longest_step(counts: [i32; 3], last: [i32; 3]) -> u32 {
    let [x, y, z] = pairs(counts, last).map(|[count, last]| count.abs_diff(last));
    x.max(y).max(z)
}

impl<const AXES: usize> Reads<AXES> {
    /// No samples yet.
    pub const fn new() -> Self {
        Self {
            adjoining: 0,
            last: [0; AXES],
            before: [0; AXES],
            repeats: JointRepeats::new(),
            equal: EqualAxes::NEW,
            stale: Stale::NEW,
        }
    }

    /// Adds the counts of the axes at one time.
    #[inline]
    pub fn push(&mut self, counts: [i32; AXES]) {
        if let (&[x, y, z], &[x1, y1, z1]) = (&counts[..], &self.last[..]) {
            self.push_three([x, y, z], || {
                let steps = [x.abs_diff(x1), y.abs_diff(y1), z.abs_diff(z1)];
                steps.map(|step| step.min(FAR.into()) as u8)
            });
        }
        self.keep(counts);
    }

    #[inline(always)]
    fn keep(&mut self, counts: [i32; AXES]) {
        self.stale.push(counts);
        (self.before, self.last) = (self.last, counts);
        self.adjoining = if self.adjoining == 0 { 1 } else { 2 };
    }

    /// What three axes show together.
    #[inline(always)]
    fn push_three(&mut self, counts: [i32; 3], steps: impl Fn() -> [u8; 3]) {
        let (&[x1, y1, z1], &[x2, y2, z2]) = (&self.last[..], &self.before[..]) else {
            return;
        };
        let [x, y, z] = counts;
        if self.adjoining > 0 {
            if x == x1 || y == y1 || z == z1 {
                self.repeats.push_some(steps());
            } else {
                self.repeats.push_none();
            }
            if (x == x2 || y == y2 || z == z2) && self.adjoining > 1 {
                let same = [x == x2, y == y2, z == z2].map(u8::from);
                self.repeats.return_to(same);
            }
            if x == y && y == z {
                self.equal.equal(counts, [x1, y1, z1]);
            }
            if self.equal.learnt < LEARNT {
                self.equal.learn(counts, [x1, y1, z1]);
            }
        }
        let is_none = |count: i32| (count as u32).wrapping_add(1) <= 1;
        if is_none(x) || is_none(y) || is_none(z) {
            self.equal.none(counts);
        }
    }

    /// The repeats of all axes at once.
    pub const fn joint(&self) -> &JointRepeats {
        &self.repeats
    }

    /// Marks a place where the next sample does not adjoin the one before.
    pub fn gap(&mut self) {
        (self.adjoining, self.last, self.before) = (0, [0; AXES], [0; AXES]);
        self.repeats.push([None; 3]);
        self.stale.gap();
    }

    /// Adds what was counted in another record.
    pub(crate) fn merge(&mut self, other: &Self) {
        self.gap();
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
        self.push_three(counts, || steps.map(|step| step.unwrap_or(FAR)));
        self.keep(counts);
    }
}

impl<const AXES: usize> Default for Reads<AXES> {
    /// No samples yet.
    fn default() -> Self {
        Self::new()
    }
}
