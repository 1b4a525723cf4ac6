//! The studies that the README's figures rest on: `cargo xtask study NAME`.

use allanite::fit::Options;
use anyhow::{Context as _, Result, bail};
use clap::{Parser, Subcommand};
use host_tests::{
    simulate::{Coefficients, Preset},
    study::{
        clean::{self, Absent},
        coefficients,
        hidden_effect::{Strength, both_found, cases, false_alarms, hide, study},
        lines, paper, precision, quantile,
        self_test::{self, Looks},
        theory, thermal,
    },
};
use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

/// The symbols of the five terms, in the order of the model.
const SYMBOLS: [&str; 5] = ["Q", "N", "B", "K", "R"];

#[derive(Parser)]
#[command(about = "Statistics over thousands of simulated records")]
struct Arguments {
    #[command(subcommand)]
    study: Study,
}

#[derive(Subcommand)]
enum Study {
    /// Compare the theoretical covariance of the curve and χ² of the fit with simulated records
    Theory {
        /// Number of records per table
        #[arg(long, default_value_t = 3000)]
        records: u64,
    },
    /// Repeat the experiment of Lv, Liu, Lai & Huang 2015: ordinary and weighted least squares on gyros of
    /// three grades
    Paper {
        /// Number of records per gyro
        #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u64).range(2..))]
        records: u64,
        /// Print JSON instead of a table
        #[arg(long)]
        json: bool,
        /// Draw one record of each gyro and its fits into this file, .svg or .png
        #[arg(long, value_name = "FILE")]
        figure: Option<PathBuf>,
    },
    /// Count how often a hidden effect is found, named and measured, and how often one is claimed in vain
    HiddenEffect {
        /// Number of records per case
        #[arg(long, default_value_t = 100)]
        records: u64,
        /// Number of records per preset in which nothing is hidden
        #[arg(long, default_value_t = 1000)]
        clean: u64,
        /// Study only this preset
        #[arg(long)]
        preset: Option<Preset>,
        /// Study only this effect
        #[arg(long)]
        effect: Option<String>,
    },
    /// Count what is said about records with one line of random frequency and amplitude
    Lines {
        /// Number of records per preset
        #[arg(long, default_value_t = 1000)]
        records: u64,
    },
    /// Count what is claimed of records in which nothing is hidden, at every length, and which absent terms are measured
    Clean {
        /// Number of records per gyro
        #[arg(long, default_value_t = 1000)]
        records: u64,
        /// Study only this preset
        #[arg(long)]
        preset: Option<Preset>,
        /// Multiply the rate random walk
        #[arg(long, default_value_t = 1.0)]
        walk: f64,
    },
    /// Count how often a temperature that the rate depends on is found, and another one is blamed
    Thermal {
        /// Number of records per case
        #[arg(long, default_value_t = 1000)]
        records: u64,
    },
    /// Count how often the self-test errs, and compare its length with a test of fixed length
    SelfTest {
        /// Number of devices per case
        #[arg(long, default_value_t = 4000)]
        devices: u64,
    },
    /// Compare single with double precision on the same records
    Precision {
        /// Number of records per table
        #[arg(long, default_value_t = 1000)]
        records: u64,
    },
    /// Measure errors of the coefficients and coverage of their intervals, for every method
    Coefficients {
        /// Number of records per method
        #[arg(long, default_value_t = 1000)]
        records: u64,
        /// Relative tolerance of the model
        #[arg(long, default_value_t = Options::default().tolerance)]
        tolerance: f64,
    },
}

fn main() -> Result<()> {
    match Arguments::parse().study {
        Study::Theory { records } => theory(records),
        Study::Paper {
            records,
            json,
            figure,
        } => experiment(records, json, figure.as_deref())?,
        Study::HiddenEffect {
            records,
            clean,
            preset,
            effect,
        } => hidden(records, clean, preset, effect.as_deref()),
        Study::Lines { records } => random_lines(records),
        Study::Clean {
            records,
            preset,
            walk,
        } => clean_records(records, preset, walk),
        Study::Thermal { records } => temperatures(records),
        Study::SelfTest { devices } => self_tests(devices),
        Study::Precision { records } => precisions(records)?,
        Study::Coefficients { records, tolerance } => accuracies(records, tolerance),
    }
    Ok(())
}

