//! What is named where an effect of a fixed size is hidden.

use allanite_host::simulate::Preset;
use allanite_studies::confusion::{CASES, study};

pub(crate) fn print(records: u64, only: Option<Preset>) {
    println!(
        "records of 2^17 samples at 100 Hz; counts of records; relative errors of the first effect's shape in %,"
    );
    println!("median and 95 % quantile");
    println!(
        "{:<8} {:<44} {:>5} {:>5} {:>6} {:>5} {:>7} | errors",
        "gyro", "hidden", "alone", "amb.", "beside", "wrong", "nothing"
    );
    let presets = Preset::TYPICAL.into_iter();
    for preset in presets.filter(|&preset| only.is_none_or(|only| only == preset)) {
        for case in CASES {
            let t = study(preset, case, records);
            let names = case
                .iter()
                .map(|(name, [first, second, _], size)| match name {
                    _ if *second > 0.0 => format!("{name} {first} {second} ({size})"),
                    _ => format!("{name} {first} ({size})"),
                });
            let names: Vec<String> = names.collect();
            let errors = t.errors.iter();
            let errors =
                errors.map(|(median, most)| format!("{:.2} {:.2}", 100.0 * median, 100.0 * most));
            let errors: Vec<String> = errors.collect();
            println!(
                "{:<8} {:<44} {:>5} {:>5} {:>6} {:>5} {:>7} | {}",
                format!("{preset:?}").to_lowercase(),
                names.join(" + "),
                t.alone,
                t.ambiguous,
                t.beside,
                t.wrong,
                t.nothing,
                errors.join("; ")
            );
            for (name, count) in &t.names {
                println!("         {count:>4} {name}");
            }
        }
    }
}
