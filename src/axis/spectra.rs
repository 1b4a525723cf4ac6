//! The spectrum of an axis, which a type may leave out: then it takes no memory, no flash and no time.

use crate::{
    curve::Scale,
    spectrum::{Spectrum, SpectrumAccumulator},
};
use core::fmt::Debug;

/// Keeps a spectrum of every axis: `S` of [`Axes`](super::Axes). The parameters are those of the
/// [`SpectrumAccumulator`], and the number of bins that the evidence has room for: `7P/16` for each level.
///
/// Level 4 of 64 blocks, which is the fifth, has its 16 segments after 2.2 million samples. So 140 bins lose
/// nothing of a record of up to 17 million samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spectral<const P: usize = 64, const LEVELS: usize = 7, const BINS: usize = 140>;

/// What can stand for `S` of [`Axes`](super::Axes): [`Spectral`], or `()` for none.
pub trait SpectrumPart: Clone + Debug + PartialEq + Eq {
    /// The spectrum of an axis: a [`Spectrum`], which has no bins if none is kept.
    type Spectrum: Clone + Debug + PartialEq;

    /// The sums of one axis.
    #[doc(hidden)]
    type Sums: SpectrumSums<Spectrum = Self::Spectrum>;
}

impl<const P: usize, const LEVELS: usize, const BINS: usize> SpectrumPart
    for Spectral<P, LEVELS, BINS>
{
    type Spectrum = Spectrum<BINS>;
    type Sums = AxisSpectrum<P, LEVELS, BINS>;
}

impl SpectrumPart for () {
    type Spectrum = Spectrum<0>;
    type Sums = ();
}

/// The spectrum's sums of one axis, or nothing.
pub trait SpectrumSums: Clone + Debug + PartialEq + Eq {
    /// The spectrum that is read from the sums.
    type Spectrum;

    /// Nothing summed yet.
    const NEW: Self;

    /// The number of blocks of a segment and the number of levels; zeros if no sums are kept.
    const SIZE: (u16, u8);

    /// Adds a count.
    fn push(&mut self, count: i32);

    /// Does a part of the work that waits, and tells whether there is more.
    fn advance(&mut self) -> bool;

    /// Whether half of the room, or all of it, is taken by counts that wait to be worked on.
    fn waits(&self) -> Waits;

    /// No segment spans this place.
    fn gap(&mut self);

    /// Adds the sums of another record.
    fn merge(&mut self, other: &Self);

    /// The spectrum at this moment.
    fn spectrum(&self, scale: Scale) -> Self::Spectrum;

    /// The largest number of bytes that the sums take in a snapshot.
    #[cfg(feature = "storage")]
    const LONGEST: usize;

    /// Writes the sums as they are after a gap, and returns the number of bytes; `None` if the buffer is too
    /// small.
    #[cfg(feature = "storage")]
    fn write(&self, buffer: &mut [u8]) -> Option<usize>;

    /// Reads sums, and returns the bytes behind them; `None` if no record can have such sums.
    #[cfg(feature = "storage")]
    fn read<'b>(&mut self, bytes: &'b [u8]) -> Option<&'b [u8]>;
}

/// How much waits to be worked on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Waits {
    /// Less than half of what there is room for.
    Little,
    /// At least half of it.
    Half,
    /// There is no room for a second count from now on.
    Full,
}

/// The accumulator of an axis, and the number of bins of its spectrum.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AxisSpectrum<const P: usize, const LEVELS: usize, const BINS: usize>(
    SpectrumAccumulator<P, LEVELS>,
);

impl<const P: usize, const LEVELS: usize, const BINS: usize> SpectrumSums
    for AxisSpectrum<P, LEVELS, BINS>
{
    type Spectrum = Spectrum<BINS>;

    const NEW: Self = Self(SpectrumAccumulator::new());
    const SIZE: (u16, u8) = (P as u16, LEVELS as u8);

    #[inline(always)]
    fn push(&mut self, count: i32) {
        self.0.push(count);
    }

    fn advance(&mut self) -> bool {
        self.0.advance()
    }

    #[inline(always)]
    fn waits(&self) -> Waits {
        match self.0.waiting() as usize {
            waiting if waiting < P / 2 => Waits::Little,
            waiting if waiting < P.saturating_sub(1) => Waits::Half,
            _ => Waits::Full,
        }
    }

    fn gap(&mut self) {
        self.0.gap();
    }

    fn merge(&mut self, other: &Self) {
        self.0.merge(&other.0);
    }

    fn spectrum(&self, scale: Scale) -> Self::Spectrum {
        self.0.spectrum(scale)
    }

    #[cfg(feature = "storage")]
    const LONGEST: usize = SpectrumAccumulator::<P, LEVELS>::LONGEST;

    #[cfg(feature = "storage")]
    fn write(&self, buffer: &mut [u8]) -> Option<usize> {
        self.0.write(buffer)
    }

    #[cfg(feature = "storage")]
    fn read<'b>(&mut self, bytes: &'b [u8]) -> Option<&'b [u8]> {
        self.0.read(bytes)
    }
}

impl SpectrumSums for () {
    type Spectrum = Spectrum<0>;

    const NEW: Self = ();
    const SIZE: (u16, u8) = (0, 0);

    #[inline(always)]
    fn push(&mut self, _: i32) {}

    fn advance(&mut self) -> bool {
        false
    }

    #[inline(always)]
    fn waits(&self) -> Waits {
        Waits::Little
    }

    fn gap(&mut self) {}

    fn merge(&mut self, (): &Self) {}

    fn spectrum(&self, _: Scale) -> Self::Spectrum {
        Spectrum::EMPTY
    }

    #[cfg(feature = "storage")]
    const LONGEST: usize = 0;

    #[cfg(feature = "storage")]
    fn write(&self, _: &mut [u8]) -> Option<usize> {
        Some(0)
    }

    #[cfg(feature = "storage")]
    fn read<'b>(&mut self, bytes: &'b [u8]) -> Option<&'b [u8]> {
        Some(bytes)
    }
}
