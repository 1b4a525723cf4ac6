//! What the course of a record tells.

use allanite_host::{quantile::quantile, simulate::Preset};
use allanite_studies::course::{CASES, Case, SAMPLES, Tally, study};

pub(crate) fn print(records: u64, only: Option<Preset>, only_clean: bool) {
    let cases = if only_clean { &CASES[..1] } else { &CASES[..] };
    println!("{records} records of {SAMPLES} samples; shares in %");
    println!(
        "{:>9} {:>10} | {:>5} {:>7} {:>8} {:>6} | {:>5} {:>5} {:>6} {:>5} {:>5} | {:>31}",
        "preset",
        "event",
        "told",
        "on time",
        "interval",
        "median",
        "extra",
        "noise",
        "bursts",
        "step",
        "warm",
        "largest |z|, 95 %/max"
    );
    let presets = Preset::TYPICAL.into_iter();
    for preset in presets.filter(|&preset| only.is_none_or(|only| only == preset)) {
        let name = format!("{preset:?}").to_lowercase();
        for (case, tally) in cases.iter().zip(study(preset, cases, 0..records)) {
            line(&name, *case, &tally);
        }
    }
}

fn line(preset: &str, case: Case, tally: &Tally) {
    let name = match case {
        Case::Clean => "none".to_owned(),
        Case::Noise(factor) => format!("noise {factor}"),
        Case::Bursts => "bursts".to_owned(),
        Case::Step => "step".to_owned(),
        Case::WarmUp => "warm-up".to_owned(),
    };
    let percent = |count: usize| 100.0 * count as f64 / tally.records as f64;
    let of_told = |count: usize| 100.0 * count as f64 / tally.told as f64;
    let median = match tally.sizes.is_empty() {
        true => f64::NAN,
        false => quantile(&tally.sizes, 0.5),
    };
    print!(
        "{preset:>9} {name:>10} | {:>5.1} {:>7.1} {:>8.1} {median:>6.3} | {:>5.1}",
        percent(tally.told),
        of_told(tally.on_time),
        of_told(tally.covered),
        percent(tally.any_besides)
    );
    for (width, count) in [5, 6, 5, 5].into_iter().zip(tally.besides) {
        print!(" {:>width$.1}", percent(count));
    }
    print!(" |");
    for sizes in &tally.largest {
        print!(
            " {:>3.1}/{:<4.1}",
            quantile(sizes, 0.95),
            quantile(sizes, 1.0)
        );
    }
    println!();
}
