//! Spectrum accumulators under any sequence of counts and events, against the definition in double precision.

use allanite::{
    Scale,
    spectrum::{Spectrum, SpectrumAccumulator},
};
use std::f64::consts::PI;

const LEVELS: usize = 3;
const BINS: usize = LEVELS * 112;

/// The most samples that are compared with the definition. The third level of the shortest segments needs 17 408.
const MOST: usize = 20_000;

/// Plays the events that the bytes encode, with segments of the length that the first byte selects.
pub fn check(bytes: &[u8]) {
    match bytes {
        [length, events @ ..] if length % 4 == 0 => play::<64>(events),
        [length, events @ ..] if length % 16 == 1 => play::<256>(events),
        [_, events @ ..] => play::<32>(events),
        [] => {}
    }
}

/// An accumulator, and what it is known to have taken.
#[derive(Clone)]
struct Record<const P: usize> {
    accumulator: SpectrumAccumulator<P, LEVELS>,
    /// The counts without a gap in between.
    stretches: Vec<Vec<i32>>,
    /// The counts since all work was done.
    waiting: usize,
    /// Whether counts were lost since all work was done.
    is_late: bool,
    lost: u64,
}

impl<const P: usize> Record<P> {
    fn new() -> Self {
        Self {
            accumulator: SpectrumAccumulator::new(),
            stretches: vec![Vec::new()],
            waiting: 0,
            is_late: false,
            lost: 0,
        }
    }

    fn push(&mut self, count: i32) {
        self.accumulator.push(count);
        let lost = self.accumulator.lost() - self.lost;
        self.lost += lost;
        self.waiting += 1;
        match lost {
            0 if self.is_late => {
                // There was room again, so that what was lost lies in between.
                self.is_late = false;
                self.stretches.push(vec![count]);
            }
            0 => self.stretch().push(count),
            1 => {
                assert!(
                    self.is_late || self.waiting > P,
                    "a count was lost although there was room"
                );
                self.is_late = true;
            }
            _ => panic!("one count was pushed and {lost} were lost"),
        }
    }

    fn stretch(&mut self) -> &mut Vec<i32> {
        if self.stretches.is_empty() {
            self.stretches.push(Vec::new());
        }
        self.stretches.last_mut().unwrap_or_else(|| unreachable!())
    }

    fn advance(&mut self) {
        if !self.accumulator.advance() {
            self.done();
        }
    }

    /// All the work was done.
    fn done(&mut self) {
        self.waiting = 0;
        if self.is_late {
            self.is_late = false;
            self.stretches.push(Vec::new());
        }
    }

    fn gap(&mut self) {
        self.accumulator.gap();
        self.done();
        self.stretches.push(Vec::new());
    }

    fn merge(&mut self, other: &Self) {
        self.accumulator.merge(&other.accumulator);
        self.gap();
        self.stretches.extend(other.stretches.iter().cloned());
        self.stretches.push(Vec::new());
        self.lost += other.lost;
    }

    fn samples(&self) -> usize {
        self.stretches.iter().map(Vec::len).sum()
    }
}

fn play<const P: usize>(bytes: &[u8]) {
    let mut records = [Record::<P>::new(), Record::new()];
    let mut bytes = bytes.iter().copied();
    while let Some(event) = bytes.next() {
        let [first, second] = &mut records;
        let (record, other) = match event & 0x80 {
            0 => (first, second),
            _ => (second, first),
        };
        // As many as can be lost, and as many as fill several segments.
        let times = 1 << ((event >> 3) & 0x0F).min(9);
        match event % 8 {
            0 if event & 0x08 == 0 => record.gap(),
            0 => {
                // A copy of a copy would grow without end.
                if record.samples() + other.samples() < MOST && other.stretches.len() < 64 {
                    record.merge(other);
                }
            }
            1 => record.advance(),
            2 => (0..times).for_each(|_| record.advance()),
            kind => {
                let counts = counts(kind, times, &mut bytes);
                if kind == 7 {
                    record.accumulator.push_slice(&counts);
                    record.done();
                    record.stretch().extend(&counts);
                } else {
                    for count in counts {
                        record.push(count);
                        // Mostly a main loop comes in time.
                        if kind > 3 {
                            record.advance();
                        }
                    }
                }
            }
        }
        assert_eq!(record.accumulator.lost(), record.lost);
        if record.samples() > MOST || record.stretches.len() > 128 {
            break;
        }
    }
    for record in &mut records {
        record.gap();
        compare(record);
    }
}

/// So many counts: of full range, of a size, constant, or alternating between the ends of the range.
fn counts(kind: u8, times: usize, bytes: &mut impl Iterator<Item = u8>) -> Vec<i32> {
    let mut next = || bytes.next().unwrap_or(0);
    let mut random = u32::from_le_bytes([next(), next(), next(), next()]);
    let size = random % 33;
    let is_constant = random % 5 == 0;
    let period = random as usize % 300 + 1;
    (0..times)
        .map(|n| {
            if !is_constant {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            }
            match kind {
                4 if (n / period).is_multiple_of(2) => i32::MIN,
                4 => i32::MAX,
                _ => (random as i32).checked_shr(size).unwrap_or(-1),
            }
        })
        .collect()
}

/// The sums over the segments of one level that the definition gives, with bounds of their rounding errors.
#[derive(Clone, Copy, Default)]
struct Sums {
    power: f64,
    square: f64,
    power_error: f64,
    square_error: f64,
}

