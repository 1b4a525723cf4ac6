//! Random numbers for tests: every seed gives the same sequence on every machine.

use crate::numerics::real::{Real, real};

/// A generator of the xorshift64* kind (Vigna 2016).
pub(crate) struct Random(u64);

impl Random {
    /// A generator whose sequence depends on the seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// The next 32 random bits.
    pub(crate) fn bits(&mut self) -> u32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 32) as u32
    }

    /// A random integer from 0 to below `end`.
    pub(crate) fn below(&mut self, end: usize) -> usize {
        self.bits() as usize % end
    }

    /// A random number between −1 and 1. Both precisions give the same one, except for rounding.
    pub(crate) fn signed(&mut self) -> f64 {
        f64::from(self.bits()) / f64::from(1_u32 << 31) - 1.0
    }

    /// The same number in the precision of the library.
    pub(crate) fn real(&mut self) -> Real {
        real(self.signed())
    }
}
