//! The covariance of noise whose power spectral density is given.
//!
//! The generalised covariance is `G(n) = −½ τ₀² ∫ A(f) (1 − cos 2π f n τ₀) df` over all frequencies up to half of the rate, with
//! `A = S/sin²(π f τ₀)`. `A` is taken for a parabola in each of some hundred cells, which are halved where it is none, and
//! the integral over each cell has a closed form for every lag (Filon, 1928). A covariance is thus that of one density, which lies
//! near the given one, and differences of it are consistent.

use std::f64::consts::PI;

/// The lowest frequency, as a power of two of the rate. A record of 2^34 samples would see it.
const LOWEST: i32 = -34;
/// Cells in each octave before they are halved. Chosen by hand.
const PER_OCTAVE: i32 = 6;
/// The largest error of a parabola, relative to `A`, and the narrowest cell, relative to its frequency. Chosen by hand:
/// variances are then right to 1e-4.
const ERROR: f64 = 1e-4;
const NARROWEST: f64 = 1e-5;
/// The most cells, so that a density which no parabola follows takes memory that is bounded. Chosen by hand.
const MOST: usize = 4000;
/// Below this share of the rate, the part of `G` that is proportional to the squared lag is left out, because it is free and
/// would grow without a bound where the density rises faster than 1/f.
const FREE: f64 = 1.0 / 16384.0;
/// The largest phase at which cosines are taken for the begin of their series.
const SMALL: f64 = 0.5;
/// The number of terms of that series.
const TERMS: usize = 6;

/// Noise with a power spectral density, sampled.
pub(crate) struct Density {
    interval_s: f64,
    /// In the order of their frequencies.
    cells: Vec<Cell>,
    /// The sums over the moments of all cells before each.
    sums: Vec<[f64; TERMS]>,
    /// The integrals over `A`, and those over `A f²` of what is free, of all cells from each on.
    rest: Vec<[f64; 2]>,
}

/// A parabola `α + β u + γ u²` for `A` around a frequency, over `|u| ≤ 1`.
struct Cell {
    middle: f64,
    half: f64,
    parabola: [f64; 3],
}

impl Density {
    /// The density `S` of a rate that is sampled, at frequencies in Hz.
    pub(crate) fn new(density: impl Fn(f64) -> f64, interval_s: f64) -> Self {
        let nyquist = 0.5 / interval_s;
        let count = (-1 - LOWEST) * PER_OCTAVE;
        let edge = |at: i32| nyquist * 2.0_f64.powf(f64::from(at - count) / f64::from(PER_OCTAVE));
        let edges: Vec<f64> = (0..=count).map(edge).collect();
        Self::between(&edges, density, interval_s)
    }

    /// The density of a rate that is sampled, smooth between the edges and zero elsewhere.
    pub(crate) fn between(edges: &[f64], density: impl Fn(f64) -> f64, interval_s: f64) -> Self {
        let a = |f: f64| {
            let sine = (PI * f * interval_s).sin();
            density(f) / (sine * sine)
        };
        let mut cells = Vec::new();
        for (&low, &high) in edges.iter().zip(&edges[1..]) {
            split(
                &a,
                [low, high],
                [a(low), a(0.5 * (low + high)), a(high)],
                &mut cells,
            );
        }
        let mut sums = vec![[0.0; TERMS]];
        for cell in &cells {
            let before = sums.last().copied().unwrap_or_default();
            let moments = cell.moments(interval_s);
            sums.push(std::array::from_fn(|k| before[k] + moments[k]));
        }
        let mut rest = vec![[0.0; 2]];
        for cell in cells.iter().rev() {
            let [whole, free] = rest.last().copied().unwrap_or_default();
            let own = match cell.is_free(interval_s) {
                true => cell.moment(2),
                false => 0.0,
            };
            rest.push([whole + cell.moment(0), free + own]);
        }
        rest.reverse();
        Self {
            interval_s,
            cells,
            sums,
            rest,
        }
    }

