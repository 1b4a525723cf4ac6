//! The exact sums of a record as numbers: the seam between integers and floats.

use crate::{
    numerics::real::{Real, real},
    record::{course::Sums, cross_sums::ProductSum, square_sum::SquareSum},
};

/// 2^64
pub(crate) const LIMB: Real = 18_446_744_073_709_551_616.0;

impl SquareSum {
    /// The sum, rounded to within one unit in the last place.
    pub fn to_real(&self) -> Real {
        let [low, middle, high] = self.limbs();
        (high as Real * LIMB + middle as Real) * LIMB + low as Real
    }
}

impl ProductSum {
    /// The sum, rounded.
    pub(crate) fn to_real(self) -> Real {
        let (low, upper) = self.parts();
        upper as Real * LIMB + low as Real
    }
}

impl<const COVARIATES: usize> Sums<COVARIATES> {
    /// The sum of squared differences, rounded.
    pub(crate) fn squares_real(&self) -> Real {
        let squares = self.squares();
        real((squares >> 64) as u32) * LIMB + squares as u64 as Real
    }
}