fn precisions(records: u64) -> Result<()> {
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

fn experiment(records: u64, json: bool, figure: Option<&Path>) -> Result<()> {
    if let Some(path) = figure {
        draw(path).with_context(|| path.display().to_string())?;
    }
    let experiment = paper::study(records);
    if json {
        println!("{}", serde_json::to_string_pretty(&experiment)?);
    } else {
        print!("{experiment}");
    }
    Ok(())
}

/// Draws the first record of each gyro.
fn draw(path: &Path) -> Result<()> {
    let drawing = || paper::figure::figure(0);
    let bytes = match path.extension().and_then(|extension| extension.to_str()) {
        Some("svg") => drawing().into_bytes(),
        #[cfg(feature = "pictures")]
        Some("png") => host_tests::plot::png(&drawing())?,
        _ => bail!("a figure must end in .svg, or in .png with the feature `pictures`"),
    };
    Ok(fs::write(path, bytes)?)
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

fn accuracies(records: u64, tolerance: f64) {
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

fn hidden(records: u64, clean: u64, only: Option<Preset>, effect: Option<&str>) {
    let presets = || {
        Preset::TYPICAL
            .into_iter()
            .filter(|&preset| only.is_none_or(|only| only == preset))
    };
    println!("records of 2^16 samples at 100 Hz; errors in %, coverage of 95 % intervals in %");
    println!(
        "{:<8} {:<18} {:<12} {:<8} {:>6} {:>8} | {:>5} {:>5} {:>5} {:>5} | {:>6} {:>5} {:>6} {:>5} {:>6} {:>5} | {:>13} {:>13} {:>5}",
        "preset",
        "effect",
        "shape",
        "strength",
        "χ²",
        "p",
        "right",
        "amb.",
        "wrong",
        "miss",
        "par.",
        "cov.",
        "par.",
        "cov.",
        "coeff.",
        "cov.",
        "rms",
        "held out",
        "falls"
    );
    for preset in presets() {
        for (name, parameters) in cases().filter(|(name, _)| effect.is_none_or(|e| e == *name)) {
            for strength in Strength::ALL {
                let Some(hidden) = hide(name, parameters, preset, strength) else {
                    continue;
                };
                let t = study(preset, &hidden, records);
                let percent = |count: usize| 100.0 * count as f64 / t.records as f64;
                print!(
                    "{:<8} {:<18} {:<12} {:<8} {:>6.0} {:>8.0e} | {:>5.0} {:>5.0} {:>5.0} {:>5.0} |",
                    format!("{preset:?}").to_lowercase(),
                    name,
                    format!("{:.4} {}", hidden.parameters[0], hidden.parameters[1]),
                    format!("{strength:?}").to_lowercase(),
                    t.median.0,
                    t.median.1,
                    percent(t.right),
                    percent(t.ambiguous),
                    percent(t.wrong),
                    percent(t.missed)
                );
                for j in 0..2 {
                    match (t.parameter_error.get(j), t.parameter_coverage.get(j)) {
                        (Some(error), Some(coverage)) if !error.is_nan() => {
                            print!(" {:>6.1} {:>5.0}", 100.0 * error, 100.0 * coverage);
                        }
                        _ => print!(" {:>6} {:>5}", "", ""),
                    }
                }
                println!(
                    " {:>6.1} {:>5.0} | {:>5.1} → {:>5.1} {:>5.1} → {:>5.1} {:>5.0}",
                    100.0 * t.coefficient_error,
                    100.0 * t.coefficient_coverage,
                    t.rms[0].0,
                    t.rms[0].1,
                    t.rms[1].0,
                    t.rms[1].1,
                    100.0 * t.held_out_falls
                );
            }
        }
    }
    if effect.is_none() {
        println!(
            "\ntwo strong effects at once, a sinusoid and a filter of two stages; share with both found:"
        );
        for preset in presets() {
            if let Some(share) = both_found(preset, records) {
                println!(
                    "{:<8} {:.0} %",
                    format!("{preset:?}").to_lowercase(),
                    100.0 * share
                );
            }
        }
    }
    println!("\nnothing hidden, {clean} records per preset; share with an effect claimed:");
    for preset in presets() {
        let (share, names) = false_alarms(preset, clean);
        println!(
            "{:<8} {:.1} % {names:?}",
            format!("{preset:?}").to_lowercase(),
            100.0 * share
        );
    }
}

fn random_lines(records: u64) {
    println!(
        "{:<8} {:>7} {:>7} {:>7} | {:>7} {:>7} {:>9} | {:>8} {:>7} {:>11}",
        "gyro",
        "records",
        "aborted",
        "nothing",
        "line",
        "within",
        "ambiguous",
        "and more",
        "others",
        "unexplained"
    );
    println!(
        "{:<8} {:>7} {:>7} {:>7} | {:>7} {:>7}",
        "", "", "", "", "alone", "1 %"
    );
    for preset in Preset::TYPICAL {
        let t = lines::study(preset, records);
        println!(
            "{:<8} {:>7} {:>7} {:>7} | {:>7} {:>7} {:>9} | {:>8} {:>7} {:>11}",
            format!("{preset:?}").to_lowercase(),
            t.records,
            t.aborted,
            t.nothing,
            t.line,
            t.exact,
            t.ambiguous,
            t.more,
            t.others,
            t.unexplained
        );
        for line in t.wrong {
            println!(
                "         {:.4} Hz, amplitude {:.4}",
                line.frequency_hz, line.amplitude
            );
        }
    }
}

fn clean_records(records: u64, only: Option<Preset>, walk: f64) {
    let presets = Preset::TYPICAL.into_iter();
    for preset in presets.filter(|&preset| only.is_none_or(|only| only == preset)) {
        for absent in [0, 2, 3, 4]
            .map(Absent::Term)
            .into_iter()
            .chain([Absent::None])
        {
            let mut coefficients = clean::without(preset, absent);
            coefficients.rate_random_walk *= walk;
            let lacks = match absent {
                Absent::None => "all five terms".to_owned(),
                Absent::Term(i) => format!("{} absent", SYMBOLS[i]),
            };
            println!(
                "\n{}, {lacks}, {records} records; shares in %",
                format!("{preset:?}").to_lowercase()
            );
            println!(
                "{:>8} {:>7} {:>10} {:>7} | {:>34} | {:>34}",
                "samples",
                "aborted",
                "inadequate",
                "claimed",
                "measured: Q N B K R",
                "covered: Q N B K R"
            );
            for (tally, length) in clean::study(coefficients, records)
                .into_iter()
                .zip(clean::LENGTHS)
            {
                let percent = |count: usize| 100.0 * count as f64 / tally.records as f64;
                print!(
                    "{:>8} {:>7.1} {:>10.1} {:>7.1} |",
                    format!("2^{length}"),
                    percent(tally.aborted),
                    percent(tally.inadequate),
                    percent(tally.claimed.len())
                );
                for count in tally.measured {
                    print!(" {:>6.1}", percent(count));
                }
                print!(" |");
                for count in tally.covered {
                    print!(" {:>6.1}", percent(count));
                }
                println!("  {:?}", counted(&tally.claimed));
            }
        }
    }
}

/// The distinct names, with how often each occurs.
fn counted<'a>(names: &[&'a str]) -> BTreeMap<&'a str, usize> {
    let mut counts = BTreeMap::new();
    for name in names {
        *counts.entry(*name).or_insert(0) += 1;
    }
    counts
}

