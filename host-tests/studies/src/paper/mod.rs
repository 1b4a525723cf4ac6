//! Repeats the experiment of Lv, Liu, Lai & Huang 2015, section 4: it simulates gyros of three grades and
//! estimates their coefficients by ordinary and by weighted least squares.
//!
//! The coefficients of the paper's gyros are not known. Those of the presets are assumed from the class of
//! each device.

pub mod figure;
mod table;

use super::{OCTAVES, record_at, theory::squares};
use allanite::{
    Curve, Model,
    fit::{Fit, Method, Options, fit},
};
use allanite_host::simulate::{CUSTOMARY, Preset, Simulator};
use rayon::prelude::*;
use serde::Serialize;

/// The sampling rate, in Hz. It is low, so that thousands of long records take minutes.
pub const RATE_HZ: f64 = 2.5;

/// The length of a record, in hours. At this rate, each of the five terms has a share of at least 17 % of
/// the variance in some octave.
pub const HOURS: usize = 12;

/// The number of samples of a record.
pub const SAMPLES: usize = HOURS * 9000;

/// The methods with their names, from the simplest to the most complete. The first four are
/// unconstrained, as in the paper: their squared coefficients may be negative.
pub const METHODS: [(&str, Method); 5] = [
    ("ordinary", Method::Ordinary),
    ("accurate part", Method::AccuratePart),
    ("cluster count", Method::ClusterCount),
    ("relative accuracy", Method::RelativeAccuracy),
    ("covariance", Method::Covariance),
];

/// The results of the study.
#[derive(Clone, Debug, Serialize)]
pub struct Experiment {
    /// The number of records of each gyro.
    pub records: u64,
    /// The sampling rate, in Hz.
    pub rate_hz: f64,
    /// The length of a record, in hours.
    pub hours: usize,
    /// Where the true coefficients come from.
    pub truth: &'static str,
    /// The gyros, best first.
    pub gyros: Vec<Gyro>,
}

/// The results of one gyro.
#[derive(Clone, Debug, Serialize)]
pub struct Gyro {
    /// The name of the preset.
    pub name: String,
    /// The coefficients Q, N, B, K and R.
    pub coefficients: Vec<Coefficient>,
}

/// The results of one coefficient.
#[derive(Clone, Debug, Serialize)]
pub struct Coefficient {
    /// The symbol, such as `N`.
    pub symbol: &'static str,
    /// The unit of the true value, of means and of standard deviations.
    pub unit: &'static str,
    /// The true value.
    pub truth: f64,
    /// The estimates of each method, in the order of [`METHODS`].
    pub methods: Vec<Estimates>,
}

/// The estimates of one coefficient by one method. An estimate is the root of the squared coefficient, or
/// zero where the square is negative.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Estimates {
    /// The name of the method.
    pub method: &'static str,
    /// The number of records that the method could fit.
    pub fits: usize,
    /// The mean.
    pub mean: f64,
    /// The standard deviation.
    pub deviation: f64,
    /// The root-mean-square error, relative to the true value.
    pub rms_error: f64,
    /// The Monte-Carlo standard error of `rms_error`.
    pub rms_error_error: f64,
    /// The share of negative squares.
    pub negative: f64,
}

/// Simulates `records` records of each gyro and fits them by every method.
pub fn study(records: u64) -> Experiment {
    let gyros = Preset::PAPER
        .into_iter()
        .map(|preset| gyro(preset, records));
    Experiment {
        records,
        rate_hz: RATE_HZ,
        hours: HOURS,
        truth: "assumed from the class of each device, because those of the paper are not known",
        gyros: gyros.collect(),
    }
}

/// Simulates records of one gyro. All methods fit the same records.
pub fn gyro(preset: Preset, records: u64) -> Gyro {
    let fits: Vec<[Option<Fit>; METHODS.len()]> = (0..records)
        .into_par_iter()
        .map(|seed| {
            let curve = curve(preset, seed);
            METHODS.map(|(_, method)| fitted(&curve, method))
        })
        .collect();
    let truths = squares(preset.coefficients()).map(f64::sqrt);
    let symbols = ["Q", "N", "B", "K", "R"];
    let coefficient = |i: usize| {
        let (unit, factor) = CUSTOMARY[i];
        let method = |m: usize| {
            let fits = fits.iter().filter_map(|fits| fits[m].as_ref());
            let found = fits.map(|fit| (fit.coefficients[i].square, fit.coefficients[i].value));
            estimates(METHODS[m].0, truths[i], factor, &found.collect::<Vec<_>>())
        };
        Coefficient {
            symbol: symbols[i],
            unit,
            truth: truths[i] * factor,
            methods: (0..METHODS.len()).map(method).collect(),
        }
    };
    Gyro {
        name: name(preset),
        coefficients: (0..symbols.len()).map(coefficient).collect(),
    }
}

/// The statistics of squares and values of a coefficient.
fn estimates(method: &'static str, truth: f64, factor: f64, found: &[(f64, f64)]) -> Estimates {
    let n = found.len() as f64;
    let mean =
        |numbers: &dyn Fn(f64) -> f64| found.iter().map(|(_, v)| numbers(*v)).sum::<f64>() / n;
    let average = mean(&|value| value);
    let variance = mean(&|value| (value - average).powi(2)) * n / (n - 1.0);
    let squared_error = |value: f64| (value / truth - 1.0).powi(2);
    let mean_square = mean(&squared_error);
    let scatter = mean(&|value| (squared_error(value) - mean_square).powi(2)).sqrt();
    let rms_error = mean_square.sqrt();
    Estimates {
        method,
        fits: found.len(),
        mean: average * factor,
        deviation: variance.sqrt() * factor,
        rms_error,
        // The error of a mean square, and half of it relative to its root.
        rms_error_error: scatter / n.sqrt() / (2.0 * rms_error),
        negative: found.iter().filter(|(square, _)| *square < 0.0).count() as f64 / n,
    }
}

/// The curve of a simulated record.
pub fn curve(preset: Preset, seed: u64) -> Curve<OCTAVES> {
    let coefficients = preset.coefficients();
    let mut simulator = Simulator::new(coefficients, RATE_HZ, seed);
    record_at(RATE_HZ, &mut simulator, coefficients, SAMPLES, |_| ())
}

/// The fit of the five terms to a curve.
fn fitted(curve: &Curve<OCTAVES>, method: Method) -> Option<Fit> {
    let options = Options {
        method,
        ..Options::default()
    };
    fit(curve, &Model::ieee_952(), options).ok()
}

/// The name of a preset on the command line.
fn name(preset: Preset) -> String {
    format!("{preset:?}").to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn negative_squares_count_as_zero_and_errors_are_relative() {
        let two = estimates("ordinary", 2.0, 10.0, &[(4.0, 2.0), (36.0, 6.0)]);
        assert_eq!((two.fits, two.mean, two.negative), (2, 40.0, 0.0));
        assert!((two.deviation - 10.0 * 8_f64.sqrt()).abs() < 1e-12);
        // The squared errors are 0 and 4. Their mean is 2 ± √2.
        assert!((two.rms_error - 2_f64.sqrt()).abs() < 1e-12);
        assert!((two.rms_error_error - 0.5).abs() < 1e-12);
        let negative = estimates("ordinary", 2.0, 1.0, &[(-1.0, 0.0), (16.0, 4.0)]);
        assert_eq!((negative.mean, negative.rms_error), (2.0, 1.0));
        assert_eq!((negative.rms_error_error, negative.negative), (0.0, 0.5));
    }
}
