//! The fourth moments of an axis, which a type may leave out: then they take no memory, no flash and no
//! time.

use crate::record::fourth_moments::FourthMoments;
use core::fmt::Debug;

/// Sums fourth powers, which distinguish jumps from Gaussian noise: `M` of [`Axes`](super::Axes).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moments;

/// What can stand for `M` of [`Axes`](super::Axes): [`Moments`], or `()` for none.
pub trait MomentPart: Clone + Debug + PartialEq + Eq {
    /// The sums of one axis.
    #[doc(hidden)]
    type Sums<const OCTAVES: usize>: MomentSums<OCTAVES>;
}

impl MomentPart for Moments {
    type Sums<const OCTAVES: usize> = FourthMoments<OCTAVES>;
}

impl MomentPart for () {
    type Sums<const OCTAVES: usize> = ();
}

/// The fourth moments of one axis, or nothing.
pub trait MomentSums<const OCTAVES: usize>: Clone + Debug + PartialEq + Eq {
    /// Nothing summed yet.
    const NEW: Self;

    /// Whether sums are kept.
    const EXIST: bool;

    /// Adds a difference of an octave.
    fn add(&mut self, octave: usize, difference: i64);

    /// Adds differences of an octave with these magnitudes, which are below 2^31.
    fn add_magnitudes(&mut self, octave: usize, magnitudes: &[u32]);

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

    #[inline(always)]
    fn add_magnitudes(&mut self, octave: usize, magnitudes: &[u32]) {
        self.add_magnitudes(octave, magnitudes);
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

    #[inline(always)]
    fn add_magnitudes(&mut self, _: usize, _: &[u32]) {}

    fn merge(&mut self, (): &Self) {}

    fn moments(&self) -> Option<&FourthMoments<OCTAVES>> {
        None
    }

    #[cfg(feature = "storage")]
    fn moments_mut(&mut self) -> Option<&mut FourthMoments<OCTAVES>> {
        None
    }
}
