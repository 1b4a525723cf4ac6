//! The optional parts of an axis. A part that a type leaves out takes no memory, no flash and no time.

use super::{gate::Gate, sample::Sample};
use crate::{
    integrity::{InvalidLimit, Limits},
    kurtosis::FourthMoments,
};
use core::fmt::Debug;

/// The part that leaves out odd samples before anything is summed: `G` of [`Axes`](super::Axes).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gated;

/// The part that sums fourth powers, which distinguish jumps from Gaussian noise: `M` of
/// [`Axes`](super::Axes).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moments;

/// The types allowed for `G` of [`Axes`](super::Axes): [`Gated`], or `()` for no gate.
pub trait GatePart: Clone + Debug + PartialEq + Eq {
    /// The state of the gate.
    #[doc(hidden)]
    type State<const AXES: usize, const COVARIATES: usize>: Passing<AXES, COVARIATES>;
}

/// The types allowed for `M` of [`Axes`](super::Axes): [`Moments`], or `()` for no fourth moments.
pub trait MomentPart: Clone + Debug + PartialEq + Eq {
    /// The sums of one axis.
    #[doc(hidden)]
    type Sums<const OCTAVES: usize>: MomentSums<OCTAVES>;
}

impl GatePart for Gated {
    type State<const AXES: usize, const COVARIATES: usize> = Gate<AXES, COVARIATES>;
}

impl GatePart for () {
    type State<const AXES: usize, const COVARIATES: usize> = ();
}

impl MomentPart for Moments {
    type Sums<const OCTAVES: usize> = FourthMoments<OCTAVES>;
}

impl MomentPart for () {
    type Sums<const OCTAVES: usize> = ();
}

/// The output of a gate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passed<const AXES: usize, const COVARIATES: usize> {
    /// There is no output yet: the sample is held back.
    Nothing,
    /// A sample passes.
    Sample(Sample<AXES, COVARIATES>),
    /// A gap passes in place of samples that were left out or lost.
    Gap,
}

/// The interface of a gate. Without a gate, every sample passes at once.
pub trait Passing<const AXES: usize, const COVARIATES: usize>:
    Clone + Debug + PartialEq + Eq
{
    /// A gate that has seen no sample.
    const NEW: Self;

    /// Whether there is a gate.
    const EXISTS: bool;

    /// Sets the limits beyond which a sample is odd.
    fn set_limits(&mut self, limits: &'static Limits) -> Result<(), InvalidLimit>;

    /// Takes a sample and returns what passes now.
    fn push(&mut self, sample: Sample<AXES, COVARIATES>) -> Passed<AXES, COVARIATES>;

    /// Notes that the next sample does not adjoin the last one, and returns what passes now.
    fn gap(&mut self) -> Passed<AXES, COVARIATES>;

    /// Returns the oldest entry that is held back, or [`Passed::Nothing`] if there is none.
    fn release(&mut self) -> Passed<AXES, COVARIATES>;

    /// Adds what another gate saw. The other gate must hold nothing back.
    fn merge(&mut self, other: &Self);

    /// The gate, or `None` if there is no gate.
    fn gate(&self) -> Option<&Gate<AXES, COVARIATES>>;

    /// The gate, or `None` if there is no gate.
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

    fn gap(&mut self) -> Passed<AXES, COVARIATES> {
        Passed::Gap
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

/// The fourth moments of one axis, or `()` if they are not kept.
pub trait MomentSums<const OCTAVES: usize>: Clone + Debug + PartialEq + Eq {
    /// Empty sums.
    const NEW: Self;

    /// Whether sums are kept.
    const EXIST: bool;

    /// Adds a difference of the given octave.
    fn add(&mut self, octave: usize, difference: i64);

    /// Adds the sums of another record.
    fn merge(&mut self, other: &Self);

    /// The sums, if they are kept.
    fn moments(&self) -> Option<&FourthMoments<OCTAVES>>;

    /// The sums, if they are kept.
    #[cfg(feature = "storage")]
    fn moments_mut(&mut self) -> Option<&mut FourthMoments<OCTAVES>>;
}

impl<const OCTAVES: usize> MomentSums<OCTAVES> for FourthMoments<OCTAVES> {
    const NEW: Self = Self::NEW;
    const EXIST: bool = true;

    #[inline(always)]
    fn add(&mut self, octave: usize, difference: i64) {
        self.add(octave, difference);
    }

    fn merge(&mut self, other: &Self) {
        self.merge(other);
    }

    fn moments(&self) -> Option<&Self> {
        Some(self)
    }

    #[cfg(feature = "storage")]
    fn moments_mut(&mut self) -> Option<&mut Self> {
        Some(self)
    }
}

impl<const OCTAVES: usize> MomentSums<OCTAVES> for () {
    const NEW: Self = ();
    const EXIST: bool = false;

    #[inline(always)]
    fn add(&mut self, _: usize, _: i64) {}

    fn merge(&mut self, (): &Self) {}

    fn moments(&self) -> Option<&FourthMoments<OCTAVES>> {
        None
    }

    #[cfg(feature = "storage")]
    fn moments_mut(&mut self) -> Option<&mut FourthMoments<OCTAVES>> {
        None
    }
}
