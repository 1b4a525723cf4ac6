//! The spectrum of a record, which is stored with the curve.

use super::{
    accumulator::SpectrumAccumulator,
    expected::expected_densities,
    level::UNIT_BITS,
    window::{bins, first_bin, is_possible, sum_of_squares},
};
use crate::{
    curve::Scale,
    error::Error,
    numerics::real::{Real, real},
    theory::effect::{Effect, SampledShape},
};
use heapless::Vec;

/// What an overlapping neighbour adds to the variance of a segment's density, on both sides together: segments that overlap
/// by half are correlated by 1/36 (Welch 1967, for the Hann window).
const OVERLAP: Real = 2.0 / 36.0;

/// One bin of a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Bin {
    /// The number of samples in a block, a power of 8.
    pub block: u32,
    /// The number of periods in a segment, `k`.
    pub index: u32,
    /// The frequency `f = k/(P M τ₀)`, in Hz.
    pub frequency_hz: Real,
    /// The one-sided power spectral density, in rate units squared per hertz.
    pub density: Real,
    /// The number of half-overlapping segments behind the density, or fewer where [filled
    /// gaps](Spectrum::without_bridges) add to its scatter: as many as would scatter so without them.
    pub segments: u32,
    /// The spectral kurtosis of the segments' powers: 1 ± 2/√n for steady Gaussian noise in `n` segments,
    /// less for a line, more for bursts or noise that changes (Nita & Gary 2010, PASP 122, 595, eq. 8).
    pub spectral_kurtosis: Real,
}

impl Bin {
    /// The number of independent segments that would scatter as much. For Gaussian noise, the relative
    /// standard error of the density is one over its root.
    pub fn effective_segments(&self) -> Real {
        self.effective_segments_of(1)
    }

    /// The same for segments from so many stretches without gaps.
    pub(crate) fn effective_segments_of(&self, stretches: u32) -> Real {
        let segments = real(self.segments);
        let first = real(stretches.saturating_sub(1)).min(segments);
        segments / (1.0 + OVERLAP * (segments - first) / segments)
    }
}

/// The power spectral densities of a record, in up to `B` bins. The bins are in the order of their levels,
/// shortest blocks first, and within a level in the order of their frequencies.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Spectrum<const B: usize> {
    rate_hz: Real,
    segment: u32,
    bins: Vec<Bin, B>,
    /// The number of bins of the levels with [`MIN_SEGMENTS`](Self::MIN_SEGMENTS) or more. The sparse ones follow.
    fitted: usize,
}

impl<const B: usize> Spectrum<B> {
    /// The number of segments that a level needs to be fitted. With fewer, the distribution of the
    /// estimates is too far from any that a fit can weight. The number is chosen by hand; no study varies it.
    pub const MIN_SEGMENTS: u32 = 16;

    /// The number of segments that a level needs to be kept. A level with fewer than
    /// [`MIN_SEGMENTS`](Self::MIN_SEGMENTS) is [sparse](Self::sparse): a diagnosis weighs it by the distribution of its
    /// powers, and no fit takes it.
    pub const SPARSE_SEGMENTS: u32 = 3;

    /// A spectrum without bins.
    // All zero, so that it is set where it stays and not moved there.
    pub const EMPTY: Self = Self {
        rate_hz: 0.0,
        segment: 0,
        bins: Vec::new(),
        fitted: 0,
    };

