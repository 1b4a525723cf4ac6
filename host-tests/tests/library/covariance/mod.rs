//! Compares the covariance of a curve with the sum over every pair of its differences.

mod catalogue;
mod every_pair;
mod gaps;
mod simulated;

use allanite::{
    Curve, Model, Term,
    effect::{IEEE_952, SampledShape, Sinusoid},
    fit::curve_covariance,
};

/// The capacity of every curve here, in octaves. Records this short fill fewer.
const OCTAVES: usize = 12;
const INTERVAL_S: f64 = 0.01;

/// The weights of a second difference.
const WEIGHTS: [f64; 3] = [1.0, -2.0, 1.0];

/// The squared coefficients, in the order of the IEEE-952 model.
type Squares = [f64; 5];

const WHITE: Squares = [0.0, 1.0, 0.0, 0.0, 0.0];
const FLICKER: Squares = [0.0, 0.0, 1.0, 0.0, 0.0];
const WALK: Squares = [0.0, 0.0, 0.0, 1.0, 0.0];
const QUANTIZATION: Squares = [1.0, 0.0, 0.0, 0.0, 0.0];
/// The squared coefficients of the simulator's preset "mems".
const MEMS: Squares = [4e-8, 2.5e-5, 1.6e-5, 9e-8, 0.0];
/// The same with a ramp that makes up half of the variance of the longest octaves.
const MEMS_ON_A_RAMP: Squares = [4e-8, 2.5e-5, 1.6e-5, 9e-8, 3e-7];

/// An octave of a record.
struct Octave {
    m: usize,
    starts: Vec<usize>,
}

/// The octaves with at least six differences.
fn octaves(samples: usize) -> Vec<Octave> {
    let octave = |k: u32| {
        let m = 1_usize << k;
        let starts = (0..=samples.saturating_sub(2 * m)).step_by((m / 4).max(1));
        Octave {
            m,
            starts: starts.collect(),
        }
    };
    (0..)
        .map(octave)
        .take_while(|octave| octave.starts.len() >= 6)
        .collect()
}

fn curve(octaves: &[Octave]) -> Curve<OCTAVES> {
    let points = octaves
        .iter()
        .map(|octave| (octave.m as u32, octave.starts.len() as u64, 1.0));
    Curve::new(1.0 / INTERVAL_S, points).expect("possible")
}

/// The number of pairs of starts that lie `ℓ` apart. The second start belongs to the longer
/// clusters and is shifted to `ℓ + offset`.
struct Pairs {
    counts: Vec<u64>,
    offset: usize,
}

impl Pairs {
    fn new(short: &Octave, long: &Octave) -> Self {
        let offset = short.starts.last().copied().unwrap_or(0);
        let mut counts = vec![0; offset + long.starts.last().copied().unwrap_or(0) + 1];
        for start in &short.starts {
            for other in &long.starts {
                counts[other + offset - start] += 1;
            }
        }
        Self { counts, offset }
    }
}

/// `Cov(σ̂²_j, σ̂²_k) = ½ Σ_ℓ N_jk(ℓ) [(c_ℓ + g_ℓ)² − g_ℓ²]/(n_j n_k)`. The covariance of the
/// random effects is `c_ℓ = Σ w_u w_v G(ℓ + v m_k − u m_j)/(τ_j τ_k)`. The ramp adds `Rτ` to every
/// difference, hence `g = R² τ_j τ_k`.
fn covariance(short: &Octave, long: &Octave, pairs: &Pairs, kernel: &[f64], ramp: f64) -> f64 {
    let tau2 = (short.m * long.m) as f64 * INTERVAL_S * INTERVAL_S;
    let g = ramp * tau2;
    let mut sum = 0.0;
    for (i, &count) in pairs
        .counts
        .iter()
        .enumerate()
        .filter(|(_, count)| **count > 0)
    {
        let mut c = 0.0;
        for (u, w_u) in WEIGHTS.iter().enumerate() {
            for (v, w_v) in WEIGHTS.iter().enumerate() {
                let lag = (i + v * long.m).abs_diff(pairs.offset + u * short.m);
                c += w_u * w_v * kernel[lag];
            }
        }
        c /= tau2;
        sum += count as f64 * c * (c + 2.0 * g);
    }
    0.5 * sum / (short.starts.len() * long.starts.len()) as f64
}

