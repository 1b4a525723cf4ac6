//! The bound that the study of efficiency compares errors with, and a short run of it. The figures of the manual come
//! from `cargo xtask study efficiency`.

use allanite_host::simulate::{Coefficients, Hidden, Preset, Simulator};
use allanite_studies::{
    RATE_HZ, efficiency,
    whittle::{bounds, densities},
};
use rustfft::{FftPlanner, num_complex::Complex};
use std::f64::consts::{PI, TAU};

const INTERVAL_S: f64 = 1.0 / RATE_HZ;

/// The densities over a period add up to the variance of what has one, and differences of a walk are its steps.
#[test]
fn densities_add_up_to_variances() {
    let c = Preset::Mems.coefficients();
    const STEPS: u32 = 1 << 16;
    let mut sums = [0.0; 4];
    for k in 0..STEPS {
        let x = (f64::from(k) + 0.5) / f64::from(STEPS);
        let [quantization, white, flicker, walk] = densities(c, INTERVAL_S, x);
        // The density of second differences, whose variance every term has.
        let twice = (2.0 * (PI * x).sin()).powi(2);
        let terms = [quantization, white, flicker * twice, walk * twice];
        for (sum, term) in sums.iter_mut().zip(terms) {
            *sum += term / f64::from(STEPS);
        }
    }
    let angle = (c.quantization / INTERVAL_S).powi(2);
    // Twice the Allan variance of a sample: 2 ln 2/π of B² (IEEE Std 952-1997, annex C).
    let flicker = 2.0 * c.bias_instability.powi(2) * 2.0 * 2_f64.ln() / PI;
    let expected = [
        2.0 * angle,
        c.angle_random_walk.powi(2) / INTERVAL_S,
        flicker,
        c.rate_random_walk.powi(2) * INTERVAL_S,
    ];
    for (sum, expected) in sums.into_iter().zip(expected) {
        assert!((sum / expected - 1.0).abs() < 1e-4, "{sum} {expected}");
    }
}

/// The density of a sampled record by its periodogram, averaged over bands of frequency and many records, is that of
/// the bound.
#[test]
fn densities_are_those_of_simulated_records() {
    const SAMPLES: usize = 1 << 12;
    const RECORDS: u64 = 100;
    const BANDS: usize = 8;
    let c = Preset::Mems.coefficients();
    let transform = FftPlanner::new().plan_fft_forward(SAMPLES);
    let mut bands = [0.0; BANDS];
    for seed in 0..RECORDS {
        let rates: Vec<f64> = Simulator::new(c, RATE_HZ, seed).take(SAMPLES).collect();
        // The window keeps the walk's leakage out of the bands.
        let windowed = rates.iter().enumerate().map(|(i, rate)| {
            let window = 0.5 - 0.5 * (TAU * i as f64 / SAMPLES as f64).cos();
            Complex::new(window * (rate - rates[0]), 0.0)
        });
        let mut buffer: Vec<_> = windowed.collect();
        transform.process(&mut buffer);
        for (k, bin) in buffer.iter().enumerate().take(SAMPLES / 2).skip(8) {
            let expected: f64 = densities(c, INTERVAL_S, k as f64 / SAMPLES as f64)
                .iter()
                .sum();
            let power = bin.norm_sqr() / (0.375 * SAMPLES as f64);
            bands[k * BANDS * 2 / SAMPLES] += power / expected;
        }
    }
    for (band, sum) in bands.into_iter().enumerate() {
        let bins = SAMPLES / 2 / BANDS - if band == 0 { 8 } else { 0 };
        let ratio = sum / (bins as f64 * RECORDS as f64);
        // Of 25 000 exponential powers, of which neighbours are correlated: 5 standard errors are 5 %.
        assert!((ratio - 1.0).abs() < 0.05, "band {band}: {ratio}");
    }
}

