//! The densities that an effect is expected to have.

use super::{
    line::Line,
    window::{Products, cosine, first_bin, is_possible, places, sum_of_squares},
};
use crate::{
    limits::MAX_SEGMENT,
    list::numbered,
    numerics::real::{Real, real},
    theory::effect::{Effect, SampledShape},
};

/// Writes the expected densities of an effect with a coefficient of one, for segments of `length` blocks of
/// `block` samples: in rate units squared per hertz and per coefficient squared, for the bins `k = P/16 … P/2 − 1`,
/// in this order. Further places of `densities` stay as they are. If the length is not a power of two from 32 to
/// [`MAX_SEGMENT`], nothing is written.
///
/// Aliases by the block means and leakage of the window are included. With the semivariogram `γ` of the block
/// means, which is that of the [effect](Effect::variogram), and the products `c(l) = Σ_j w_j w_{j+l}`,
///
/// ```text
/// E P_k = −(4Mτ₀/Σw²) Σ_{l=1}^{P−1} γ(l) c(l) cos(2πkl/P)
/// ```
///
/// This is Welch's (1967) expectation with the autocovariance `r(0) − γ(l)`, of which the window ignores the
/// constant. It exists therefore for effects without an autocovariance too. Deterministic effects have a closed
/// form, averaged over the phase of a sinusoid.
pub fn expected_densities(
    effect: &dyn Effect,
    shape: &SampledShape,
    length: usize,
    block: u32,
    densities: &mut [Real],
) {
    densities_from(first_bin(length), effect, shape, length, block, densities);
}

/// Does the same for the bins `k = first … P/2 − 1`, where `first` is 2 or more.
#[inline(never)]
pub(super) fn densities_from(
    first: usize,
    effect: &dyn Effect,
    shape: &SampledShape,
    length: usize,
    block: u32,
    densities: &mut [Real],
) {
    if !is_possible(length) {
        return;
    }
    let per_block = real(block) * shape.interval_s;
    let bins = first..length / 2;
    if let Some(response) = effect.response(1.0, shape) {
        let line = Line::new(response, shape.interval_s, length, block);
        for (density, k) in densities.iter_mut().zip(bins) {
            *density = per_block * line.density(k);
        }
        return;
    }

    let folded = folded(effect, shape, length, block);
    let scale = -4.0 * per_block / sum_of_squares(real(length));
    let mut set = |k: usize, sum: Real| {
        let place = k.wrapping_sub(first);
        if k < length / 2
            && let Some(density) = densities.get_mut(place)
        {
            *density = scale * sum;
        }
    };
    // The cosines of the bins k and P/2 − k agree at even distances, and have opposite signs at odd ones.
    let (pairs, _) = folded.as_chunks::<2>();
    // One period, so that the sums below look up no symmetries.
    let mut wave = [0.0; MAX_SEGMENT];
    for (i, value) in numbered(wave.iter_mut()).take(length) {
        *value = cosine(i.wrapping_mul(places(length)));
    }
    let within = length.wrapping_sub(1);
    for k in 1..=length / 4 {
        let (mut even, mut odd) = (0.0, 0.0);
        let mut place = 0_usize;
        for [at_even, at_odd] in pairs.iter().take(length / 4 + 1) {
            let near = |place: usize| wave.get(place & within).copied().unwrap_or(0.0);
            even += at_even * near(place);
            odd += at_odd * near(place.wrapping_add(k));
            place = place.wrapping_add(k.wrapping_mul(2));
        }
        set(k, even + odd);
        set((length / 2).wrapping_sub(k), even - odd);
    }
}

/// The number of distances from 0 to half the longest segment, and one for an even number.
const DISTANCES: usize = MAX_SEGMENT / 2 + 2;

/// The terms `γ(l) c(l)` at the distances `l` and `P − l`, which have the same cosine, added up. It is less by a
/// constant times `c(l)`, which the window ignores, so that the terms are small.
fn folded(
    effect: &dyn Effect,
    shape: &SampledShape,
    length: usize,
    block: u32,
) -> [Real; DISTANCES] {
    let mut values = [0.0; MAX_SEGMENT];
    let (_, distant) = values.split_at_mut(1);
    if let Some(distant) = distant.get_mut(..length.saturating_sub(1)) {
        effect.variogram(real(block), shape, distant);
    }
    let middle = values.get(length / 8).copied().unwrap_or(0.0);
    let products = Products::new(length);
    let mut folded = [0.0; DISTANCES];
    for (l, value) in numbered(values).take(length) {
        let term = (value - middle) * products.at(l);
        // The distance 0 appears once, every other one on both sides.
        let term = if l == 0 { 0.5 * term } else { term };
        let nearest = l.min(length.saturating_sub(l));
        if let Some(folded) = folded.get_mut(nearest) {
            *folded += term;
        }
    }
    folded
}
