//! Records of few rows that are too coarse for their noise.

use super::{OCTAVES, disturbed::Extremes};
use allanite::{
    Accumulator,
    integrity::{Limits, Reason},
};

/// The differences from which few rows are judged, and those from which the library judges every record.
const JUDGED: std::ops::Range<u64> = 256..1000;

/// Why the counts of a record of few rows are too coarse for their noise; `None` if they are not, or if rows are too many or
/// too few.
///
/// Two neighbouring values are all that there is: of white noise of half a count, wherever its mean lies, at least 4 % of the
/// samples have another value, and 256 samples are without one in a record of 10⁵. Or the mean square of the differences is
/// below half of the limit that holds for many rows, from which it is then six standard errors away.
pub(super) fn coarse(sums: &Accumulator<OCTAVES>, extremes: &Extremes) -> Option<Reason> {
    let octave = sums.octave(0)?;
    if !JUDGED.contains(&octave.differences) {
        return None;
    }
    let per_mille = 1000.0 * octave.sum.to_real() / octave.differences as f64;
    let limit = f64::from(Limits::DEFAULT.difference_per_mille);
    let is_coarse = extremes.span() == 1 || per_mille < 0.5 * limit;
    is_coarse.then_some(Reason::Coarse {
        per_mille: per_mille as u16,
    })
}
