//! The expected densities of every effect against sums over single samples in double precision.

use super::{PI, std, std::vec::Vec, window};
use crate::{
    numerics::real::{by_precision, double, real},
    spectrum::expected_densities,
    theory::effect::{
        Behind, CATALOGUE, DriftingResonance, DriftingSinusoid, Effect, MAX_PARAMETERS,
        MovingAverage, OutputLowPass, Quantization, Resonance, SampledShape, Sinusoid,
    },
};

const INTERVAL_S: f64 = 0.01;

/// The semivariogram of single samples at a distance of `n`, for a coefficient of one.
fn single(name: &str, [first, second, third]: [f64; 3], n: f64) -> f64 {
    if n == 0.0 {
        return 0.0;
    }
    let t = INTERVAL_S;
    let decay = |time_s: f64| -libm::expm1(-n * t / time_s);
    match name {
        "quantization" => (if n == 1.0 { 3.0 } else { 2.0 }) / (t * t),
        "angle_random_walk" => 1.0 / t,
        "bias_instability" => {
            let h = |x: f64| if x == 0.0 { 0.0 } else { x * x * libm::log(x) };
            (h(n + 1.0) - 2.0 * h(n) + h(n - 1.0)) / (2.0 * PI)
        }
        "rate_random_walk" => 0.5 * n * t,
        "gauss_markov" | "random_telegraph" => decay(first),
        "resonance" => {
            let time_s = second / (PI * first);
            // 1 − e^(−x) cos y = (1 − e^(−x)) + 2 e^(−x) sin²(y/2)
            let sine = libm::sin(PI * first * n * t);
            decay(time_s) + 2.0 * libm::exp(-n * t / time_s) * sine * sine
        }
        "low_pass" if second < 1.5 => {
            let z = libm::exp(-t / first);
            (1.0 - z) / ((1.0 + z) * t) * decay(first)
        }
        "low_pass" => {
            // The sum over the poles of the filter, at which 1 + ω^(2·poles) is zero.
            let poles = second as u32;
            let covariance = |n: f64| {
                let pole = |k: u32| {
                    let angle = PI * (2.0 * f64::from(k) + 1.0) / (2.0 * f64::from(poles));
                    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
                    let (decay, turn) = (n * t / first * sine, n * t / first * cosine);
                    libm::exp(-decay) * (sine * libm::cos(turn) + cosine * libm::sin(turn))
                };
                (0..poles).map(pole).sum::<f64>()
            };
            // The slowest pole has fallen to e⁻²³.
            let far = (60.0 * first / t) as i32;
            let sum: f64 = (-far..=far).map(|i| covariance(f64::from(i).abs())).sum();
            (covariance(0.0) - covariance(n)) / (sum * t)
        }
        "decimation_filter" => {
            let width = first / (t * libm::sqrt(second));
            let spline = |x: f64| match second {
                1.0 => (1.0 - x).max(0.0),
                _ if x < 1.0 => 2.0 / 3.0 - x * x + 0.5 * x * x * x,
                _ => libm::pow((2.0 - x).max(0.0), 3.0) / 6.0,
            };
            let sum: f64 = (-200..=200)
                .map(|i| spline(f64::from(i).abs() / width))
                .sum();
            (spline(0.0) - spline(n / width)) / (sum * t)
        }
        "drifting_resonance" => {
            let time_s = second / (PI * first);
            fallen(libm::exp(-n * t / time_s), first, third, n * t)
        }
        "drifting_sinusoid" => 0.5 * fallen(1.0, first, second, n * t),
        "power_law" => {
            let growth = first - 1.0;
            let h = |x: f64| libm::pow(x, 2.0 + growth);
            let unit = libm::pow(t, growth) / (4.0 * (libm::pow(2.0, growth) - 1.0));
            unit * (h(n + 1.0) - 2.0 * h(n) + h(n - 1.0) - 2.0)
        }
        _ => panic!("{name} is not known here"),
    }
}

/// One less the autocovariance of an oscillation whose frequency drifts.
fn fallen(decay: f64, frequency_hz: f64, drift_hz: f64, time_s: f64) -> f64 {
    let kappa = PI * drift_hz * time_s;
    1.0 - decay * libm::cos(2.0 * PI * frequency_hz * time_s) * libm::sin(kappa) / kappa
}

