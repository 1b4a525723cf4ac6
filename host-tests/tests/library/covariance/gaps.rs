//! Compares the covariance of the curve of a record with gaps with the sum over every pair of differences.

use super::{FLICKER, INTERVAL_S, MEMS, OCTAVES, Octave, Pairs, WHITE, covariance, kernel};
use allanite::{Curve, Model, fit::curve_covariance};

/// The distance of the first samples of two stretches. What is left of the noise in common is small.
const APART: usize = 4096;

/// Differences within stretches of these lengths. Blocks begin with a stretch, as those of the accumulator.
fn octaves(lengths: &[usize]) -> Vec<Octave> {
    let octave = |k: u32| {
        let m = 1_usize << k;
        let starts = lengths.iter().enumerate().flat_map(|(i, &length)| {
            let last = length.checked_sub(2 * m);
            let within = last
                .into_iter()
                .flat_map(move |last| (0..=last).step_by((m / 4).max(1)));
            within.map(move |start| i * APART + start)
        });
        Octave {
            m,
            starts: starts.collect(),
        }
    };
    let octaves = (0..OCTAVES as u32).map(octave);
    octaves
        .take_while(|octave| octave.starts.len() >= 6)
        .collect()
}

/// The number of differences a stretch from which on the lengths of single stretches do not matter.
const MANY: u64 = 15;

/// The largest errors of a covariance of two octaves, relative to the standard errors of both: of octaves with many
/// differences a stretch, and of all others.
fn worst(lengths: &[usize]) -> [f64; 2] {
    let octaves = octaves(lengths);
    let points = octaves
        .iter()
        .map(|octave| (octave.m as u32, octave.starts.len() as u64, 1.0));
    let curve = Curve::<OCTAVES>::new(1.0 / INTERVAL_S, points).expect("possible");
    let mut worst = [0.0_f64; 2];
    for squares in [WHITE, FLICKER, MEMS] {
        let kernel = kernel(&squares, (lengths.len() + 1) * APART);
        let found = curve_covariance(&curve, &Model::ieee_952(), &squares);
        let exact = |j: usize, k: usize| {
            let (short, long) = (&octaves[j], &octaves[k]);
            covariance(short, long, &Pairs::new(short, long), &kernel, 0.0)
        };
        for j in 0..octaves.len() {
            for k in j..octaves.len().min(j + 3) {
                let unit = (exact(j, j) * exact(k, k)).sqrt();
                let error = (found[(j, k)] - exact(j, k)) / unit;
                let point = &curve.points()[k];
                let few = point.differences < MANY * u64::from(point.stretches);
                let worst = &mut worst[usize::from(few)];
                *worst = worst.max(error.abs());
            }
        }
    }
    worst
}

#[test]
fn stretches_of_one_length_scatter_as_the_pairs_within_them_say() {
    for length in [40, 100, 333] {
        let [many, few] = worst(&[length; 20]);
        println!("{length} samples: {many:.3}, {few:.3}");
        assert!(many < 0.01, "{length} samples: {many}");
        assert!(few < 0.1, "{length} samples: {few}");
    }
}

/// The stretches that have differences of an octave count as equally long, which matters where they hardly have any.
#[test]
fn stretches_of_many_lengths_scatter_as_the_pairs_within_them_say() {
    let lengths: Vec<usize> = (0..25).map(|i| 20 + 37 * i * i % 701).collect();
    let [many, few] = worst(&lengths);
    println!("{many:.3}, {few:.3}");
    assert!(many < 0.01, "{many}");
    assert!(few < 0.17, "{few}");
}
