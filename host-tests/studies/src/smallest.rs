//! Studies the smallest effects that are found, beside those that the whole periodogram would show.

use super::{
    RATE_HZ, measured::Measured, periodogram::Periodogram, said::Said, slow::LIMIT, whittle,
};
use allanite_host::simulate::{Coefficients, Hidden, Preset, Random, Simulator};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

/// The number of samples of a record, which is 22 minutes long.
const SAMPLES: usize = 1 << 17;

/// The multiples of the ideal size that are hidden.
pub const FACTORS: [f64; 5] = [1.0, 1.25, 1.6, 2.0, 3.0];

/// The effects, each with the ranges from which its shape is drawn. Of a filter, the first one is found.
pub const KINDS: [(&str, [(f64, f64); 2]); 4] = [
    ("sinusoid", [(0.5, 45.0), (1.0, 1.0)]),
    ("resonance", [(0.5, 40.0), (2.0, 20.0)]),
    ("gauss_markov", [(0.3, 30.0), (1.0, 1.0)]),
    ("digital_low_pass", [(0.002, 0.05), (2.0, 2.0)]),
];

/// Counts how many records tell an effect of each of the [`FACTORS`], and returns the number of records. Shapes that five
/// terms imitate at any size have no ideal size.
pub fn study(
    kind: (&'static str, [(f64, f64); 2]),
    records: u64,
) -> (usize, [usize; FACTORS.len()]) {
    let told: Vec<[bool; FACTORS.len()]> = (0..records)
        .into_par_iter()
        .filter_map(|seed| {
            let mut random = Random::seed_from_u64(seed ^ 0x736d_616c);
            let preset = [Preset::Mems, Preset::Fog][usize::from(seed % 2 == 1)];
            let base = preset.coefficients();
            let shape = kind
                .1
                .map(|(low, high): (f64, f64)| low * (high / low).powf(random.random::<f64>()));
            let ideal = ideal(kind.0, shape, base)?;
            Some(FACTORS.map(|factor| {
                let hidden = [with_size(kind.0, shape, base, factor * ideal)];
                let mut simulator = Simulator::with_hidden(base, &hidden, RATE_HZ, seed);
                let said = Said::of(&Measured::of(&mut simulator, base, SAMPLES));
                said.compared(&[kind.0]).among
            }))
        })
        .collect();
    let counts = std::array::from_fn(|i| told.iter().filter(|told| told[i]).count());
    (told.len(), counts)
}

/// An effect of this size: that of a filter is its time constant, and that of any other one its coefficient.
fn with_size(name: &str, shape: [f64; 2], base: Coefficients, size: f64) -> Hidden {
    let mut hidden = Hidden::new(name, shape, base.angle_random_walk).expect("of the catalogue");
    if hidden.replaces_white_noise() {
        hidden.parameters[0] = size;
    } else {
        hidden.coefficient = size;
    }
    hidden
}

/// The size that a test of the whole periodogram which knows the shape finds in half of the records, if it errs in one of 200
/// clean ones.
fn ideal(name: &str, shape: [f64; 2], base: Coefficients) -> Option<f64> {
    let at = |size: f64| with_size(name, shape, base, size);
    if whittle::is_line(&at(1.0), 1.0 / RATE_HZ) {
        // An ordinate of the periodogram exceeds ln 200 times its mean in one of 200 clean records, and that of a line is
        // larger than the mean by the factor A² n/4S.
        let x = shape[0] / RATE_HZ;
        let density: f64 = whittle::densities(base, 1.0 / RATE_HZ, x).iter().sum();
        return Some((4.0 * 200_f64.ln() * density / SAMPLES as f64).sqrt());
    }
    let white = base.angle_random_walk * RATE_HZ.sqrt();
    let is_filter = at(1.0).replaces_white_noise();
    let (mut low, mut high) = if is_filter {
        (0.36 / RATE_HZ, 30.0 / RATE_HZ)
    } else {
        (1e-6 * white, 30.0 * white)
    };
    let fall = |size: f64| {
        let grid = whittle::Density::new(&at(size), 1.0 / RATE_HZ);
        let lost = if is_filter { white * white } else { 0.0 };
        Periodogram::new(base, SAMPLES, &|x| grid.at(x) - lost).ratio(1.0)
    };
    if fall(high) < LIMIT {
        return None;
    }
    for _ in 0..25 {
        let middle = (low * high).sqrt();
        if fall(middle) < LIMIT {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(high)
}