/// The kernel `G(n)` of the random effects.
fn kernel(squares: &Squares, longest: usize) -> Vec<f64> {
    let shape = SampledShape::new(INTERVAL_S);
    let random = || {
        IEEE_952
            .iter()
            .zip(squares)
            .take(4)
            .filter(|(_, square)| **square > 0.0)
    };
    let at = |lag| {
        random()
            .map(|(effect, square)| square * effect.kernel(lag, &shape))
            .sum()
    };
    (0..longest).map(|lag| at(lag as f64)).collect()
}

fn assert_all_pairs(samples: usize, cases: &[(&str, Squares)]) {
    let octaves = octaves(samples);
    let count = octaves.len();
    let mut expected = vec![vec![vec![0.0; count]; count]; cases.len()];
    let kernels: Vec<_> = cases
        .iter()
        .map(|(_, squares)| kernel(squares, 2 * samples))
        .collect();
    for j in 0..count {
        for k in j..count {
            let (short, long) = (&octaves[j], &octaves[k]);
            let pairs = Pairs::new(short, long);
            for (case, kernel) in kernels.iter().enumerate() {
                let value = covariance(short, long, &pairs, kernel, cases[case].1[4]);
                expected[case][j][k] = value;
                expected[case][k][j] = value;
            }
        }
    }
    let mut worst = Vec::new();
    for ((name, squares), expected) in cases.iter().zip(&expected) {
        let found = curve_covariance(&curve(&octaves), &Model::ieee_952(), squares);
        for j in 0..OCTAVES {
            for k in 0..OCTAVES {
                if j >= count || k >= count {
                    assert_eq!(found[(j, k)], 0.0, "{name}: beyond the curve's octaves");
                    continue;
                }
                assert_eq!(found[(j, k)], found[(k, j)], "{name}: symmetry");
                let unit = (expected[j][j] * expected[k][k]).sqrt();
                let error = (found[(j, k)] - expected[j][k]) / unit;
                if error.abs() > 0.01 {
                    worst.push(format!("{name}, octaves {j} and {k}: off by {error:.3}"));
                }
            }
        }
        let mut filled = found;
        (count..OCTAVES).for_each(|k| filled[(k, k)] = 1.0);
        assert!(filled.cholesky().is_some(), "{name}: positive definite");
    }
    assert!(worst.is_empty(), "{samples} samples:\n{}", worst.join("\n"));
}

const CASES: [(&str, Squares); 6] = [
    ("white", WHITE),
    ("flicker", FLICKER),
    ("random walk", WALK),
    ("quantization", QUANTIZATION),
    ("mems", MEMS),
    ("mems on a ramp", MEMS_ON_A_RAMP),
];

#[test]
fn covariance_is_the_sum_over_every_pair_of_differences() {
    assert_all_pairs(1 << 12, &CASES);
}

#[test]
fn covariance_is_right_for_lengths_other_than_powers_of_two() {
    assert_all_pairs(3000, &CASES);
    assert_all_pairs(5555, &CASES);
}

#[test]
fn covariance_is_right_for_the_shortest_records() {
    for samples in 13..40 {
        assert_all_pairs(samples, &CASES);
    }
    assert_all_pairs(100, &CASES);
}

/// The correlations of neighbouring octaves in long records, on which theory and thousands of
/// simulated records agree.
#[test]
fn long_records_have_the_correlations_of_theory() {
    let samples = 1_u64 << 17;
    let points = (0..OCTAVES as u32).map(|k| {
        let m = 1_u64 << k;
        (m as u32, (samples - 2 * m) / (m / 4).max(1) + 1, 1.0)
    });
    let curve = Curve::<OCTAVES>::new(100.0, points).expect("possible");
    for (squares, correlations) in [
        (WHITE, [0.51, 0.18, 0.06, 0.02]),
        (FLICKER, [0.69, 0.31, 0.12, 0.04]),
        (WALK, [0.89, 0.67, 0.49, 0.34]),
    ] {
        let matrix = curve_covariance(&curve, &Model::ieee_952(), &squares);
        for (d, expected) in correlations.into_iter().enumerate() {
            let (j, k) = (6, 7 + d);
            let found = matrix[(j, k)] / (matrix[(j, j)] * matrix[(k, k)]).sqrt();
            assert!(
                (found - expected).abs() < 0.01,
                "{found}, expected {expected}"
            );
        }
    }
}

