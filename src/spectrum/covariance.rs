//! How the bins of a spectrum scatter together.

use super::density::Bin;
use crate::numerics::{
    math,
    real::{Real, consts::PI},
};

/// The number of bins, from a bin on, with which it is correlated: itself and the next two.
pub const BAND: usize = 3;

/// The correlation of the amplitudes of bins at a distance of 0, 1 and 2, without its sign: that of the window's
/// transform ½, −¼ with itself, relative to ⅜.
const AMPLITUDES: [Real; BAND] = [1.0, 2.0 / 3.0, 1.0 / 6.0];

/// The correlation of the densities of bins at a distance of 0, 1 and 2. Neighbouring segments share half of their
/// samples, so that a bin's amplitude in one segment is correlated with those of all near bins in the next one as well:
/// by ⅙, 4/(9π) and ¹⁄₁₂ at these distances. With the squares of the amplitudes' correlations within a segment and with
/// the two beside it (Welch 1967), the densities' are
///
/// ```text
/// (4/9 + 2·16/(81π²))/(1 + 2/36) = (8/19)(1 + 8/(9π²))   and   (1/36 + 2/144)/(1 + 2/36) = 3/76
/// ```
const DENSITIES: [Real; BAND] = [1.0, 8.0 / 19.0 * (1.0 + 8.0 / (9.0 * PI * PI)), 3.0 / 76.0];

/// The covariance of two bins of a level, relative to the product of their expected densities. Bins of
/// different levels, and those at a distance of [`BAND`] and more, do not scatter together.
///
/// `shares` are those that deterministic effects, such as a sinusoid, have in the two expected densities.
/// With the random part `c`, the deterministic part `g`, the correlation `a = 1, ⅔, ⅙` of the amplitudes and that of the
/// random densities, `ρ = 1, 0.459, 0.039`,
///
/// ```text
/// Cov(P_k, P_k') = [ρ c c' + 2 a √(c c' g g')] / n_eff
/// ```
///
/// which is `[(c+g)² − g²]/n_eff` for one bin. The amplitudes are taken to be in phase, as they are within the main lobe
/// of a line. The matrix is positive definite for any shares below 1, and banded.
///
/// The number of effective segments is that of the random part. Where a line beats against noise, it is 0.71 to
/// 1.4 times as many, depending on the place of the line between two bins.
pub fn relative_covariance(distance: usize, effective_segments: Real, shares: [Real; 2]) -> Real {
    let (Some(amplitude), Some(density)) = (AMPLITUDES.get(distance), DENSITIES.get(distance))
    else {
        return 0.0;
    };
    let [share, other] = shares;
    let (random, both) = ((1.0 - share) * (1.0 - other), share * other);
    let beat = if both > 0.0 {
        2.0 * amplitude * math::sqrt((random * both).max(0.0))
    } else {
        0.0
    };
    (density * random + beat) / effective_segments
}

/// The upper band of the covariance of all bins, relative to their expected densities: for each bin, its
/// variance and its covariance with the next bins, up to [`BAND`]` − 1` of them. `shares` are those of
/// deterministic effects in the bins, in their order; bins beyond their end have none.
///
/// [`Spectrum::bins`](super::Spectrum::bins) gives the bins.
pub fn covariance_rows<'a>(
    bins: &'a [Bin],
    shares: &'a [Real],
) -> impl Iterator<Item = [Real; BAND]> + 'a {
    let share = |place: usize| shares.get(place).copied().unwrap_or(0.0);
    (0..bins.len()).map(move |place| {
        let mut row = [0.0; BAND];
        let own = bins.get(place);
        for (covariance, later) in row.iter_mut().zip(place..usize::MAX) {
            if let (Some(own), Some(other)) = (own, bins.get(later))
                && own.block == other.block
            {
                let distance = other.index.wrapping_sub(own.index) as usize;
                let shares = [share(place), share(later)];
                *covariance = relative_covariance(distance, own.effective_segments(), shares);
            }
        }
        row
    })
}
