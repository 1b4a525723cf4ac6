//! What the program says of records whose logger repeated, held, clipped or cut out samples.

use crate::INVALID;
use allanite::diagnosis::Verdict;
use allanite_host::verdict::ADEQUATE;
use program::{json, number, output, rows, run};
use serde_json::Value;
use std::{fs, path::Path};
use tempfile::TempDir;

/// White Gaussian noise of this size, the same in every run.
fn noise(samples: usize, size: f64, seed: u64) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut uniform = move || {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        (state.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 53) as f64
    };
    // The sum of twelve uniform numbers has a variance of 1.
    let mut one = || (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
    (0..samples).map(|_| size * one()).collect()
}

/// Writes columns of numbers with so many decimals below their names.
fn write(folder: &Path, names: &str, columns: &[Vec<f64>], decimals: usize) {
    let rows = (0..columns[0].len()).map(|row| {
        let cells = columns
            .iter()
            .map(|column| format!("{:.decimals$}", column[row]));
        cells.collect::<Vec<_>>().join(",")
    });
    let rows = rows.collect::<Vec<_>>().join("\n");
    fs::write(folder.join("log.csv"), format!("{names}\n{rows}\n")).unwrap();
}

/// The samples of a sensor, read faster by a factor.
fn read_faster(noise: &[f64], factor: f64, samples: usize) -> Vec<f64> {
    (0..samples)
        .map(|row| noise[((row as f64 + 0.5) / factor) as usize])
        .collect()
}

fn errors(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(output.status.success());
    String::from_utf8(output.stderr).unwrap()
}

/// The effects beside the five terms in the last step of a diagnosis.
fn named(diagnosis: &Value) -> Vec<&str> {
    let axis = &diagnosis["axes"][0];
    let steps = axis["steps"].as_array().unwrap();
    let effects = steps[steps.len() - 1]["effects"].as_array().unwrap();
    let names = effects
        .iter()
        .map(|effect| effect["name"].as_str().unwrap());
    let own = [
        "quantization",
        "angle_random_walk",
        "bias_instability",
        "rate_random_walk",
        "rate_ramp",
    ];
    names.filter(|name| !own.contains(name)).collect()
}

/// Whether the angle random walk of a fit is measured within 4 % of the truth.
fn has_white_noise(fit: &Value, truth: f64) -> bool {
    let coefficients = fit["axes"][0]["coefficients"].as_array().unwrap();
    let white = coefficients
        .iter()
        .find(|one| one["effect"] == "angle_random_walk")
        .unwrap();
    (number(&white["value"]) / truth - 1.0).abs() < 0.04
}

#[test]
fn repeats_of_fine_values_are_left_out_and_the_rate_is_that_of_the_sensor() {
    let folder = TempDir::new().unwrap();
    for (given_hz, sensor_hz, words) in rows! {
        500.0, 400.0, "every fifth sample repeats the one before: the sensor runs at 400 Hz";
        1000.0, 500.0, "every second sample repeats the one before: the sensor runs at 500 Hz";
        150.0, 100.0, "every third sample repeats the one before: the sensor runs at 100 Hz";
        102.0, 100.0, "2.0 % of the samples repeat the one before: the sensor runs at 100 Hz";
    } {
        let sensor = noise(20_000, 0.0024, 1);
        let read = read_faster(&sensor, given_hz / sensor_hz, 20_000);
        write(folder.path(), "gyro_x", &[read], 6);
        let rate = given_hz.to_string();
        let log = ["log.csv", "--rate", &rate, "--unit", "rad/s"];
        let fit = [&["fit"][..], &log].concat();
        let said = errors(folder.path(), &fit);
        assert!(
            said.contains(words) && said.contains("--repeats keep"),
            "{said}"
        );
        let fit = json(folder.path(), &[&fit[..]].concat());
        assert_eq!(number(&fit["axes"][0]["rate_hz"]), sensor_hz);
        assert!(
            has_white_noise(&fit, 0.0024 / sensor_hz.sqrt()),
            "{given_hz}: {fit}"
        );
        let diagnose = [&["diagnose"][..], &log].concat();
        let diagnosis = json(folder.path(), &diagnose);
        assert_eq!(
            (
                diagnosis["axes"][0]["verdict"].as_str(),
                named(&diagnosis).len()
            ),
            (Some(Verdict::Adequate.name()), 0)
        );
        let kept = json(
            folder.path(),
            &[&diagnose[..], &["--repeats", "keep"]].concat(),
        );
        assert_eq!(kept["axes"][0]["verdict"], INVALID.name());
        assert_eq!(named(&kept), [""; 0]);
        // The rate is an estimate here.
        let (words, _) = words.split_once(" runs at").unwrap();
        assert!(kept.to_string().contains(words), "{kept}");
    }
}