/// The autocovariance of the samples of a filter's output, up to a lag behind which there is nothing; `None` for an effect that is
/// no digital filter.
fn filtered(name: &str, [first, second, _]: [f64; 3]) -> Option<Vec<f64>> {
    if name == "mode_split" {
        return Some(mode_split(first, second));
    }
    let response = match name {
        "notch" => notch(first, second),
        "digital_low_pass" | "output_low_pass" => digital_low_pass(first, second),
        "moving_average" => averaged(first),
        // The rate is the difference of neighbouring angles.
        "quantization behind output_low_pass" => differences(&digital_low_pass(first, second)),
        "quantization behind moving_average" => differences(&averaged(first)),
        "cascade" => cascade(first, second),
        "high_pass" => high_pass(first),
        _ => return None,
    };
    let at = |l: usize| -> f64 {
        let pairs = response.iter().zip(&response[l..]);
        pairs.map(|(one, other)| one * other).sum::<f64>() / INTERVAL_S
    };
    Some((0..response.len()).map(at).collect())
}

/// The impulse response of a mean over some samples, with zeros behind it.
fn averaged(samples: f64) -> Vec<f64> {
    let mut response = std::vec![0.0; 100];
    response[..samples as usize].fill(1.0 / samples);
    response
}

/// The rates of a sequence of angles, in the unit in which [`filtered`] takes the rates that follow white noise.
fn differences(angles: &[f64]) -> Vec<f64> {
    let unit = 1.0 / libm::sqrt(INTERVAL_S);
    let before = [0.0].iter().chain(angles);
    let last = [0.0];
    let angles = angles.iter().chain(&last);
    angles
        .zip(before)
        .map(|(now, before)| (now - before) * unit)
        .collect()
}

/// The impulse response of `y_n = Σ b_k x_(n−k) − Σ a_k y_(n−k)` with `k` from 0 and from 1, applied to an input.
fn recursion(input: &[f64], b: [f64; 3], a: [f64; 2]) -> Vec<f64> {
    let mut output = Vec::new();
    for i in 0..input.len() {
        let before = |values: &[f64], k: usize| i.checked_sub(k).map_or(0.0, |i| values[i]);
        let forward: f64 = (0..3).map(|k| b[k] * before(input, k)).sum();
        let back: f64 = (1..3).map(|k| a[k - 1] * before(&output, k)).sum();
        output.push(forward - back);
    }
    output
}

/// An impulse, and so many zeros behind it as a filter of this time constant needs to forget it.
fn impulse(time_s: f64) -> Vec<f64> {
    let mut impulse = std::vec![0.0; 400 + (100.0 * time_s / INTERVAL_S) as usize];
    impulse[0] = 1.0;
    impulse
}

/// The impulse response of a bilinear Butterworth filter, by sections of first and second order.
fn digital_low_pass(time_s: f64, poles: f64) -> Vec<f64> {
    let w = libm::tan(0.5 * INTERVAL_S / time_s);
    let mut response = impulse(time_s);
    for k in 0..poles as u32 / 2 {
        // 1/(s² + 2 d s + 1) with s = (1 − B)/(1 + B)/w.
        let d = libm::sin(PI * (2.0 * f64::from(k) + 1.0) / (2.0 * poles));
        let unit = 1.0 + 2.0 * d * w + w * w;
        let gain = w * w / unit;
        let a = [
            2.0 * (w * w - 1.0) / unit,
            (1.0 - 2.0 * d * w + w * w) / unit,
        ];
        response = recursion(&response, [gain, 2.0 * gain, gain], a);
    }
    if poles as u32 % 2 == 1 {
        let gain = w / (1.0 + w);
        response = recursion(&response, [gain, gain, 0.0], [(w - 1.0) / (1.0 + w), 0.0]);
    }
    response
}

/// The impulse response of equal smoothing filters in series.
fn cascade(time_s: f64, stages: f64) -> Vec<f64> {
    let z = libm::exp(-INTERVAL_S / time_s);
    let mut response = impulse(time_s);
    for _ in 0..stages as u32 {
        response = recursion(&response, [1.0 - z, 0.0, 0.0], [-z, 0.0]);
    }
    response
}

