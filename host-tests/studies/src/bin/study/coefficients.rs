//! The errors of the coefficients and the coverage of their intervals.

use super::SYMBOLS;
use allanite::fit::Options;
use allanite_host::simulate::Preset;
use allanite_studies::coefficients;

pub(crate) fn print(records: u64, tolerance: f64) {
    println!("mems, {records} records of 2^17 samples");
    for (name, method) in coefficients::METHODS {
        let settings = Options { method, tolerance };
        let (accuracies, negative) =
            coefficients::accuracy(Preset::Mems.coefficients(), 1 << 17, records, settings);
        println!(
            "\n{name}: a negative square in {:.0} % of the records",
            100.0 * negative
        );
        println!(
            "{:>3} {:>10} {:>8} {:>10} {:>10}",
            "", "rms error", "bias", "coverage", "measured"
        );
        for (symbol, a) in SYMBOLS.iter().zip(accuracies) {
            println!(
                "{symbol:>3} {:>9.2}% {:>7.2}% {:>9.1}% {:>9.1}%",
                100.0 * a.rms_error,
                100.0 * a.bias,
                100.0 * a.coverage,
                100.0 * a.measured
            );
        }
    }
}
