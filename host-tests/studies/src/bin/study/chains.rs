//! What is said of filters that run at a multiple of the rate.

use allanite_studies::chains::{KINDS, study};

pub(crate) fn print(records: u64, octaves: u32) {
    println!("records of 2^{octaves} samples at 100 Hz; counts of records");
    println!(
        "{:<44} {:>7} {:>12} {:>7} {:>11} {:>9} {:>11}",
        "chain", "records", "filter alone", "beside", "unexplained", "N covered", "N off 10 %"
    );
    for kind in KINDS {
        let t = study(kind, records, 1 << octaves);
        println!(
            "{:<44} {:>7} {:>12} {:>7} {:>11} {:>9} {:>11}",
            kind.name, t.records, t.alone, t.beside, t.unexplained, t.covered, t.off
        );
        for said in &t.words {
            println!("         said: {said}");
        }
    }
}