#[test]
fn repeats_are_left_out_of_all_axes_and_covariates_of_a_log_with_stamps() {
    let folder = TempDir::new().unwrap();
    let rows = 7000;
    let axes = [1, 2, 3].map(|seed| read_faster(&noise(rows, 8.0, seed), 1.25, rows));
    let stamps = (0..rows).map(|row| 1e6 + 800.0 * row as f64).collect();
    let temperature = noise(rows, 0.1, 9);
    let [x, y, z] = axes;
    // Counts of three axes: each repeats by chance, and all of them hardly ever.
    let columns = [stamps, x, y, z, temperature]
        .map(|column| column.iter().map(|value: &f64| value.round()).collect());
    write(folder.path(), "timestamp_us,gx,gy,gz,temp", &columns, 0);
    let fit = ["fit", "log.csv", "--unit", "deg/s", "--scale", "0.01"];
    let said = errors(folder.path(), &fit);
    assert!(
        said.contains("every fifth sample repeats the one before: the sensor runs at 1000 Hz"),
        "{said}"
    );
    let fit = json(folder.path(), &[&fit[..]].concat());
    assert!(has_white_noise(&fit, 0.08 / 1000_f64.sqrt()), "{fit}");
}

#[test]
fn repeats_among_coarse_counts_name_the_rate_and_no_filter() {
    let folder = TempDir::new().unwrap();
    for axes in [1, 3] {
        let columns: Vec<_> = (0..axes)
            .map(|axis| read_faster(&noise(40_000, 1.2, axis + 1), 1.25, 40_000))
            .collect();
        let names = ["gx", "gx,gy", "gx,gy,gz"][axes as usize - 1];
        write(folder.path(), names, &columns, 0);
        let diagnosis = json(
            folder.path(),
            &[
                "diagnose", "log.csv", "--rate", "500", "--unit", "deg/s", "--scale", "0.01",
            ],
        );
        assert_eq!(diagnosis["axes"][0]["verdict"], INVALID.name());
        assert_eq!(named(&diagnosis), [""; 0]);
        let words = diagnosis.to_string();
        assert!(
            ["every fifth sample repeats", "20 % of the samples repeat"]
                .iter()
                .any(|said| {
                    words.contains(&format!("{said} the one before: the sensor runs at"))
                }),
            "{words}"
        );
        let (_, rate) = words.split_once("the sensor runs at ").unwrap();
        let rate: f64 = rate.split(' ').next().unwrap().parse().unwrap();
        assert!((rate / 400.0 - 1.0).abs() < 0.01, "{rate}");
    }
}

#[test]
fn a_change_of_range_within_a_record_is_said() {
    let folder = TempDir::new().unwrap();
    for times in [2.0, 8.0] {
        let mut changed = noise(60_000, 20.0, 3);
        changed[40_000..].iter_mut().for_each(|rate| *rate /= times);
        write(folder.path(), "gx", &[changed], 0);
        let diagnose = [
            "diagnose", "log.csv", "--rate", "200", "--unit", "deg/s", "--scale", "0.01",
        ];
        let said = output(folder.path(), &diagnose);
        // Within a few parts in a hundred, and within a block of the time.
        let (_, rest) = said.split_once("the noise fell to ").expect(&said);
        let factor: f64 = rest.split(' ').next().unwrap().parse().unwrap();
        assert!((factor * times - 1.0).abs() < 0.06, "{said}");
        let (_, rest) = rest.split_once("at about ").expect(&said);
        let at: f64 = rest.split(' ').next().unwrap().parse().unwrap();
        assert!((at - 200.0).abs() < 6.0, "{said}");
        // Each part alone is that of a gyro at rest.
        let (_, rest) = rest.split_once("one part alone, with ").expect(&said);
        let (before, rest) = rest.split_once(" or ").unwrap();
        let behind = rest
            .split_whitespace()
            .take(2)
            .collect::<Vec<_>>()
            .join(" ");
        let behind = behind.trim_end_matches('.');
        for part in [before, behind] {
            let part = part.replace(' ', "=");
            let alone = json(folder.path(), &[&diagnose[..], &[&part]].concat());
            assert_eq!(alone["axes"][0]["verdict"], ADEQUATE, "{part}");
        }
    }
}