/// The impulse response of a high pass.
fn high_pass(time_s: f64) -> Vec<f64> {
    let z = libm::exp(-INTERVAL_S / time_s);
    let b = libm::sqrt(z);
    recursion(&impulse(time_s), [b, -b, 0.0], [-z, 0.0])
}

/// The autocovariance of rising white noise, from its density with all aliases.
fn mode_split(rise_hz: f64, corner_hz: f64) -> Vec<f64> {
    const ALIASES: i32 = 2000;
    const GRID: i32 = 1024;
    let density = |hz: f64| {
        let (rise, corner) = (hz / rise_hz, hz / corner_hz);
        (1.0 + rise * rise) / (1.0 + corner * corner * corner * corner)
    };
    let sampled = |i: i32| {
        let cycles = f64::from(i) / f64::from(GRID);
        let near = (-ALIASES..=ALIASES).map(|k| density((cycles + f64::from(k)) / INTERVAL_S));
        // Far up, the density falls with the square of the frequency.
        let square = corner_hz * corner_hz * INTERVAL_S / rise_hz;
        let end = f64::from(ALIASES) + 0.5;
        near.sum::<f64>() + square * square * (1.0 / (end - cycles) + 1.0 / (end + cycles))
    };
    let densities: Vec<f64> = (0..GRID).map(sampled).collect();
    let unit = 1.0 / (densities[0] * f64::from(GRID) * INTERVAL_S);
    let at = |lag: i32| {
        let waves = (0..GRID).map(|i| {
            let turns = f64::from(i * lag % GRID) / f64::from(GRID);
            densities[i as usize] * libm::cos(2.0 * PI * turns)
        });
        unit * waves.sum::<f64>()
    };
    (0..GRID / 4).map(at).collect()
}

/// The impulse response of a notch filter, by its difference equation.
fn notch(frequency_hz: f64, quality: f64) -> Vec<f64> {
    let turn = 2.0 * PI * frequency_hz * INTERVAL_S;
    let tangent = libm::tan(turn / (2.0 * quality)).min(0.95 * libm::sin(turn));
    let gain = 1.0 / (1.0 + tangent);
    let cosine = libm::cos(turn);
    let (mut inputs, mut outputs) = ([0.0; 2], [0.0; 2]);
    let output = |i: usize| {
        let input = if i == 0 { 1.0 } else { 0.0 };
        let forward = input - 2.0 * cosine * inputs[0] + inputs[1];
        let output =
            gain * forward + 2.0 * gain * cosine * outputs[0] - (2.0 * gain - 1.0) * outputs[1];
        inputs = [input, inputs[0]];
        outputs = [output, outputs[0]];
        output
    };
    (0..800).map(output).collect()
}

/// The semivariogram of block means, at every distance below `length` blocks.
fn of_means(single: impl Fn(f64) -> f64, length: usize, block: usize) -> Vec<f64> {
    let all: Vec<f64> = (0..=length * block).map(|n| single(n as f64)).collect();
    let m = block as isize;
    let at = |l: usize| {
        let terms = (1 - m..m).map(|d| {
            let far = (l as isize * m + d).unsigned_abs();
            (m - d.abs()) as f64 * (all[far] - all[d.unsigned_abs()])
        });
        terms.sum::<f64>() / (m * m) as f64
    };
    (0..length).map(at).collect()
}

