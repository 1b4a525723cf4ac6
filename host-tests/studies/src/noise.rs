//! Noises of unit size and filters, for records that studies damage or move.

use allanite_host::simulate::Random;
use rand::RngExt;
use rand_distr::StandardNormal;
use std::f64::consts::PI;

/// A Gaussian value of standard deviation 1.
pub(super) fn normal(random: &mut Random) -> f64 {
    random.sample(StandardNormal)
}

/// Noise with its mean taken off, and scaled to a standard deviation of 1.
pub(super) fn normalised(mut noise: Vec<f64>) -> Vec<f64> {
    let mean = noise.iter().sum::<f64>() / noise.len() as f64;
    let squares: f64 = noise.iter().map(|value| (value - mean).powi(2)).sum();
    let deviation = (squares / noise.len() as f64).sqrt();
    noise
        .iter_mut()
        .for_each(|value| *value = (*value - mean) / deviation);
    noise
}

/// A Butterworth low pass of two poles by the bilinear transform.
pub(super) fn butterworth(samples: &[f64], cutoff: f64) -> Vec<f64> {
    let k = (PI * cutoff).tan();
    let scale = 1.0 / (1.0 + 2_f64.sqrt() * k + k * k);
    let (b, a1, a2) = (
        k * k * scale,
        2.0 * (k * k - 1.0) * scale,
        (1.0 - 2_f64.sqrt() * k + k * k) * scale,
    );
    let ([mut x1, mut x2], [mut y1, mut y2]) = ([0.0; 2], [0.0; 2]);
    let step = |&x: &f64| {
        let y = b * (x + 2.0 * x1 + x2) - a1 * y1 - a2 * y2;
        (x2, x1, y2, y1) = (x1, x, y1, y);
        y
    };
    samples.iter().map(step).collect()
}

/// Flicker noise: a sum of relaxations whose times grow fourfold, from one sample on. The product of frequency and spectral
/// density is 1 / ln 4 between their corners.
pub(super) fn flicker<const POLES: usize>(samples: usize, random: &mut Random) -> Vec<f64> {
    let time = |pole: usize| 4_f64.powi(pole as i32);
    let poles: [f64; POLES] = std::array::from_fn(|pole| (-1.0 / time(pole)).exp());
    let mut states = poles.map(|_| normal(random));
    (0..samples)
        .map(|_| {
            for (state, pole) in states.iter_mut().zip(poles) {
                *state = pole * *state + (1.0 - pole * pole).sqrt() * normal(random);
            }
            states.iter().sum()
        })
        .collect()
}
