//! How fast logs are read.

use crate::origin::{Origin, print_json};
use allanite_studies::speed::study;
use std::time::Instant;

pub(crate) fn print(samples: usize, json: bool) -> anyhow::Result<()> {
    let begun = Instant::now();
    let rows = study(samples)?;
    let origin = Origin::new("speed", [1, 1], begun);
    if json {
        return print_json(origin, &rows);
    }
    println!("{samples} samples of one axis; ns a sample by the clock, median and quartiles");
    println!(
        "{:<18} {:>8} {:>8} {:>15}",
        "", "elements", "median", "quartiles"
    );
    for row in rows {
        let [first, third] = row.time.quartiles_ns;
        let quartiles = format!("{first:.2} to {third:.2}");
        println!(
            "{:<18} {:>8} {:>8.2} {quartiles:>15}",
            row.work, row.elements, row.time.median_ns
        );
    }
    println!("\n{origin}");
    Ok(())
}
