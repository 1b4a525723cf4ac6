//! Compares the small fit of the five terms with the general one.

use super::{OCTAVES, quantum, theory::squares};
use allanite::{
    Accumulator, Coefficient, Curve, Model, Scale,
    fit::{Options, State, fit},
    ieee_952,
};
use allanite_host::simulate::{Preset, Random, Simulator};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

/// What the two fits of a record say.
#[derive(Clone, Debug)]
pub struct Compared {
    /// The octaves of the curve.
    pub octaves: usize,
    /// Whether samples were lost, so that the curve has several stretches.
    pub has_gaps: bool,
    /// The differences of the coefficients' squares, in standard errors of the general fit.
    pub squares: [f64; 5],
    /// The differences of the lower and upper ends, in the same unit, where both fits have them.
    pub ends: Vec<f64>,
    /// Whether the states are equal.
    pub states: [bool; 5],
    /// The difference of χ².
    pub chi_squared: f64,
    /// Whether the interval or bound of each coefficient contains the true one: of the general fit, and of the small one.
    pub covered: [[bool; 2]; 5],
    /// The p-values.
    pub p_values: [f64; 2],
}

/// Fits records of a preset, of 2^11 to 2^`longest` samples, a third of them with gaps.
pub fn study(preset: Preset, longest: f64, records: u64, seed: u64) -> Vec<Compared> {
    (0..records)
        .into_par_iter()
        .filter_map(|record| compare(preset, longest, seed.wrapping_add(record)))
        .collect()
}

fn compare(preset: Preset, longest: f64, seed: u64) -> Option<Compared> {
    const RATE_HZ: f64 = super::RATE_HZ;
    let coefficients = preset.coefficients();
    let quantum = quantum(coefficients, RATE_HZ);
    let mut random = Random::seed_from_u64(seed ^ 0x0952);
    let samples = 2_f64.powf(random.random_range(11.0..longest)) as usize;
    let has_gaps = seed.is_multiple_of(3);
    let per_gap = samples as f64 / random.random_range(2.0..30.0);
    let mut accumulator = Accumulator::<OCTAVES>::new();
    for rate in Simulator::new(coefficients, RATE_HZ, seed).take(samples) {
        accumulator.push((rate / quantum).round() as i32);
        if has_gaps && random.random_bool(1.0 / per_gap) {
            accumulator.gap();
        }
    }
    let curve: Curve<OCTAVES> = accumulator.curve(Scale::new(quantum, RATE_HZ).ok()?);
    let general = fit(&curve, &Model::ieee_952(), Options::default()).ok()?;
    let small = ieee_952::fit(&curve).ok()?;
    let truth = squares(coefficients).map(f64::sqrt);
    let pairs: Vec<(Coefficient, Coefficient)> = general
        .coefficients
        .iter()
        .copied()
        .zip(small.coefficients)
        .collect();
    let mut ends = Vec::new();
    for (one, other) in &pairs {
        if one.state == other.state && one.upper.is_finite() {
            let unit = one.square_error;
            ends.push((one.lower.powi(2) - other.lower.powi(2)) / unit);
            ends.push((one.upper.powi(2) - other.upper.powi(2)) / unit);
        }
    }
    let is_same = |(one, other): &(Coefficient, Coefficient)| {
        std::mem::discriminant(&one.state) == std::mem::discriminant(&other.state)
    };
    let covers = |one: &Coefficient, truth: f64| {
        matches!(one.state, State::NotObservable { .. }) || one.lower <= truth && truth <= one.upper
    };
    Some(Compared {
        octaves: curve.points().len(),
        has_gaps,
        squares: std::array::from_fn(|i| {
            let (one, other) = &pairs[i];
            match one.square_error.is_finite() {
                true => (one.square - other.square) / one.square_error,
                false => 0.0,
            }
        }),
        ends,
        states: std::array::from_fn(|i| is_same(&pairs[i])),
        chi_squared: general.chi_squared - small.chi_squared,
        covered: std::array::from_fn(|i| {
            let (one, other) = &pairs[i];
            [covers(one, truth[i]), covers(other, truth[i])]
        }),
        p_values: [general.p_value, small.p_value()],
    })
}
