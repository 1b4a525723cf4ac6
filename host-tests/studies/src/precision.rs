//! Compares fits and diagnoses of the same records in single and double precision.

use allanite_host::confidence::TWO_SIDED_95;
use anyhow::{Context as _, Result};
use demonstration::diagnose::HIDDEN;
use xtask::firmware::{Precision, agreement::told_here};

/// The differences between single and double precision over many records.
#[derive(Clone, Debug, Default)]
pub struct Differences {
    /// The differences of the values and interval ends of all coefficients, in standard errors,
    /// sorted.
    pub standard_errors: Vec<f64>,
    /// The differences of χ², sorted.
    pub chi_squared: Vec<f64>,
}

/// Compares fits of simulated gyros.
///
/// # Errors
/// Fails if the program cannot be built, if it fails, or if it prints different lines in the two
/// precisions.
pub fn fits(records: u64) -> Result<Differences> {
    let mut all = Differences::default();
    for [single, double] in both("characterise", &[], records)? {
        // The small fit computes in single precision in both.
        let is_general = |pair: &(&String, &String)| !pair.1.starts_with("small ");
        for (single, double) in single.iter().zip(&double).filter(is_general) {
            if let (Some(one), Some(other)) =
                (after(single, "chi_squared"), after(double, "chi_squared"))
            {
                all.chi_squared.push((one - other).abs());
            }
            let numbers = |line: &str| -> Option<[f64; 3]> {
                let [value, lower, upper] =
                    ["value", "lower", "upper"].map(|name| after(line, name));
                Some([value?, lower?, upper?])
            };
            let Some(expected) = numbers(double) else {
                continue;
            };
            let found =
                numbers(single).with_context(|| format!("comparing {single:?} with {double:?}"))?;
            let [_, lower, upper] = expected;
            let error = (upper - lower) / (2.0 * TWO_SIDED_95);
            let largest = found
                .iter()
                .zip(expected)
                .map(|(one, other)| (one - other).abs());
            all.standard_errors
                .push(largest.fold(0.0, f64::max) / error);
        }
    }
    all.standard_errors.sort_by(f64::total_cmp);
    all.chi_squared.sort_by(f64::total_cmp);
    Ok(all)
}

/// How often the diagnoses in both precisions agree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Alike {
    /// The number of records.
    pub records: usize,
    /// The number of records with the same verdict and the same added effects.
    pub same: usize,
    /// The number of records whose diagnoses differ, and of which at least one calls an effect
    /// ambiguous.
    pub ambiguous: usize,
}

/// Compares diagnoses of simulated gyros, with each of the demonstration's hidden effects and
/// without one.
///
/// # Errors
/// The errors are those of [`fits`].
pub fn diagnoses(records: u64) -> Result<Vec<(&'static str, Alike)>> {
    let names = HIDDEN.iter().map(|hidden| hidden.case).chain(["nothing"]);
    names
        .map(|name| {
            let mut alike = Alike::default();
            for pair in both("hidden_effect", &[name], records)? {
                let [one, other] = pair
                    .each_ref()
                    .map(|lines| named(lines, &["added", "verdict"]));
                let ambiguous = pair
                    .iter()
                    .any(|lines| !named(lines, &["ambiguous"]).is_empty());
                alike.records += 1;
                alike.same += usize::from(one == other);
                alike.ambiguous += usize::from(one != other && ambiguous);
            }
            Ok((name, alike))
        })
        .collect()
}

/// The lines that a program prints for each record, in single and in double precision.
fn both(program: &str, arguments: &[&str], records: u64) -> Result<Vec<[Vec<String>; 2]>> {
    let last = match program {
        "characterise" => "small degrees_of_freedom ",
        _ => "verdict ",
    };
    let seeds: Vec<String> = (1..=records).map(|seed| seed.to_string()).collect();
    let seeds = seeds.iter().map(String::as_str);
    let arguments: Vec<&str> = arguments.iter().copied().chain(seeds).collect();
    let told = |precision| -> Result<Vec<Vec<String>>> {
        let lines = told_here(precision, program, &arguments)?;
        let records = lines.split_inclusive(|line| line.starts_with(last));
        Ok(records.map(<[String]>::to_vec).collect())
    };
    let (single, double) = (told(Precision::Single)?, told(Precision::Double)?);
    let pairs = single.into_iter().zip(double);
    Ok(pairs.map(|(one, other)| [one, other]).collect())
}

/// The number that follows a word.
fn after(line: &str, name: &str) -> Option<f64> {
    let mut words = line.split(' ').skip_while(|word| *word != name);
    words.nth(1)?.parse().ok()
}

/// The words that follow the given starts of lines, in order.
fn named<'a>(lines: &'a [String], starts: &[&str]) -> Vec<&'a str> {
    let word = |line: &'a String| {
        let mut words = line.split(' ');
        let start = words.next()?;
        starts.contains(&start).then(|| words.next()).flatten()
    };
    lines.iter().filter_map(word).collect()
}
