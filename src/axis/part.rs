//! The parts of an axis that a type may leave out: those that are left out take no memory, no flash and no
//! time.

use super::{gate::Gate, sample::Sample};
use crate::{
    integrity::{InvalidLimit, Limits},
    kurtosis::FourthMoments,
};
use core::fmt::Debug;

/// Leaves out odd samples before anything is summed: `G` of [`Axes`](super::Axes).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gated;

/// Sums fourth powers, which tell jumps from Gaussian noise: `M` of [`Axes`](super::Axes).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moments;

/// What can stand for `G` of [`Axes`](super::Axes): [`Gated`], or `()` for no gate.
pub trait GatePart: Clone + Debug + PartialEq + Eq {
    /// The state of the gate.
    #[doc(hidden)]
    type State<const AXES: usize, const COVARIATES: usize>: Passing<AXES, COVARIATES>;
}

/// What can stand for `M` of [`Axes`](super::Axes): [`Moments`], or `()` for none.
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

/// What a gate lets go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passed<const AXES: usize, const COVARIATES: usize> {
    /// Nothing yet: the sample is held back.
    Nothing,
    /// A sample.
    Sample(Sample<AXES, COVARIATES>),
    /// The place of a sample that was left out or lost.
    Gap,
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
    fn gap(&mut self) -> Passed<AXES, COVARIATES>;

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

/// The fourth moments of one axis, or nothing.
pub trait MomentSums<const OCTAVES: usize>: Clone + Debug + PartialEq + Eq {
    /// Nothing summed yet.
    const NEW: Self;

    /// Whether sums are kept.
    const EXIST: bool;

    /// Adds a difference of an octave.
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
