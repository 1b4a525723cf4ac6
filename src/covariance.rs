//! The covariance of an Allan curve, from its effects.
//!
//! ```text
//! Cov(σ̂²_j, σ̂²_k) = ½ Σ_ℓ N_jk(ℓ) [(c_ℓ + g_ℓ)² − g_ℓ²] / (n_j n_k)
//! ```
//!
//! `c` is the covariance of two differences that lie `ℓ` apart as the random effects make it, `g`
//! the product of what the deterministic ones put there, `N_jk(ℓ)` the number of pairs of starts
//! so far apart (Isserlis 1918 for the fourth moments; Greenhall 1991 for Allan variances).
//! Only octaves' own ends limit the pairs: gaps inside a record are not known to a curve, and the
//! smaller numbers of differences that they leave stand in for them.
//!
//! The sum runs over every lag near 0 and near `m_k`, where `c` has its kinks, and by the
//! trapezoidal rule over lags in steps that grow with the distance from both: within 1 % of the
//! full sum for the effects of [`IEEE_952`](crate::effect::IEEE_952).

use crate::{
    curve::{Curve, Point},
    lattice::{self, SecondDifferences},
    math,
    model::{MAX_EFFECTS, Model},
};
use heapless::Vec;
use nalgebra::SMatrix;

/// Lags kept one by one on either side of a kink, in quarters of the shorter cluster.
const NEAR: u32 = 8;

/// The outward tail of the sum ends where two lags in turn add less than this share.
const NEGLIGIBLE: f64 = 1e-4;

/// The covariance of a curve's Allan variances, in rate units to the fourth, where a model's
/// effects have the squared coefficients `squares`: what the fit weights with. Rows and columns
/// beyond the curve's octaves are zero.
pub fn curve_covariance<const K: usize>(
    curve: &Curve<K>,
    model: &Model,
    squares: &[f64],
) -> SMatrix<f64, K, K> {
    covariance(curve.points(), model, squares, curve.interval_s())
}

/// The covariance of a curve's variances, in rate units to the fourth, where the effects have the
/// squared coefficients `squares`. Rows and columns beyond the curve's octaves are zero.
pub(crate) fn covariance<const K: usize>(
    points: &[Point],
    model: &Model,
    squares: &[f64],
    interval_s: f64,
) -> SMatrix<f64, K, K> {
    let mut matrix = SMatrix::zeros();
    let longest = points.last().map_or(1, |point| point.m);
    let present = || {
        let terms = model.terms().iter().zip(squares);
        terms.filter(|&(_, &square)| square > 0.0)
    };
    for (j, shorter) in points.iter().enumerate().take(K) {
        let reach = (u64::from(longest / shorter.m) * 32).min(u64::from(lattice::END)) as u32;
        let m_j = f64::from(shorter.m);
        let mut random = SecondDifferences::zero(shorter.m, reach);
        for (term, &square) in present() {
            let setting = term.setting(interval_s);
            if term.effect.response(m_j, &setting).is_none() {
                term.effect
                    .add_second_differences(m_j, square, &setting, &mut random);
            }
        }
        for (k, longer) in points.iter().enumerate().take(K).skip(j) {
            let pair = Pair { shorter, longer };
            // Beyond the lattice, octaves a factor of 2^18 apart: correlations below 0.002.
            if pair.middle() >= lattice::END / 4 {
                break;
            }
            let mut waves = Vec::<Wave, MAX_EFFECTS>::new();
            for (term, &square) in present() {
                let setting = term.setting(interval_s);
                let response = |m: u32| term.effect.response(f64::from(m), &setting);
                if let (Some(short), Some(long)) = (response(shorter.m), response(longer.m)) {
                    // As many as effects: there is always room.
                    let _ = waves.push(Wave {
                        product: square * short.amplitude * long.amplitude,
                        phase: 0.25 * m_j * short.phase,
                    });
                }
            }
            let value = pair.covariance(&random, &waves);
            matrix[(j, k)] = value;
            matrix[(k, j)] = value;
        }
    }
    matrix
}

