//! The deviations that the study of peers compares with, against their definitions. The study itself needs Python and
//! packages of others: `cargo xtask study peers`.

use allanite_host::simulate::{Preset, Simulator};
use allanite_studies::peers::{
    agreement::{quarter, separate},
    bootstrap::{bootstrap, mean},
};

/// Counts of a gyro; their number is a prime.
fn counts() -> Vec<i32> {
    let simulator = Simulator::new(Preset::Mems.coefficients(), 100.0, 3);
    let rates = simulator.take(50_021);
    rates.map(|rate| (rate * 2e4).round() as i32).collect()
}

/// The deviation of adjacent means over `m` counts, whose starts are `step` apart, as a textbook has it.
fn textbook(counts: &[i32], m: usize, step: usize) -> f64 {
    let mean = |s: usize| counts[s..s + m].iter().map(|&c| f64::from(c)).sum::<f64>() / m as f64;
    let starts = (0..)
        .map(|i| i * step)
        .take_while(|s| s + 2 * m <= counts.len());
    let squares: Vec<f64> = starts.map(|s| (mean(s + m) - mean(s)).powi(2)).collect();
    (0.5 * squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[test]
fn deviations_agree_with_the_textbook_to_1e_9() {
    let counts = counts();
    let (ours, apart) = (quarter(&counts), separate(&counts));
    assert_eq!((ours.len(), apart.len()), (15, 15));
    for (k, ((m, deviation), (m_apart, separate))) in ours.iter().zip(&apart).enumerate() {
        assert_eq!((*m, *m_apart), (1 << k, 1 << k));
        let m = 1 << k;
        let same = |found: f64, step: usize| (found / textbook(&counts, m, step) - 1.0).abs();
        assert!(same(*deviation, (m / 4).max(1)) < 1e-9, "{m}");
        assert!(same(*separate, m) < 1e-9, "{m}");
        // The definitions differ by far more than that, unless their starts are the same.
        assert!(m == 1 || (deviation / separate - 1.0).abs() > 1e-6, "{m}");
    }
}

/// A fully overlapping deviation at four means over blocks is the quarter-overlapping one of the counts: the pair of
/// definitions by which the study compares every octave.
#[test]
fn blocks_of_a_quarter_give_the_same_deviation() {
    let counts = counts();
    for (m, deviation) in quarter(&counts).into_iter().skip(2) {
        let block = m as usize / 4;
        let sums = counts.chunks_exact(block).map(|block| block.iter().sum());
        let sums: Vec<i32> = sums.collect();
        let overlapping = textbook(&sums, 4, 1) / block as f64;
        assert!((overlapping / deviation - 1.0).abs() < 1e-9, "{m}");
    }
}

#[test]
fn a_bootstrap_error_falls_with_the_root_of_the_records() {
    let numbers: Vec<f64> = counts().iter().map(|&count| f64::from(count)).collect();
    let [_, few] = bootstrap(&numbers[..100], mean);
    let [_, many] = bootstrap(&numbers[..10_000], mean);
    assert!((5.0..20.0).contains(&(few / many)), "{few} {many}");
}
