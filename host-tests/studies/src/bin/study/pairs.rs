//! What is named where several effects are hidden.

use allanite_host::simulate::Preset;
use allanite_studies::pairs::{Kinds, study};

pub(crate) fn print(records: u64, only: Option<Preset>, kinds: Kinds) {
    println!("records of 2^17 samples at 100 Hz; counts of records");
    println!(
        "{:<8} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9} {:>11} {:>5}",
        "gyro",
        "effects",
        "records",
        "exact",
        "among",
        "wrong",
        "missing",
        "N covered",
        "unexplained",
        "rises"
    );
    let presets = Preset::TYPICAL.into_iter();
    for preset in presets.filter(|&preset| only.is_none_or(|only| only == preset)) {
        for effects in [2, 3] {
            let t = study(preset, effects, kinds, records);
            println!(
                "{:<8} {effects:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9} {:>11} {:>5}",
                format!("{preset:?}").to_lowercase(),
                t.records,
                t.exact,
                t.among,
                t.wrong,
                t.missing,
                t.covered,
                t.unexplained,
                t.rises
            );
            for (truth, said) in &t.others {
                println!("         {truth}\n           said: {said}");
            }
        }
    }
}