/// The phase of an oscillation is not known. A record of few periods tells different phases by different
/// variances, and that is all the scatter that an oscillation alone has.
#[test]
fn an_oscillation_scatters_with_its_phase() {
    const PHASES: usize = 16;
    for (samples, frequency_hz) in [
        (4096, 0.03),
        (4096, 0.1),
        (3000, 7.7),
        (1000, 0.05),
        (555, 49.0),
    ] {
        let octaves = octaves(samples);
        let variances: Vec<Vec<f64>> = (0..PHASES)
            .map(|i| {
                let phase = i as f64 / PHASES as f64;
                let turns = |n: usize| frequency_hz * INTERVAL_S * n as f64 + phase;
                let rate = |n: usize| (std::f64::consts::TAU * turns(n)).sin();
                let mut sums = vec![0.0];
                sums.extend((0..samples).scan(0.0, |sum, n| {
                    *sum += rate(n);
                    Some(*sum)
                }));
                let square = |m: usize, s: usize| {
                    let difference = sums[s + 2 * m] - 2.0 * sums[s + m] + sums[s];
                    (difference / m as f64).powi(2)
                };
                let mean = |o: &Octave| {
                    let squares = o.starts.iter().map(|s| square(o.m, *s));
                    0.5 * squares.sum::<f64>() / o.starts.len() as f64
                };
                octaves.iter().map(mean).collect()
            })
            .collect();
        let mean = |j: usize| variances.iter().map(|v| v[j]).sum::<f64>() / PHASES as f64;
        let product = |j: usize, k: usize| {
            let off = |v: &Vec<f64>, j: usize| v[j] - mean(j);
            let products = variances.iter().map(|v| off(v, j) * off(v, k));
            products.sum::<f64>() / PHASES as f64
        };
        let mut model = Model::new(&[]).expect("empty");
        let term = Term::known(&Sinusoid, [frequency_hz]);
        model.add(term).expect("there is room");
        let found = curve_covariance(&curve(&octaves), &model, &[1.0]);
        for j in 0..octaves.len() {
            for k in 0..octaves.len() {
                let expected = product(j, k);
                let error = (found[(j, k)] - expected).abs();
                assert!(
                    error < 1e-6 * mean(j) * mean(k),
                    "{frequency_hz} Hz, {samples} samples, octaves {j} and {k}: {:e}, expected {expected:e}",
                    found[(j, k)]
                );
            }
        }
    }
}

#[test]
fn a_ramp_alone_has_no_covariance() {
    let curve = curve(&octaves(4096));
    let matrix = curve_covariance(&curve, &Model::ieee_952(), &[0.0, 0.0, 0.0, 0.0, 1.0]);
    assert_eq!(matrix.abs().max(), 0.0);
}

#[test]
fn covariances_scale_with_the_fourth_power_of_the_coefficients() {
    let curve = curve(&octaves(4096));
    let unit = curve_covariance(&curve, &Model::ieee_952(), &MEMS_ON_A_RAMP);
    let scaled = curve_covariance(&curve, &Model::ieee_952(), &MEMS_ON_A_RAMP.map(|x| 9.0 * x));
    for (unit, scaled) in unit.iter().zip(scaled.iter()) {
        assert!((scaled - 81.0 * unit).abs() <= 1e-12 * scaled.abs());
    }
}

/// A gap reduces the number of differences and leaves their correlation. Half the differences give
/// twice the variance.
#[test]
fn half_the_differences_give_twice_the_variance() {
    let full = octaves(4096);
    let halved = full
        .iter()
        .map(|o| (o.m as u32, (o.starts.len() as u64).div_ceil(2), 1.0));
    let halved = Curve::<OCTAVES>::new(1.0 / INTERVAL_S, halved).expect("possible");
    let whole = curve_covariance(&curve(&full), &Model::ieee_952(), &MEMS);
    let half = curve_covariance(&halved, &Model::ieee_952(), &MEMS);
    for k in 0..full.len() {
        let ratio = half[(k, k)] / whole[(k, k)];
        assert!((1.5..2.1).contains(&ratio), "octave {k}: {ratio}");
    }
}
