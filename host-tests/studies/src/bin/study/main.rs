//! The studies that the README's figures rest on: `cargo xtask study NAME`.

mod calibration;
mod chains;
mod clean;
mod coefficients;
mod confusion;
mod course;
mod detection;
mod efficiency;
mod export;
mod faults;
mod five_terms;
mod hidden_effect;
mod limits;
mod lines;
mod long;
mod losses;
mod lot;
mod motion;
mod origin;
mod own;
mod pairs;
mod paper;
mod peers;
mod precision;
mod rounding;
mod self_test;
mod slow;
mod smallest;
mod speed;
mod stamps;
mod strange;
mod theory;
mod thermal;

use allanite::fit::Options;
use allanite_cli::command::CommandLine;
use allanite_host::simulate::Preset;
use allanite_studies::{detection::Judged, long::Program, pairs::Kinds};
use anyhow::Result;
use clap::{Parser, Subcommand};
use std::{ffi::OsString, path::PathBuf};

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
    /// Count what is named where an effect of a fixed size is hidden
    Confusion {
        /// Number of records per case
        #[arg(long, default_value_t = 100)]
        records: u64,
        /// Study only this preset
        #[arg(long)]
        preset: Option<Preset>,
    },
    /// Count what is named where two and three effects of random kinds, sizes and shapes are hidden
    Pairs {
        /// Number of records per preset and number of effects
        #[arg(long, default_value_t = 300)]
        records: u64,
        /// Study only this preset
        #[arg(long)]
        preset: Option<Preset>,
        /// Hide every kind of the catalogue, rare ones too
        #[arg(long)]
        every_kind: bool,
    },
    /// Judge a lot of thousands of devices, with its table and its page, and measure time and memory
    Lot {
        /// Number of devices, each of three axes
        #[arg(long, default_value_t = 10_000, value_parser = clap::value_parser!(u64).range(10..=100_000))]
        devices: u64,
        /// The folder for the files of the devices, and for those of the lot [default: a temporary one]
        #[arg(long)]
        folder: Option<PathBuf>,
    },
    /// Count what is said of slow Gauss–Markov noise: a published benchmark, and noise of a size near its ideal limit
    Slow {
        /// Number of records of the benchmark
        #[arg(long, default_value_t = 100)]
        records: u64,
        /// Number of records near the limit
        #[arg(long, default_value_t = 100)]
        limits: u64,
        /// Multiply the limits
        #[arg(long, default_value_t = 2.0)]
        factor: f64,
    },
    /// Count how often the five terms are called adequate and limits pass beside slow noise, and how many promised lengths of
    /// records come true
    Limits {
        /// Number of records per kind
        #[arg(long, default_value_t = 300)]
        records: u64,
        /// The first seed
        #[arg(long, default_value_t = 0)]
        seed: u64,
        /// The limits, as multiples of the true coefficients
        #[arg(long, default_value_t = 0.9)]
        factor: f64,
        /// Follow up promised lengths only
        #[arg(long)]
        promises: bool,
    },
    /// Count what is said of noise behind a digital filter that is rounded to whole counts
    Rounding {
        /// Number of records per size and filter
        #[arg(long, default_value_t = 60)]
        records: u64,
        /// The first seed
        #[arg(long, default_value_t = 0)]
        seed: u64,
    },
    /// Count how many records tell an effect of the size that the whole periodogram would show, and of larger ones
    Smallest {
        /// Number of records per effect
        #[arg(long, default_value_t = 100)]
        records: u64,
    },
    /// Count what is said of white noise behind filters that run at a multiple of the rate of the log
    Chains {
        /// Number of records per chain
        #[arg(long, default_value_t = 60)]
        records: u64,
        /// Samples of a record, as a power of two
        #[arg(long, default_value_t = 17, value_parser = clap::value_parser!(u32).range(10..=24))]
        octaves: u32,
        /// With the catalogue alone, as a device
        #[arg(long)]
        catalogue: bool,
        /// Only chains with this part in their names
        #[arg(long, default_value = "")]
        chain: String,
    },
    /// Count what is said of noise that the catalogue does not have, or has only nearly
    Strange {
        /// Number of records per kind
        #[arg(long, default_value_t = 60)]
        records: u64,
    },
    /// Count how often an effect shows that is as large as its limit of detection
    Detection {
        /// Number of records per effect
        #[arg(long, default_value_t = 300)]
        records: u64,
        /// Study only this effect
        #[arg(long)]
        effect: Option<String>,
        /// Multiply the limits
        #[arg(long, default_value_t = 1.0)]
        factor: f64,
        /// Take limits from octaves alone, and diagnose octaves alone
        #[arg(long)]
        octaves: bool,
    },
    /// Accumulate a record of known sums, measure time and memory against its length, and merge what separate
    /// processes measured
    Long(#[command(flatten)] long::Arguments),
    /// Compare the library with other programs on the same records: deviations, CPU time, memory, errors of
    /// coefficients, and what is said of hidden effects. Needs Python and a connection to the package indexes
    Peers(#[command(flatten)] peers::Arguments),
    /// Measure a record with the library, and print what that took, for the study of peers
    #[command(hide = true)]
    Own {
        /// What to do
        task: own::Task,
        /// Record of 32-bit counts, .npy
        file: PathBuf,
    },
    /// Run a command of `allanite` in this process, for the studies that need several processes
    #[command(hide = true)]
    Allanite {
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<OsString>,
    },
    /// Give exported models to a Kalman filter, and count whether it knows its errors
    Export {
        /// Number of gyros
        #[arg(long, default_value_t = 100)]
        gyros: u64,
        /// Seed of the first one
        #[arg(long, default_value_t = 1000)]
        seed: u64,
        /// The preset whose white noise and quantization the gyros have
        #[arg(long, default_value = "mems")]
        preset: Preset,
        /// Add the bias instability and the random walk of the preset
        #[arg(long)]
        real: bool,
        /// Instead, read every format by the parser of the program that it is for
        #[arg(long)]
        consumers: bool,
        /// Instead, give white noise and the random walk of gyros with bias instability to a filter
        #[arg(long, conflicts_with = "consumers")]
        walks: bool,
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
        /// Study only gyros without the term of this symbol, or those that lack the rate ramp alone
        #[arg(long, value_parser = ["Q", "B", "K", "nothing"])]
        absent: Option<String>,
        /// Multiply the rate random walk
        #[arg(long, default_value_t = 1.0)]
        walk: f64,
        /// Study records whose five terms have random sizes, as floats and as counts, instead of the presets
        #[arg(long, conflicts_with_all = ["preset", "absent", "walk"])]
        mixtures: bool,
        /// Seed of the first of these records
        #[arg(long, default_value_t = 0, requires = "mixtures")]
        seed: u64,
    },
    /// Count how often a temperature that the rate depends on is found, and another one is blamed
    Thermal {
        /// Number of records per case
        #[arg(long, default_value_t = 1000)]
        records: u64,
        /// Draw the course, the lag and the noise of the temperature at random
        #[arg(long, conflicts_with = "steps")]
        drawn: bool,
        /// Round the temperature to steps of 0.01 to 1 K
        #[arg(long)]
        steps: bool,
    },
    /// Count how often the course of a record tells of a change of noise, of bursts, a step and a warm-up, when there is one and when there is none
    Course {
        /// Number of records per preset
        #[arg(long, default_value_t = 1000)]
        records: u64,
        /// Study only this preset
        #[arg(long)]
        preset: Option<Preset>,
        /// Study only records without events
        #[arg(long)]
        clean: bool,
    },
    /// Count how often repeated, stuck and clipped samples and dead bands are told, and how often without one
    Faults {
        /// Number of records per fault
        #[arg(long, default_value_t = 1000)]
        records: u64,
        /// Number of records without a fault
        #[arg(long, default_value_t = 20_000)]
        clean: u64,
        /// Seed of the records
        #[arg(long, default_value_t = 0)]
        seed: u64,
    },
    /// Compare records of which samples are lost with the same records without losses
    Losses {
        /// Number of records per kind of gyro and of loss
        #[arg(long, default_value_t = 400)]
        records: u64,
    },
    /// Count how often motion that never stops is told, and how often in records at rest
    Motion {
        /// Number of records in motion, of all kinds
        #[arg(long, default_value_t = 6000)]
        records: u64,
        /// Number of records at rest, of all kinds
        #[arg(long, default_value_t = 12_000)]
        rest: u64,
        /// Seed of the records
        #[arg(long, default_value_t = 0)]
        seed: u64,
    },
    /// Compare the small fit of the five terms with the general one
    FiveTerms {
        /// Number of records per kind of gyro
        #[arg(long, default_value_t = 500)]
        records: u64,
        /// Length of the longest record, as a power of two
        #[arg(long, default_value_t = 19.0)]
        longest: f64,
        /// Seed of the records
        #[arg(long, default_value_t = 0)]
        seed: u64,
    },
    /// Compare the losses and the rate that are told of logs with late stamps with the true ones
    Stamps {
        /// Number of records per kind of stamps and share of losses
        #[arg(long, default_value_t = 200)]
        records: u64,
        /// Seed of the records
        #[arg(long, default_value_t = 0)]
        seed: u64,
    },
    /// Count how often the self-test errs, and compare its length with a test of fixed length
    SelfTest {
        /// Number of devices per case
        #[arg(long, default_value_t = 4000)]
        devices: u64,
        /// Study only limits of this effect
        #[arg(long)]
        effect: Option<String>,
        /// Study only gyros with this multiple of the preset's flicker noise
        #[arg(long)]
        flicker: Option<f64>,
    },
    /// Measure whether p-values are uniform and intervals contain the truth, with and without a hidden effect
    Calibration {
        /// Number of records per case
        #[arg(long, default_value_t = 1000)]
        records: u64,
        /// Study only this preset
        #[arg(long)]
        preset: Option<Preset>,
        /// Relative tolerance of the model, instead of that of a diagnosis
        #[arg(long)]
        tolerance: Option<f64>,
        /// Print JSON instead of a table
        #[arg(long)]
        json: bool,
    },
    /// Compare errors with the smallest ones that the records allow, of coefficients and of effects' sizes and shapes
    Efficiency {
        /// Number of records per case
        #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u64).range(2..))]
        records: u64,
        /// Study only this preset
        #[arg(long)]
        preset: Option<Preset>,
        /// Print JSON instead of tables
        #[arg(long)]
        json: bool,
    },
    /// Time how fast logs of every type of element are read, and how fast an accumulator takes slices
    Speed {
        /// Number of samples
        #[arg(long, default_value_t = 10_000_000, value_parser = clap::value_parser!(u32).range(1000..))]
        samples: u32,
        /// Print JSON instead of a table
        #[arg(long)]
        json: bool,
        /// Instead, time whole logs with this program, such as target/release/allanite, beside pyarrow, polars and numpy
        #[arg(long)]
        program: Option<PathBuf>,
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
        Study::Theory { records } => theory::print(records),
        Study::Paper {
            records,
            json,
            figure,
        } => paper::print(records, json, figure.as_deref())?,
        Study::HiddenEffect {
            records,
            clean,
            preset,
            effect,
        } => hidden_effect::print(records, clean, preset, effect.as_deref()),
        Study::Confusion { records, preset } => confusion::print(records, preset),
        Study::Pairs {
            records,
            preset,
            every_kind,
        } => {
            let kinds = if every_kind {
                Kinds::Every
            } else {
                Kinds::Usual
            };
            pairs::print(records, preset, kinds);
        }
        Study::Lot { devices, folder } => lot::print(devices, folder.as_deref(), &allanite()?)?,
        Study::Slow {
            records,
            limits,
            factor,
        } => slow::print(records, limits, factor),
        Study::Limits {
            records,
            seed,
            promises: true,
            ..
        } => limits::print_promises(records, seed),
        Study::Limits {
            records,
            seed,
            factor,
            ..
        } => limits::print(records, seed, factor),
        Study::Rounding { records, seed } => rounding::print(records, seed),
        Study::Smallest { records } => smallest::print(records),
        Study::Chains {
            records,
            octaves,
            catalogue,
            chain,
        } => chains::print(records, octaves, catalogue, &chain),
        Study::Strange { records } => strange::print(records),
        Study::Detection {
            records,
            effect,
            factor,
            octaves,
        } => {
            let judged = if octaves {
                Judged::Octaves
            } else {
                Judged::Spectrum
            };
            detection::print(records, effect.as_deref(), judged, factor);
        }
        Study::Long(arguments) => long::print(&arguments, &allanite()?)?,
        Study::Peers(arguments) => peers::print(&arguments, &allanite()?)?,
        Study::Own { task, file } => own::print(task, &file)?,
        Study::Allanite { arguments } => {
            let name = [OsString::from("allanite")];
            CommandLine::try_parse_from(name.into_iter().chain(arguments))?.run()?;
        }
        Study::Export {
            gyros,
            seed,
            preset,
            real,
            consumers,
            walks,
        } => match (consumers, walks) {
            (true, _) => export::print_consumers()?,
            (_, true) => export::print_walks(preset, gyros, seed)?,
            _ => export::print(preset, gyros, seed, real)?,
        },
        Study::Lines { records } => lines::print(records),
        Study::Clean {
            records,
            preset,
            absent,
            walk,
            mixtures: false,
            ..
        } => clean::print(records, preset, absent.as_deref(), walk),
        Study::Clean { records, seed, .. } => clean::print_mixtures(records, seed),
        Study::Thermal {
            records,
            drawn: true,
            ..
        } => thermal::print_drawn(records),
        Study::Thermal {
            records,
            steps: true,
            ..
        } => thermal::print_steps(records),
        Study::Thermal { records, .. } => thermal::print(records),
        Study::Course {
            records,
            preset,
            clean,
        } => course::print(records, preset, clean),
        Study::Faults {
            records,
            clean,
            seed,
        } => faults::print(records, clean, seed),
        Study::Losses { records } => losses::print(records),
        Study::Motion {
            records,
            rest,
            seed,
        } => motion::print(records, rest, seed),
        Study::FiveTerms {
            records,
            longest,
            seed,
        } => five_terms::print(records, longest, seed),
        Study::Stamps { records, seed } => stamps::print(records, seed)?,
        Study::SelfTest {
            devices,
            effect,
            flicker,
        } => self_test::print(devices, effect.as_deref(), flicker),
        Study::Calibration {
            records,
            preset,
            tolerance,
            json,
        } => calibration::print(records, preset, tolerance, json)?,
        Study::Efficiency {
            records,
            preset,
            json,
        } => efficiency::print(records, preset, json)?,
        Study::Speed {
            samples,
            json,
            program,
        } => match program {
            Some(program) => speed::print_processes(&program, json)?,
            None => speed::print(samples as usize, json)?,
        },
        Study::Precision { records } => precision::print(records)?,
        Study::Coefficients { records, tolerance } => coefficients::print(records, tolerance),
    }
    Ok(())
}

/// This program, which runs the commands of `allanite` and tasks of the studies as well.
fn allanite() -> Result<Program> {
    Ok(Program {
        file: std::env::current_exe()?,
        first: vec!["allanite".into()],
    })
}
