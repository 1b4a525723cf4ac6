//! What is said of filters that run at a multiple of the rate.

use allanite_studies::chains::{KINDS, study};

pub(crate) fn print(records: u64, octaves: u32, as_device: bool, chain: &str) {
    println!("records of 2^{octaves} samples at 100 Hz; counts of records");
    println!(
        "{:<44} {:>7} {:>12} {:>7} {:>11} {:>9} {:>11} {:>9}",
        "chain", "records", "filter alone", "beside", "unexplained", "N covered", "N off 10 %", "free form"
    );
    for kind in KINDS.into_iter().filter(|kind| kind.name.contains(chain)) {
        let t = study(kind, records, 1 << octaves, as_device);
        println!(
            "{:<44} {:>7} {:>12} {:>7} {:>11} {:>9} {:>11} {:>9}",
            kind.name, t.records, t.alone, t.beside, t.unexplained, t.covered, t.off, t.freeform
        );
        for said in &t.words {
            println!("         said: {said}");
        }
    }
}
