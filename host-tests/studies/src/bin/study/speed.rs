//! How fast logs are read.

use crate::origin::{Origin, print_json};
use allanite_studies::{processes, speed::study};
use std::{path::Path, time::Instant};

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

pub(crate) fn print_processes(program: &Path, json: bool) -> anyhow::Result<()> {
    let begun = Instant::now();
    let folder = tempfile::tempdir()?;
    let rows = processes::study(program, folder.path())?;
    let origin = Origin::new("speed --program", [1, 1], begun);
    if json {
        return print_json(origin, &rows);
    }
    println!("CPU time in s of whole processes, median of five pairs, and the ratio of a pair");
    println!(
        "{:<20} {:>9} {:>9} {:>8} {:>15}",
        "", "allanite", "beside", "ratio", "least to most"
    );
    for row in rows {
        let ([ours, theirs], [least, ratio, most]) = (row.cpu_s, row.ratios);
        let range = format!("{least:.2} to {most:.2}");
        println!(
            "{:<20} {ours:>9.2} {theirs:>9.2} {ratio:>8.2} {range:>15}",
            row.work
        );
    }
    println!("\n{origin}");
    Ok(())
}
