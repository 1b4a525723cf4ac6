//! Tests what `diagnose` says of a rate that follows a temperature with a lag, and of its record over time.

use allanite::diagnosis::Verdict;
use allanite_host::{
    simulate::{Preset, Random, Simulator},
    verdict::NOT_STATIONARY,
};
use program::{json, output};
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use serde_json::Value;
use std::{f64::consts::PI, fmt::Write, fs, path::Path};
use tempfile::TempDir;

const RATE_HZ: f64 = 20.0;
const SAMPLES: usize = 1 << 15;

/// A thermometer and a gyro that follows it.
#[derive(Clone, Copy)]
struct Record {
    /// The temperature in kelvin above that of the room, at a time in seconds.
    temperature: fn(f64) -> f64,
    slope: f64,
    lag_s: f64,
    /// White noise of the thermometer, in kelvin.
    noise: f64,
    seed: u64,
}

impl Record {
    /// Writes the log of a consumer gyro.
    fn write(&self, folder: &Path) {
        let mut simulator = Simulator::new(Preset::Mems.coefficients(), RATE_HZ, self.seed);
        let mut random = Random::seed_from_u64(self.seed);
        let mut text = "# rate_hz=20\n# unit=deg/s\ngyro_z,temp_C\n".to_owned();
        let mut behind = (self.temperature)(0.0);
        for n in 0..SAMPLES {
            let celsius = (self.temperature)(n as f64 / RATE_HZ);
            behind += (celsius - behind) / (self.lag_s * RATE_HZ).max(1.0);
            let rate = simulator.next().unwrap() + self.slope * behind;
            let told = 25.0 + celsius + self.noise * random.sample::<f64, _>(StandardNormal);
            writeln!(text, "{rate:.7},{told:.3}").unwrap();
        }
        fs::write(folder.join("log.csv"), text).unwrap();
    }

    fn diagnosed(&self, folder: &Path) -> Value {
        self.write(folder);
        json(folder, &["diagnose", "log.csv", "--covariates", "temp_C"])["axes"][0].clone()
    }
}

/// A sinusoid of 400 s and one of 1100 s.
fn cycles(t: f64) -> f64 {
    2.0 * (2.0 * PI * t / 400.0).sin() + 1.5 * (2.0 * PI * t / 1100.0).sin()
}

fn number(value: &Value, name: &str) -> f64 {
    value[name].as_f64().unwrap()
}

#[test]
fn a_lag_is_told_with_its_interval_and_no_sinusoid_takes_its_place() {
    let folder = TempDir::new().unwrap();
    let mut covered = 0;
    for seed in 0..8 {
        let record = Record {
            temperature: cycles,
            slope: 0.02,
            lag_s: 30.0,
            noise: 0.05,
            seed,
        };
        let axis = record.diagnosed(folder.path());
        assert_eq!(axis["missing"], serde_json::json!(["covariate"]), "{seed}");
        let tried = &axis["covariates"][0];
        let ends = |name: &str| ["lower", "upper"].map(|end| name.replace('*', end));
        let [low, high] = ends("lag_*_s").map(|name| number(tried, &name));
        let [least, most] = ends("slope_*").map(|name| number(tried, &name));
        println!("{seed}: lag {low:.1} … {high:.1} s, slope {least:.5} … {most:.5}");
        assert!((number(tried, "lag_s") - 30.0).abs() < 8.0, "{tried}");
        assert!((number(tried, "slope") - 0.02).abs() < 0.002, "{tried}");
        assert!(high - low < 25.0 && most - least < 0.006, "{tried}");
        let is_covered = (low..high).contains(&30.0) && (least..most).contains(&0.02);
        covered += u32::from(is_covered);
    }
    assert!(covered >= 6, "{covered} of 8");
    let text = output(
        folder.path(),
        &["diagnose", "log.csv", "--covariates", "temp_C"],
    );
    assert!(
        text.contains("tried temp_C: the rate follows it with a lag of ")
            && text.contains("deg/s per K ("),
        "{text}"
    );
    assert!(
        text.contains("missing effect: covariate temp_C behind a lag of "),
        "{text}"
    );
}

#[test]
fn a_bound_on_a_dependence_holds_for_any_lag() {
    let folder = TempDir::new().unwrap();
    let record = Record {
        temperature: |t| 2.0 * (2.0 * PI * t / 300.0).sin(),
        slope: 0.0,
        lag_s: 0.0,
        noise: 0.1,
        seed: 3,
    };
    let axis = record.diagnosed(folder.path());
    let tried = &axis["covariates"][0];
    let most = number(tried, "most");
    // With a lag of a quarter period, a slope as large as the bound would show.
    let one = ["slope_lower", "slope_upper"].map(|end| number(tried, end).abs());
    assert!(most >= one[0].max(one[1]), "{tried}");
    let text = output(
        folder.path(),
        &["diagnose", "log.csv", "--covariates", "temp_C"],
    );
    let sentence = text
        .lines()
        .find(|line| line.contains("tried temp_C"))
        .unwrap();
    assert!(
        sentence.contains("with a lag or without, at its main period of "),
        "{sentence}"
    );
    let period = sentence.split("main period of ").nth(1).unwrap();
    let period: f64 = period.trim_end_matches(" s").parse().unwrap();
    assert!((period - 300.0).abs() < 30.0, "{sentence}");
    // Twice the bound, a quarter of a period late, is found.
    let lagged = Record {
        temperature: |t| {
            2.0 * (2.0 * PI * (t + 75.0) / 300.0).sin() + 0.3 * (2.0 * PI * t / 900.0).sin()
        },
        slope: 10.0 * most,
        lag_s: 200.0,
        ..record
    };
    let axis = lagged.diagnosed(folder.path());
    let tried = axis["covariates"].as_array().unwrap();
    assert!(tried.iter().any(|tried| tried["acts"] == true), "{tried:?}");
}

