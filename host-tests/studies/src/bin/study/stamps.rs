//! Late stamps.

use allanite_host::quantile::quantile;
use allanite_log::failure::Failure;
use allanite_studies::stamps::{LOSSES, SAMPLES, Stamps, study};

pub(crate) fn print(records: u64, seed: u64) -> Result<(), Failure> {
    println!(
        "{records} records of {SAMPLES} samples a row, 50 to 1000 Hz, seed {seed}; right: as many losses told as there are, \
         to 2 % or one; excess: losses told less those that there are, of all samples; rate: its errors"
    );
    println!(
        "{:<16} {:>7} | {:>8} {:>8} | {:>9} {:>9} | {:>9} {:>9}",
        "stamps", "lost", "refused", "right", "excess", "95 %", "rate", "95 %"
    );
    for stamps in Stamps::ALL {
        for losses in LOSSES {
            let tally = study(stamps, losses, records, seed)?;
            let (excess, rate) = (middle(&tally.excess), middle(&tally.rate_errors));
            println!(
                "{:<16} {:>5.1} % | {:>8} {:>6.1} % | {:>7.3} % {:>7.3} % | {:>7.4} % {:>7.4} %",
                format!("{stamps:?}"),
                100.0 * losses,
                tally.refused.len(),
                100.0 * tally.right as f64 / tally.records as f64,
                excess.0,
                excess.1,
                rate.0,
                rate.1
            );
            let mut reasons = tally.refused;
            reasons.sort();
            reasons.dedup();
            reasons.iter().take(1).for_each(|why| println!("    {why}"));
        }
    }
    Ok(())
}

/// The median and the 95 % quantile of sizes, in %.
fn middle(values: &[f64]) -> (f64, f64) {
    let mut sizes: Vec<f64> = values.iter().map(|value| 100.0 * value.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    match sizes.is_empty() {
        true => (f64::NAN, f64::NAN),
        false => (quantile(&sizes, 0.5), quantile(&sizes, 0.95)),
    }
}
