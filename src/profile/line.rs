//! The frequency of the strongest line of a spectrum, read from its peak.

use crate::{
    fit::Problem,
    math,
    nnls::Vector,
    real::{Real, real},
    spectrum::Bin,
};

/// The standard errors by which a peak of a longer block must stand out before it corrects the frequency. Chosen by
/// hand: the peak of 28 bins without a line reaches it in one of a million levels.
const STANDS_OUT: Real = 6.0;
/// The distance in bins at which a peak is looked for beside the place where it is expected. The error of a peak that
/// stands out is below a tenth of a bin, which is less than one bin of the next level.
const NEARBY: Real = 1.5;

/// The strongest peak of a spectrum beyond a model.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Peak {
    /// The frequency of a line that makes such a peak, in Hz.
    pub(crate) frequency_hz: Real,
    /// The same without the corrections by longer blocks, in which another line may be at the place of the alias.
    pub(crate) uncorrected_hz: Real,
    /// The frequency of the lowest bin, in Hz.
    pub(crate) lowest_hz: Real,
}

/// The strongest peak beyond a model, taken for a line. `None` if the problem has no spectrum, or nothing of it
/// lies above the model.
///
/// The highest bin and its larger neighbour tell the frequency to a part of a bin: a line `δ` bins from the middle of
/// a bin has the amplitude `r = (1 + δ)/(2 − δ)` in the next one, relative to the first, for Hann's window (Jain,
/// Collins & Davis 1979). Blocks that are longer show the line too, at an alias and smaller, but in bins that are
/// narrower by the ratio of the blocks. They correct the frequency one after the other.
#[inline(never)]
pub(crate) fn strongest_peak<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    squares: &Vector,
) -> Option<Peak> {
    let excess = |at: usize| {
        let row = K.saturating_add(at);
        problem.measured(row) - problem.variance(row, squares)
    };
    let significance = |at: usize, bin: &Bin| {
        let row = K.saturating_add(at);
        excess(at) / problem.variance(row, squares) * math::sqrt(problem.effective_segments(bin))
    };
    let bins = problem.bins;
    let mut strongest: Option<(usize, Real)> = None;
    for (at, bin) in (0..B).zip(bins) {
        let here = significance(at, bin);
        if here > strongest.map_or(0.0, |(_, most)| most) {
            strongest = Some((at, here));
        }
    }
    let (at, _) = strongest?;
    let first = bins.get(at)?;
    // Frequencies are counted in bins of the first level, which is a bin's frequency by its index.
    let bin_hz = |bin: &Bin| bin.frequency_hz / real(bin.index);
    let uncorrected_hz = middle(bins, at, &excess)? * bin_hz(first);
    let mut frequency_hz = uncorrected_hz;
    let segment = real(problem.observed.spectrum()?.segment());
    // The lowest bin of every longer block.
    let mut block = first.block;
    for lowest in bins {
        if lowest.block <= block {
            continue;
        }
        block = lowest.block;
        let place = frequency_hz / bin_hz(lowest);
        let wrapped = place - segment * math::floor(place / segment + 0.5);
        let alias = wrapped.abs();
        let mut peak: Option<(usize, Real)> = None;
        for (at, bin) in (0..B)
            .zip(bins)
            .filter(|(_, bin)| bin.block == lowest.block)
        {
            let here = significance(at, bin);
            let is_near = (real(bin.index) - alias).abs() < NEARBY;
            if is_near && here > peak.map_or(STANDS_OUT, |(_, most)| most) {
                peak = Some((at, here));
            }
        }
        let found = peak.and_then(|(at, _)| middle(bins, at, &excess));
        if let Some(found) = found.filter(|found| (found - alias).abs() < NEARBY) {
            let change = if wrapped < 0.0 {
                alias - found
            } else {
                found - alias
            };
            frequency_hz += change * bin_hz(lowest);
        }
    }
    let frequencies = bins.iter().map(|bin| bin.frequency_hz);
    Some(Peak {
        frequency_hz,
        uncorrected_hz,
        lowest_hz: frequencies.fold(Real::INFINITY, Real::min),
    })
}

/// The place of a line between the bins, from the highest bin and its larger neighbour of the same level.
fn middle(bins: &[Bin], at: usize, excess: &dyn Fn(usize) -> Real) -> Option<Real> {
    let own = bins.get(at)?;
    let size = excess(at);
    let ratio = |beside: Option<usize>| {
        let beside = beside.filter(|&at| bins.get(at).is_some_and(|bin| bin.block == own.block));
        beside.map(|beside| math::sqrt((excess(beside) / size).max(0.0)))
    };
    let (below, above) = (ratio(at.checked_sub(1)), ratio(at.checked_add(1)));
    let shift = |ratio: Real| ((2.0 * ratio - 1.0) / (ratio + 1.0)).clamp(-0.5, 1.0);
    let distance = match (below, above) {
        (Some(below), Some(above)) if below > above => -shift(below),
        (Some(_) | None, Some(above)) => shift(above),
        (Some(below), None) => -shift(below),
        (None, None) => 0.0,
    };
    Some(real(own.index) + distance)
}
