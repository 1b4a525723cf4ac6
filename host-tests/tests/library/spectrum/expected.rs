//! The expected density of every effect of the catalogue against the mean of simulated records.

use super::records::{Records, mean};
use allanite::effect::{CATALOGUE, EXPLAINED};
use rayon::prelude::*;

const RECORDS: usize = 240;

/// The number of Monte-Carlo standard errors that a bin may be off. There are about 1000 bins.
const MOST: f64 = 4.5;

/// The share of its density that a bin may be off in addition. A sinusoid has the same density in every record
/// but for its phase.
const ROUNDING: f64 = 1e-4;

/// The share of the level's largest density that a bin may be off in addition: the sums are in single precision.
const SINGLE: f64 = 1e-6;

#[test]
fn densities_of_every_effect_are_those_of_simulated_records() {
    let shapes = EXPLAINED.iter().zip(CATALOGUE);
    let shapes = shapes.flat_map(|(explained, effect)| {
        let shapes = explained.typical_shapes().iter();
        shapes.map(move |&parameters| (effect, parameters))
    });
    let shapes: Vec<_> = shapes.collect();
    let failures: Vec<String> = shapes
        .par_iter()
        .flat_map_iter(|&(effect, parameters)| {
            let mut records = Records::new(effect, parameters);
            let (expected, bins) = records.expected();
            let found = records.densities(RECORDS);
            let all = expected.clone();
            let off = move |(place, expected): (usize, f64)| {
                let of = || found.iter().map(|densities| densities[place]);
                let mean_density = mean(of());
                let variance = mean(of().map(|density| (density - mean_density).powi(2)));
                let error = (variance / RECORDS as f64).sqrt();
                let off = mean_density - expected;
                let level = bins.iter().zip(&all).filter(|(bin, _)| bin.block == bins[place].block);
                let largest = level.map(|(_, density)| *density).fold(0.0, f64::max);
                let (block, index) = (bins[place].block, bins[place].index);
                (off.abs() > MOST * error + ROUNDING * expected + SINGLE * largest).then(|| {
                    format!(
                        "{} {parameters:?}, block {block}, bin {index}: {:.4} of {expected:e}, {:.1} errors",
                        effect.name(),
                        off / expected,
                        off / error
                    )
                })
            };
            let failures: Vec<String> = expected.into_iter().enumerate().filter_map(off).collect();
            failures
        })
        .collect();
    assert!(shapes.len() >= CATALOGUE.len());
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