/// The expected densities, from sums over the window.
fn direct(name: &str, parameters: [f64; MAX_PARAMETERS], length: usize, block: usize) -> Vec<f64> {
    let rate_hz = 1.0 / (INTERVAL_S * block as f64);
    let mean = |rate: &dyn Fn(f64) -> f64, j: usize| {
        let samples = (0..block).map(|i| rate((j * block + i) as f64 * INTERVAL_S));
        samples.sum::<f64>() / block as f64
    };
    match name {
        "rate_ramp" => {
            let ramp: Vec<f64> = (0..length).map(|j| mean(&|t| t, j)).collect();
            super::densities(&ramp, rate_hz)
        }
        "sinusoid" => {
            // Two phases, a quarter of a turn apart, have the mean over all phases.
            let of = |phase: f64| {
                let sine = |t: f64| libm::sin(2.0 * PI * parameters[0] * t + phase);
                let means: Vec<f64> = (0..length).map(|j| mean(&sine, j)).collect();
                super::densities(&means, rate_hz)
            };
            let both = of(0.0).into_iter().zip(of(0.5 * PI));
            both.map(|(one, other)| 0.5 * (one + other)).collect()
        }
        _ => {
            let covariance = filtered(name, parameters);
            let single = |n: f64| match &covariance {
                Some(covariance) => {
                    covariance[0] - covariance.get(n as usize).copied().unwrap_or(0.0)
                }
                None => single(name, parameters, n),
            };
            let variogram = of_means(single, length, block);
            let weights = window(length);
            let squares: f64 = weights.iter().map(|w| w * w).sum();
            let overlap = |l: usize| -> f64 {
                weights
                    .iter()
                    .zip(&weights[l..])
                    .map(|(one, other)| one * other)
                    .sum()
            };
            let terms: Vec<f64> = (0..length).map(|l| variogram[l] * overlap(l)).collect();
            let one = |k: usize| {
                let turns = |l: usize| ((k * l) % length) as f64 / length as f64;
                let sum: f64 = (1..length)
                    .map(|l| terms[l] * libm::cos(2.0 * PI * turns(l)))
                    .sum();
                -4.0 * sum / (rate_hz * squares)
            };
            (length / 16..length / 2).map(one).collect()
        }
    }
}

/// The typical shapes, and slow ones whose rate hardly changes within a segment.
fn shapes(name: &str) -> &'static [[f64; MAX_PARAMETERS]] {
    match name {
        "gauss_markov" | "random_telegraph" => &[
            [0.1, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [30.0, 0.0, 0.0],
            [1e4, 0.0, 0.0],
        ],
        "sinusoid" => &[
            [0.3, 0.0, 0.0],
            [7.7, 0.0, 0.0],
            [33.0, 0.0, 0.0],
            [0.01, 0.0, 0.0],
            [81.0, 0.0, 0.0],
        ],
        "resonance" => &[[3.0, 3.0, 0.0], [20.0, 20.0, 0.0], [0.05, 3.0, 0.0]],
        "low_pass" => &[
            [0.02, 1.0, 0.0],
            [0.5, 1.0, 0.0],
            [0.008, 2.0, 0.0],
            [0.02, 3.0, 0.0],
            [0.012, 4.0, 0.0],
            [0.006, 4.0, 0.0],
        ],
        "notch" => &[
            [20.0, 2.0, 0.0],
            [8.0, 4.0, 0.0],
            [33.0, 1.5, 0.0],
            [3.0, 3.0, 0.0],
        ],
        "decimation_filter" => &[[0.03, 1.0, 0.0], [0.03, 2.0, 0.0], [0.1, 2.0, 0.0]],
        "power_law" => &[
            [0.7, 0.0, 0.0],
            [1.3, 0.0, 0.0],
            [1.5, 0.0, 0.0],
            [1.9, 0.0, 0.0],
        ],
        "moving_average" => &[[2.0, 0.0, 0.0], [5.0, 0.0, 0.0], [16.0, 0.0, 0.0]],
        "digital_low_pass" | "output_low_pass" => &[
            [0.02, 1.0, 0.0],
            [0.0045, 1.0, 0.0],
            [0.006_366, 1.0, 0.0],
            [0.53, 2.0, 0.0],
            [0.008, 2.0, 0.0],
            [0.006, 3.0, 0.0],
            [0.006_366, 3.0, 0.0],
            [0.1, 3.0, 0.0],
            [0.012, 4.0, 0.0],
            [0.2, 4.0, 0.0],
            [0.0036, 4.0, 0.0],
        ],
        "cascade" => &[
            [0.0025, 2.0, 0.0],
            [0.01, 2.0, 0.0],
            [0.2, 2.0, 0.0],
            [0.02, 3.0, 0.0],
            [0.3, 3.0, 0.0],
            [0.003, 4.0, 0.0],
            [0.015, 4.0, 0.0],
            [0.1, 4.0, 0.0],
        ],
        "mode_split" => &[
            [10.0, 30.0, 0.0],
            [5.0, 60.0, 0.0],
            [1.0, 5.0, 0.0],
            [1.0, 100.0, 0.0],
            [30.0, 30.0, 0.0],
        ],
        "high_pass" => &[[0.02, 0.0, 0.0], [0.1, 0.0, 0.0], [0.5, 0.0, 0.0]],
        "drifting_resonance" => &[
            [20.0, 14.0, 1.0],
            [20.0, 14.0, 10.0],
            [6.0, 30.0, 2.0],
            [6.0, 30.0, 0.01],
            [0.5, 5.0, 0.1],
            [0.02, 10.0, 0.01],
            [0.001, 3.0, 0.0005],
            [43.0, 3.0, 20.0],
        ],
        "drifting_sinusoid" => &[
            [20.0, 2.0, 0.0],
            [20.0, 0.05, 0.0],
            [7.7, 0.5, 0.0],
            [0.6, 0.3, 0.0],
            [0.07, 0.03, 0.0],
            [0.001, 0.0005, 0.0],
            [33.0, 16.0, 0.0],
            [48.0, 10.0, 0.0],
        ],
        _ => &[[0.0, 0.0, 0.0]],
    }
}

