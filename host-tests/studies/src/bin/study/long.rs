//! Long records.

use allanite_studies::{
    long::{
        Distributed, Length, Merged, Program, RATE_HZ, Sequence, Slope, distributed, growth,
        merged, slope,
    },
    resources::{Resources, commit},
};
use anyhow::{Result, ensure};
use clap::Args;
use serde::Serialize;
use std::time::Instant;

/// The seed of the sequence.
const SEED: u64 = 1;

/// The shortest record that counts for the slopes: what the system does besides is then less than a hundredth.
const SHORTEST: u64 = 1 << 22;

#[derive(Args)]
pub(crate) struct Arguments {
    /// Samples of the record whose sums are known
    #[arg(long, default_value_t = 1 << 30, value_parser = clap::value_parser!(u64).range(1 << 12..1 << 40))]
    samples: u64,
    /// Parts of the same record that are accumulated apart and merged
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u64).range(1..=64))]
    parts: u64,
    /// Files of a record at 1 kHz that separate processes measure; a year has 8760 files of an hour, and 0 leaves this
    /// part out
    #[arg(long, default_value_t = 298, value_parser = clap::value_parser!(u64).range(..=10_000))]
    files: u64,
    /// Length of a file, in s
    #[arg(long, default_value_t = 3600, value_parser = clap::value_parser!(u64).range(10..=1 << 20))]
    file_s: u64,
    /// Print JSON instead of tables
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Figures {
    commit: String,
    seed: u64,
    lengths: Vec<Length>,
    time_slope: Option<Slope>,
    memory_slope: Option<Slope>,
    merged: Merged,
    distributed: Option<Distributed>,
    run_time_s: f64,
    used: Resources,
}

pub(crate) fn print(arguments: &Arguments, program: &Program) -> Result<()> {
    let begun = Instant::now();
    let sequence = Sequence::new(SEED);
    let lengths = growth(&sequence, arguments.samples);
    let long: Vec<Length> = lengths
        .iter()
        .copied()
        .filter(|l| l.samples >= SHORTEST)
        .collect();
    let merged = merged(&sequence, arguments.samples, arguments.parts);
    let distributed = match arguments.files {
        0 => None,
        files => Some(distributed(program, files, arguments.file_s)?),
    };
    let figures = Figures {
        commit: commit(),
        seed: SEED,
        time_slope: slope(&long, |length| length.cpu_s),
        memory_slope: slope(&long, |length| length.peak_bytes),
        lengths,
        merged,
        distributed,
        run_time_s: begun.elapsed().as_secs_f64(),
        used: Resources::used(),
    };
    if arguments.json {
        println!("{}", serde_json::to_string(&figures)?);
    } else {
        tables(&figures);
    }
    let all = allanite_studies::long::OCTAVES;
    let mut exact = figures.lengths.iter().map(|length| length.exact);
    ensure!(exact.all(|exact| exact == all), "a sum is not exact");
    ensure!(figures.merged.exact == all, "a merged sum is not exact");
    let same = figures.distributed.as_ref();
    let same = same.is_none_or(|all| all.same_bytes == all.orders.len() && all.same_sums_in_groups);
    ensure!(same, "the order of merging changes the curve");
    Ok(())
}

fn tables(figures: &Figures) {
    println!(
        "commit {}, seed {}, {:.0} s of run time",
        figures.commit, figures.seed, figures.run_time_s
    );
    println!(
        "\n{:>12} {:>10} {:>10} {:>10} {:>8} {:>8}",
        "samples", "CPU, s", "ns each", "peak, MiB", "octaves", "exact"
    );
    for length in &figures.lengths {
        println!(
            "{:>12} {:>10.4} {:>10.2} {:>10.2} {:>8} {:>8}",
            power(length.samples),
            length.cpu_s,
            1e9 * length.cpu_s / length.samples as f64,
            length.peak_bytes / f64::from(1 << 20),
            length.octaves,
            length.exact
        );
    }
    let slope = |slope: Option<Slope>| match slope {
        Some(Slope { value, error }) => format!("{value:.4} ± {error:.4}"),
        None => "–".to_owned(),
    };
    println!(
        "slope of log CPU time against log length, from 2^22: {}",
        slope(figures.time_slope)
    );
    println!(
        "slope of log memory against log length, from 2^22: {}",
        slope(figures.memory_slope)
    );
    let merged = &figures.merged;
    println!(
        "\n{} parts of {} samples, merged: {} octaves have differences, all {} are exact",
        merged.parts,
        power(merged.part),
        merged.octaves,
        merged.exact
    );
    let Some(all) = &figures.distributed else {
        return;
    };
    println!(
        "\n{} files of {} s at {RATE_HZ} Hz, seeds {} to {}, {:.3e} samples: {} of {} orders of merging give the same {} bytes",
        all.files,
        all.file_s,
        all.seeds[0],
        all.seeds[1],
        all.samples as f64,
        all.same_bytes,
        all.orders.len(),
        all.bytes
    );
    println!(
        "halves merged first: {} sums, densities differ by at most {:.1e}",
        if all.same_sums_in_groups {
            "the same"
        } else {
            "other"
        },
        all.density_in_groups
    );
    println!(
        "{:>12} {:>14} {:>14} {:>8}",
        "τ, s", "merged", "whole", "lost"
    );
    for octave in &all.octaves {
        println!(
            "{:>12} {:>14} {:>14} {:>6.2} %",
            octave.tau_s,
            octave.merged,
            octave.whole,
            100.0 * (1.0 - octave.merged as f64 / octave.whole as f64)
        );
    }
}

/// A number of samples, as a power of two if it is one.
fn power(samples: u64) -> String {
    match samples.is_power_of_two() {
        true => format!("2^{}", samples.ilog2()),
        false => samples.to_string(),
    }
}
