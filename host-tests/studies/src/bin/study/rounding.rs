//! Noise behind a filter that is rounded.

use allanite_studies::rounding::{POLES, STEPS, study};

pub(crate) fn print(records: u64, seed: u64) {
    println!("{records} records of 2^17 samples from seed {seed} on; counts of records");
    println!(
        "{:>5} {:>5} {:>8} {:>11} {:>7} {:>7} {:>12} {:>9}",
        "steps", "poles", "refused", "unexplained", "wrong", "missing", "white behind", "N covered"
    );
    for steps in STEPS {
        for poles in POLES {
            let found = study(steps, poles, seed, records);
            println!(
                "{steps:>5} {poles:>5} {:>8} {:>11} {:>7} {:>7} {:>12} {:>9}",
                found.refused,
                found.unexplained,
                found.wrong,
                found.missing,
                found.behind,
                found.covered
            );
            for other in found.others.iter().take(2) {
                println!("        said: {other}");
            }
        }
    }
}
