//! The variances of sums of octaves and bins are compared with those of simulated records.

use super::Overlap;
extern crate std;

use crate::{
    Accumulator, Curve, Model, Scale, Term,
    evidence::observed::Observed,
    fit::{Columns, Problem, Rows, Weights},
    numerics::{
        nnls::Vector,
        real::{Real, double, real},
        test_random::Random,
    },
    spectrum::{Spectrum, SpectrumAccumulator, covariance_rows},
    theory::{
        covariance::curve_covariance,
        effect::{AngleRandomWalk, Sinusoid},
    },
};
use core::f64::consts::PI;

const OCTAVES: usize = 9;
const BINS: usize = 28;
/// The length of a record, and the number of records. The variance of a sum is then known to 1.8 %.
const SAMPLES: usize = 1 << 12;
const RECORDS: usize = 6000;
const RATE_HZ: Real = 100.0;
/// The standard deviation of a sample, in counts.
const NOISE: f64 = 1000.0;

/// White noise, to which a line may be added.
fn record(random: &mut Random, amplitude: f64, frequency_hz: f64) -> impl Iterator<Item = i32> {
    // The sum of twelve uniform numbers is nearly normal (Irwin 1927).
    let phase = PI * random.signed();
    (0..SAMPLES).map(move |n| {
        let normal: f64 = (0..12).map(|_| random.signed()).sum::<f64>() / 2.0;
        let angle = 2.0 * PI * frequency_hz / double(RATE_HZ) * n as f64 + phase;
        libm::round(NOISE * (normal + amplitude * libm::sin(angle))) as i32
    })
}

fn observe(counts: impl Iterator<Item = i32>) -> (Curve<OCTAVES>, Spectrum<BINS>) {
    let mut accumulator = Accumulator::<OCTAVES>::new();
    let mut sums = SpectrumAccumulator::<32, 2>::new();
    for count in counts {
        accumulator.push(count);
        sums.push(count);
        sums.advance();
    }
    let scale = Scale::new(real(1.0 / NOISE), RATE_HZ).unwrap();
    (accumulator.curve(scale), sums.spectrum(scale))
}

/// The variance of a sum for which octaves, and the levels of a spectrum, are independent of each other.
fn known(
    problem: &Problem<'_, OCTAVES, BINS>,
    curve: &Curve<OCTAVES>,
    squares: &Vector,
    factors: &Rows<OCTAVES, BINS>,
) -> Real {
    let unit = problem.variance_unit;
    let in_rate_units = squares.map(|square| square * unit);
    let octaves = curve_covariance(curve, problem.model, in_rate_units.as_slice());
    let first = curve.points().len() - problem.points.len();
    let mut sum = 0.0;
    for k in 0..problem.points.len() {
        for j in 0..problem.points.len() {
            let covariance = octaves[(first + k, first + j)] / (unit * unit);
            sum += factors[k] * factors[j] * covariance;
        }
    }
    let deterministic = problem.deterministic();
    let share = |row| problem.share_of(&deterministic, row, squares);
    let shares: std::vec::Vec<Real> = (OCTAVES..).map(share).take(problem.bins.len()).collect();
    let part = |b: usize| factors[OCTAVES + b] * problem.variance(OCTAVES + b, squares);
    for (b, row) in covariance_rows(problem.bins, &shares).enumerate() {
        for (d, covariance) in row.into_iter().enumerate() {
            if covariance != 0.0 {
                let twice = if d == 0 { 1.0 } else { 2.0 };
                sum += twice * part(b) * part(b + d) * covariance;
            }
        }
    }
    sum
}

