//! The gate leaves out samples that integrity finds odd, before anything is summed.

use super::sample::Sample;
use crate::record::integrity::{Integrity, InvalidLimit, Limits, Observation};
use core::fmt::Debug;

/// Leaves out odd samples before anything is summed: `G` of [`Axes`](super::Axes).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gated;

/// What can stand for `G` of [`Axes`](super::Axes): [`Gated`], or `()` for no gate.
pub trait GatePart: Clone + Debug + PartialEq + Eq {
    /// The state of the gate.
    #[doc(hidden)]
    type State<const AXES: usize, const COVARIATES: usize>: Passing<AXES, COVARIATES>;
}

impl GatePart for Gated {
    type State<const AXES: usize, const COVARIATES: usize> = Gate<AXES, COVARIATES>;
}

impl GatePart for () {
    type State<const AXES: usize, const COVARIATES: usize> = ();
}

/// What a gate lets go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passed<const AXES: usize, const COVARIATES: usize> {
    /// Nothing yet: the sample is held back.
    Nothing,
    /// A sample.
    Sample(Sample<AXES, COVARIATES>),
    /// The place of samples that were left out or lost.
    Gap(Missing),
}

/// Samples that are missing at a place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Missing {
    /// The number of samples that are known to be missing.
    pub samples: u64,
    /// Whether others, whose number is not known, are missing too.
    pub has_more: bool,
}

impl Missing {
    /// So many samples, or an unknown number if it is 0.
    pub(crate) const fn new(samples: u64) -> Self {
        let has_more = samples == 0;
        Self { samples, has_more }
    }

    const fn and(self, other: Self) -> Self {
        Self {
            samples: self.samples.saturating_add(other.samples),
            has_more: self.has_more || other.has_more,
        }
    }
}

/// How samples pass a gate. Without one, everything passes at once.
pub trait Passing<const AXES: usize, const COVARIATES: usize>:
    Clone + Debug + PartialEq + Eq
{
    /// Nothing seen yet.
    const NEW: Self;

    /// Whether there is a gate.
    const EXISTS: bool;

    /// The same with limits of what is odd.
    fn set_limits(&mut self, limits: &'static Limits) -> Result<(), InvalidLimit>;

    /// A sample comes; what passes now.
    fn push(&mut self, sample: Sample<AXES, COVARIATES>) -> Passed<AXES, COVARIATES>;

    /// The next sample does not adjoin the last; what passes now.
    fn gap(&mut self, lost: Missing) -> Passed<AXES, COVARIATES>;

    /// The oldest that is held back; [`Passed::Nothing`] where nothing is.
    fn release(&mut self) -> Passed<AXES, COVARIATES>;

    /// Adds what another gate saw, which holds nothing back.
    fn merge(&mut self, other: &Self);

    /// The gate itself, if there is one.
    fn gate(&self) -> Option<&Gate<AXES, COVARIATES>>;

    /// The gate itself, if there is one.
    #[cfg(feature = "storage")]
    fn gate_mut(&mut self) -> Option<&mut Gate<AXES, COVARIATES>>;
}

impl<const AXES: usize, const COVARIATES: usize> Passing<AXES, COVARIATES> for () {
    const NEW: Self = ();
    const EXISTS: bool = false;

    fn set_limits(&mut self, _: &'static Limits) -> Result<(), InvalidLimit> {
        Ok(())
    }

    #[inline(always)]
    fn push(&mut self, sample: Sample<AXES, COVARIATES>) -> Passed<AXES, COVARIATES> {
        Passed::Sample(sample)
    }

    fn gap(&mut self, lost: Missing) -> Passed<AXES, COVARIATES> {
        Passed::Gap(lost)
    }

    fn release(&mut self) -> Passed<AXES, COVARIATES> {
        Passed::Nothing
    }

    fn merge(&mut self, (): &Self) {}

    fn gate(&self) -> Option<&Gate<AXES, COVARIATES>> {
        None
    }

    #[cfg(feature = "storage")]
    fn gate_mut(&mut self) -> Option<&mut Gate<AXES, COVARIATES>> {
        None
    }
}

/// The number of samples in the shortest cluster by which integrity detects motion. It is that of
/// `integrity::state::CLUSTERS`.
const CLUSTER: u8 = 64;

/// The number of samples held back: one cluster, and the cluster before it, in which motion may have begun.
pub(crate) const HELD: usize = 2 * CLUSTER as usize;

/// The number of slots whose flags fit into one word.
const WORD: usize = u32::BITS as usize;

/// Leaves out stuck values, samples at a rail, spikes and motion. It puts a gap in their place and counts
/// them. A sample that is odd in one axis is left out of all axes, so that axes and covariates stay aligned.
///
/// Integrity detects motion at the end of a cluster of 64 samples. The gate therefore holds the last 128
/// samples back until they are known to be at rest, and it leaves out 64 more samples after motion ends.
/// More gradual motion is detected in clusters of 1024 samples, so its first samples are already in the
/// record by then. The same is true of a run of equal values, which is at least 128 samples long before it
/// is found to be too long.
///
/// Every sample takes the same time, odd or not, because samples and gaps wait in the same queue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Gate<const AXES: usize, const COVARIATES: usize> {
    /// The integrity of all samples, including those that were left out.
    integrity: [Integrity; AXES],
    held: [Sample<AXES, COVARIATES>; HELD],
    /// One bit for each slot, which is set if the slot marks a gap and holds no sample. Its first count then holds
    /// the number of samples that are missing there, with all bits inverted if others are missing too.
    is_gap: [u32; HELD / WORD],
    /// The slot of the oldest entry.
    first: u8,
    /// The number of slots in use.
    length: u8,
    /// The number of samples that are still to be left out after a motion.
    behind: u8,
    left_out: u64,
}