    /// The generalised covariance at a lag in samples, in s² times the unit of the density times Hz.
    pub(crate) fn covariance(&self, lag: f64) -> f64 {
        let kappa = 2.0 * PI * lag * self.interval_s;
        // Cells whose phases are small come first, and their series are sums that are known.
        let first = self
            .cells
            .partition_point(|cell| kappa * (cell.middle + cell.half) < SMALL);
        let mut power = 1.0;
        let square = -(kappa * kappa);
        let mut sum = 0.0;
        for moment in self.sums[first] {
            power *= square;
            sum -= power * moment;
        }
        let [whole, free] = self.rest[first];
        let waves: f64 = self.cells[first..]
            .iter()
            .map(|cell| cell.wave(kappa))
            .sum();
        sum += whole - waves - 0.5 * kappa * kappa * free;
        -0.5 * self.interval_s * self.interval_s * sum
    }
}

/// Adds the cell between two frequencies, or its halves, whose own halves follow where `A` is no parabola there either.
fn split(
    a: &impl Fn(f64) -> f64,
    [low, high]: [f64; 2],
    [at_low, at_middle, at_high]: [f64; 3],
    cells: &mut Vec<Cell>,
) {
    let middle = 0.5 * (low + high);
    let parabola = [
        at_middle,
        0.5 * (at_high - at_low),
        0.5 * (at_high + at_low) - at_middle,
    ];
    let [one, other] = [0.5 * (low + middle), 0.5 * (middle + high)].map(a);
    let of_parabola = |u: f64| parabola[0] + u * (parabola[1] + u * parabola[2]);
    let bar = ERROR * at_middle.abs().max(at_low.abs()).max(at_high.abs());
    let is_near = |value: f64, u: f64| (value - of_parabola(u)).abs() <= bar;
    let is_last = high - low < NARROWEST * high || cells.len() >= MOST;
    if is_last || is_near(one, -0.5) && is_near(other, 0.5) {
        cells.push(Cell {
            middle,
            half: 0.5 * (high - low),
            parabola,
        });
        return;
    }
    split(a, [low, middle], [at_low, one, at_middle], cells);
    split(a, [middle, high], [at_middle, other, at_high], cells);
}

impl Cell {
    /// Whether the part of `G` that is proportional to the squared lag is left out.
    fn is_free(&self, interval_s: f64) -> bool {
        (self.middle + self.half) * interval_s < FREE
    }

    /// The integral over `A f^k` with an even `k`, by Gauss's rule of six points, which is exact up to `k = 9`.
    fn moment(&self, k: i32) -> f64 {
        const RULE: [[f64; 2]; 3] = [
            [0.238_619_186_083_196_9, 0.467_913_934_572_691_04],
            [0.661_209_386_466_264_5, 0.360_761_573_048_138_6],
            [0.932_469_514_203_152, 0.171_324_492_379_170_35],
        ];
        let [alpha, beta, gamma] = self.parabola;
        let value =
            |u: f64| (alpha + u * (beta + u * gamma)) * (self.middle + self.half * u).powi(k);
        let pairs = RULE
            .iter()
            .map(|[u, weight]| weight * (value(*u) + value(-u)));
        self.half * pairs.sum::<f64>()
    }

    /// The moments with the factors of the series of a cosine: `1/2!`, `1/4!`, ….
    fn moments(&self, interval_s: f64) -> [f64; TERMS] {
        let mut factorial = 1.0;
        std::array::from_fn(|at| {
            let k = 2 * (at as i32 + 1);
            factorial *= f64::from(k - 1) * f64::from(k);
            match at == 0 && self.is_free(interval_s) {
                true => 0.0,
                false => self.moment(k) / factorial,
            }
        })
    }

    /// The integral over `A cos(κ f)`.
    fn wave(&self, kappa: f64) -> f64 {
        let theta = kappa * self.half;
        let (sine, cosine) = theta.sin_cos();
        let square = theta * theta;
        let [even, odd, second] = if theta < 0.1 {
            [
                2.0 - square / 3.0 + square * square / 60.0,
                theta * (2.0 / 3.0 - square / 15.0 + square * square / 420.0),
                2.0 / 3.0 - square / 5.0 + square * square / 84.0,
            ]
        } else {
            [
                2.0 * sine / theta,
                2.0 * (sine - theta * cosine) / square,
                2.0 * ((square - 2.0) * sine + 2.0 * theta * cosine) / (square * theta),
            ]
        };
        let [alpha, beta, gamma] = self.parabola;
        let (sine, cosine) = (kappa * self.middle).sin_cos();
        self.half * (cosine * (alpha * even + gamma * second) - sine * beta * odd)
    }
}
