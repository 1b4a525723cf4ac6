//! How much of the information in a record the estimates keep.

use crate::origin::{Origin, print_json};
use allanite_host::simulate::Preset;
use allanite_studies::efficiency::{
    ESTIMATES, Figure, LENGTHS, Row, SAMPLES, coefficients, effect, effects,
};
use std::time::Instant;

/// The largest bound, in percent, of which the ratio is told. Beyond it, estimates are not Gaussian, and their error is
/// no longer what the bound is about.
const IDENTIFIABLE: f64 = 30.0;

pub(crate) fn print(records: u64, only: Option<Preset>, json: bool) -> anyhow::Result<()> {
    let begun = Instant::now();
    let presets = Preset::TYPICAL.into_iter();
    let presets: Vec<_> = presets
        .filter(|&preset| only.is_none_or(|only| only == preset))
        .collect();
    let cases = presets
        .iter()
        .flat_map(|&preset| LENGTHS.map(|samples| (preset, samples)));
    let hidden = presets
        .iter()
        .flat_map(|&preset| effects().map(move |case| (preset, case)));
    let mut all = Vec::new();
    if !json {
        println!(
            "{records} records at 100 Hz. Root-mean-square errors relative to the smallest possible one; in brackets, how many\n\
             times as long a record a method needs for the error of the octaves, where errors fall with its root\n"
        );
        print!(
            "{:<8} {:>8} {:>3} {:>8} {:>8}",
            "preset", "samples", "", "bound", "error"
        );
        for (name, ..) in ESTIMATES {
            print!(" {name:>20}");
        }
        println!();
    }
    for (preset, samples) in cases {
        for row in coefficients(preset, samples, records) {
            if !json {
                print_coefficient(&row);
            }
            all.push(row);
        }
    }
    if !json {
        println!(
            "\n{SAMPLES} samples that hide an effect, which the diagnosis names and nothing else"
        );
        println!(
            "{:<8} {:<18} {:<20} {:>7} {:>9} {:>9} {:>15}",
            "preset", "hidden", "estimated", "records", "bound", "error", "error/bound"
        );
    }
    for (preset, case) in hidden {
        for row in effect(preset, case, records) {
            if !json {
                print_effect(&row);
            }
            all.push(row);
        }
    }
    let origin = Origin::new("efficiency", [0, records - 1], begun);
    if json {
        return print_json(origin, &all);
    }
    println!("\n{origin}");
    Ok(())
}

fn print_coefficient(row: &Row) {
    let bound = 100.0 * row.bound;
    let octaves = &row.errors[0];
    print!(
        "{:<8} {:>8} {:>3} {bound:>7.2}% {:>7.2}%",
        row.preset,
        row.samples,
        row.name,
        100.0 * octaves.rms
    );
    for (i, error) in row.errors.iter().enumerate() {
        let told = if bound > IDENTIFIABLE {
            String::new()
        } else if i < 2 {
            ratio(error, row.bound)
        } else {
            let longer = (error.rms / octaves.rms).powi(2);
            format!("{:.2} ({longer:.1})", error.rms / row.bound)
        };
        print!(" {told:>20}");
    }
    println!();
}

fn print_effect(row: &Row) {
    let Some(error) = row.errors.first() else {
        return;
    };
    if row.bound > IDENTIFIABLE / 100.0 {
        return;
    }
    println!(
        "{:<8} {:<18} {:<20} {:>7} {:>8.3}% {:>8.3}% {:>15}",
        row.preset,
        row.effect.unwrap_or_default(),
        row.name,
        error.records,
        100.0 * row.bound,
        100.0 * error.rms,
        ratio(error, row.bound)
    );
}

fn ratio(error: &Figure, bound: f64) -> String {
    format!(
        "{:.3} ± {:.3}",
        error.rms / bound,
        error.standard_error / bound
    )
}