impl<const AXES: usize, const COVARIATES: usize> Gate<AXES, COVARIATES> {
    /// The integrity of all samples, axis by axis.
    pub(crate) fn integrity(&self) -> &[Integrity; AXES] {
        &self.integrity
    }

    /// The number of samples left out.
    pub(crate) fn left_out(&self) -> u64 {
        self.left_out
    }

    /// The integrity and the number of samples left out, for a restore from a snapshot.
    #[cfg(feature = "storage")]
    pub(crate) fn state_mut(&mut self) -> (&mut [Integrity; AXES], &mut u64) {
        (&mut self.integrity, &mut self.left_out)
    }

    /// Appends a sample to the queue, and returns the oldest entry if the queue was full.
    #[inline(always)]
    fn hold(&mut self, sample: Sample<AXES, COVARIATES>) -> Passed<AXES, COVARIATES> {
        let passed = if usize::from(self.length) == HELD {
            self.release()
        } else {
            Passed::Nothing
        };
        let slot = self.slot(self.length);
        self.held[slot] = sample;
        self.length = self.length.wrapping_add(1);
        passed
    }

    /// Appends a gap to the queue. Consecutive samples that are left out or lost share one gap.
    #[inline(never)]
    fn hold_gap(&mut self, missing: Missing) -> Passed<AXES, COVARIATES> {
        let mut passed = Passed::Nothing;
        let mut newest = self.slot(self.length.wrapping_sub(1));
        if self.length == 0 || !self.is_gap(newest) {
            passed = self.hold(Sample::ZERO);
            newest = self.slot(self.length.wrapping_sub(1));
            self.is_gap[newest / WORD] |= flag(newest);
        }
        let all = self.missing_at(newest).and(missing);
        if let Some(count) = self.held[newest].counts.first_mut() {
            let samples = i32::try_from(all.samples).unwrap_or(i32::MAX);
            *count = if all.has_more { !samples } else { samples };
        }
        passed
    }

    /// The samples that are missing at a slot that marks a gap.
    fn missing_at(&self, slot: usize) -> Missing {
        let count = self.held[slot].counts.first().copied().unwrap_or(0);
        let has_more = count < 0;
        let samples = if has_more { !count } else { count };
        Missing {
            samples: samples as u64,
            has_more,
        }
    }