fn shape(parameters: [f64; MAX_PARAMETERS]) -> SampledShape {
    SampledShape {
        interval_s: real(INTERVAL_S),
        parameters: parameters.map(real),
    }
}

/// The error that an approximation may have, relative to the density of the bin, to the largest one of the level, and to
/// that of white noise with the same variance. The last one is what rounding leaves of the variance where the density is many
/// powers of ten below it.
fn approximation(name: &str) -> [f64; 3] {
    let [own, largest, white] = match name {
        // Only where the cut-off is a quarter of the sample rate, the pole on the real axis is not exact.
        "digital_low_pass" | "output_low_pass" => {
            [0.0, by_precision(2e-6, 4e-4), by_precision(1e-13, 5e-6)]
        }
        "cascade" => [1e-3, 0.0, by_precision(1e-10, 2e-4)],
        "drifting_resonance" | "drifting_sinusoid" => [0.0, 0.01, 5e-6],
        // The density of the differences of smooth angles is small beside their variance.
        _ if name.starts_with("quantization behind") => [0.0, 0.0, by_precision(1e-12, 1e-5)],
        _ => [0.0; 3],
    };
    [own, largest, white].map(double)
}

/// Whether rounding explains an error of a bin, of this density, in a level whose largest density is given.
///
/// The densities of a random walk fall by 1:64 from the lowest to the highest bin, and single precision keeps
/// seven digits of the largest terms. With the frequency of a sinusoid, its density changes by 5e-4.
fn is_rounding(off: f64, density: f64, largest: f64, length: usize) -> bool {
    let (own, shared) = if length <= 64 {
        (by_precision(1e-8, 6e-4), by_precision(1e-12, 4e-7))
    } else {
        (by_precision(1e-8, 1e-3), by_precision(1e-12, 1e-4))
    };
    off.abs() < double(own) * density + double(shared) * largest
}

/// Compares the densities of an effect with the sums over the window, and returns how many.
fn compare(name: &str, effect: &dyn Effect, parameters: [f64; MAX_PARAMETERS]) -> usize {
    let mut compared = 0;
    let sizes = [
        (64, 1),
        (64, 8),
        (64, 64),
        (256, 1),
        (256, 8),
        (32, 8),
        (64, 512),
    ];
    let is_drifting = name.starts_with("drifting");
    let variance = filtered(name, parameters).map_or(1.0, |covariance| covariance[0]);
    for (length, block) in sizes.into_iter().take(if is_drifting { 7 } else { 6 }) {
        let expected = direct(name, parameters, length, block as usize);
        let mut found = std::vec![-1.0; expected.len() + 1];
        expected_densities(effect, &shape(parameters), length, block, &mut found);
        assert_eq!(found.pop(), Some(-1.0), "beyond the bins");
        let largest = expected.iter().copied().fold(0.0, f64::max);
        for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
            let off = double(*found) - expected;
            let [own, shared, white] = approximation(name);
            let white = white * 2.0 * f64::from(block) * INTERVAL_S * variance;
            let off = (off.abs() - own * expected - shared * largest - white).max(0.0);
            assert!(
                is_rounding(off, expected, largest, length),
                "{name} {parameters:?}, {length}, {block}, bin {k}: {:e} of {expected:e}, {:e} of the \
                 largest",
                off / expected,
                off / largest
            );
            compared += 1;
        }
    }
    compared
}

