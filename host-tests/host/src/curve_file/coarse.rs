//! Whether the noise of a curve is too small for its counts.

use super::AxisCurve;
use allanite::{
    curve::carries_rounding,
    integrity::{Limits, Reason},
};

impl AxisCurve {
    /// Why a curve is not valid whose noise is below half a count, so that the result of a fit follows from the constant offset: the mean
    /// square of the differences of neighbours. This is for curves of which nothing else is known.
    pub(super) fn coarse(&self) -> Option<Reason> {
        let square = self.rate_per_count * self.rate_per_count;
        // A difference of neighbours has twice their Allan variance.
        let first = self.octaves.first().filter(|octave| octave.m == 1)?;
        let per_mille = 1000.0 * 2.0 * first.variance / square;
        let is_coarse = per_mille < f64::from(Limits::DEFAULT.difference_per_mille);
        let octaves = self.octaves.iter();
        let octaves = octaves.map(|octave| (octave.m, octave.differences, octave.variance));
        (is_coarse && !carries_rounding(octaves)).then_some(Reason::Coarse {
            per_mille: per_mille as u16,
        })
    }
}
