//! The figure of the study: the curve of one record of each gyro, and the fits of all methods.

use super::{METHODS, curve, fitted, name};
use crate::theory::squares;
use allanite::{Model, fit::curve_covariance};
use allanite_host::simulate::Preset;
use allanite_plot::{Overlay, Span, overlays};

/// The unit of the figure: degrees per hour in a degree per second.
const PER_HOUR: f64 = 3600.0;

/// The drawing of the record of one seed, as the text of an SVG file.
pub fn figure(seed: u64) -> String {
    overlays(&Preset::PAPER.map(|preset| overlay(preset, seed)))
}

fn overlay(preset: Preset, seed: u64) -> Overlay {
    let model = Model::ieee_952();
    let curve = curve(preset, seed);
    let points = curve.points();
    let truth = squares(preset.coefficients());
    let covariance = curve_covariance(&curve, &model, &truth);
    let deviation = |variance: f64| PER_HOUR * variance.sqrt();
    let of = |squares: &[f64]| -> Vec<f64> {
        let variance = |m: u32| model.variance(squares, m, curve.interval_s());
        points
            .iter()
            .map(|point| deviation(variance(point.m)))
            .collect()
    };
    let measured: Vec<f64> = points.iter().map(|p| deviation(p.variance)).collect();
    // The standard error of a root is that of the square, divided by twice the root.
    let errors = measured.iter().enumerate();
    let errors = errors.map(|(k, sigma)| {
        let error = PER_HOUR * PER_HOUR * covariance[(k, k)].sqrt();
        0.5 * error / sigma
    });
    let fits = METHODS.into_iter().filter_map(|(name, method)| {
        let fit = fitted(&curve, method)?;
        Some((name.to_owned(), of(&fit.squares())))
    });
    let (low, high) = measured
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(low, high), sigma| {
            (low.min(*sigma), high.max(*sigma))
        });
    Overlay {
        title: format!("{}: Allan deviation of one record", name(preset)),
        subtitle: format!(
            "{} h at {} Hz; where a line is missing, the fit has a negative variance",
            super::HOURS,
            super::RATE_HZ
        ),
        unit: "°/h",
        tau_s: points.iter().map(|point| point.tau_s).collect(),
        errors: errors.collect(),
        curves: std::iter::once(("true".to_owned(), of(&truth)))
            .chain(fits)
            .collect(),
        measured,
        span: Span {
            low: 0.5 * low,
            high: 2.0 * high,
        },
    }
}
