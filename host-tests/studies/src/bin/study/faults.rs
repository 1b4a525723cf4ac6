//! Faults of a logger.

use allanite_host::quantile::quantile;
use allanite_studies::faults::{Fault, Resolution, SAMPLES, Tally, study};

pub(crate) fn print(records: u64, clean: u64, seed: u64) {
    println!(
        "{records} records of {SAMPLES} samples a fault, {clean} without one, seed {seed}; told: of records with less than \
         45 % of equal neighbours by chance; rate: errors of the sensor's rate in %, and share within 0.5 %"
    );
    println!(
        "{:<20} {:<7} {:>6} | {:>13} {:>7} | {:>9} | {:>6} {:>6} {:>8}",
        "fault", "counts", "axes", "told", "%", "otherwise", "median", "95 %", "within"
    );
    for (resolution, name) in [
        (Resolution::Counts, "0.4–10"),
        (Resolution::Fine, "fine"),
        (Resolution::Pulses, "pulses"),
    ] {
        for fault in [Fault::None].into_iter().chain(Fault::ALL) {
            let is_coarse = matches!(
                fault,
                Fault::Clipped(_) | Fault::DeadBand(_) | Fault::Threshold(_)
            );
            if is_coarse && resolution != Resolution::Counts {
                continue;
            }
            let records = if fault == Fault::None { clean } else { records };
            let tallies = study(fault, resolution, records, seed);
            for (axes, tally) in ["1", "3", "device"].into_iter().zip(tallies) {
                print_row(&format!("{fault:?}"), (name, axes), &tally);
            }
        }
    }
}

fn print_row(fault: &str, (resolution, axes): (&str, &str), tally: &Tally) {
    let mut errors: Vec<f64> = tally.rate_errors.iter().map(|error| error.abs()).collect();
    errors.sort_by(f64::total_cmp);
    print!(
        "{fault:<20} {resolution:<7} {axes:>6} | {:>6}/{:<6} {:>7.2} | {:>9} |",
        tally.told,
        tally.judged,
        100.0 * tally.told as f64 / tally.judged.max(1) as f64,
        tally.otherwise.len(),
    );
    if !errors.is_empty() {
        let within = errors.iter().filter(|error| **error < 0.005).count();
        print!(
            " {:>6.3} {:>6.3} {:>6.1} %",
            100.0 * quantile(&errors, 0.5),
            100.0 * quantile(&errors, 0.95),
            100.0 * within as f64 / errors.len() as f64
        );
    }
    println!();
    for other in tally
        .otherwise
        .iter()
        .take(if fault == "None" { 5 } else { 0 })
    {
        println!("    {other}");
    }
}
