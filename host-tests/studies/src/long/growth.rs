//! Time and memory of an accumulator against the length of its record, with every sum checked.

use super::sequence::Sequence;
use crate::resources::{cpu_s, peak_bytes};
use allanite::Accumulator;
use serde::Serialize;
use std::{hint::black_box, ops::Range};

/// The octaves of the accumulator, all that it can have.
pub const OCTAVES: usize = 30;

/// The shortest record of the table, in octaves of samples.
const SHORTEST: u32 = 20;

/// A record of one length, which begins with the shorter ones.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Length {
    /// The number of samples.
    pub samples: u64,
    /// The CPU time that the accumulator took for them, in s.
    pub cpu_s: f64,
    /// The largest resident memory of the process until then, in bytes.
    pub peak_bytes: f64,
    /// The number of octaves with a difference.
    pub octaves: usize,
    /// The number of octaves whose sum and number of differences are those of the definition.
    pub exact: usize,
}

/// The slope of a straight line through logarithms.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Slope {
    /// The slope by least squares.
    pub value: f64,
    /// Its standard error from the scatter about the line.
    pub error: f64,
}

/// A record that was accumulated in parts, which were merged.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Merged {
    /// The number of parts.
    pub parts: u64,
    /// The number of samples of a part.
    pub part: u64,
    /// The number of octaves with a difference.
    pub octaves: usize,
    /// The number of octaves whose sum and number of differences are those of the definition.
    pub exact: usize,
}

/// Accumulates the sequence, and checks every octave at each power of two.
pub fn growth(sequence: &Sequence, samples: u64) -> Vec<Length> {
    let mut accumulator = Accumulator::<OCTAVES>::new();
    let mut cpu = 0.0;
    let mut at = 0;
    let powers = (SHORTEST.min(samples.ilog2())..u64::BITS - 1).map(|k| 1 << k);
    let ends = powers.take_while(|&end| end < samples).chain([samples]);
    ends.map(|end| {
        let begun = cpu_s();
        sequence.accumulate(at, end, black_box(&mut accumulator));
        cpu += cpu_s() - begun;
        at = end;
        let (octaves, exact) = checked(sequence, &accumulator, std::iter::once(0..end));
        Length {
            samples: end,
            cpu_s: cpu,
            peak_bytes: peak_bytes(),
            octaves,
            exact,
        }
    })
    .collect()
}

/// Accumulates equal parts of the sequence apart, last one first, and merges them.
pub fn merged(sequence: &Sequence, samples: u64, parts: u64) -> Merged {
    let part = samples / parts;
    let ranges = (0..parts).rev().map(|i| i * part..(i + 1) * part);
    let mut all = Accumulator::<OCTAVES>::new();
    for range in ranges.clone() {
        let mut one = Accumulator::<OCTAVES>::new();
        sequence.accumulate(range.start, range.end, &mut one);
        all.merge(&one);
    }
    let (octaves, exact) = checked(sequence, &all, ranges);
    Merged {
        parts,
        part,
        octaves,
        exact,
    }
}

/// The number of octaves with a difference, and the number of those that are as defined.
fn checked(
    sequence: &Sequence,
    accumulator: &Accumulator<OCTAVES>,
    ranges: impl IntoIterator<Item = Range<u64>> + Clone,
) -> (usize, usize) {
    let mut octaves = 0;
    let mut exact = 0;
    for (k, octave) in (0..).zip(accumulator.octaves()) {
        let mut differences = 0;
        let mut sum = 0;
        for range in ranges.clone() {
            let expected = sequence.expected(k, range.start, range.end);
            differences += expected.differences;
            sum += expected.sum;
        }
        octaves += usize::from(octave.differences > 0);
        let agrees = octave.differences == differences && octave.sum.to_u128() == Some(sum);
        exact += usize::from(agrees);
    }
    (octaves, exact)
}

/// The slope of `ln y` against `ln samples`; `None` for fewer than three records.
pub fn slope(lengths: &[Length], y: impl Fn(&Length) -> f64) -> Option<Slope> {
    let n = lengths.len() as f64;
    if lengths.len() < 3 {
        return None;
    }
    let points = lengths.iter().map(|l| ((l.samples as f64).ln(), y(l).ln()));
    let mean = |f: &dyn Fn((f64, f64)) -> f64| points.clone().map(f).sum::<f64>() / n;
    let (x0, y0) = (mean(&|p| p.0), mean(&|p| p.1));
    let scatter = mean(&|p| (p.0 - x0).powi(2));
    let value = mean(&|p| (p.0 - x0) * (p.1 - y0)) / scatter;
    let rest = mean(&|p| (p.1 - y0 - value * (p.0 - x0)).powi(2));
    let error = (rest / (n - 2.0) / scatter).sqrt();
    Some(Slope { value, error })
}
