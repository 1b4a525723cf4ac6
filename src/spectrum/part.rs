//! The spectrum of an axis as a part of [`Axes`](crate::Axes).

use super::{Spectrum, SpectrumAccumulator};
use crate::{
    curve::Scale,
    record::{
        axis::spectra::{SpectrumPart, SpectrumSums, Waits},
        octave::Accumulator,
    },
};
use core::fmt::Debug;

/// Keeps a spectrum of every axis: `S` of [`Axes`](crate::Axes). The parameters are those of the
/// [`SpectrumAccumulator`], and the number of bins that the evidence has room for: `7P/16` for each level.
///
/// Level 4 of 64 blocks, which is the fifth, has its 16 segments after 2.2 million samples. So 140 bins lose
/// nothing of a record of up to 17 million samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spectral<const P: usize = 64, const LEVELS: usize = 7, const BINS: usize = 140>;

/// Reads the spectrum that is kept of an axis: [`Spectral`], or `()` for none.
pub trait SpectrumReading: SpectrumPart {
    /// The spectrum of an axis: a [`Spectrum`], which has no bins if none is kept.
    type Spectrum: Clone + Debug + PartialEq;

    /// The spectrum at this moment, of the same samples as the curve.
    #[doc(hidden)]
    fn spectrum<const OCTAVES: usize>(
        sums: &Self::Sums,
        beside: &Accumulator<OCTAVES>,
        scale: Scale,
    ) -> Self::Spectrum;
}

impl<const P: usize, const LEVELS: usize, const BINS: usize> SpectrumReading
    for Spectral<P, LEVELS, BINS>
{
    type Spectrum = Spectrum<BINS>;

    fn spectrum<const OCTAVES: usize>(
        sums: &Self::Sums,
        beside: &Accumulator<OCTAVES>,
        scale: Scale,
    ) -> Self::Spectrum {
        let spectrum = sums.0.spectrum(scale);
        spectrum.without_bridges(beside.bridged(), beside.samples())
    }
}

impl SpectrumReading for () {
    type Spectrum = Spectrum<0>;

    fn spectrum<const OCTAVES: usize>(
        (): &Self::Sums,
        _: &Accumulator<OCTAVES>,
        _: Scale,
    ) -> Self::Spectrum {
        Spectrum::EMPTY
    }
}

impl<const P: usize, const LEVELS: usize, const BINS: usize> SpectrumPart
    for Spectral<P, LEVELS, BINS>
{
    type Sums = AxisSpectrum<P, LEVELS, BINS>;
}

/// The accumulator of an axis, and the number of bins of its spectrum.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AxisSpectrum<const P: usize, const LEVELS: usize, const BINS: usize>(
    SpectrumAccumulator<P, LEVELS>,
);

impl<const P: usize, const LEVELS: usize, const BINS: usize> SpectrumSums
    for AxisSpectrum<P, LEVELS, BINS>
{
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