#[test]
fn bounds_of_white_noise_and_of_a_line_are_those_of_textbooks() {
    const SAMPLES: usize = 1 << 14;
    let white = Coefficients {
        angle_random_walk: 5e-3,
        ..Coefficients::default()
    };
    let deviation = 5e-3 * RATE_HZ.sqrt();
    let line = Hidden::new("sinusoid", [7.7, 0.0], 0.4 * deviation).expect("known");
    let [q, n, b, k, amplitude, frequency, _] = bounds(white, Some(&line), SAMPLES, INTERVAL_S);
    assert!(q.is_nan() && b.is_nan() && k.is_nan());
    // The relative error of a standard deviation is 1/√(2n), and 0, f_s/2 and the record's ends count for little.
    let samples = SAMPLES as f64;
    assert!((n * (2.0 * samples).sqrt() - 1.0).abs() < 1e-3);
    // Rife & Boorstyn 1974: σ²/A² = 1/0.16.
    let ratio: f64 = 1.0 / 0.16;
    assert!((amplitude / (2.0 * ratio / samples).sqrt() - 1.0).abs() < 1e-9);
    let error_hz = (24.0 * ratio / samples.powi(3)).sqrt() / TAU * RATE_HZ;
    assert!((7.7 * frequency / error_hz - 1.0).abs() < 1e-9);
}

/// A Gauss–Markov process and a low pass have densities in closed form.
#[test]
fn bounds_of_effects_follow_closed_forms() {
    const SAMPLES: usize = 1 << 14;
    let white = Coefficients {
        angle_random_walk: 5e-3,
        ..Coefficients::default()
    };
    let filter = Hidden::new("low_pass", [0.02, 1.0], 5e-3).expect("known");
    let [_, n, .., time_constant, poles] = bounds(white, Some(&filter), SAMPLES, INTERVAL_S);
    assert!(poles.is_nan());
    // S = N²/τ₀ (1 − z)²/|1 − z e^(iω)|² with z = e^(−τ₀/T); Fisher's matrix of ln N and ln T.
    let log_density = |time_constant: f64, x: f64| {
        let z = (-INTERVAL_S / time_constant).exp();
        let denominator = 1.0 + z * z - 2.0 * z * (TAU * x).cos();
        ((1.0 - z).powi(2) / denominator).ln()
    };
    let [mut own, mut both, mut other] = [0.0; 3];
    for k in 1..SAMPLES / 2 {
        let x = k as f64 / SAMPLES as f64;
        let [above, below] = [1.0 + 1e-5, 1.0 - 1e-5].map(|factor| log_density(0.02 * factor, x));
        let derivative = (above - below) / 2e-5;
        own += 4.0;
        both += 2.0 * derivative;
        other += derivative * derivative;
    }
    let determinant = own * other - both * both;
    assert!((n / (other / determinant).sqrt() - 1.0).abs() < 1e-3);
    assert!((time_constant / (own / determinant).sqrt() - 1.0).abs() < 1e-3);
}

/// The smallest errors of the MEMS gyro are those that `host-tests/doc/studies/coefficients.md` compares with.
#[test]
fn a_record_of_22_minutes_gives_the_bounds_of_the_manual() {
    let bounds = bounds(Preset::Mems.coefficients(), None, 1 << 17, INTERVAL_S);
    for (bound, percent) in bounds.into_iter().zip([1.2, 0.41, 5.1]) {
        assert!((100.0 * bound / percent - 1.0).abs() < 0.02, "{bound}");
    }
}

/// In 40 records, an error scatters by 11 %.
#[test]
fn octaves_keep_nearly_all_information() {
    let rows = efficiency::coefficients(Preset::Mems, 1 << 14, 40);
    for row in rows.iter().filter(|row| row.bound < 0.3) {
        let [octaves, with_spectrum, ..] = row.errors[..] else {
            panic!("{row:?}");
        };
        for error in [octaves, with_spectrum] {
            assert_eq!(error.records, 40);
            let ratio = error.rms / row.bound;
            assert!((0.6..1.5).contains(&ratio), "{row:?}");
            assert!((0.05..0.25).contains(&(error.standard_error / error.rms)));
        }
    }
}