/// A warm-up that the temperature explains is no event, whether the rate follows it at once or late.
#[test]
fn a_record_is_stationary_beside_what_follows_the_temperature() {
    let folder = TempDir::new().unwrap();
    for lag_s in [0.0, 40.0] {
        let record = Record {
            temperature: |t| -10.0 * (-t / 200.0).exp_m1(),
            slope: 0.02,
            lag_s,
            noise: 0.02,
            seed: 11,
        };
        let axis = record.diagnosed(folder.path());
        assert_eq!(axis["missing"], serde_json::json!(["covariate"]), "{lag_s}");
        assert_eq!(axis["events"], serde_json::json!([]), "{lag_s}");
        assert_eq!(axis["verdict"], Verdict::Improved.name(), "{lag_s}");
        let blind = json(folder.path(), &["diagnose", "log.csv", "--no-covariates"]);
        assert_eq!(blind["axes"][0]["verdict"], NOT_STATIONARY, "{lag_s}");
    }
}

/// A thermometer in whole degrees is known where it changes, which is four times in this record. What the rate follows between
/// these steps is not excluded, and no lag is told.
#[test]
fn few_steps_of_a_thermometer_exclude_no_dependence_and_tell_no_lag() {
    for (slope, steps, seed) in [
        (0.02, 1.0, 1),
        (0.02, 1.0, 2),
        (0.0, 1.0, 3),
        (0.0, 0.05, 4),
    ] {
        let folder = TempDir::new().unwrap();
        let mut random = Random::seed_from_u64(seed);
        let mut text = "# rate_hz=2\n# unit=deg/s\ngyro_z,temp_C\n".to_owned();
        for n in 0..4800 {
            let t = f64::from(n) / 2.0;
            let celsius = 24.8 + 4.0 * t / 2400.0 + 0.1 * (2.0 * PI * t / 800.0).sin();
            let noise: [f64; 2] = [(); 2].map(|()| random.sample(StandardNormal));
            let rate = slope * celsius + 0.007 * noise[0];
            let told = ((celsius + 0.02 * noise[1]) / steps).round() * steps;
            writeln!(text, "{rate:.6},{told:.2}").unwrap();
        }
        fs::write(folder.path().join("log.csv"), text).unwrap();
        let text = output(folder.path(), &["fit", "log.csv"]);
        let what = format!("{slope} {steps}: {text}");
        assert!(!text.contains("with a lag of"), "{what}");
        let excludes = text.contains("temp_C: no dependence above");
        assert_eq!(excludes, steps < 1.0, "{what}");
        let seldom = "temp_C: changes in 4 steps, too few to exclude a dependence";
        let follows = text.contains("temp_C: the rate follows it");
        assert_eq!(text.contains(seldom) || follows, steps == 1.0, "{what}");
    }
}

/// A ramp of 6 K an hour, in steps of a whole degree, with a swing between the steps. Taken as it is, the column is off by half
/// a degree for minutes, which looked like an oscillation and hid the slope.
#[test]
fn the_slope_on_a_thermometer_in_whole_degrees_is_found() {
    for seed in 1..=4 {
        let folder = TempDir::new().unwrap();
        let mut random = Random::seed_from_u64(seed);
        let mut text = "# rate_hz=2\n# unit=deg/s\ngyro_z,temp_C\n".to_owned();
        for n in 0..7200 {
            let t = f64::from(n) / 2.0;
            let celsius = 24.8 + 6.0 * t / 3600.0 + 0.05 * (2.0 * PI * t / 600.0).sin();
            let noise: [f64; 2] = [(); 2].map(|()| random.sample(StandardNormal));
            let rate = 0.02 * celsius + 0.007 * noise[0];
            let told = (celsius + 0.02 * noise[1]).round();
            writeln!(text, "{rate:.6},{told:.0}").unwrap();
        }
        fs::write(folder.path().join("log.csv"), text).unwrap();
        let axis = json(folder.path(), &["diagnose", "log.csv"])["axes"][0].clone();
        assert_eq!(axis["missing"], serde_json::json!(["covariate"]), "{axis}");
        let text = output(folder.path(), &["diagnose", "log.csv"]);
        let (_, rest) = text.split_once("slope ").unwrap();
        let (_, interval) = rest.split_once('(').unwrap();
        let (interval, _) = interval.split_once(')').unwrap();
        let (lower, upper) = interval.split_once(" … ").unwrap();
        let ends: [f64; 2] = [lower, upper].map(|end| end.parse().unwrap());
        assert!((ends[0]..=ends[1]).contains(&0.02), "{text}");
        assert!(!text.contains("with a lag of"), "{text}");
    }
}
