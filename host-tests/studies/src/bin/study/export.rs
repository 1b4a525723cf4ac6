//! Whether a filter with an exported model knows its errors.

use crate::origin::Origin;
use allanite_host::simulate::Preset;
use allanite_studies::export::{Exported, Outcome, consumers, study};
use anyhow::{Result, ensure};
use std::time::Instant;

/// Prints the counts of all gyros, of those that `export` takes without being told, and what the gyros have whose N is
/// outside its interval.
pub(crate) fn print(preset: Preset, gyros: u64, seed: u64, real: bool) -> Result<()> {
    let begun = Instant::now();
    let outcomes = study(preset, seed..seed + gyros, real)?;
    let taken = outcomes.iter().filter(|one| one.refused.is_none());
    let taken: Vec<&Outcome> = taken.collect();
    let all: Vec<&Outcome> = outcomes.iter().collect();
    println!(
        "| gyros | model | number | N inside | median N / truth | mean NEES | median NEES | rms angle error |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (name, group) in [
        ("all, despite everything", &all),
        ("exported without being told", &taken),
    ] {
        row(name, "diagnosis", group, |one| &one.diagnosed);
        row(name, "five terms, N and K", group, |one| &one.five_terms);
    }
    println!();
    for one in &outcomes {
        let is_odd = !one.diagnosed.inside || one.refused.is_some() || one.diagnosed.nees > 1.5;
        if !is_odd {
            continue;
        }
        let Exported {
            density,
            inside,
            nees,
            ref model,
            ..
        } = one.diagnosed;
        let inside = if inside { "inside" } else { "outside" };
        println!(
            "seed {}: N {density:.4} {inside}, NEES {nees:.2}: {}; said: {model}",
            one.seed, one.truth
        );
        if let Some(refused) = &one.refused {
            println!("  refused: {refused}");
        }
    }
    let last = seed + gyros.saturating_sub(1);
    println!("\n{}", Origin::new("export", [seed, last], begun));
    Ok(())
}

fn row(name: &str, model: &str, group: &[&Outcome], of: impl Fn(&Outcome) -> &Exported) {
    let each: Vec<&Exported> = group.iter().map(|one| of(one)).collect();
    let count = each.len();
    let inside = each.iter().filter(|one| one.inside).count();
    let mean =
        |value: fn(&Exported) -> f64| each.iter().map(|one| value(one)).sum::<f64>() / count as f64;
    let median = |value: fn(&Exported) -> f64| {
        let mut values: Vec<f64> = each.iter().map(|one| value(one)).collect();
        values.sort_by(f64::total_cmp);
        values.get(count / 2).copied().unwrap_or(f64::NAN)
    };
    println!(
        "| {name} | {model} | {count} | {inside} | {:.3} | {:.3} | {:.3} | {:.2e}° |",
        median(|one| one.density),
        mean(|one| one.nees),
        median(|one| one.nees),
        mean(|one| one.angle_error.powi(2)).sqrt()
    );
}

/// Prints what the parsers of other programs read of an exported model.
pub(crate) fn print_consumers() -> Result<()> {
    let folder = tempfile::tempdir()?;
    println!("| format | parser | number | read | relative difference |");
    println!("|---|---|---|---|---|");
    let mut largest = 0_f64;
    for number in consumers(folder.path())? {
        let difference = (number.read / number.expected - 1.0).abs();
        largest = largest.max(difference);
        println!(
            "| {} | {} | `{}` | {:e} | {difference:.1e} |",
            number.format, number.parser, number.name, number.read
        );
    }
    println!("\nThe largest relative difference is {largest:.1e}.");
    ensure!(largest < 1e-9, "a program reads another number");
    Ok(())
}