fn temperatures(records: u64) {
    println!("mems at 20 Hz, {records} records of 2^16 samples, 0.01 deg/s per kelvin");
    println!(
        "{:<20} {:>6} {:>12} {:>9} {:>9} {:>11} {:>17} {:>13}",
        "course",
        "found",
        "mean slope",
        "coverage",
        "scatter",
        "error",
        "over the bound",
        "wrongly blamed"
    );
    for (name, course, kelvin, bound) in thermal::CASES {
        let t = thermal::study(course, kelvin, records);
        println!(
            "{name:<20} {:>4.1} % {:>10.3}   {:>7.1} % {:>9.5} {:>11.5} {:>17.2} {:>11.2} %",
            100.0 * t.found,
            t.mean,
            100.0 * t.coverage,
            t.deviation,
            t.error,
            t.error / bound,
            100.0 * t.blamed
        );
    }
    println!(
        "\nwith strong Gauss–Markov noise (T_c 1 s) and ten times the slope; share with both found:"
    );
    for (name, course, kelvin, _) in thermal::CASES {
        let share = thermal::with_gauss_markov(course, kelvin, records.min(200));
        println!("{name:<20} {:.1} %", 100.0 * share);
    }
}

/// The factors between coefficient and limit that are studied.
const FACTORS: [f64; 7] = [0.5, 1.0 / 1.3, 0.9, 1.0, 1.1, 1.3, 2.0];

fn self_tests(devices: u64) {
    println!(
        "{devices} devices per line; the plan allows {} % of false pass and as much of false fail",
        100.0 * self_test::PROBABILITY
    );
    println!(
        "false verdicts: share of passes above the limit, of fails below it, of either at it;"
    );
    println!("in brackets the upper end of its one-sided 95 % confidence interval");
    for case in self_test::CASES {
        let (shortest, longest) = case.lengths_s;
        println!(
            "\n{}, {shortest} s to {longest} s, {} times the flicker noise",
            case.effect, case.flicker
        );
        println!(
            "coefficient / limit   passed   failed  undecided  median s   false passes    false fails"
        );
        let mut missed: f64 = 0.0;
        let tallies = self_test::study(case, &FACTORS, devices, Looks::Early);
        for (factor, tally) in FACTORS.into_iter().zip(tallies) {
            println!(
                "{factor:>19.3} {:>6.2} % {:>6.2} % {:>8.2} % {:>9.2} {} {}",
                100.0 * tally.passed,
                100.0 * tally.failed,
                100.0 * tally.undecided,
                tally.median_s,
                false_share(factor >= 1.0, tally.passed, devices),
                false_share(factor <= 1.0, tally.failed, devices),
            );
            if factor == 1.3 || factor == 1.0 / 1.3 {
                let right = if factor > 1.0 {
                    tally.failed
                } else {
                    tally.passed
                };
                missed = missed.max(1.0 - right);
            }
        }
        let shares = [self_test::PROBABILITY, missed];
        for missed in shares.into_iter().filter(|_| case.compared) {
            let fixed = self_test::fixed_length_s(case, devices, missed);
            println!(
                "a test of one look that misses at most {:.2} % of devices a factor of 1.3 off the limit: {fixed:.1} s",
                100.0 * missed
            );
        }
    }
}

/// A share of false verdicts with the upper end of its confidence interval; nothing if the verdict is
/// right.
fn false_share(is_false: bool, share: f64, devices: u64) -> String {
    if !is_false {
        return format!("{:>14}", "");
    }
    let upper = self_test::at_most(share, devices);
    format!("{:>5.2} ({:.2}) %", 100.0 * share, 100.0 * upper)
}