    /// Leaves out all samples that are held back, and returns what is missing in their place.
    #[cold]
    #[inline(never)]
    fn leave_out_held(&mut self) -> Missing {
        let (mut samples, mut missing) = (0_u64, Missing::default());
        for behind in 0..self.length {
            let slot = self.slot(behind);
            if self.is_gap(slot) {
                missing = missing.and(self.missing_at(slot));
            } else {
                samples = samples.saturating_add(1);
            }
        }
        self.left_out = self.left_out.saturating_add(samples);
        self.is_gap = [0; HELD / WORD];
        self.length = 0;
        missing.samples = missing.samples.saturating_add(samples);
        missing
    }

    /// The slot at this distance from the oldest entry.
    #[inline(always)]
    fn slot(&self, behind: u8) -> usize {
        usize::from(self.first.wrapping_add(behind)) % HELD
    }

    #[inline(always)]
    fn is_gap(&self, slot: usize) -> bool {
        self.is_gap[slot / WORD] & flag(slot) != 0
    }
}

/// The flag of a slot within its word.
#[inline(always)]
const fn flag(slot: usize) -> u32 {
    1_u32.wrapping_shl(slot as u32)
}

impl<const AXES: usize, const COVARIATES: usize> Passing<AXES, COVARIATES>
    for Gate<AXES, COVARIATES>
{
    const NEW: Self = Self {
        integrity: [const { Integrity::new() }; AXES],
        held: [Sample::ZERO; HELD],
        is_gap: [0; HELD / WORD],
        first: 0,
        length: 0,
        behind: 0,
        left_out: 0,
    };
    const EXISTS: bool = true;

    fn set_limits(&mut self, limits: &'static Limits) -> Result<(), InvalidLimit> {
        let fresh = Integrity::with_limits(limits)?;
        self.integrity = [(); AXES].map(|()| fresh.clone());
        Ok(())
    }

    #[inline(always)]
    fn push(&mut self, sample: Sample<AXES, COVARIATES>) -> Passed<AXES, COVARIATES> {
        let mut seen = Observation::default();
        for (integrity, &count) in self.integrity.iter_mut().zip(&sample.counts) {
            seen = seen.or(integrity.push(count));
        }
        let is_odd = seen.is_odd() || self.behind > 0;
        if !is_odd {
            return self.hold(sample);
        }
        self.left_out = self.left_out.saturating_add(1);
        self.behind = self.behind.saturating_sub(1);
        let mut missing = Missing::new(1);
        if seen.moving || seen.stuck {
            missing = missing.and(self.leave_out_held());
        }
        if seen.moving {
            self.behind = CLUSTER;
        }
        self.hold_gap(missing)
    }

    fn gap(&mut self, lost: Missing) -> Passed<AXES, COVARIATES> {
        self.integrity.iter_mut().for_each(Integrity::gap);
        self.hold_gap(lost)
    }

    #[inline(always)]
    fn release(&mut self) -> Passed<AXES, COVARIATES> {
        if self.length == 0 {
            return Passed::Nothing;
        }
        let oldest = self.slot(0);
        self.first = self.first.wrapping_add(1) % HELD as u8;
        self.length = self.length.wrapping_sub(1);
        if self.is_gap(oldest) {
            self.is_gap[oldest / WORD] &= !flag(oldest);
            return Passed::Gap(self.missing_at(oldest));
        }
        Passed::Sample(self.held[oldest])
    }

    fn merge(&mut self, other: &Self) {
        for (own, other) in self.integrity.iter_mut().zip(&other.integrity) {
            own.merge(other);
        }
        self.left_out = self.left_out.saturating_add(other.left_out);
    }

    fn gate(&self) -> Option<&Self> {
        Some(self)
    }

    #[cfg(feature = "storage")]
    fn gate_mut(&mut self) -> Option<&mut Self> {
        Some(self)
    }
}