/// What a deterministic effect puts into the product of two differences: `product · cos(phase · ℓ)`
/// at a lag of `ℓ` quarters of the shorter cluster.
struct Wave {
    product: f64,
    phase: f64,
}

impl Wave {
    fn at(&self, lag: u32) -> f64 {
        if self.phase == 0.0 {
            return self.product;
        }
        self.product * math::cos(self.phase * f64::from(lag))
    }
}

/// Two octaves of a curve.
struct Pair<'a> {
    shorter: &'a Point,
    longer: &'a Point,
}

impl Pair<'_> {
    /// The longer cluster in quarters of the shorter: the lag of the outer kinks.
    fn middle(&self) -> u32 {
        (self.longer.m / self.shorter.m).saturating_mul(4)
    }

    fn covariance(&self, differences: &SecondDifferences, waves: &[Wave]) -> f64 {
        let middle = self.middle();
        let stride = lattice::stride(self.shorter.m);
        let (mut sum, mut quiet) = (0.0, 0);
        let (mut lag, mut step_before) = (0, 0);
        loop {
            let step = step_after(lag, middle, stride);
            let pairs = self.pairs(lag);
            let random = differences.at(lag.abs_diff(middle)) - 2.0 * differences.at(lag)
                + differences.at(lag + middle);
            // Half the steps to either side, in strides; both signs of the lag are in `pairs`.
            let weight = 0.5 * f64::from(step_before + step) * pairs;
            let deterministic: f64 = waves.iter().map(|wave| wave.at(lag)).sum();
            let term = weight * random * (random + 2.0 * deterministic);
            sum += term;
            quiet = if term.abs() <= NEGLIGIBLE * sum.abs() {
                quiet + 1
            } else {
                0
            };
            lag += step;
            step_before = step;
            let far = lag > middle + NEAR && quiet >= 2;
            if far || pairs == 0.0 || lag >= lattice::END / 2 {
                break;
            }
        }
        let tau = self.shorter.tau_s * self.longer.tau_s;
        let counts = self.shorter.differences as f64 * self.longer.differences as f64;
        0.5 * sum / (f64::from(stride) * counts * tau * tau)
    }

    /// How many pairs of starts have their differences' middles so far apart, either way round.
    fn pairs(&self, lag: u32) -> f64 {
        let (m_j, m_k) = (u64::from(self.shorter.m), u64::from(self.longer.m));
        let (h_j, h_k) = (advance(m_j), advance(m_k));
        let (n_j, n_k) = (self.shorter.differences, self.longer.differences);
        let distance = u64::from(lag) * m_j / 4;
        // Starts of the longer difference, less those whose partner would lie before the record …
        let before = distance.saturating_sub(m_k - m_j).div_ceil(h_k).min(n_k);
        // … or after its end.
        let last = n_j.saturating_sub(1).saturating_mul(h_j);
        let after = match last.checked_sub(distance + (m_k - m_j)) {
            Some(room) => (room / h_k + 1).min(n_k),
            None => 0,
        };
        (n_k - before + after) as f64
    }
}

/// Samples from one start to the next.
fn advance(m: u64) -> u64 {
    (m / 4).max(1)
}

/// The next lag of the sum: by strides near 0 and near the middle, then by half the distance's
/// power of two.
fn step_after(lag: u32, middle: u32, stride: u32) -> u32 {
    let away = |distance: u32| {
        if distance < NEAR {
            stride
        } else {
            1 << (distance.ilog2() - 1)
        }
    };
    if middle <= 2 * NEAR && lag < middle {
        return stride;
    }
    if lag >= middle {
        return away(lag - middle);
    }
    if lag < middle / 2 {
        return away(lag);
    }
    let towards = middle - lag;
    if towards <= NEAR {
        stride
    } else {
        1 << ((towards - 1).ilog2() - 1)
    }
}
