//! Lengths of records against the information of each length, summed up anew.

use super::*;
use crate::{
    numerics::{
        real::{double, real},
        test_random::Random,
    },
    theory::effect::{Effect, SampledShape},
};

const INTERVAL_S: f64 = 0.01;

/// Squared coefficients of a MEMS gyro, in the order of the model and in units in which the least
/// variance of the curve is about one.
const SQUARES: [f64; 5] = [4e-3, 2.5, 1.6, 9e-3, 1e-6];

/// Variance of a squared coefficient from a record of so many samples, in double precision: the inverse
/// of `Σ ½ (N/m − 1) s s'/σ⁴` over octaves of four clusters and more.
fn variance(i: usize, squares: &[f64; 5], free: u32, model: &Model, samples: u64) -> f64 {
    let mut information = nalgebra::SMatrix::<f64, 5, 5>::identity();
    for a in (0..5).filter(|a| free >> a & 1 == 1) {
        information[(a, a)] = 0.0;
    }
    let mut m = 1_u64;
    while samples / m >= 4 {
        let unit = |a: usize| {
            let effect: &dyn Effect = model.terms()[a].effect;
            double(effect.variance(real(m), &SampledShape::new(real(INTERVAL_S))))
        };
        let model: f64 = (0..5).map(|a| squares[a] * unit(a)).sum();
        let weight = 0.5 * (samples as f64 / m as f64 - 1.0) / (model * model);
        for a in (0..5).filter(|a| free >> a & 1 == 1) {
            for b in (0..5).filter(|b| free >> b & 1 == 1) {
                information[(a, b)] += weight * unit(a) * unit(b);
            }
        }
        m *= 2;
    }
    // Columns of one size, or the elimination loses the small ones.
    let scale = information.diagonal().map(|x| 1.0 / libm::sqrt(x));
    let scaled =
        nalgebra::SMatrix::<f64, 5, 5>::from_fn(|a, b| information[(a, b)] * scale[a] * scale[b]);
    let inverse = scaled.try_inverse().expect("regular");
    inverse[(i, i)] * scale[i] * scale[i]
}

#[test]
fn the_record_length_is_the_shortest_doubling_that_measures_the_effect() {
    let model = Model::ieee_952();
    let mut random = Random::new(61);
    let (mut told, mut never) = (0, 0);
    for _ in 0..200 {
        let i = random.below(5);
        // White noise is always there.
        let free = random.bits() & 31 | 2;
        let chosen = PassiveSet::of(|j| free >> j & 1 == 1);
        // At a bound from far below to far above what the curve shows.
        let square = SQUARES[i] * libm::pow(10.0, 3.0 * random.signed() - 1.0);
        let mut squares = SQUARES;
        for (j, other) in squares.iter_mut().enumerate() {
            *other *= f64::from(free >> j & 1);
        }
        let samples = 1_u64 << (10 + random.below(8));
        let found = record_length_s(
            i,
            real(square),
            &Vector::from_fn(|j| squares.get(j).map_or(0.0, |&square| real(square))),
            &chosen,
            &model,
            real(INTERVAL_S),
            real(samples),
        );
        squares[i] = square;
        let with = 0b1_1111;
        let lengths = (1..30).map(|k| samples << k).take_while(|&n| n <= 1 << 30);
        let ratio = |n: u64| {
            let variance = variance(i, &squares, with, &model, n);
            square * square / (7.848_879 * variance)
        };
        // Rounding decides where the two are alike.
        if lengths.clone().any(|n| (ratio(n) - 1.0).abs() < 0.01) {
            continue;
        }
        let expected = { lengths }.find(|&n| ratio(n) > 1.0);
        let seconds = expected.map(|n| real(n as f64 * INTERVAL_S));
        match (found, seconds) {
            (Some(found), Some(expected)) => {
                assert!(
                    (found / expected - 1.0).abs() < 1e-6,
                    "{found}, not {expected}"
                );
                told += 1;
            }
            (None, None) => never += 1,
            _ => panic!("{found:?}, not {seconds:?}: effect {i}, {free:05b}, {square:e}"),
        }
    }
    assert!(told > 50 && never > 5, "{told} lengths, {never} without");
}
