//! Numbers that were rounded to a step as large as their noise are judged as counts of that step.

use program::output;
use rand::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::{fmt::Write as _, fs};
use tempfile::TempDir;

/// White noise of so many steps about a mean, rounded to steps, in a folder as `log.csv` with numbers of this form.
fn log(rows: u32, noise: f64, mean: f64, number: impl Fn(i32) -> String) -> TempDir {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(u64::from(rows));
    let mut text = String::from("gx\n");
    for _ in 0..rows {
        let value: f64 = StandardNormal.sample(&mut random);
        let steps = (mean + noise * value).round() as i32;
        writeln!(text, "{}", number(steps)).unwrap();
    }
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("log.csv"), text).unwrap();
    folder
}

const FIT: [&str; 6] = ["fit", "log.csv", "--rate", "100", "--unit", "deg/s"];

/// The noise is half a step to one. The note has what angle random walk is without the rounding, with its interval, which
/// agrees with that of the noise before it was rounded.
#[test]
fn decimals_rounded_to_a_step_as_large_as_their_noise_get_the_note_of_whole_numbers() {
    for (step, digits, noise) in [
        (0.01, 2, 0.55),
        (0.05, 2, 0.8),
        (1.0 / 131.0, 9, 0.6),
        (0.2, 1, 1.1),
    ] {
        let number = |steps| format!("{:.digits$}", step * f64::from(steps));
        let folder = log(12_000, noise, 3.2, number);
        let text = output(folder.path(), &FIT);
        let note = text
            .lines()
            .find_map(|line| line.split_once("without it, it is "));
        let (note, rest) = note.unwrap_or_else(|| panic!("{step}: {text}"));
        assert!(note.starts_with("Note: rounding of the values raises angle random walk by "));
        let words: Vec<&str> = rest.trim_end_matches('.').split([' ', ',']).collect();
        let numbers: Vec<f64> = words.iter().filter_map(|word| word.parse().ok()).collect();
        let [value, 95.0, lower, upper] = numbers[..] else {
            panic!("{step}: {rest}");
        };
        // In degrees per root of an hour: 60 times the noise of a sample over the root of the rate.
        let right = 60.0 * step * noise / 10.0;
        assert!((value / right - 1.0).abs() < 0.05, "{step}: {rest}");
        // The interval has 95 %, and one and a half of it 99.7 %.
        let (below, above) = (1.5 * (value - lower), 1.5 * (upper - value));
        assert!(
            (value - below..value + above).contains(&right),
            "{step}: {rest}, not {right}"
        );
    }
}

#[test]
fn decimals_far_below_their_noise_get_no_note() {
    let folder = log(12_000, 40.0, 3.2, |steps| {
        format!("{:.3}", 0.001 * f64::from(steps))
    });
    let text = output(folder.path(), &FIT);
    assert!(!text.contains("rounding to"), "{text}");
}

/// Of noise below half a step, the result follows from where between two steps the mean lies. Some hundred rows show it as
/// well as thousands do, in decimals and in whole numbers.
#[test]
fn few_rows_of_two_values_are_not_valid() {
    for rows in [300, 500, 900, 2000] {
        for (noise, mean) in [(0.06, 3.48), (0.06, 3.5), (0.2, 3.5), (0.15, 3.2)] {
            for decimals in [0, 2] {
                let number = |steps| match decimals {
                    0 => format!("{steps}"),
                    _ => format!("{:.2}", 0.01 * f64::from(steps)),
                };
                let folder = log(rows, noise, mean, number);
                let text = output(folder.path(), &FIT);
                let what = format!("{rows} {noise} {mean} {decimals}: {text}");
                assert!(text.contains("The curve is not valid: "), "{what}");
            }
        }
    }
}

#[test]
fn few_rows_of_half_a_step_or_more_are_valid_wherever_their_mean_lies() {
    for rows in [260, 400, 900] {
        for tenth in 0..10 {
            for noise in [0.52, 0.7] {
                let folder = log(rows, noise, 3.0 + 0.1 * f64::from(tenth), |steps| {
                    format!("{:.2}", 0.01 * f64::from(steps))
                });
                let text = output(folder.path(), &FIT);
                assert!(
                    !text.contains("not valid"),
                    "{rows} {tenth} {noise}: {text}"
                );
            }
        }
    }
}

/// White noise of 2.5 steps behind a Butterworth low pass of two poles at a tenth of the rate, rounded to hundredths. What
/// rounding adds behind the filter is named so, with its size, and is no resonance or power law.
#[test]
fn rounding_behind_a_filter_is_white_noise_behind_the_filter() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(54);
    // The bilinear transform of 1/(s² + √2 s + 1).
    let k = (std::f64::consts::PI * 0.1).tan();
    let norm = 1.0 / (1.0 + std::f64::consts::SQRT_2 * k + k * k);
    let gain = k * k * norm;
    let [one, two] = [
        2.0 * (k * k - 1.0) * norm,
        (1.0 - std::f64::consts::SQRT_2 * k + k * k) * norm,
    ];
    let (mut inputs, mut outputs) = ([0.0; 2], [0.0; 2]);
    let filtered: Vec<f64> = (0..1 << 16)
        .map(|_| {
            let input: f64 = StandardNormal.sample(&mut random);
            let passed = gain * (input + 2.0 * inputs[0] + inputs[1]);
            let output = passed - one * outputs[0] - two * outputs[1];
            (inputs, outputs) = ([input, inputs[0]], [output, outputs[0]]);
            output
        })
        .collect();
    let square: f64 = filtered.iter().map(|value| value * value).sum();
    let factor = 2.5 / (square / filtered.len() as f64).sqrt();
    let mut text = String::from("gx\n");
    for value in filtered {
        writeln!(text, "{:.2}", 0.01 * (factor * value + 0.3).round()).unwrap();
    }
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("log.csv"), text).unwrap();
    let arguments = ["diagnose", "log.csv", "--rate", "100", "--unit", "deg/s"];
    let text = output(folder.path(), &arguments);
    assert!(
        text.contains("2. + white noise behind the filter: χ²") && !text.contains("3. + "),
        "{text}"
    );
    let note = "rounding of the values to steps of 0.01000 deg/s adds 0.01732 °/√h of white noise behind the filter";
    assert!(text.contains(note), "{text}");
    let found = text
        .split_once("\n  white noise behind the filter ")
        .and_then(|(_, rest)| rest.split(' ').next()?.parse::<f64>().ok());
    let found = found.unwrap_or_else(|| panic!("{text}"));
    assert!((found / 0.01732 - 1.0).abs() < 0.15, "{found}");
}
