//! Spectra of records with filled gaps against those of the same records without gaps.

extern crate std;

use super::super::{Bin, Spectrum, SpectrumAccumulator};
use crate::{Accumulator, Scale, numerics::real::double};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus as Random;
use std::vec::Vec;

const SAMPLES: usize = 1 << 18;

/// What a record is made of.
type Noise = fn(&mut Random, &mut [f64; 2]) -> f64;

fn white(random: &mut Random, _: &mut [f64; 2]) -> f64 {
    (0..4).map(|_| random.random_range(-500.0..500.0)).sum()
}

/// White noise and its differences, ten times as strong.
fn blue(random: &mut Random, state: &mut [f64; 2]) -> f64 {
    let before = state[0];
    state[0] = 10.0 * white(random, &mut [0.0; 2]);
    state[0] - before + white(random, &mut [0.0; 2])
}

/// White noise and a random walk that is as strong at a period of 600 samples.
fn walking(random: &mut Random, state: &mut [f64; 2]) -> f64 {
    state[0] += 0.01 * white(random, &mut [0.0; 2]);
    state[0] + white(random, &mut [0.0; 2])
}

/// Noise behind a low pass of some five samples, and a line.
fn smooth(random: &mut Random, state: &mut [f64; 2]) -> f64 {
    state[0] += 0.2 * (white(random, &mut [0.0; 2]) - state[0]);
    state[1] += 0.04;
    state[0] + 0.1 * white(random, &mut [0.0; 2]) + 100.0 * libm::sin(state[1])
}

/// The spectra of a record without losses and with them, filled.
fn both(noise: Noise, share: f64, length: u64, seed: u64) -> [Spectrum<140>; 2] {
    let mut random = Random::seed_from_u64(seed);
    let mut losses = Random::seed_from_u64(seed ^ 0x10_55);
    let mut accumulator = Accumulator::<16>::new();
    let mut sums = [(); 2].map(|()| SpectrumAccumulator::<64, 5>::new());
    let (mut state, mut left) = ([0.0; 2], 0);
    for _ in 0..SAMPLES {
        let count = libm::round(noise(&mut random, &mut state)) as i32;
        sums[0].push_slice(&[count]);
        if left == 0 && losses.random_bool(share / length as f64) {
            left = length;
            match accumulator.filling(length) {
                Some(filling) => filling.for_each(|count| sums[1].push_slice(&[count])),
                None => sums[1].gap(),
            }
            accumulator.lost(length);
        }
        if left > 0 {
            left -= 1;
            continue;
        }
        accumulator.push(count);
        sums[1].push_slice(&[count]);
    }
    let scale = Scale::new(1.0, 100.0).unwrap();
    let [whole, filled] = sums.map(|sums| sums.spectrum(scale));
    [
        whole,
        filled.without_bridges(accumulator.bridged(), accumulator.samples()),
    ]
}

/// The mean and the root mean square, over the bins of a level in many records, of what losses change in a density,
/// relative to the standard error of the density.
fn changes(pairs: &[[Spectrum<140>; 2]], block: u32) -> [f64; 2] {
    let (mut sum, mut squares, mut number) = (0.0, 0.0, 0.0);
    let bins = |spectrum: &Spectrum<140>| -> Vec<Bin> {
        let own = spectrum.all().iter().filter(|bin| bin.block == block);
        own.copied().collect()
    };
    for [whole, filled] in pairs {
        let (whole, filled) = (bins(whole), bins(filled));
        for (whole, filled) in whole.iter().zip(&filled) {
            let error = double(whole.density) / double(filled.effective_segments()).sqrt();
            let change = double(filled.density - whole.density) / error;
            sum += change;
            squares += change * change;
            number += 1.0;
        }
    }
    [sum / number, (squares / number).sqrt()]
}

/// As taken for gaps, losses of 5 % would leave no segment of 64 blocks of 64 samples.
#[test]
fn filled_gaps_leave_the_densities_of_every_level() {
    let noises: [(&str, Noise); 4] = [
        ("white", white),
        ("blue", blue),
        ("walking", walking),
        ("smooth", smooth),
    ];
    for (name, noise) in noises {
        for (share, length) in [(0.001, 1), (0.01, 1), (0.05, 1), (0.01, 3), (0.02, 20)] {
            let pairs: Vec<_> = (0..4)
                .map(|seed| both(noise, share, length, seed))
                .collect();
            let is_much = share > 0.02;
            for block in [1, 8, 64, 512] {
                let [mean, scatter] = changes(&pairs, block);
                if mean.is_nan() {
                    // Ten times as much as is left would be taken off.
                    assert!(is_much && name == "blue" && block == 512, "{name}, {share}");
                    continue;
                }
                let (most, most_scatter) = if is_much { (1.0, 1.6) } else { (0.65, 1.15) };
                assert!(
                    mean.abs() < most && scatter < most_scatter,
                    "{name}, {share} in {length}, block {block}: {mean} {scatter}"
                );
            }
        }
    }
}
