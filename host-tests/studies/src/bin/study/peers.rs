//! The library beside other programs.

use allanite_host::simulate::{Hidden, Preset};
use allanite_studies::{
    RATE_HZ,
    long::Program,
    peers::{
        Environment, PEERS,
        agreement::{self, Agreement, agreement},
        coefficients::{self, Gyro, gyro},
        cost::{Cost, RUNS, SHORT, costs},
    },
    resources::commit,
};
use anyhow::{Context as _, Result};
use clap::{Args, ValueEnum};
use serde::Serialize;
use std::{path::PathBuf, time::Instant};

#[derive(Args)]
pub(crate) struct Arguments {
    /// Records of each gyro for the errors of the coefficients; a fifth of them for hidden effects
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u64).range(10..))]
    records: u64,
    /// Samples of the record for CPU time and memory
    #[arg(long, default_value_t = 10_000_000, value_parser = clap::value_parser!(u64).range(1 << 16..1 << 30))]
    samples: u64,
    /// Study only this part
    #[arg(long)]
    part: Option<Part>,
    /// Study the coefficients of this preset only
    #[arg(long)]
    preset: Option<Preset>,
    /// Folder for the virtual environment and the crates [default: a temporary folder]
    #[arg(long, value_name = "FOLDER")]
    install: Option<PathBuf>,
    /// Print JSON instead of tables
    #[arg(long)]
    json: bool,
}

/// The parts of the study.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Part {
    /// Whether deviations agree.
    Deviations,
    /// CPU time and memory.
    Cost,
    /// Errors of coefficients where nothing is hidden.
    Coefficients,
    /// Errors of coefficients beside a hidden effect, and what is said of it.
    Hidden,
}

