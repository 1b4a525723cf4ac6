//! Nothing overflows with square waves of full scale or with sums beyond 128 bits.

use super::{
    definition::{Octave, Record, Stretch, big, octaves, square},
    events::Counts,
};
use allanite::{Accumulator, Real};
use num_bigint::BigUint;

/// A full-scale square wave whose sums follow from the positions of its edges.
#[derive(Clone, Copy)]
struct SquareWave {
    half_period: u64,
    samples: u64,
}

impl SquareWave {
    fn accumulate(self) -> Accumulator<30> {
        let mut accumulator = Accumulator::new();
        self.push_to(&mut accumulator);
        accumulator
    }

    fn push_to(self, accumulator: &mut Accumulator<30>) {
        const CHUNK: u64 = 1 << 16;
        if self.half_period < CHUNK {
            let half_period = self.half_period as usize;
            let counts = Counts::Square { half_period }.take(CHUNK as usize);
            for _ in 0..self.samples / CHUNK {
                accumulator.push_slice(&counts);
            }
        } else {
            let (low, high) = ([i32::MIN; CHUNK as usize], [i32::MAX; CHUNK as usize]);
            for chunk in 0..self.samples / CHUNK {
                let up = chunk * CHUNK / self.half_period % 2 == 1;
                accumulator.push_slice(if up { &high } else { &low });
            }
        }
    }

    /// The angle at `n` in closed form.
    fn angle(self, n: u64) -> i128 {
        let (p, n) = (i128::from(self.half_period), i128::from(n));
        let (periods, rest) = (n / (2 * p), n % (2 * p));
        let (low, high) = (rest.min(p), (rest - p).max(0));
        -periods * p + low * i128::from(i32::MIN) + high * i128::from(i32::MAX)
    }

    fn octave(self, k: u32) -> Octave {
        let m = 1_u64 << k;
        let h = (m / 4).max(1);
        if self.samples < 2 * m {
            return (m as u32, 0, BigUint::ZERO);
        }
        let last = (self.samples - 2 * m) / h;
        let squared = |i: u64| {
            let s = i * h;
            square(self.angle(s + 2 * m) - 2 * self.angle(s + m) + self.angle(s))
        };
        // The differences repeat with the period. Within a period, only those that span an edge are
        // not zero.
        let period = (2 * self.half_period / h).max(1);
        let (whole, rest) = ((last + 1) / period, (last + 1) % period);
        let spans_edge = |i: &u64| {
            let (first, end) = (
                i * h / self.half_period,
                (i * h + 2 * m - 1) / self.half_period,
            );
            first != end
        };
        let mut in_period = BigUint::ZERO;
        let mut sum = BigUint::ZERO;
        let starts = |end: u64| {
            // These are the starts of differences that span the edges at every half-period, each
            // listed once.
            let edges = 1..=(end * h + 2 * m) / self.half_period;
            let mut next = 0;
            edges.flat_map(move |edge| {
                let edge = edge * self.half_period;
                let from = (edge.saturating_sub(2 * m) / h).max(next);
                let to = (edge / h + 1).min(end).max(from);
                next = to;
                from..to
            })
        };
        for i in starts(period.min(last + 1)).filter(spans_edge) {
            in_period += squared(i);
        }
        for i in starts(rest).filter(spans_edge) {
            sum += squared(i);
        }
        if whole > 0 {
            sum += in_period * whole;
        }
        (m as u32, last + 1, sum)
    }

    fn octaves(self) -> Vec<Octave> {
        (0..30).map(|k| self.octave(k)).collect()
    }
}

/// Checks the closed form itself, on records that are short enough for the definition.
#[test]
fn the_closed_form_of_square_waves_follows_the_definition() {
    for half_period in [1_u64, 2, 16, 256, 2048, 1 << 15] {
        let wave = SquareWave {
            half_period,
            samples: 1 << 16,
        };
        let record = Record {
            running: Stretch {
                counts: Counts::Square {
                    half_period: half_period as usize,
                }
                .take(1 << 16),
                ..Stretch::default()
            },
            ..Record::default()
        };
        assert_eq!(
            wave.octaves(),
            record.octaves(30),
            "half-period {half_period}"
        );
    }
}

#[test]
fn full_scale_square_waves_overflow_no_octave() {
    for (exponent, length) in [(0, 24), (3, 24), (12, 24), (18, 24), (21, 24), (26, 27)] {
        let wave = SquareWave {
            half_period: 1 << exponent,
            samples: 1 << length,
        };
        assert_eq!(
            octaves(&wave.accumulate()),
            wave.octaves(),
            "half-period 2^{exponent}"
        );
    }
}

#[test]
fn the_largest_possible_difference_fits_the_longest_octave() {
    let wave = SquareWave {
        half_period: 1 << 29,
        samples: 1 << 30,
    };
    let found = octaves(&wave.accumulate());
    assert_eq!(found, wave.octaves());
    assert_eq!(found[29].2, square((1 << 29) * ((1 << 32) - 1)));
}

/// A wave with the period that gives an octave its largest sum, repeated for as many samples as can
/// be counted. The sum fits into 192 bits, and both ways of adding carry into the third limb.
#[test]
fn sums_beyond_128_bits_stay_exact() {
    const OCTAVE: usize = 20;
    let wave = SquareWave {
        half_period: 1 << OCTAVE,
        samples: 1 << 23,
    };
    let once = wave.octaves();
    let mut records = vec![wave.accumulate()];
    for i in 0..39 {
        let mut twice = records[i].clone();
        twice.merge(&records[i]);
        records.push(twice);
    }
    let limit = BigUint::from(1_u8) << 128_u32;

    // Whole records bring the sum as close below 2^128 as possible. Single samples then carry it over.
    let mut times = &limit / &once[OCTAVE].2;
    let mut accumulator = Accumulator::<30>::new();
    for (i, record) in records.iter().enumerate() {
        if times.bit(i as u64) {
            accumulator.merge(record);
        }
    }
    let multiple =
        |times: &BigUint| -> Vec<BigUint> { once.iter().map(|octave| &octave.2 * times).collect() };
    let sums = |accumulator: &Accumulator<30>| -> Vec<BigUint> {
        octaves(accumulator)
            .into_iter()
            .map(|octave| octave.2)
            .collect()
    };
    assert_eq!(sums(&accumulator), multiple(&times));
    assert!(
        accumulator
            .octave(OCTAVE)
            .is_some_and(|octave| octave.sum.to_u128().is_some())
    );
    wave.push_to(&mut accumulator);
    times += 1_u8;
    assert_eq!(sums(&accumulator), multiple(&times));
    assert!(
        accumulator
            .octave(OCTAVE)
            .is_some_and(|octave| octave.sum.to_u128().is_none())
    );

    // The record has 2^62 samples.
    let longest = &records[39];
    assert_eq!(longest.samples(), 1 << 62);
    assert_eq!(sums(longest), multiple(&(BigUint::from(1_u8) << 39_u32)));
    let sum = longest
        .octave(OCTAVE)
        .expect("an octave of the accumulator")
        .sum;
    assert!(big(sum.limbs()).bits() > 144);
    let expected = once[OCTAVE].2.to_string().parse::<f64>().expect("digits") * 2_f64.powi(39);
    // Single precision ends at 2^128.
    let expected = expected as Real;
    let is_near = (sum.to_real() / expected - 1.0).abs() < 4.0 * Real::EPSILON;
    assert!(is_near || expected == Real::INFINITY && sum.to_real() == expected);
}
