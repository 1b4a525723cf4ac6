//! Records in which nothing is hidden.

use super::SYMBOLS;
use host_tests::{
    simulate::Preset,
    study::clean::{self, Absent},
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

/// The distinct names, with how often each occurs.
fn counted<'a>(names: &[&'a str]) -> BTreeMap<&'a str, usize> {
    let mut counts = BTreeMap::new();
    for name in names {
        *counts.entry(*name).or_insert(0) += 1;
    }
    counts
}
