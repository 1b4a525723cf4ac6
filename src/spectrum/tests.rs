//! The accumulator and the spectrum against Welch's definition in double precision, and the expected densities
//! against direct sums.

extern crate std;

mod accumulator;
mod bridged;
mod expected;
mod scipy;
mod stored;

use core::f64::consts::PI;
use std::vec::Vec;

/// The weights of the periodic Hann window.
fn window(length: usize) -> Vec<f64> {
    let weight = |j: usize| 0.5 - 0.5 * libm::cos(2.0 * PI * j as f64 / length as f64);
    (0..length).map(weight).collect()
}

/// The one-sided densities of the bins `P/16 … P/2 − 1` of one segment of values, sampled at `rate_hz`.
fn densities(values: &[f64], rate_hz: f64) -> Vec<f64> {
    let length = values.len();
    let weights = window(length);
    let squares: f64 = weights.iter().map(|w| w * w).sum();
    let one = |k: usize| {
        let (mut re, mut im) = (0.0, 0.0);
        for (j, (value, weight)) in values.iter().zip(&weights).enumerate() {
            let angle = 2.0 * PI * ((j * k) % length) as f64 / length as f64;
            re += weight * value * libm::cos(angle);
            im += weight * value * libm::sin(angle);
        }
        2.0 * (re * re + im * im) / (rate_hz * squares)
    };
    (length / 16..length / 2).map(one).collect()
}

/// Integers that any language can make: white noise, its neighbour added, on slow steps.
fn counts(number: usize) -> Vec<i32> {
    let (mut random, mut before) = (1_u32, 0);
    let mut next = |n: usize| {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let new = (random >> 24) as i32;
        let count = new + before + ((n >> 6) % 97) as i32;
        before = new;
        count
    };
    (0..number).map(&mut next).collect()
}
