//! The covariance of an Allan curve, computed from its effects.
//!
//! ```text
//! Cov(σ̂²_j, σ̂²_k) = ½ Σ_ℓ N_jk(ℓ) [(c_ℓ + g_ℓ)² − g_ℓ²] / (n_j n_k)
//! ```
//!
//! Here `c_ℓ` is the covariance that the random effects give two differences a lag of `ℓ` apart, `g_ℓ`
//! is the product that the deterministic effects add to it, `N_jk(ℓ)` is the number of pairs of starts
//! that far apart, and `n_j` is the number of differences of octave `j`. The fourth moments follow
//! Isserlis 1918, the Allan variances follow Greenhall 1991. Only the ends of the octaves limit the
//! pairs: a curve does not know the gaps inside its record. The smaller numbers of differences that
//! gaps leave stand in for them.
//!
//! The sum takes every lag near 0 and near `m_k`, where `c` has its kinks. Elsewhere it follows the
//! trapezoidal rule, in steps that grow with the distance from both. It is within 1 % of the full sum
//! for the effects of [`IEEE_952`](crate::effect::IEEE_952).
//!
//! The sum is taken in single precision, and its numbers are in units of the octave's own variance.
//! Weights need no more than six digits, and a core that computes single precision in hardware takes
//! half as long.

mod detailed;
mod products;
mod series;
mod starts;

use crate::{
    curve::{Curve, Point},
    lattice::{self, Rounded, SecondDifferences},
    limits::MAX_EFFECTS,
    list::{self, numbered},
    math::{self, floor_log2},
    model::{Model, Term},
    real::{Real, consts::PI, real, single},
};
use detailed::Detailed;
use heapless::Vec;
use nalgebra::{Complex, SMatrix};
use products::Products;
use starts::{NEAR, Starts, advance, step_after};

/// The outward tail of the sum ends after two lags in a row that each add less than this share of the
/// sum. Chosen by hand, and held to 1 % of the full sum by `host-tests/tests/covariance.rs`.
const NEGLIGIBLE: f32 = 1e-4;

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
        covariance_row(points, model, squares, interval_s, j, &mut |k, value| {
            each(k, j, value);
        });
    }
}

/// Computes the covariance of octave `j` with itself and with all longer octaves. Calls
/// `each(k, covariance)` for `k ≥ j`. Calls nothing for an octave that the curve does not have.
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
    let (mut with_detail, mut of_detailed) = (Vec::<_, DETAILED>::new(), 0.0);
    for (term, &square) in present() {
        let shape = term.sampled_shape(interval_s);
        if term.effect.response(m_j, &shape).is_some() {
            continue;
        }
        let has_detail = term.effect.tail(m_j, &shape).is_some();
        if has_detail && with_detail.push((term, square)).is_ok() {
            of_detailed += square * term.effect.variance(m_j, &shape);
        } else {
            term.effect
                .add_second_differences(m_j, square, &shape, &mut random);
        }
    }
    let random = random.rounded(of_detailed * shorter.tau_s * shorter.tau_s);
    let per_unit = 1.0 / random.unit();
    let detailed = with_detail
        .iter()
        .filter_map(|&(term, square)| Detailed::of(term, square, shorter.m, interval_s, per_unit));
    let detailed: Vec<Detailed, DETAILED> = list::fill(detailed);
    let per_unit = 2.0 / random.unit();
    let mut turns = Vec::<Turn, TABLES>::new();
    let mut waves = Vec::<Wave, MAX_EFFECTS>::new();
    for (term, &square) in present() {
        if let Some(short) = term.effect.response(m_j, &term.sampled_shape(interval_s)) {
            let phase = 0.25 * m_j * short.phase;
            // There is a place for every effect of a model.
            let _ = waves.push(Wave {
                term,
                square,
                size: per_unit * square * short.amplitude,
                product: 0.0,
                phase,
                turn: Turn::of(phase, &mut turns),
                now: START,
                scatter: coherent(term, square, shorter, interval_s),
                sample_phase: short.phase,
            });
        }
    }
    for (k, longer) in numbered(points.iter()).skip(j) {
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
}

