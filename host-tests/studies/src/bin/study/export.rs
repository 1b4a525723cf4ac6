//! Whether a filter with an exported model knows its errors.

use crate::origin::Origin;
use allanite_host::simulate::Preset;
use allanite_studies::export::{Exported, Filtered, HELD, Outcome, Walk, consumers, study, walks};
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

/// The share of the gyros of which a filter has to know its errors.
const SHARE: f64 = 0.93;

/// Prints how filters fare that are given no more than white noise and a random walk.
pub(crate) fn print_walks(preset: Preset, gyros: u64, seed: u64) -> Result<()> {
    let begun = Instant::now();
    let all = walks(preset, seed..seed + gyros)?;
    println!(
        "| random walk | gyros | NEES up to {HELD} | mean NEES | median NEES | rms angle error |"
    );
    println!("|---|---|---|---|---|---|");
    let row = |name: &str, of: fn(&Walk) -> Filtered| {
        let mut nees: Vec<f64> = all.iter().map(|one| of(one).nees).collect();
        nees.sort_by(f64::total_cmp);
        let held = nees.iter().filter(|nees| **nees <= HELD).count();
        let count = nees.len() as f64;
        let mean = nees.iter().sum::<f64>() / count;
        let squares = all.iter().map(|one| of(one).angle_error.powi(2));
        println!(
            "| {name} | {count} | {held} | {mean:.3} | {:.3} | {:.3} N √s |",
            nees.get(nees.len() / 2).copied().unwrap_or(f64::NAN),
            (squares.sum::<f64>() / count).sqrt()
        );
        held
    };
    let held = row("as exported", |one| one.exported);
    row("overbound", |one| one.overbound);
    row("K alone", |one| one.alone);
    println!();
    for one in all.iter().filter(|one| one.exported.nees > HELD) {
        let Walk {
            seed,
            flicker,
            walk,
            exported,
            ..
        } = one;
        println!(
            "seed {seed}: (B/N)² {flicker:.2e} rad/s, K/N {walk:.2e} rad/s, NEES {:.2}",
            exported.nees
        );
    }
    let last = seed + gyros.saturating_sub(1);
    println!("\n{}", Origin::new("export", [seed, last], begun));
    // Few gyros may have fewer by chance.
    let count = gyros as f64;
    let chance = 1.645 * (SHARE * (1.0 - SHARE) * count).sqrt();
    let least = SHARE * count - if gyros < 200 { chance } else { 0.0 };
    ensure!(
        held as f64 >= least,
        "the filters of {held} of {gyros} gyros know their errors"
    );
    Ok(())
}

/// Prints what the parsers of other programs read of an exported model, and what they take where a number is left out.
pub(crate) fn print_consumers() -> Result<()> {
    let folder = tempfile::tempdir()?;
    println!("| format | parser | number | read | relative difference |");
    println!("|---|---|---|---|---|");
    let mut largest = 0_f64;
    for number in consumers(folder.path())? {
        let difference = match number.expected {
            0.0 => number.read.abs(),
            expected => (number.read / expected - 1.0).abs(),
        };
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
