//! The small fit of the five terms beside the general one.

use super::SYMBOLS;
use allanite_host::{quantile::quantile, simulate::Preset};
use allanite_studies::five_terms::{Compared, study};
use clap::ValueEnum;

pub(crate) fn print(records: u64, longest: f64, seed: u64) {
    println!(
        "{records} records a gyro, of 2^11 to 2^{longest} samples, a third with gaps, seed {seed}; differences in standard errors"
    );
    let mut all = Vec::new();
    for preset in Preset::value_variants() {
        let compared = study(*preset, longest, records, seed);
        println!("\n{preset:?}");
        summary(&compared);
        all.extend(compared);
    }
    println!("\nall");
    summary(&all);
    let gaps: Vec<Compared> = all.into_iter().filter(|one| one.has_gaps).collect();
    println!("\nwith gaps");
    summary(&gaps);
}

fn summary(compared: &[Compared]) {
    let n = compared.len() as f64;
    println!(
        "{:>3} {:>9} {:>8} {:>8} {:>8} {:>8} | covered: general, small",
        "", "difference", "95 %", "99 %", "largest", "states"
    );
    for (i, symbol) in SYMBOLS.iter().enumerate() {
        let same = compared.iter().filter(|one| one.states[i]).count() as f64;
        let covered = |which: usize| {
            let covered = compared.iter().filter(|one| one.covered[i][which]);
            100.0 * covered.count() as f64 / n
        };
        println!(
            "{symbol:>3} {} {:>6.2} % | {:>5.1} % {:>5.1} %",
            sizes(compared.iter().map(|one| one.squares[i])),
            100.0 * same / n,
            covered(0),
            covered(1)
        );
    }
    let together = compared.iter().flat_map(|one| one.squares);
    let states = compared.iter().flat_map(|one| one.states);
    let equal = states.filter(|&same| same).count() as f64;
    println!(
        "all {} {:>6.2} %",
        sizes(together),
        100.0 * equal / (5.0 * n)
    );
    let ends = compared.iter().flat_map(|one| one.ends.iter().copied());
    println!("ends{}", sizes(ends));
    println!("χ²  {}", sizes(compared.iter().map(|one| one.chi_squared)));
    let low = |which: usize| {
        let low = compared.iter().filter(|one| one.p_values[which] < 0.05);
        100.0 * low.count() as f64 / n
    };
    println!("p below 5 %: {:.2} %, {:.2} %", low(0), low(1));
}

/// Median, 95 and 99 % and the largest of sizes.
fn sizes(values: impl Iterator<Item = f64>) -> String {
    let mut sizes: Vec<f64> = values.map(f64::abs).collect();
    sizes.sort_by(f64::total_cmp);
    let at = |share| quantile(&sizes, share);
    format!(
        "{:>9.4} {:>8.4} {:>8.4} {:>8.4}",
        at(0.5),
        at(0.95),
        at(0.99),
        at(1.0)
    )
}