/// Asserts that the spectrum of a record has the densities of all segments within its stretches.
fn compare<const P: usize>(record: &Record<P>) {
    let scale = Scale::new(1.0, 1.0).unwrap();
    let spectrum: Spectrum<BINS> = record.accumulator.spectrum(scale);
    let mut found = spectrum.levels();
    for level in 0..LEVELS {
        let block = 8_usize.pow(level as u32);
        let (segments, sums) = definition::<P>(&record.stretches, level);
        if segments < Spectrum::<BINS>::MIN_SEGMENTS {
            continue;
        }
        let bins = found.next().expect("a level with enough segments");
        assert_eq!(bins.len(), sums.len());
        let n = f64::from(segments);
        // τ₀ is 1 s, and Σw² is 3P/8.
        let density = 2.0 * block as f64 / (0.375 * P as f64);
        for (bin, sums) in bins.iter().zip(sums) {
            assert_eq!((bin.block as usize, bin.segments), (block, segments));
            let off = (bin.density - density * sums.power / n).abs();
            let most = density * sums.power_error / n;
            assert!(
                off <= most,
                "block {block}, bin {}: density {} instead of {}, more than {most:e} off",
                bin.index,
                bin.density,
                density * sums.power / n
            );
            let kurtosis = bin.spectral_kurtosis;
            assert!(
                (0.0..=n + 1.01).contains(&kurtosis),
                "kurtosis {kurtosis} of {n}"
            );
            let Sums {
                power,
                square,
                power_error,
                square_error,
            } = sums;
            if power_error < 1e-3 * power {
                let factor = (n + 1.0) / (n - 1.0);
                let ratio = n * square / (power * power);
                let expected = factor * (ratio - 1.0);
                let relative = square_error / square + 3.0 * power_error / power + 1e-5;
                let off = (kurtosis - expected).abs();
                assert!(
                    off <= factor * ratio * relative,
                    "block {block}, bin {}: kurtosis {kurtosis} instead of {expected}",
                    bin.index
                );
            }
        }
    }
    assert!(found.next().is_none(), "a level without enough segments");
}

/// The number of segments of a level, and the sums of the powers `|Σ w y e^…|²` of block means of every bin.
fn definition<const P: usize>(stretches: &[Vec<i32>], level: usize) -> (u32, Vec<Sums>) {
    let block = 8_usize.pow(level as u32);
    let turns: Vec<f64> = (0..P).map(|i| 2.0 * PI * i as f64 / P as f64).collect();
    let waves: Vec<(f64, f64)> = turns.iter().map(|x| (x.cos(), x.sin())).collect();
    let window: Vec<f64> = waves.iter().map(|(cosine, _)| 0.5 - 0.5 * cosine).collect();
    let mut sums = vec![Sums::default(); P / 2 - P / 16];
    let mut segments = 0;
    for stretch in stretches {
        let Some(&reference) = stretch.first() else {
            continue;
        };
        // Sums over blocks, which the reference makes small, are exact.
        let blocks = |length: usize| {
            let sum = move |block: &[i32]| -> i64 {
                let less = |&count| i64::from(count) - i64::from(reference);
                block.iter().map(less).sum()
            };
            stretch.chunks_exact(length).map(sum).collect::<Vec<_>>()
        };
        // Beyond 2^30, blocks lose their lowest bits, and those of the next level are sums of eight.
        let mut dropped = 0.0;
        for level in 0..=level {
            let blocks = blocks(8_usize.pow(level as u32));
            let largest = blocks.iter().map(|sum| sum.unsigned_abs()).max();
            let bits = u64::BITS - largest.unwrap_or(0).leading_zeros();
            let own = match bits {
                0..=30 => 0.0,
                bits => 2_f64.powi(bits as i32 - 29),
            };
            dropped = 8.0 * dropped + own;
        }
        for segment in blocks(block).windows(P).step_by(P / 2) {
            segments += 1;
            let weighted: Vec<f64> = segment
                .iter()
                .zip(&window)
                .map(|(sum, weight)| weight * (sum - segment[0]) as f64 / block as f64)
                .collect();
            let size: f64 = weighted.iter().map(|value| value.abs()).sum();
            let unweighted: f64 = segment
                .iter()
                .map(|sum| (sum - segment[0]).abs() as f64)
                .sum();
            // Single precision has 24 bits, and a value takes part in up to a dozen roundings. The window is
            // applied to the transform, so that values with small weights are rounded too.
            let rounded = (size + unweighted / block as f64) * 12.0 / 2_f64.powi(24);
            let error = rounded + P as f64 * dropped / block as f64;
            for (k, sums) in (P / 16..P / 2).zip(&mut sums) {
                let (mut real, mut imaginary) = (0.0, 0.0);
                for (j, value) in weighted.iter().enumerate() {
                    let (cosine, sine) = waves[j * k % P];
                    real += value * cosine;
                    imaginary += value * sine;
                }
                let power = real * real + imaginary * imaginary;
                let off = 2.0 * power.sqrt() * error + error * error;
                sums.power += power;
                sums.square += power * power;
                sums.power_error += off;
                sums.square_error += 2.0 * power * off + off * off;
            }
        }
    }
    for sums in &mut sums {
        // Sums of many powers in single precision.
        let rounding = 1e-7 * f64::from(segments).max(10.0);
        sums.power_error += rounding * sums.power + 1e-18;
        sums.square_error += rounding * sums.square + 1e-18;
    }
    (segments, sums)
}
