//! The covariance of an Allan curve, computed from its effects.
//!
//! ```text
//! Cov(σ̂²_j, σ̂²_k) = ½ Σ_ℓ N_jk(ℓ) [(c_ℓ + g_ℓ)² − g_ℓ²] / (n_j n_k)
//! ```
//!
//! Here `c_ℓ` is the covariance that the random effects give two differences a lag of `ℓ` apart, `g_ℓ`
//! is the product that the deterministic effects add to it, `N_jk(ℓ)` is the number of pairs of starts
//! that far apart, and `n_j` is the number of differences of octave `j`. The fourth moments follow
//! Isserlis 1918, the Allan variances follow Greenhall 1991. The ends of the record and its gaps limit the
//! pairs. A curve does not keep where its gaps are; the [number of stretches](crate::curve::Point::stretches) that are
//! long enough for an octave follows from the numbers of differences, and the stretches count as equally long.
//!
//! The sum takes every lag near 0 and near `m_k`, where `c` has its kinks. Elsewhere it follows the
//! trapezoidal rule, in steps that grow with the distance from both. It is within 1 % of the full sum
//! for the effects of [`IEEE_952`](crate::effect::IEEE_952).
//!
//! The sum is taken in single precision, and its numbers are in units of the octave's own variance.
//! Weights need no more than six digits, and a core that computes single precision in hardware takes
//! half as long.

mod detailed;
mod pair;
mod products;
mod series;
mod starts;
mod wave;

use crate::{
    curve::{Curve, Point},
    limits::MAX_EFFECTS,
    list::numbered,
    numerics::{
        math,
        real::{Real, consts::PI, real, single},
    },
    theory::{
        lattice::{self, SecondDifferences},
        model::{Model, Term},
    },
};
use detailed::Detailed;
use heapless::Vec;
use nalgebra::SMatrix;
use pair::Pair;
use products::Products;
use wave::{START, TABLES, Turn, Wave, coherent, middle};

/// The number of parts of effects whose detail is summed. An effect for which no place is left is taken at the lags of
/// the lattice alone.
const DETAILED: usize = 3;

/// The number of pairs of octaves that are computed in one go if an effect has detail. Chosen by hand, so that one
/// piece of a diagnosis stays below 2 million instructions (`cargo xtask bench`).
const PAIRS_AT_ONCE: usize = 2;

/// The covariance of a curve's Allan variances, in rate units to the fourth, for a model whose effects
/// have the squared coefficients `squares`. A fit takes its weights from this matrix. Rows and columns
/// beyond the curve's octaves are zero.
pub fn curve_covariance<const K: usize>(
    curve: &Curve<K>,
    model: &Model,
    squares: &[Real],
) -> SMatrix<Real, K, K> {
    let mut matrix = SMatrix::<Real, K, K>::zeros();
    let (points, interval_s) = (curve.points(), curve.interval_s());
    covariance(points, model, squares, interval_s, &mut |k, j, value| {
        matrix[(k, j)] = value;
        matrix[(j, k)] = value;
    });
    matrix
}

/// Computes the covariance of a curve's variances, in rate units to the fourth, for effects with the
/// squared coefficients `squares`. Calls `each(k, j, covariance)` for the lower triangle, `j ≤ k`.
pub(crate) fn covariance(
    points: &[Point],
    model: &Model,
    squares: &[Real],
    interval_s: Real,
    each: &mut dyn FnMut(usize, usize, Real),
) {
    for j in 0..points.len() {
        let mut next = j;
        while next < points.len() {
            let each = &mut |k, value| each(k, j, value);
            next = covariance_row(points, model, squares, interval_s, (j, next), each);
        }
    }
}

