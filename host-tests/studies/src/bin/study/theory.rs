//! The covariance of the curve and χ² of the fit against simulated records.

use allanite::fit::Options;
use allanite_host::simulate::{Coefficients, Preset};
use allanite_studies::theory;

pub(crate) fn print(records: u64) {
    let none = Coefficients::default();
    let cases = [
        (
            "white",
            Coefficients {
                angle_random_walk: 1.0,
                ..none
            },
        ),
        (
            "flicker",
            Coefficients {
                bias_instability: 1.0,
                ..none
            },
        ),
        (
            "random walk",
            Coefficients {
                rate_random_walk: 1.0,
                ..none
            },
        ),
        (
            "quantization",
            Coefficients {
                quantization: 1.0,
                ..none
            },
        ),
        ("mems", Preset::Mems.coefficients()),
    ];
    for (name, coefficients) in cases {
        println!("\n{name}: {records} records of 2^14 samples; simulated / theory");
        println!(
            "{:>6} {:>7} {:>9}  correlation at 1, 2, 3, 4 octaves",
            "m", "mean", "variance"
        );
        for octave in theory::scatter(coefficients, 1 << 14, records) {
            print!(
                "{:>6} {:>7.4} {:>9.3} ",
                octave.m, octave.mean, octave.variance
            );
            for (simulated, theory) in octave.correlations {
                if simulated.is_nan() {
                    print!(" {:>11}", "");
                } else {
                    print!(" {simulated:>5.2}/{theory:<5.2}");
                }
            }
            println!();
        }
    }
    println!("\nχ² of the fit, mems, {records} records of 2^16 samples");
    println!(
        "{:>10} {:>6} {:>7} {:>6} {:>6} {:>6}",
        "tolerance", "mean", "median", "90 %", "95 %", "99 %"
    );
    for tolerance in [0.0, Options::default().tolerance] {
        let settings = Options {
            tolerance,
            ..Options::default()
        };
        let chi_squared =
            theory::chi_squared(Preset::Mems.coefficients(), 1 << 16, records, settings);
        let [mean, median, p90, p95, p99] = theory::summary(&chi_squared);
        println!("{tolerance:>10} {mean:>6.1} {median:>7.1} {p90:>6.1} {p95:>6.1} {p99:>6.1}");
    }
}
