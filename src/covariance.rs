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
//!
//! It is taken in single precision, of numbers in units of the octave's own variance: weights need no
//! more than six digits, and a core whose arithmetic is in single precision spends half as long.

use crate::{
    curve::{Curve, Point},
    lattice::{self, Rounded, SecondDifferences},
    limits::MAX_EFFECTS,
    list::numbered,
    math::{self, floor_log2},
    model::{Model, Term},
    real::{Real, consts::PI, real, single},
};
use heapless::Vec;
use nalgebra::{Complex, SMatrix};

/// Kinks lie within a cluster, four quarters, of 0 and of the middle: lags up to here are taken one by
/// one, in quarters of the shorter cluster …
const KINK: u32 = 6;
/// … up to here by two, and beyond in steps of the distance's power of two …
const NEAR: u32 = 8;
/// … or of half of that between octaves less far apart than this.
const FAR: u32 = 256;

/// The outward tail of the sum ends where two lags in turn add less than this share.
const NEGLIGIBLE: f32 = 1e-4;

/// The covariance of a curve's Allan variances, in rate units to the fourth, where a model's
/// effects have the squared coefficients `squares`: what the fit weights with. Rows and columns
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

/// The covariance of a curve's variances, in rate units to the fourth, where the effects have the
/// squared coefficients `squares`: `each(k, j, covariance)` for the lower triangle, `j ≤ k`.
pub(crate) fn covariance(
    points: &[Point],
    model: &Model,
    squares: &[Real],
    interval_s: Real,
    each: &mut dyn FnMut(usize, usize, Real),
) {
    for j in 0..points.len() {
        covariance_row(points, model, squares, interval_s, j, &mut |k, value| {
            each(k, j, value);
        });
    }
}

/// The covariance of octave `j` with itself and with all longer ones: `each(k, covariance)` for
/// `k ≥ j`. Nothing for an octave that the curve does not have.
#[inline(never)]
pub(crate) fn covariance_row(
    points: &[Point],
    model: &Model,
    squares: &[Real],
    interval_s: Real,
    j: usize,
    each: &mut dyn FnMut(usize, Real),
) {
    let longest = points.last().map_or(1, |point| point.m);
    let present = || {
        let terms = model.terms().iter().zip(squares);
        terms.filter(|&(_, &square)| square > 0.0)
    };
    let Some(shorter) = points.get(j) else {
        return;
    };
    let ratio = longest.checked_div(shorter.m).unwrap_or(0);
    let reach = (u64::from(ratio) * 32).min(u64::from(lattice::END)) as u32;
    let m_j = real(shorter.m);
    let mut random = SecondDifferences::zero(shorter.m, reach);
    for (term, &square) in present() {
        let shape = term.sampled_shape(interval_s);
        if term.effect.response(m_j, &shape).is_none() {
            term.effect
                .add_second_differences(m_j, square, &shape, &mut random);
        }
    }
    let random = random.rounded();
    let per_unit = 2.0 / random.unit();
    let mut turns = Vec::<Turn, TABLES>::new();
    let mut waves = Vec::<Wave, MAX_EFFECTS>::new();
    for (term, &square) in present() {
        if let Some(short) = term.effect.response(m_j, &term.sampled_shape(interval_s)) {
            let phase = 0.25 * m_j * short.phase;
            // As many as effects: there is always room.
            let _ = waves.push(Wave {
                term,
                size: per_unit * square * short.amplitude,
                product: 0.0,
                phase,
                turn: Turn::of(phase, &mut turns),
                now: START,
            });
        }
    }
    for (k, longer) in numbered(points.iter()).skip(j) {
        let pair = Pair { shorter, longer };
        // Beyond the lattice, octaves a factor of 2^18 apart: correlations below 0.002.
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
        each(k, pair.covariance(&random, &turns, &mut waves));
    }
}

/// Twice what a deterministic effect puts into the product of two differences: `product · cos(phase · ℓ)`
/// at a lag of `ℓ` quarters of the shorter cluster.
struct Wave<'a> {
    term: &'a Term,
    /// All of the product but what the longer octave brings.
    size: Real,
    product: f32,
    phase: Real,
    turn: Option<usize>,
    /// `e^(i · phase · ℓ)`.
    now: Complex<f32>,
}

impl Wave<'_> {
    fn value(&self) -> f32 {
        self.product * self.now.re
    }

    /// Goes from one lag to another, a power of two further.
    fn advance(&mut self, lag: u32, step: u32, turns: &[Turn]) {
        if self.phase == 0.0 {
            return;
        }
        let turn = self
            .turn
            .and_then(|turn| turns.get(turn)?.steps.get(floor_log2(step) as usize));
        self.now = match turn {
            Some(turn) => self.now * turn,
            None => {
                let turns = self.phase / (2.0 * PI) * (real(lag) + real(step));
                Complex::new(single(math::sincos_of_turns(turns).1), 0.0)
            }
        };
    }
}

const START: Complex<f32> = Complex::new(1.0, 0.0);

/// Oscillations of a model whose turns are tabled; those beyond take a cosine a lag.
const TABLES: usize = 2;

/// `e^(i · phase · 2^k)`, by squaring: a lattice of cosines for one exponential.
struct Turn {
    phase: Real,
    steps: [Complex<f32>; (lattice::END / 2).ilog2() as usize],
}

