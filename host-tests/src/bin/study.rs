//! The studies behind the README's figures: `cargo xtask study NAME`.

use allanite::Settings;
use clap::{Parser, Subcommand};
use host_tests::{
    simulate::{Coefficients, Preset},
    study::{coefficients, theory},
};

#[derive(Parser)]
#[command(about = "Statistics over thousands of simulated records")]
struct Arguments {
    #[command(subcommand)]
    study: Study,
}

#[derive(Subcommand)]
enum Study {
    /// Covariance of the curve and χ² of the fit, against simulated records
    Theory {
        /// Records a table
        #[arg(long, default_value_t = 3000)]
        records: u64,
    },
    /// Errors of the coefficients and coverage of their intervals, for every method
    Coefficients {
        /// Records a method
        #[arg(long, default_value_t = 1000)]
        records: u64,
        /// Model tolerance
        #[arg(long, default_value_t = Settings::default().tolerance)]
        tolerance: f64,
    },
}

fn main() {
    match Arguments::parse().study {
        Study::Theory { records } => theory(records),
        Study::Coefficients { records, tolerance } => accuracies(records, tolerance),
    }
}

fn theory(records: u64) {
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
    for tolerance in [0.0, Settings::default().tolerance] {
        let settings = Settings {
            tolerance,
            ..Settings::default()
        };
        let chi_squared =
            theory::chi_squared(Preset::Mems.coefficients(), 1 << 16, records, settings);
        let [mean, median, p90, p95, p99] = theory::summary(&chi_squared);
        println!("{tolerance:>10} {mean:>6.1} {median:>7.1} {p90:>6.1} {p95:>6.1} {p99:>6.1}");
    }
}

fn accuracies(records: u64, tolerance: f64) {
    println!("mems, {records} records of 2^17 samples");
    for (name, method) in coefficients::METHODS {
        let settings = Settings { method, tolerance };
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
        for (symbol, a) in ["Q", "N", "B", "K", "R"].iter().zip(accuracies) {
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