    /// A spectrum from stored bins, of segments of `segment` blocks. Of each bin, `block`, `index`, `density`,
    /// `segments` and `spectral_kurtosis` are taken; its frequency follows.
    ///
    /// # Errors
    /// [`Error::InvalidRate`] if `rate_hz` is not positive and finite, [`Error::InvalidSegment`] if segments
    /// cannot have this length, [`Error::InvalidBin`] if a bin is not possible, [`Error::TooManyBins`] if there
    /// are more than `B`.
    pub fn new(
        rate_hz: Real,
        segment: u32,
        bins: impl IntoIterator<Item = Bin>,
    ) -> Result<Self, Error> {
        Scale::new(1.0, rate_hz)?;
        let length = segment as usize;
        if !is_possible(length) {
            return Err(Error::InvalidSegment { length: segment });
        }
        let mut list: Vec<Bin, B> = Vec::new();
        let mut last = (0, 0);
        for bin in bins {
            let Bin { block, index, .. } = bin;
            let indices = first_bin(length)..length / 2;
            let exists = is_block(block) && indices.contains(&(index as usize));
            let is_number = |x: Real| x.is_finite() && x >= 0.0;
            let measured = bin.segments > 0 && is_number(bin.density);
            if !(exists && measured && is_number(bin.spectral_kurtosis) && (block, index) > last) {
                return Err(Error::InvalidBin { block, index });
            }
            last = (block, index);
            let frequency_hz = frequency(rate_hz, length, block, index);
            if list
                .push(Bin {
                    frequency_hz,
                    ..bin
                })
                .is_err()
            {
                return Err(Error::TooManyBins { capacity: B });
            }
        }
        Ok(Self {
            rate_hz,
            segment,
            fitted: fitted::<B>(&list),
            bins: list,
        })
    }

    /// Samples per second.
    pub const fn rate_hz(&self) -> Real {
        self.rate_hz
    }

    /// The number of blocks in a segment, `P`.
    pub const fn segment(&self) -> u32 {
        self.segment
    }

    /// The bins that are fitted.
    pub fn bins(&self) -> &[Bin] {
        self.bins.get(..self.fitted).unwrap_or_default()
    }

    /// The bins of the levels with too few segments to be fitted, which lie below the others.
    pub fn sparse(&self) -> &[Bin] {
        self.bins.get(self.fitted..).unwrap_or_default()
    }

    /// The bins that are fitted, and the sparse ones.
    pub fn all(&self) -> &[Bin] {
        &self.bins
    }

    /// The fitted bins of each level, shortest blocks first.
    pub fn levels(&self) -> impl Iterator<Item = &[Bin]> {
        levels_of(self.bins())
    }

    /// All bins, to be changed.
    pub(super) fn all_mut(&mut self) -> &mut [Bin] {
        &mut self.bins
    }

    /// Leaves out the levels whose blocks have this number of samples or more.
    pub(crate) fn leave_out_from(&mut self, block: u32) {
        let kept = self.bins.partition_point(|bin| bin.block < block);
        self.bins.truncate(kept);
        self.fitted = self.fitted.min(kept);
    }

    /// Hands the densities that an effect with a coefficient of one is expected to have to `each`, for the fitted bins
    /// and then the sparse ones, in their order.
    pub(crate) fn each_expected(
        &self,
        effect: &dyn Effect,
        parameters: [Real; crate::limits::MAX_PARAMETERS],
        each: &mut dyn FnMut(Real),
    ) {
        expected(self, self.all(), effect, parameters, each);
    }

    /// The densities that an effect with a coefficient of one is expected to have in the fitted bins, in their order,
    /// in rate units squared per hertz and per coefficient squared. `parameters` are those of its shape.
    pub fn expected(
        &self,
        effect: &dyn Effect,
        parameters: [Real; crate::limits::MAX_PARAMETERS],
    ) -> Vec<Real, B> {
        let mut all = Vec::new();
        expected(self, self.bins(), effect, parameters, &mut |density| {
            // There are as many densities as bins.
            let _ = all.push(density);
        });
        all
    }
}