#[derive(Serialize)]
struct Figures {
    commit: String,
    packages: Vec<&'static str>,
    missing: Vec<(&'static str, String)>,
    agreement_samples: u64,
    agreement: Vec<Agreement>,
    cost_samples: u64,
    cost: Vec<Cost>,
    coefficient_samples: u64,
    gyros: Vec<Gyro>,
    run_time_s: f64,
}

/// The hidden effects: a line of 0.4 standard deviations of the white noise of a sample, and a filter of two poles.
fn hidden(preset: Preset) -> Result<[Hidden; 2]> {
    let white = preset.coefficients().angle_random_walk;
    let line = Hidden::new("sinusoid", [7.7, 0.0], 0.4 * white * RATE_HZ.sqrt());
    let filter = Hidden::new("low_pass", [0.02, 2.0], white);
    Ok([
        line.context("in the catalogue")?,
        filter.context("in the catalogue")?,
    ])
}

pub(crate) fn print(arguments: &Arguments, program: &Program) -> Result<()> {
    let begun = Instant::now();
    let temporary = tempfile::tempdir()?;
    let install = arguments.install.clone();
    let environment = Environment::new(&install.unwrap_or_else(|| temporary.path().join("peers")))?;
    for (package, why) in &environment.missing {
        eprintln!("{package} cannot be installed and is left out: {why}");
    }
    let mut packages: Vec<&str> = PEERS.iter().map(|peer| peer.package).collect();
    packages.dedup();
    let mut figures = Figures {
        commit: commit(),
        packages,
        missing: environment.missing.clone(),
        agreement_samples: agreement::SAMPLES,
        agreement: Vec::new(),
        cost_samples: arguments.samples,
        cost: Vec::new(),
        coefficient_samples: coefficients::SAMPLES,
        gyros: Vec::new(),
        run_time_s: 0.0,
    };
    let folder = temporary.path();
    let is_chosen = |part| arguments.part.is_none_or(|only| only == part);
    let tables = !arguments.json;
    if tables {
        println!("commit {}; {}", figures.commit, figures.packages.join(", "));
    }
    if is_chosen(Part::Deviations) {
        figures.agreement = agreement(&environment, folder)?;
        if tables {
            print_agreement(&figures);
        }
    }
    if is_chosen(Part::Cost) {
        figures.cost = costs(&environment, program, folder, arguments.samples)?;
        if tables {
            print_cost(&figures);
        }
    }
    let is_studied = |preset: &Preset| arguments.preset.is_none_or(|only| only == *preset);
    let mut gyros = Vec::new();
    if is_chosen(Part::Coefficients) {
        let presets = Preset::TYPICAL.into_iter().filter(is_studied);
        gyros.extend(presets.map(|preset| (preset, None, arguments.records)));
    }
    if is_chosen(Part::Hidden) && is_studied(&Preset::Mems) {
        let effects = hidden(Preset::Mems)?;
        let few = (arguments.records / 5).max(2);
        gyros.extend(effects.map(|hidden| (Preset::Mems, Some(hidden), few)));
    }
    for (preset, hidden, records) in gyros {
        let gyro = gyro(&environment, folder, preset, hidden, records)?;
        if tables {
            print_gyro(&gyro);
        }
        figures.gyros.push(gyro);
    }
    figures.run_time_s = begun.elapsed().as_secs_f64();
    if tables {
        println!("\n{:.0} s of run time", figures.run_time_s);
    } else {
        println!("{}", serde_json::to_string(&figures)?);
    }
    Ok(())
}

fn print_agreement(figures: &Figures) {
    println!(
        "\nOne record of {} samples, seed {}: largest relative difference of a deviation from ours",
        figures.agreement_samples,
        agreement::SEED
    );
    println!(
        "{:<24} {:>8} {:>16} {:>16} {:>10}",
        "program", "octaves", "same definition", "own definition", "σ"
    );
    for row in &figures.agreement {
        println!(
            "{:<24} {:>8} {:>16.1e} {:>15.2}% {:>10.2}",
            row.peer,
            row.octaves,
            row.same,
            100.0 * row.own,
            row.own_errors
        );
    }
}

fn print_cost(figures: &Figures) {
    println!(
        "\nOne record of {} samples, median of {RUNS} runs, less that of {SHORT} samples; a channel",
        figures.cost_samples
    );
    println!(
        "{:<24} {:>5} {:>10} {:>17} {:>8} {:>9} {:>9} {:>10} {:>9}",
        "program",
        "taus",
        "CPU, s",
        "of all channels",
        "ns each",
        "MiB",
        "B each",
        "start, s",
        "MiB"
    );
    let n = figures.cost_samples as f64;
    let mib = f64::from(1 << 20);
    for row in &figures.cost {
        println!(
            "{:<24} {:>5} {:>10.3} {:>17} {:>8.1} {:>9.2} {:>9.3} {:>10.3} {:>9.1}",
            row.program,
            row.taus,
            row.channel_s(),
            format!("{:.3} to {:.3}", row.cpu_s[1], row.cpu_s[2]),
            1e9 * row.channel_s() / n,
            row.channel_bytes() / mib,
            row.channel_bytes() / n,
            row.start_s,
            row.start_bytes / mib
        );
    }
    let cost = |name: &str| figures.cost.iter().find(|row| row.program == name);
    let Some(peer) = cost("allantools") else {
        return;
    };
    for ours in figures
        .cost
        .iter()
        .filter(|row| row.program.starts_with("allanite"))
    {
        println!(
            "allantools takes {:.1} times the CPU time and at least {:.0} times the memory of {}",
            peer.channel_s() / ours.channel_s(),
            ours.times_the_memory(peer),
            ours.program
        );
    }
}

fn print_gyro(gyro: &Gyro) {
    println!(
        "\n{}, {}: seeds {} to {}, {} samples; relative to the truth",
        gyro.preset,
        gyro.hidden.unwrap_or("nothing hidden"),
        gyro.seeds[0],
        gyro.seeds[1],
        coefficients::SAMPLES
    );
    println!(
        "{:<24} {:>10} {:>7} {:>18} {:>18} {:>16}",
        "program", "", "records", "mean error, %", "rms error, %", "rms / ours"
    );
    for method in &gyro.methods {
        for row in &method.errors {
            let percent =
                |[value, error]: [f64; 2]| format!("{:.2} ± {:.2}", 100.0 * value, 100.0 * error);
            let ratio = |[value, error]: [f64; 2]| match value.is_nan() {
                true => String::new(),
                false => format!("{value:.2} ± {error:.2}"),
            };
            println!(
                "{:<24} {:>10} {:>7} {:>18} {:>18} {:>16}",
                method.program,
                row.coefficient,
                row.records,
                percent(row.bias),
                percent(row.rms),
                ratio(row.ratio)
            );
        }
        for (note, records) in &method.notes {
            println!("{:<24} says of {records} records: {note}", method.program);
        }
    }
    for (name, [value, error]) in &gyro.familiar {
        println!("{name}: {value:.4} ± {error:.4}");
    }
}
