//! The smallest effects that are found.

use allanite_studies::smallest::{FACTORS, KINDS, study};

pub(crate) fn print(records: u64) {
    println!(
        "shares of records in %, by multiples of the size that half of the whole periodograms would show"
    );
    print!("{:<18} {:>7}", "effect", "records");
    for factor in FACTORS {
        print!(" {factor:>6}");
    }
    println!();
    for kind in KINDS {
        let (of, told) = study(kind, records);
        print!("{:<18} {of:>7}", kind.0);
        for told in told {
            print!(" {:>6.0}", 100.0 * told as f64 / of as f64);
        }
        println!();
    }
}
