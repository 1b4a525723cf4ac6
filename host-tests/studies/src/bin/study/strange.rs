//! What is said of noise that the catalogue does not have.

use allanite_studies::strange::{KINDS, study};

pub(crate) fn print(records: u64) {
    println!("records of 2^17 samples at 100 Hz; counts of records");
    println!(
        "{:<68} {:>7} {:>6} {:>6} {:>6} {:>6} {:>6} {:>9} {:>5}",
        "kind", "records", "right", "honest", "wrong", "beside", "silent", "N covered", "order"
    );
    for kind in KINDS {
        let t = study(kind, records);
        let counted =
            |count: Option<usize>| count.map_or("–".to_owned(), |count| count.to_string());
        println!(
            "{:<68} {:>7} {:>6} {:>6} {:>6} {:>6} {:>6} {:>9} {:>5}",
            kind.name,
            t.records,
            t.right,
            t.honest,
            t.wrong,
            t.beside,
            t.silent,
            counted(t.covered),
            counted(t.order)
        );
        for said in &t.words {
            println!("         said: {said}");
        }
    }
}