/// What a deterministic effect adds to the product of two differences, times two. It is
/// `product · cos(phase · ℓ)` at a lag of `ℓ` quarters of the shorter cluster.
struct Wave<'a> {
    term: &'a Term,
    square: Real,
    /// Its [`coherent`] share of the shorter octave.
    scatter: Real,
    /// The phase from one sample to the next, in radians.
    sample_phase: Real,
    /// The product without the factor of the longer octave.
    size: Real,
    product: f32,
    phase: Real,
    turn: Option<usize>,
    /// `e^(i · phase · ℓ)` at the present lag.
    now: Complex<f32>,
}

impl Wave<'_> {
    fn value(&self) -> f32 {
        self.product * self.now.re
    }

    /// `product · e^(i · phase · lag)`, at any lag.
    fn from(&self, lag: u32) -> Complex<f32> {
        let turns = self.phase / (2.0 * PI) * real(lag);
        let (sine, cosine) = math::sincos_of_turns(turns);
        Complex::new(single(cosine), single(sine)) * self.product
    }

    /// `1 − e^(i · phase)` for the phase over a number of quarters.
    fn rest(&self, quarters: u32) -> Complex<f32> {
        detailed::rest(0.0, self.phase * real(quarters))
    }

    /// The magnitude of that phase below half a turn, or a little less.
    fn speed(&self, quarters: u32) -> f32 {
        let rest = self.rest(quarters);
        rest.re.abs().max(rest.im.abs())
    }

    /// Advances from a lag by a step, which is a power of two.
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

/// The number of oscillations of a model whose turns are kept in tables. Any further one takes a cosine
/// per lag.
const TABLES: usize = 2;

/// The number of effects of a model whose detail is summed. Any further one is taken at the lags of the lattice
/// alone.
const DETAILED: usize = 2;

/// The number of powers of two among the steps of the sum.
const LEVELS: usize = (lattice::END / 2).ilog2() as usize;

/// The powers `e^(i · phase · 2^k)`, by repeated squaring: one exponential replaces the cosines of a
/// lattice.
struct Turn {
    phase: Real,
    steps: [Complex<f32>; LEVELS],
}

impl Turn {
    /// The place of a phase's turns in `known`, where they are added if they are missing. `None` if
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

/// The part of an oscillation's variance in an octave that depends on its phase, which nobody knows: the
/// amplitude of `σ̂² = σ²(τ) + coherent · cos 2φ`.
///
/// A difference of phase `φ + ωs` contributes `2σ² cos²(φ + ωs)` to the average, and `cos 2(φ + ωs)` sums
/// over `n` starts that are `a` samples apart to `sin(nωa)/sin(ωa)`. Only a record of many periods averages
/// it away. The phase `2φ` is that in the [`middle`] of the octave.
fn coherent(term: &Term, square: Real, point: &Point, interval_s: Real) -> Real {
    let shape = term.sampled_shape(interval_s);
    let Some(sample) = term
        .effect
        .response(1.0, &shape)
        .filter(|sample| sample.phase != 0.0)
    else {
        return 0.0;
    };
    let apart = sample.phase / (2.0 * PI) * real(advance(point.m));
    let count = point.differences as Real;
    let sine = math::sincos_of_turns(apart).0;
    // Starts that are whole half periods apart all have the same phase.
    let mean = if sine.abs() * count < 1e-3 {
        1.0
    } else {
        math::sincos_of_turns(apart * count).0 / (count * sine)
    };
    square * term.effect.variance(real(point.m), &shape) * mean
}

/// The time, in samples, around which an octave's differences lie.
fn middle(point: &Point) -> Real {
    let starts = (point.differences as Real - 1.0) * real(advance(point.m));
    0.5 * starts + real(point.m)
}

/// Two octaves of a curve.
struct Pair<'a> {
    shorter: &'a Point,
    longer: &'a Point,
}

impl Pair<'_> {
    /// The length of the longer cluster in quarters of the shorter one: the lag of the outer kinks.
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
                // The trapezoidal rule weights a lag with half the steps to either side. The factor of
                // one half follows below, and so does the division by the stride. `pairs` counts both
                // signs of the lag.
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
        self.scaled(sum, stride, differences)
    }

    /// The covariance that belongs to a sum over pairs, which took every pair `2 stride` times.
    fn scaled(&self, sum: f32, stride: u32, differences: &Rounded) -> Real {
        let counts = self.shorter.differences as Real * self.longer.differences as Real;
        // The square of τ² would leave the range of single precision, so τ² is divided out first.
        let unit = differences.unit() / (self.shorter.tau_s * self.longer.tau_s);
        0.25 * real(sum) * (unit * unit) / (real(stride) * counts)
    }
}