/// The variance of a sum of rows over simulated records, relative to the one that is known, and to that with the excess.
fn ratios(line: Option<(f64, f64)>, weight: fn(usize) -> Real) -> [f64; 2] {
    let mut model = Model::new(&[&AngleRandomWalk]).unwrap();
    let mut truth = Vector::zeros();
    truth.put(0, 0.01);
    if let Some((amplitude, frequency_hz)) = line {
        model
            .put(Term::known(&Sinusoid, [real(frequency_hz)]))
            .unwrap();
        truth.put(1, real(amplitude * amplitude));
    }
    let (amplitude, frequency_hz) = line.unwrap_or((0.0, 1.0));
    let mut random = Random::new(7);
    let (curve, spectrum) = observe(record(&mut random, amplitude, frequency_hz));
    let observed = Observed::new(&curve, &spectrum);
    let columns = Columns::new(observed, &model);
    let problem = Problem::new(observed, &model, &columns);
    let unit = problem.variance_unit;
    let squares = Vector::from_fn(|i| truth[i] / unit);
    let mut weights = Weights::EMPTY;
    weights.set(&problem, &squares, 0.0).unwrap();
    let factors = Rows::of(problem.rows(), |row| weight(row) / weights.model[row]);
    let overlap = Overlap::new(&problem, &squares, &weights.model);
    let levels: std::vec::Vec<_> = overlap.levels().collect();
    let of_levels: Real = (0..levels.len())
        .map(|i| {
            let fine = overlap.fine(&levels[i]);
            overlap.of_level(&levels[i], levels.get(i + 1), &fine, &factors)
        })
        .sum();
    let excess = of_levels + overlap.of_lines(&factors);
    let known = known(&problem, &curve, &squares, &factors);

    let (mut sum, mut squared) = (0.0, 0.0);
    for _ in 0..RECORDS {
        let (curve, spectrum) = observe(record(&mut random, amplitude, frequency_hz));
        let observed = Observed::new(&curve, &spectrum);
        let columns = Columns::new(observed, &model);
        let problem = Problem::new(observed, &model, &columns);
        let per_unit = problem.variance_unit / unit;
        let value: Real = problem
            .rows()
            .map(|row| factors[row] * problem.measured(row) * per_unit)
            .sum();
        sum += double(value);
        squared += double(value) * double(value);
    }
    let n = RECORDS as f64;
    let variance = (squared - sum * sum / n) / (n - 1.0);
    [variance / double(known), variance / double(known + excess)]
}

/// 1 for the rows of a range, 0 for all others.
fn among(row: usize, range: core::ops::Range<usize>) -> Real {
    if range.contains(&row) { 1.0 } else { 0.0 }
}

/// Whether the excess explains most of what a sum varies more than its weights say.
fn check(line: Option<(f64, f64)>, weight: fn(usize) -> Real) {
    let [without, with] = ratios(line, weight);
    std::println!("{line:?}: {without:.3} without the excess, {with:.3} with it");
    assert!(without > 1.08, "{line:?}: {without}");
    assert!((with - 1.0).abs() < 0.06, "{line:?}: {without}, {with}");
}

const FIRST: usize = OCTAVES;
const SECOND: usize = OCTAVES + BINS / 2;

#[test]
fn levels_that_see_the_same_noise_vary_together() {
    check(None, |row| among(row, FIRST..FIRST + BINS));
    // The lowest bins of the first level, and the upper half of the second one.
    check(None, |row| {
        among(row, FIRST..FIRST + 3) + among(row, SECOND + 6..SECOND + 14)
    });
}

#[test]
fn octaves_and_bins_that_see_the_same_noise_vary_together() {
    check(None, |row| {
        among(row, 0..3) + among(row, SECOND..SECOND + 4)
    });
}

/// The difference of the bins beside a line tells its frequency. The same noise beats in both, so that it scatters less than
/// the weights say, by a factor of three.
#[test]
fn the_difference_of_bins_beside_a_line_scatters_less() {
    // 7.7 Hz is at 2.46 bins of the first level, and its alias at 12.3 bins of the second.
    let [without, with] = ratios(Some((1.0, 7.7)), |row| {
        among(row, SECOND + 11..SECOND + 12) - among(row, SECOND + 10..SECOND + 11)
    });
    std::println!("{without:.3} without the excess, {with:.3} with it");
    assert!(without < 0.4, "{without}");
    assert!((with - 1.0).abs() < 0.1, "{with}");
}

#[test]
fn a_line_beats_against_the_same_noise_in_both_levels_that_show_it() {
    // 7.7 Hz is at 2.5 bins of the first level. The second one shows its alias of 4.8 Hz at 12.3 bins.
    check(Some((1.0, 7.7)), |row| {
        3.0 * among(row, FIRST..FIRST + 2) + among(row, SECOND + 9..SECOND + 12)
    });
}

/// The same between the last bin and half the rate, where the noise beside the line beats in bins that no level has.
#[test]
fn the_last_bins_below_half_the_rate_scatter_as_a_line_between_them_says() {
    // 48.2 Hz is at 15.4 bins of the first level, whose last bin is the 15th.
    let [without, with] = ratios(Some((1.0, 48.2)), |row| {
        among(row, FIRST + 13..FIRST + 14) - 2.0 * among(row, FIRST + 12..FIRST + 13)
    });
    std::println!("{without:.3} without the excess, {with:.3} with it");
    assert!((with - 1.0).abs() < 0.1, "{without}, {with}");
}
