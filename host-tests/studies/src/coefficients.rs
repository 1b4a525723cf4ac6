//! Studies the errors of the coefficients and the coverage of their intervals.

use super::{curve, theory::squares};
use allanite::{
    Model,
    fit::{Method, Options, State, fit},
};
use allanite_host::simulate::Coefficients;
use rayon::prelude::*;

/// The accuracy of one coefficient over many records.
#[derive(Clone, Copy, Debug, Default)]
pub struct Accuracy {
    /// The root-mean-square error, relative to the true value. It is NaN if that is zero.
    pub rms_error: f64,
    /// The mean error, relative to the true value.
    pub bias: f64,
    /// The share of records whose 95 % interval contains the true value.
    pub coverage: f64,
    /// The share of records in which the coefficient was measured.
    pub measured: f64,
    /// The share of records in which its square is negative.
    pub negative: f64,
}

/// Fits `records` simulated records by a method. Returns the accuracies in the order of the model,
/// and the share of records with any negative square.
pub fn accuracy(
    coefficients: Coefficients,
    samples: usize,
    records: u64,
    settings: Options,
) -> ([Accuracy; 5], f64) {
    let truth = squares(coefficients).map(f64::sqrt);
    let fits: Vec<_> = (0..records)
        .into_par_iter()
        .filter_map(|seed| {
            fit(
                &curve(coefficients, samples, seed),
                &Model::ieee_952(),
                settings,
            )
            .ok()
        })
        .collect();
    let n = fits.len() as f64;
    let share = |f: &dyn Fn(&allanite::fit::Fit) -> bool| {
        fits.iter().filter(|fit| f(fit)).count() as f64 / n
    };
    let accuracies = std::array::from_fn(|i| {
        let errors = fits
            .iter()
            .map(|fit| fit.coefficients[i].value / truth[i] - 1.0);
        let square: f64 = errors.clone().map(|e| e * e).sum();
        Accuracy {
            rms_error: (square / n).sqrt(),
            bias: errors.sum::<f64>() / n,
            coverage: share(&|fit| {
                let c = &fit.coefficients[i];
                c.lower <= truth[i] && truth[i] <= c.upper
            }),
            measured: share(&|fit| fit.coefficients[i].state == State::Measured),
            negative: share(&|fit| fit.coefficients[i].square < 0.0),
        }
    });
    let any = share(&|fit| fit.coefficients.iter().any(|c| c.square < 0.0));
    (accuracies, any)
}

/// All methods with their names.
pub const METHODS: [(&str, Method); 5] = [
    ("covariance", Method::Covariance),
    ("relative accuracy", Method::RelativeAccuracy),
    ("ordinary", Method::Ordinary),
    ("accurate part", Method::AccuratePart),
    ("cluster count", Method::ClusterCount),
];
