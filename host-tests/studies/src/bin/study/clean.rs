//! Records in which nothing is hidden.

use super::SYMBOLS;
use allanite_host::{simulate::Preset, verdict::NOT_STATIONARY_IN_WORDS};
use allanite_studies::{
    clean::{self, Absent},
    mixtures::{self, Stored, Terms},
};
use std::collections::BTreeMap;

/// The gyros of a preset: each lacks one of the terms that it may lack, and the last one lacks none. No preset has a
/// rate ramp, and every gyro has white noise.
const GYROS: [Absent; 4] = [
    Absent::Term(0),
    Absent::Term(2),
    Absent::Term(3),
    Absent::None,
];

pub(crate) fn print(records: u64, only: Option<Preset>, symbol: Option<&str>, walk: f64) {
    let presets = Preset::TYPICAL.into_iter();
    let is_chosen = |absent: &Absent| match (symbol, absent) {
        (None, _) => true,
        (Some(symbol), Absent::Term(i)) => SYMBOLS[*i] == symbol,
        (Some(symbol), Absent::None) => symbol == "nothing",
    };
    for preset in presets.filter(|&preset| only.is_none_or(|only| only == preset)) {
        for absent in GYROS.into_iter().filter(is_chosen) {
            let mut coefficients = clean::without(preset, absent);
            coefficients.rate_random_walk *= walk;
            let lacks = match absent {
                Absent::None => "no term absent but R".to_owned(),
                Absent::Term(i) => format!("{} absent", SYMBOLS[i]),
            };
            println!(
                "\n{}, {lacks}, {records} records; shares in %",
                format!("{preset:?}").to_lowercase()
            );
            println!(
                "{:>8} {:>7} {:>10} {:>7} | {:>34} | {:>34}",
                "samples",
                "aborted",
                "inadequate",
                "claimed",
                "measured: Q N B K R",
                "covered: Q N B K R"
            );
            for (tally, length) in clean::study(coefficients, records)
                .into_iter()
                .zip(clean::LENGTHS)
            {
                let percent = |count: usize| 100.0 * count as f64 / tally.records as f64;
                print!(
                    "{:>8} {:>7.1} {:>10.1} {:>7.1} |",
                    format!("2^{length}"),
                    percent(tally.aborted),
                    percent(tally.inadequate),
                    percent(tally.claimed.len())
                );
                for count in tally.measured {
                    print!(" {:>6.1}", percent(count));
                }
                print!(" |");
                for count in tally.covered {
                    print!(" {:>6.1}", percent(count));
                }
                println!("  {:?}", counted(&tally.claimed));
            }
        }
    }
}

pub(crate) fn print_mixtures(records: u64, seed: u64) {
    println!("{records} records of each length from seed {seed} on; shares in %");
    println!(
        "{:>14} {:>7} {:>8} {:>7} {:>5} {:>14} | {:>5} {:>6} {:>5} {:>5} | {:>7} | Q, N, B, K, R covered",
        "terms",
        "stored",
        "samples",
        "aborted",
        "told",
        NOT_STATIONARY_IN_WORDS,
        "noise",
        "bursts",
        "step",
        "warm",
        "p < 5 %"
    );
    for (terms, name) in [(Terms::All, "all five"), (Terms::WalkAndRamp, "N, K and R")] {
        for (stored, kind) in [(Stored::Floats, "floats"), (Stored::Counts, "counts")] {
            let tallies = mixtures::study(terms, stored, seed, records);
            for (tally, length) in tallies.iter().zip(clean::LENGTHS) {
                let percent = |count: usize| 100.0 * count as f64 / tally.records as f64;
                print!(
                    "{name:>14} {kind:>7} {:>8} {:>7.2} {:>5.2} {:>14.2} |",
                    format!("2^{length}"),
                    percent(tally.aborted),
                    percent(tally.told.len()),
                    percent(tally.not_stationary.len()),
                );
                for (width, count) in [5, 6, 5, 5].into_iter().zip(tally.events) {
                    print!(" {:>width$.2}", percent(count));
                }
                print!(" | {:>7.1} |", percent(tally.improbable));
                for count in tally.covered {
                    print!(" {:.1}", percent(count));
                }
                println!(
                    "  {:?}, seeds {:?}",
                    counted(&tally.told),
                    tally.not_stationary
                );
            }
        }
    }
}

/// The distinct names, with how often each occurs.
fn counted<'a>(names: &[&'a str]) -> BTreeMap<&'a str, usize> {
    let mut counts = BTreeMap::new();
    for name in names {
        *counts.entry(*name).or_insert(0) += 1;
    }
    counts
}
