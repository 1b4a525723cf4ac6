//! What single precision changes.

use allanite_host::quantile::quantile;
use allanite_studies::precision;
use anyhow::Result;

pub(crate) fn print(records: u64) -> Result<()> {
    let fits = precision::fits(records)?;
    println!("single compared with double precision: fits of {records} records of 2^18 samples");
    println!(
        "{:>28} {:>9} {:>9} {:>9}",
        "difference of", "median", "99 %", "largest"
    );
    for (what, sorted) in [
        ("coefficients, std. errors", &fits.standard_errors),
        ("χ²", &fits.chi_squared),
    ] {
        let [median, most, largest] = [0.5, 0.99, 1.0].map(|share| quantile(sorted, share));
        println!("{what:>28} {median:>9.1e} {most:>9.1e} {largest:>9.1e}");
    }
    println!("\ndiagnoses of {records} records of 2^17 samples each");
    println!(
        "{:>28} {:>9} {:>22}",
        "hidden", "the same", "differ, ambiguous"
    );
    for (name, alike) in precision::diagnoses(records)? {
        println!("{name:>28} {:>9} {:>22}", alike.same, alike.ambiguous);
    }
    Ok(())
}