#[test]
fn densities_are_those_of_sums_over_single_samples() {
    let mut compared = 0;
    for effect in CATALOGUE {
        for &parameters in shapes(effect.name()) {
            compared += compare(effect.name(), effect, parameters);
        }
    }
    assert!(compared >= 5000, "{compared}");
}

/// Quantization behind a filter has the densities of the filtered angles.
#[test]
fn densities_of_quantization_behind_a_filter_are_exact() {
    let filters: [(&str, &dyn Effect, [f64; 3]); 4] = [
        (
            "quantization behind moving_average",
            &MovingAverage,
            [2.0, 0.0, 0.0],
        ),
        (
            "quantization behind moving_average",
            &MovingAverage,
            [9.0, 0.0, 0.0],
        ),
        (
            "quantization behind output_low_pass",
            &OutputLowPass,
            [0.008, 2.0, 0.0],
        ),
        (
            "quantization behind output_low_pass",
            &OutputLowPass,
            [0.03, 1.0, 0.0],
        ),
    ];
    for (name, filter, parameters) in filters {
        let behind = Behind::new(&Quantization, filter, &shape(parameters));
        let behind = behind.expect("quantization has a kernel behind a filter");
        assert!(compare(name, &behind, parameters) > 100, "{name}");
    }
}

/// The densities of a drifting oscillation are the average of those of a steady one over the range.
#[test]
fn densities_that_drift_are_averages_over_the_range() {
    const FREQUENCIES: i32 = 200;
    let line = |frequency_hz, drift_hz| (frequency_hz, 0.0, drift_hz);
    let cases = [
        line(20.0, 2.0),
        line(20.0, 10.0),
        line(6.0, 0.1),
        line(0.3, 0.1),
        line(0.02, 0.01),
        (20.0, 14.0, 1.0),
        (20.0, 5.0, 8.0),
        (6.0, 30.0, 2.0),
        (0.3, 10.0, 0.1),
        (0.02, 3.0, 0.01),
    ];
    let mut compared = 0;
    for (frequency_hz, quality, drift_hz) in cases {
        for block in [1, 8, 64, 512] {
            // The steady oscillations have to lie closer than the bins.
            let bin_hz = 1.0 / (64.0 * f64::from(block) * INTERVAL_S);
            if drift_hz > 20.0 * bin_hz {
                continue;
            }
            let densities = |effect: &dyn Effect, parameters: [f64; 3]| {
                let mut densities = [0.0; 28];
                expected_densities(effect, &shape(parameters), 64, block, &mut densities);
                densities.map(double)
            };
            let found = if quality == 0.0 {
                densities(&DriftingSinusoid, [frequency_hz, drift_hz, 0.0])
            } else {
                densities(&DriftingResonance, [frequency_hz, quality, drift_hz])
            };
            let mut average = [0.0; 28];
            for i in 0..FREQUENCIES {
                let share = (f64::from(i) + 0.5) / f64::from(FREQUENCIES) - 0.5;
                let own_hz = frequency_hz + share * drift_hz;
                let own = if quality == 0.0 {
                    densities(&Sinusoid, [own_hz, 0.0, 0.0])
                } else {
                    // The time constant stays.
                    let own_quality = quality * own_hz / frequency_hz;
                    densities(&Resonance, [own_hz, own_quality, 0.0])
                };
                for (average, own) in average.iter_mut().zip(own) {
                    *average += own / f64::from(FREQUENCIES);
                }
            }
            let largest = average.iter().copied().fold(0.0, f64::max);
            // A rounding error of the variance is white.
            let white = 5e-6 * 2.0 * f64::from(block) * INTERVAL_S;
            for (k, (found, average)) in found.into_iter().zip(average).enumerate() {
                assert!(
                    (found - average).abs() < 0.01 * largest + white,
                    "{frequency_hz} {quality} {drift_hz}, {block}, bin {k}: {found:e}, not {average:e}"
                );
                compared += 1;
            }
        }
    }
    assert!(compared > 500, "{compared}");
}

#[test]
fn lengths_that_segments_cannot_have_are_left_alone() {
    for length in [0, 16, 48, 512] {
        let mut densities = [7.0; 4];
        let shape = SampledShape::new(1.0);
        expected_densities(CATALOGUE[0], &shape, length, 1, &mut densities);
        assert_eq!(densities, [7.0; 4]);
    }
}
