//! Curves and spectra of simulated records, whose rates are rounded to counts far below their noise.

use super::{Coefficients, simulator::Simulator};
use allanite::{Accumulator, Curve, Scale, spectrum::Spectrum};
use allanite_log::{BINS, SpectrumSums};

/// The number of octaves of the curves of simulated records.
pub const OCTAVES: usize = 24;

/// The sampling rate of simulated records for which no other is given, in Hz.
pub const RATE_HZ: f64 = 100.0;

/// The curve of a simulated record. The rates are rounded to counts far below their noise.
pub fn curve(coefficients: Coefficients, samples: usize, seed: u64) -> Curve<OCTAVES> {
    let mut simulator = Simulator::new(coefficients, RATE_HZ, seed);
    record(&mut simulator, coefficients, samples, |_| ())
}

/// The curve of the next `samples` of a simulator. `watch` receives the counts as well.
pub fn record(
    simulator: &mut Simulator,
    coefficients: Coefficients,
    samples: usize,
    watch: impl FnMut(&[i32]),
) -> Curve<OCTAVES> {
    record_at(RATE_HZ, simulator, coefficients, samples, watch)
}

/// The curve of the next `samples` of a simulator that has this rate.
pub fn record_at(
    rate_hz: f64,
    simulator: &mut Simulator,
    coefficients: Coefficients,
    samples: usize,
    mut watch: impl FnMut(&[i32]),
) -> Curve<OCTAVES> {
    let quantum = quantum(coefficients, rate_hz);
    let mut accumulator = Accumulator::<OCTAVES>::new();
    let mut counts = [0; 1024];
    let mut left = samples;
    while left > 0 {
        let chunk = &mut counts[..left.min(1024)];
        for (count, rate) in chunk.iter_mut().zip(&mut *simulator) {
            // The conversion saturates. A record with so wide a range would show it at once.
            *count = (rate / quantum).round() as i32;
        }
        accumulator.push_slice(chunk);
        watch(chunk);
        left -= chunk.len();
    }
    let scale = Scale::new(quantum, rate_hz).expect("positive");
    accumulator.curve(scale)
}

/// The curve that a record of so many samples is expected to have, of the octaves with enough differences.
pub fn expected_curve(samples: usize, variance: impl Fn(u32) -> f64) -> Curve<OCTAVES> {
    let octaves = (0..OCTAVES as u32).map(|k| 1_u32 << k).map_while(|m| {
        let differences =
            (samples.checked_sub(2 * m as usize)? / (m as usize / 4).max(1)) as u64 + 1;
        (differences >= Curve::<OCTAVES>::MIN_DIFFERENCES).then_some((m, differences, variance(m)))
    });
    Curve::new(RATE_HZ, octaves).expect("a model's curve")
}

/// The spectrum of a record whose counts are those of [`record`].
pub fn spectrum(sums: &SpectrumSums, coefficients: Coefficients) -> Spectrum<BINS> {
    sums.spectrum(Scale::new(quantum(coefficients, RATE_HZ), RATE_HZ).expect("positive"))
}

/// The size of a count: 1/4096 of the standard deviation of the differences between neighbouring
/// samples.
pub fn quantum(c: Coefficients, rate_hz: f64) -> f64 {
    let interval_s = 1.0 / rate_hz;
    let white = c.angle_random_walk.powi(2) / interval_s;
    let variance = white
        + 3.0 * (c.quantization / interval_s).powi(2)
        + c.bias_instability.powi(2)
        + c.rate_random_walk.powi(2) * interval_s
        + (c.rate_ramp * interval_s).powi(2);
    variance.sqrt() / 4096.0
}