#[test]
fn stuck_clipped_and_cut_out_values_are_said_and_no_effect_is_named() {
    let folder = TempDir::new().unwrap();
    let sound = noise(40_000, 11.0, 5);
    let mut stuck = sound.clone();
    for start in (500..39_000).step_by(1300) {
        let length = 5 + start % 44;
        let (held, rest) = (stuck[start], &mut stuck[start..start + length]);
        rest.fill(held);
    }
    let clipped = sound.iter().map(|value| value.min(11.0)).collect();
    let cut = sound
        .iter()
        .map(|value| if value.abs() < 5.5 { 0.0 } else { *value })
        .collect();
    // A dead band that moves all values towards zero leaves no hole.
    let moved = sound
        .iter()
        .map(|value| value.signum() * (value.abs() - 5.5).max(0.0))
        .collect();
    for (column, words) in [
        (moved, "values are exactly zero, as a dead band leaves them"),
        (stuck, "stuck values"),
        (clipped, "samples are at the end of the scale"),
        (cut, "values are exactly zero, as a dead band leaves them"),
    ] {
        write(folder.path(), "gx", &[column], 0);
        let log = [
            "log.csv", "--rate", "1000", "--unit", "deg/s", "--scale", "0.01",
        ];
        let diagnosis = json(folder.path(), &[&["diagnose"][..], &log].concat());
        assert_eq!(diagnosis["axes"][0]["verdict"], INVALID.name(), "{words}");
        assert_eq!(named(&diagnosis), [""; 0]);
        assert!(diagnosis.to_string().contains(words), "{diagnosis}");
        let fit = run(folder.path(), &[&["fit"][..], &log].concat());
        assert!(String::from_utf8_lossy(&fit.stdout).contains(words));
    }
}

#[test]
fn a_bound_is_said_where_repeats_cannot_be_told() {
    let folder = TempDir::new().unwrap();
    let coarse = noise(4000, 0.55, 3)
        .iter()
        .map(|value| value.round())
        .collect();
    write(folder.path(), "gx", &[coarse], 0);
    let said = errors(
        folder.path(),
        &[
            "fit", "log.csv", "--rate", "100", "--unit", "deg/s", "--scale", "0.01",
        ],
    );
    let (_, bound) = said
        .split_once("repeats below ")
        .unwrap_or_else(|| panic!("{said}"));
    let bound: f64 = bound.split(' ').next().unwrap().parse().unwrap();
    assert!(
        (5.0..60.0).contains(&bound) && said.contains("% cannot be told"),
        "{said}"
    );
}

/// A filter of the sensor is no repeat.
#[test]
fn filter_stays_a_filter() {
    let folder = TempDir::new().unwrap();
    let (mut one, mut two) = (0.0, 0.0);
    let filtered = noise(20_000, 0.05, 4).into_iter().map(|value| {
        one += 0.4 * (value - one);
        two += 0.4 * (one - two);
        two
    });
    write(folder.path(), "gx_dps", &[filtered.collect()], 6);
    let diagnosis = json(folder.path(), &["diagnose", "log.csv", "--rate", "200"]);
    assert_eq!(
        diagnosis["axes"][0]["verdict"],
        Verdict::Improved.name(),
        "{diagnosis}"
    );
    assert_eq!(named(&diagnosis).len(), 1);
}

/// A record in a hand, which looks like noise behind a low pass, and one beside a fan, which all axes see.
#[test]
fn motion_that_never_stops_is_told_and_no_effect_is_named() {
    let folder = TempDir::new().unwrap();
    let swings = noise(30_000, 0.3, 9);
    for (name, is_motion) in [("hand", true), ("fan", false)] {
        let axes = [(0.4, 1), (1.0, 2), (-0.7, 3)].map(|(share, seed)| {
            let (mut slow, mut slower) = (0.0, 0.0);
            let white = noise(30_000, 0.02, seed);
            let rows = white.iter().zip(&swings).enumerate();
            let rows = rows.map(|(row, (white, swing))| {
                slow += 0.1 * (swing - slow);
                slower += 0.1 * (slow - slower);
                let fan = 0.05 * (2.0 * std::f64::consts::PI * 0.37 * row as f64).sin();
                white + share * if is_motion { slower } else { fan }
            });
            rows.collect::<Vec<f64>>()
        });
        write(folder.path(), "gx [deg/s],gy [deg/s],gz [deg/s]", &axes, 5);
        let diagnosis = json(folder.path(), &["diagnose", "log.csv", "--rate", "100"]);
        let said = diagnosis.to_string();
        assert_eq!(
            said.contains("was not at rest"),
            is_motion,
            "{name}: {said}"
        );
        for axis in diagnosis["axes"].as_array().unwrap() {
            assert_eq!(
                axis["verdict"] == INVALID.name(),
                is_motion,
                "{name}: {axis}"
            );
        }
        match is_motion {
            true => assert_eq!(named(&diagnosis), [""; 0]),
            false => assert_eq!(named(&diagnosis), ["sinusoid"]),
        }
    }
}
