//! Compares the theoretical covariance of the curve and the χ² of the fit with simulated records.

use super::{OCTAVES, curve};
use allanite::{
    Model,
    fit::{Options, curve_covariance, fit},
};
use allanite_host::{quantile::quantile, simulate::Coefficients};
use rayon::prelude::*;

/// Theory and simulation of one octave.
#[derive(Clone, Copy, Debug)]
pub struct Octave {
    /// The averaging factor.
    pub m: u32,
    /// The mean of the estimates, relative to the theoretical Allan variance.
    pub mean: f64,
    /// The variance of the estimates, relative to the theoretical one.
    pub variance: f64,
    /// The correlations with the octaves 1, 2, 3 and 4 above, simulated and theoretical. They are
    /// NaN beyond the curve.
    pub correlations: [(f64, f64); 4],
}

/// Simulates `records` records and compares the scatter of their curves with theory.
pub fn scatter(coefficients: Coefficients, samples: usize, records: u64) -> Vec<Octave> {
    let curves: Vec<Vec<f64>> = (0..records)
        .into_par_iter()
        .map(|seed| {
            let curve = curve(coefficients, samples, seed);
            curve.points().iter().map(|point| point.variance).collect()
        })
        .collect();
    let template = curve(coefficients, samples, 0);
    let model = Model::ieee_952();
    let squares = squares(coefficients);
    let covariance = curve_covariance::<OCTAVES>(&template, &model, &squares);
    let points = template.points();
    let n = records as f64;
    let mean = |k: usize| curves.iter().map(|c| c[k]).sum::<f64>() / n;
    let means: Vec<f64> = (0..points.len()).map(mean).collect();
    let simulated = |j: usize, k: usize| {
        let products = curves.iter().map(|c| (c[j] - means[j]) * (c[k] - means[k]));
        products.sum::<f64>() / (n - 1.0)
    };
    (0..points.len())
        .map(|k| {
            let correlations = std::array::from_fn(|d| {
                let j = k + d + 1;
                if j >= points.len() {
                    return (f64::NAN, f64::NAN);
                }
                let own = (simulated(k, k) * simulated(j, j)).sqrt();
                let theory = (covariance[(k, k)] * covariance[(j, j)]).sqrt();
                (simulated(k, j) / own, covariance[(k, j)] / theory)
            });
            Octave {
                m: points[k].m,
                mean: means[k] / model.variance(&squares, points[k].m, template.interval_s()),
                variance: simulated(k, k) / covariance[(k, k)],
                correlations,
            }
        })
        .collect()
}

/// The χ² of the covariance fit of simulated records, sorted.
pub fn chi_squared(
    coefficients: Coefficients,
    samples: usize,
    records: u64,
    settings: Options,
) -> Vec<f64> {
    let mut values: Vec<f64> = (0..records)
        .into_par_iter()
        .map(|seed| {
            let curve = curve(coefficients, samples, seed);
            fit(&curve, &Model::ieee_952(), settings).map_or(f64::NAN, |fit| fit.chi_squared)
        })
        .collect();
    values.sort_by(f64::total_cmp);
    values
}

/// The mean, and the median and the 90 %, 95 % and 99 % quantiles.
pub fn summary(sorted: &[f64]) -> [f64; 5] {
    let mean = sorted.iter().sum::<f64>() / sorted.len() as f64;
    [
        mean,
        quantile(sorted, 0.5),
        quantile(sorted, 0.9),
        quantile(sorted, 0.95),
        quantile(sorted, 0.99),
    ]
}

/// The squared coefficients in the order of the IEEE-952 model.
pub fn squares(c: Coefficients) -> [f64; 5] {
    [
        c.quantization,
        c.angle_random_walk,
        c.bias_instability,
        c.rate_random_walk,
        c.rate_ramp,
    ]
    .map(|x| x * x)
}
