//! The spectrum among the sums of an axis. A type may leave it out: then it takes no memory, no flash and no
//! time.

use core::fmt::Debug;

/// What can stand for `S` of [`Axes`](super::Axes): [`Spectral`](crate::spectrum::Spectral), or `()` for none.
pub trait SpectrumPart: Clone + Debug + PartialEq + Eq {
    /// The sums of one axis.
    #[doc(hidden)]
    type Sums: SpectrumSums;
}

impl SpectrumPart for () {
    type Sums = ();
}

/// The spectrum's sums of one axis, or nothing.
pub trait SpectrumSums: Clone + Debug + PartialEq + Eq {
    /// Nothing summed yet.
    const NEW: Self;

    /// The number of blocks of a segment and the number of levels; zeros if no sums are kept.
    const SIZE: (u16, u8);

    /// Adds a count.
    fn push(&mut self, count: i32);

    /// Does a part of the pending work, and returns whether there is more.
    fn advance(&mut self) -> bool;

    /// Whether half of the room, or all of it, is taken by counts that wait to be worked on.
    fn waits(&self) -> Waits;

    /// No segment spans this place.
    fn gap(&mut self);

    /// Adds the sums of another record.
    fn merge(&mut self, other: &Self);

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

impl SpectrumSums for () {
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