/// Computes covariances of octave `j` with itself and with longer octaves, from octave `from ≥ j` on. Calls
/// `each(k, covariance)` for each of them, and returns the octave that comes next: effects with detail take several
/// calls. Calls nothing for an octave that the curve does not have.
#[inline(never)]
pub(crate) fn covariance_row(
    points: &[Point],
    model: &Model,
    squares: &[Real],
    interval_s: Real,
    (j, from): (usize, usize),
    each: &mut dyn FnMut(usize, Real),
) -> usize {
    let longest = points.last().map_or(1, |point| point.m);
    let present = || {
        let terms = model.terms().iter().zip(squares);
        terms.filter(|&(_, &square)| square > 0.0)
    };
    let Some(shorter) = points.get(j) else {
        return points.len();
    };
    let ratio = longest.checked_div(shorter.m).unwrap_or(0);
    let reach = (u64::from(ratio) * 32).min(u64::from(lattice::END)) as u32;
    let m_j = real(shorter.m);
    let mut random = SecondDifferences::zero(shorter.m, reach);
    let is_random = |term: &Term| {
        let shape = term.sampled_shape(interval_s);
        term.effect.response(m_j, &shape).is_none()
    };
    let variances = present()
        .filter(|(term, _)| is_random(term))
        .map(|(term, square)| {
            let shape = term.sampled_shape(interval_s);
            square * term.effect.variance(m_j, &shape)
        });
    let unit = variances.sum::<Real>() * shorter.tau_s * shorter.tau_s;
    let unit = if unit > 0.0 { unit } else { 1.0 };
    let per_unit = 1.0 / unit;
    let mut detailed = Vec::<Detailed, DETAILED>::new();
    for (term, &square) in present().filter(|(term, _)| is_random(term)) {
        let shape = term.sampled_shape(interval_s);
        let left = DETAILED.saturating_sub(detailed.len());
        let tail = term.effect.tail(m_j, &shape);
        if let Some(tail) = tail.filter(|tail| tail.places() <= left) {
            for part in 0..tail.places() {
                let scale = square * per_unit;
                let part = Detailed::of(&tail, part, term.effect, &shape, shorter.m, scale);
                if let Some(part) = part {
                    // There is a place for every part.
                    let _ = detailed.push(part);
                }
            }
        } else {
            let effect = term.effect;
            effect.add_second_differences(m_j, square, &shape, &mut random);
        }
    }
    let random = random.rounded(unit);
    let mut turns = Vec::<Turn, TABLES>::new();
    let mut waves = Vec::<Wave, MAX_EFFECTS>::new();
    for (term, &square) in present() {
        if let Some(short) = term.effect.response(m_j, &term.sampled_shape(interval_s)) {
            let phase = 0.25 * m_j * short.phase;
            // There is a place for every effect of a model.
            let _ = waves.push(Wave {
                term,
                square,
                size: 2.0 * per_unit * square * short.amplitude,
                product: 0.0,
                phase,
                turn: Turn::of(phase, &mut turns),
                now: START,
                scatter: coherent(term, square, shorter, interval_s),
                sample_phase: short.phase,
            });
        }
    }
    let at_once = if detailed.is_empty() {
        points.len()
    } else {
        PAIRS_AT_ONCE
    };
    let next = from.saturating_add(at_once).min(points.len());
    for (k, longer) in numbered(points.iter()).take(next).skip(from) {
        let pair = Pair { shorter, longer };
        // Octaves a factor of 2^18 apart lie beyond the lattice. Their correlation is below 0.002.
        if pair.middle() >= lattice::END / 4 {
            each(k, 0.0);
            continue;
        }
        for wave in &mut waves {
            let shape = wave.term.sampled_shape(interval_s);
            let long = wave.term.effect.response(real(longer.m), &shape);
            wave.product = long.map_or(0.0, |long| single(wave.size * long.amplitude));
            wave.now = START;
        }
        let of_phases = waves.iter().map(|wave| {
            let long = coherent(wave.term, wave.square, longer, interval_s);
            let apart = wave.sample_phase / PI * (middle(longer) - middle(shorter));
            0.5 * wave.scatter * long * math::sincos_of_turns(apart).1
        });
        let of_phases: Real = of_phases.sum();
        let mut own = pair.covariance(&random, &turns, &mut waves);
        if !detailed.is_empty() {
            let products = Products::new(&pair, &random, &detailed);
            own += pair.scaled(2.0 * products.sum(&detailed, &waves), 1, &random);
        }
        each(k, of_phases + own);
    }
    next
}
