//! The factor `c` of the variance of a slope, from the Allan variances of the noise and of the covariate.

use crate::{
    list::numbered,
    numerics::{
        math,
        real::{
            Real,
            consts::{LN_2, PI},
            real,
        },
    },
};
use heapless::Vec;

/// What a frequency per octave tells about the slope. It is the frequency with `πfτ = 1`, which is close to the
/// maximum of the octave's response.
struct Octave {
    m: Real,
    /// The Allan variance of the noise.
    noise: Real,
    /// The spectral density of the noise at the frequency, in units of `σ²τ₀`.
    density: Real,
    /// The share of the covariate's variance that lies at the frequency.
    covariate: Real,
}

/// The margin on the factor, because the noise is itself estimated, and because a covariate that changes more slowly
/// than the longest octave scatters up to 1.4 times as much as its octaves tell. The test of
/// `host-tests/tests/library/covariate.rs` with 2000 records a case set it: without it, 11 of 8000 records of a random walk
/// blame an unrelated warm-up where 4 are due, and 93 % of the intervals cover the slope; with it, 4 do, and 96 %
/// cover.
const MARGIN: Real = 1.25;

/// The factor `c` for a covariate that counts from the octave `first` on. `points` are the averaging factor and the
/// Allan variance of the covariate in every octave, and `noise(k)` is the Allan variance of the noise in octave `k`.
pub(super) fn factor<const K: usize>(
    points: impl ExactSizeIterator<Item = (u32, Real)>,
    first: usize,
    noise: &dyn Fn(usize) -> Real,
) -> Real {
    let last = points.len().saturating_sub(1);
    let mut octaves = Vec::<Octave, K>::new();
    for (k, (m, covariate)) in numbered(points).skip(first) {
        // There is room for every octave.
        let _ = octaves.push(Octave {
            m: real(m),
            noise: noise(k),
            density: noise(k) * real(m) * density(k, last, noise),
            covariate,
        });
    }
    // A longer octave is the first to see a slow change of the covariate. What it leaves of a shorter octave's
    // variance lies at higher frequencies.
    let mut left = octaves.as_mut_slice();
    while let [rest @ .., longest] = left {
        for shorter in &mut *rest {
            let seen = response(shorter.m / longest.m) / response(1.0);
            shorter.covariate = (shorter.covariate - longest.covariate * seen).max(0.0);
        }
        left = rest;
    }
    let (mut sum, mut information) = (0.0, 0.0);
    for at in &octaves {
        let weights = octaves
            .iter()
            .map(|k| response(k.m / at.m) / (k.m * k.noise));
        let weight = weights.sum::<Real>();
        sum += at.covariate * weight * (weight * at.density);
        information += at.covariate * weight;
    }
    if information > 0.0 {
        MARGIN * sum / information
    } else {
        WHITE
    }
}

/// The factor for white noise.
const WHITE: Real = 2.0;

/// The response `|H|² = 2 sin⁴u/u²` of an octave to a frequency.
fn response(u: Real) -> Real {
    let sine = math::sincos_of_turns(u / (2.0 * PI)).0;
    let square = sine * sine;
    2.0 * square * square / (u * u)
}

/// The spectral density of the noise at `πfτ = 1`, in units of `σ²τ`, for octave `k` of `0 … last`. It is 1 for white
/// noise, `π/(4 ln 2)` for flicker noise and `3/4` for a random walk. The slope of the curve shows the mixture, and
/// the density goes with it along a parabola. Noise that falls faster than white noise is taken for white.
fn density(k: usize, last: usize, noise: &dyn Fn(usize) -> Real) -> Real {
    let (before, after) = (k.saturating_sub(1), k.saturating_add(1).min(last));
    let octaves = after.saturating_sub(before) as Real;
    let slope = math::log(noise(after) / noise(before)) / (LN_2 * octaves.max(1.0));
    let x = (slope + 1.0).clamp(0.0, 2.0);
    let flicker = PI / (4.0 * LN_2);
    0.5 * (1.0 - x) * (2.0 - x) + flicker * x * (2.0 - x) + 0.375 * x * (x - 1.0)
}