/// The expected densities of some bins of a spectrum.
#[inline(never)]
fn expected<const B: usize>(
    spectrum: &Spectrum<B>,
    bins: &[Bin],
    effect: &dyn Effect,
    parameters: [Real; crate::limits::MAX_PARAMETERS],
    each: &mut dyn FnMut(Real),
) {
    let shape = SampledShape {
        interval_s: 1.0 / spectrum.rate_hz,
        parameters,
    };
    let length = spectrum.segment as usize;
    for level in levels_of(bins) {
        let Some(block) = level.first().map(|bin| bin.block) else {
            continue;
        };
        let mut densities = [0.0; crate::limits::MAX_SEGMENT / 2];
        expected_densities(effect, &shape, length, block, &mut densities);
        for bin in level {
            let place = (bin.index as usize).wrapping_sub(first_bin(length));
            each(densities.get(place).copied().unwrap_or(0.0));
        }
    }
}

/// The number of bins of the levels that are fitted.
fn fitted<const B: usize>(bins: &[Bin]) -> usize {
    let is_enough = |bin: &Bin| bin.segments >= Spectrum::<B>::MIN_SEGMENTS;
    let dense = levels_of(bins).take_while(|level| level.iter().any(is_enough));
    dense.fold(0, |all: usize, level| all.saturating_add(level.len()))
}

/// Bins of several levels, level by level.
pub(crate) fn levels_of(bins: &[Bin]) -> impl Iterator<Item = &[Bin]> {
    let mut rest = bins;
    core::iter::from_fn(move || {
        let block = rest.first()?.block;
        let end = rest.iter().position(|bin| bin.block != block);
        let (level, later) = rest.split_at_checked(end.unwrap_or(rest.len()))?;
        rest = later;
        Some(level)
    })
}
/// Whether blocks can have this number of samples: a power of 8 up to 8^9.
fn is_block(block: u32) -> bool {
    block.is_power_of_two() && block.trailing_zeros().is_multiple_of(3) && block <= 1 << 27
}

/// The frequency of a bin, in Hz.
fn frequency(rate_hz: Real, length: usize, block: u32, index: u32) -> Real {
    real(index) * (rate_hz / (real(length) * real(block)))
}

impl<const P: usize, const LEVELS: usize> SpectrumAccumulator<P, LEVELS> {
    /// The spectrum of the levels with at least [`Spectrum::SPARSE_SEGMENTS`] segments. Only whole levels are
    /// taken, shortest blocks first, as many as the list has room for. A level has `7P/16` bins.
    ///
    /// What still waits for [`advance`](Self::advance) is not in it.
    pub fn spectrum<const B: usize>(&self, scale: Scale) -> Spectrum<B> {
        let mut list: Vec<Bin, B> = Vec::new();
        for (block_bits, level) in self.levels() {
            let segments = level.segments();
            let room = B.saturating_sub(list.len());
            if segments < Spectrum::<B>::SPARSE_SEGMENTS || room < bins(P) {
                break;
            }
            let block = 1_u32.wrapping_shl(block_bits);
            let n = real(segments);
            let unit = scale.rate_per_count() * real(1_u32 << UNIT_BITS);
            let per_power = 2.0 * real(block) / (scale.rate_hz() * sum_of_squares(real(P)));
            for ((power, square), index) in level.sums().zip(first_bin(P) as u32..u32::MAX) {
                let mean = real(power) / n;
                let bin = Bin {
                    block,
                    index,
                    frequency_hz: frequency(scale.rate_hz(), P, block, index),
                    density: per_power * (mean * unit) * unit,
                    segments,
                    spectral_kurtosis: spectral_kurtosis(n, mean, real(square) / n),
                };
                // There is room for the level.
                let _ = list.push(bin);
            }
        }
        Spectrum {
            rate_hz: scale.rate_hz(),
            segment: P as u32,
            fitted: fitted::<B>(&list),
            bins: list,
        }
    }
}

/// `(n+1)/(n−1) (n ΣP²/(ΣP)² − 1)`, and 1 where there is no power.
fn spectral_kurtosis(n: Real, mean: Real, mean_square: Real) -> Real {
    if mean <= 0.0 {
        return 1.0;
    }
    let ratio = (mean_square / mean) / mean;
    ((n + 1.0) / (n - 1.0) * (ratio - 1.0)).max(0.0)
}