impl Turn {
    /// The place of a phase's turns among those that are known, or where they come to be. `None` where
    /// there is no room.
    fn of(phase: Real, known: &mut Vec<Self, TABLES>) -> Option<usize> {
        if let Some(at) = known.iter().position(|turn| turn.phase == phase) {
            return Some(at);
        }
        let (sine, cosine) = math::sincos_of_turns(phase / (2.0 * PI));
        let mut turn = Complex::new(cosine, sine);
        let steps = core::array::from_fn(|_| {
            let here = Complex::new(single(turn.re), single(turn.im));
            turn *= turn;
            here
        });
        known.push(Self { phase, steps }).ok()?;
        known.len().checked_sub(1)
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
        let ratio = self.longer.m.checked_div(self.shorter.m).unwrap_or(0);
        ratio.saturating_mul(4)
    }

    fn covariance(&self, differences: &Rounded, turns: &[Turn], waves: &mut [Wave<'_>]) -> Real {
        let middle = self.middle();
        let stride = lattice::stride(self.shorter.m);
        let starts = Starts::new(self.shorter, self.longer);
        let outer = middle.saturating_add(NEAR);
        let (mut sum, mut quiet) = (0.0_f32, 0_u32);
        let (mut lag, mut step_before) = (0_u32, 0);
        loop {
            let step = step_after(lag, middle, stride);
            let pairs = starts.pairs(lag);
            let here = differences.at(lag);
            let random = differences.at(lag.abs_diff(middle)) - (here + here)
                + differences.at(lag.saturating_add(middle));
            if random != 0.0 {
                // Half the steps to either side, in strides; both signs of the lag are in `pairs`.
                let weight =
                    (u64::from(step_before) + u64::from(step)).saturating_mul(pairs) as f32;
                let mut factor = random;
                for wave in &*waves {
                    factor += wave.value();
                }
                let term = weight * (random * factor);
                sum += term;
                let counts = lag <= outer || term.abs() > NEGLIGIBLE * sum.abs();
                quiet = if counts { 0 } else { quiet.saturating_add(1) };
            } else {
                quiet = quiet.saturating_add(1);
            }
            for wave in &mut *waves {
                wave.advance(lag, step, turns);
            }
            lag = lag.saturating_add(step);
            step_before = step;
            let far = lag > outer && quiet >= 2;
            if far || pairs == 0 || lag >= lattice::END / 2 {
                break;
            }
        }
        let counts = self.shorter.differences as Real * self.longer.differences as Real;
        // Of single precision's range, the square of τ² would take too much.
        let unit = differences.unit() / (self.shorter.tau_s * self.longer.tau_s);
        0.25 * real(sum) * (unit * unit) / (real(stride) * counts)
    }
}

/// Where the differences of two octaves start.
struct Starts {
    /// Samples between the starts of the longer, as a power of two.
    advance_bits: u32,
    /// Quarters of the shorter cluster to samples: a power of two, and two less.
    quarter_bits: u32,
    /// Room on either side of the shorter difference inside the longer, in samples.
    inside: u64,
    /// The last start of the shorter.
    last: u64,
    /// Starts of the longer.
    count: u64,
}

impl Starts {
    fn new(shorter: &Point, longer: &Point) -> Self {
        Self {
            advance_bits: floor_log2(advance(longer.m)),
            quarter_bits: floor_log2(shorter.m),
            inside: u64::from(longer.m.saturating_sub(shorter.m)),
            last: shorter
                .differences
                .saturating_sub(1)
                .wrapping_shl(floor_log2(advance(shorter.m))),
            count: longer.differences,
        }
    }

    /// How many pairs of starts have their differences' middles `lag` quarters of the shorter
    /// cluster apart, either way round.
    fn pairs(&self, lag: u32) -> u64 {
        let distance = u64::from(lag).wrapping_shl(self.quarter_bits) >> 2;
        // Starts of the longer difference, less those whose partner would lie before the record …
        let outside = distance.saturating_sub(self.inside);
        let advance = 1_u64.wrapping_shl(self.advance_bits);
        let partly = outside.saturating_add(advance.saturating_sub(1));
        let before = partly.wrapping_shr(self.advance_bits);
        // … or after its end.
        let end = distance.saturating_add(self.inside);
        let after = match self.last.checked_sub(end) {
            Some(room) => room.wrapping_shr(self.advance_bits).saturating_add(1),
            None => 0,
        };
        let kept = self.count.saturating_sub(before);
        kept.saturating_add(after.min(self.count))
    }
}

/// Samples from one start to the next.
fn advance(m: u32) -> u32 {
    (m / 4).max(1)
}

/// The next lag of the sum: by quarters of a cluster near 0 and near the middle, where the kinks
/// are, then by two, then by the distance's power of two.
fn step_after(lag: u32, middle: u32, stride: u32) -> u32 {
    // Far apart, octaves are correlated too little for half steps to matter.
    let halvings = if middle < FAR { 1 } else { 0 };
    let power = |distance: u32| 1_u32.wrapping_shl(floor_log2(distance).saturating_sub(halvings));
    let away = |distance: u32| match distance {
        0..KINK => stride,
        KINK..NEAR => stride.max(2),
        _ => power(distance),
    };
    let towards = |distance: u32| match distance {
        0..=KINK => stride,
        _ if distance <= NEAR => stride.max(2),
        _ => power(distance.saturating_sub(1)),
    };
    if lag >= middle {
        away(lag - middle)
    } else if middle <= 2 * NEAR {
        stride
    } else if lag < middle / 2 {
        away(lag)
    } else {
        towards(middle - lag)
    }
}
