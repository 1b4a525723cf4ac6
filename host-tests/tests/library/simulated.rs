//! Compares the integer gyro with the Allan variance of each of its terms.

use allanite::{Accumulator, Scale};
use demonstration::simulated::{Amplitudes, SimulatedGyro};

const SILENT: Amplitudes = Amplitudes {
    quantization: 0,
    white: 0,
    flicker: 0,
    walk: 0,
    ramp: 0,
};

const COUNT: u32 = 1 << 24;

/// The number of octaves that are compared. Each record has the length of 64 clusters of the
/// longest octave.
const OCTAVES: usize = 12;
const SAMPLES: usize = 1 << 17;

/// The Allan variances in counts², averaged over many records.
fn variances(amplitudes: Amplitudes, records: u64) -> Vec<f64> {
    let scale = Scale::new(1.0, 1.0).unwrap();
    let mut sums = Accumulator::<OCTAVES>::new();
    for seed in 0..records {
        let counts: Vec<i32> = SimulatedGyro::new(amplitudes, seed).take(SAMPLES).collect();
        sums.push_slice(&counts);
        sums.gap();
    }
    let curve = sums.curve(scale);
    curve.points().iter().map(|point| point.variance).collect()
}

/// The quantization that every record has from rounding alone.
fn rounding(m: f64) -> f64 {
    3.0 / 12.0 / (m * m)
}

#[track_caller]
fn assert_close(measured: &[f64], expected: impl Fn(f64) -> f64, tolerance: f64, first: usize) {
    assert_eq!(measured.len(), OCTAVES);
    for (k, &variance) in measured.iter().enumerate().skip(first) {
        let m = f64::from(1 << k);
        let ratio = variance / expected(m);
        assert!((ratio - 1.0).abs() < tolerance, "m = {m}: {ratio}");
    }
}

#[test]
fn quantization_falls_with_the_square_of_time() {
    let quantization = Amplitudes {
        quantization: 3 * COUNT,
        ..SILENT
    };
    let expected = |m: f64| 3.0 * 9.0 / (m * m) + rounding(m);
    assert_close(&variances(quantization, 40), expected, 0.04, 0);
}

#[test]
fn white_noise_falls_with_time() {
    let white = Amplitudes {
        white: 20 * COUNT,
        ..SILENT
    };
    let expected = |m: f64| 400.0 / m + rounding(m);
    assert_close(&variances(white, 60), expected, 0.03, 0);
}

#[test]
fn flicker_noise_is_flat() {
    let flicker = Amplitudes {
        flicker: 20 * COUNT,
        ..SILENT
    };
    let [.., bias_instability, _, _] = flicker.coefficients(Scale::new(1.0, 1.0).unwrap());
    let flat = 2.0 * std::f64::consts::LN_2 / std::f64::consts::PI;
    let expected = |_| flat * bias_instability * bias_instability;
    assert_close(&variances(flicker, 100), expected, 0.05, 3);
}

#[test]
fn a_random_walk_rises_with_time() {
    let walk = Amplitudes {
        walk: 2 * COUNT,
        ..SILENT
    };
    // The variance of a walk with one step per sample is K²τ₀ (2m² + 1)/6m.
    let expected = |m: f64| 4.0 * (2.0 * m * m + 1.0) / (6.0 * m) + rounding(m);
    assert_close(&variances(walk, 100), expected, 0.05, 0);
}

#[test]
fn a_ramp_rises_with_the_square_of_time() {
    let ramp = Amplitudes {
        ramp: 1 << 22,
        ..SILENT
    };
    let expected = |m: f64| m * m / 32.0;
    assert_close(&variances(ramp, 1), expected, 0.001, 7);
}

#[test]
fn counts_are_the_same_on_every_machine() {
    let all = Amplitudes {
        quantization: 3 * COUNT,
        white: 100 * COUNT,
        flicker: 10 * COUNT,
        walk: COUNT,
        ramp: 1 << 20,
    };
    let counts: Vec<i32> = SimulatedGyro::new(all, 1).take(5).collect();
    assert_eq!(counts, [-168, 39, -78, -189, 56]);
}

#[test]
fn zero_amplitudes_give_zero_and_other_seeds_other_counts() {
    assert!(
        SimulatedGyro::new(SILENT, 3)
            .take(100)
            .all(|count| count == 0)
    );
    let white = Amplitudes {
        white: 20 * COUNT,
        ..SILENT
    };
    let record = |seed| SimulatedGyro::new(white, seed).take(10).collect::<Vec<_>>();
    assert_eq!(record(1), record(1));
    assert_ne!(record(1), record(2));
}
