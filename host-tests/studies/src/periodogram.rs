//! What the whole periodogram of a record would show (Whittle 1953): the likelihood ratio that is expected of noise beside
//! the best fit of quantization, angle random walk, flicker noise and rate random walk.

use super::{RATE_HZ, whittle};
use allanite_host::simulate::Coefficients;
use nalgebra::{SMatrix, SVector};

/// A group of the periodogram's ordinates.
struct Row {
    /// Their number.
    count: f64,
    /// What four terms add to them for a coefficient of one.
    terms: SVector<f64, 4>,
    /// What the gyro's own terms add.
    own: f64,
    /// What noise with a root mean square of one adds.
    noise: f64,
}

/// The whole periodogram.
pub(super) struct Periodogram(Vec<Row>);

impl Periodogram {
    /// The periodogram of a gyro with noise of this density for a size of one, as a variance, at `x` periods per sample.
    pub(super) fn new(base: Coefficients, samples: usize, noise: &dyn Fn(f64) -> f64) -> Self {
        let mut edges = vec![1.0];
        while let Some(&last) = edges.last() {
            let next = (last * 1.01_f64).max(last + 1.0).floor();
            if next > samples as f64 / 2.0 {
                break;
            }
            edges.push(next);
        }
        let interval_s = 1.0 / RATE_HZ;
        let one = Coefficients {
            quantization: 1.0,
            angle_random_walk: 1.0,
            bias_instability: 1.0,
            rate_random_walk: 1.0,
            rate_ramp: 0.0,
        };
        let squares = [
            base.quantization,
            base.angle_random_walk,
            base.bias_instability,
            base.rate_random_walk,
        ]
        .map(|coefficient| coefficient.powi(2));
        let group = |edge: &[f64]| {
            let x = (edge[0] + edge[1] - 1.0) / (2.0 * samples as f64);
            let terms = SVector::from(whittle::densities(one, interval_s, x));
            Row {
                count: edge[1] - edge[0],
                own: terms.dot(&SVector::from(squares)),
                noise: noise(x),
                terms,
            }
        };
        Self(edges.windows(2).map(group).collect())
    }

    /// The expected `−2 ln L` of the best four terms, less that of the truth, beside noise of this square.
    pub(super) fn ratio(&self, square: f64) -> f64 {
        let mut model: Vec<f64> = self.0.iter().map(|row| row.own).collect();
        let mut least = f64::INFINITY;
        for _ in 0..12 {
            let Some(squares) = self.best(square, &model) else {
                break;
            };
            model = self.0.iter().map(|row| row.terms.dot(&squares)).collect();
            let rows = self.0.iter().zip(&model);
            let sum: f64 = rows
                .map(|(row, model)| {
                    let ratio = (row.own + square * row.noise) / model;
                    row.count * (ratio - 1.0 - ratio.ln())
                })
                .sum();
            least = least.min(2.0 * sum);
        }
        least
    }

    /// The squared coefficients that fit the truth best, none of them negative, by the weights of a model.
    fn best(&self, square: f64, model: &[f64]) -> Option<SVector<f64, 4>> {
        let mut normal = SMatrix::<f64, 4, 4>::zeros();
        let mut right = SVector::<f64, 4>::zeros();
        for (row, model) in self.0.iter().zip(model) {
            let weight = row.count / (model * model);
            normal += weight * row.terms * row.terms.transpose();
            right += weight * (row.own + square * row.noise) * row.terms;
        }
        let scale = normal.diagonal().map(|diagonal| 1.0 / diagonal.sqrt());
        let scaled = SMatrix::<f64, 4, 4>::from_fn(|i, j| normal[(i, j)] * scale[i] * scale[j]);
        let right = right.component_mul(&scale);
        let mut best: Option<(f64, SVector<f64, 4>)> = None;
        for choice in 1_u32..16 {
            let has = |i: usize| choice >> i & 1 == 1;
            let part = SMatrix::<f64, 4, 4>::from_fn(|i, j| match (has(i) && has(j), i == j) {
                (true, _) => scaled[(i, j)],
                (false, true) => 1.0,
                (false, false) => 0.0,
            });
            let data = SVector::<f64, 4>::from_fn(|i, _| if has(i) { right[i] } else { 0.0 });
            let Some(solved) = part.cholesky().map(|root| root.solve(&data)) else {
                continue;
            };
            // What the choice explains of the squares.
            let explained = solved.dot(&data);
            let is_better = best.as_ref().is_none_or(|(most, _)| explained > *most);
            if (0..4).all(|i| !has(i) || solved[i] > 0.0) && is_better {
                best = Some((explained, solved.component_mul(&scale)));
            }
        }
        best.map(|(_, squares)| squares)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn the_limit_of_a_gyro_with_white_noise_alone_is_that_of_its_information() {
        // Beside white noise of one per sample, the ratio of small noise is the sum of half the squared relative change,
        // less what a fitted level takes: Σ (g − ḡ)²/2 · 2 over all ordinates.
        let base = Coefficients {
            angle_random_walk: 0.1,
            ..Coefficients::default()
        };
        let (samples, time_s) = (1 << 14, 0.5);
        let pole = (-1.0 / (RATE_HZ * time_s)).exp();
        let noise =
            |x: f64| (1.0 - pole * pole) / (1.0 - 2.0 * pole * (2.0 * PI * x).cos() + pole * pole);
        let rows = Periodogram::new(base, samples, &noise);
        let square = 1e-6;
        let weighted = |power: i32| -> f64 {
            let rows = rows.0.iter();
            rows.map(|row| row.count * (square * row.noise / row.own).powi(power))
                .sum()
        };
        let white_only = weighted(2) - weighted(1).powi(2) / weighted(0);
        let ratio = rows.ratio(square);
        // Three more terms can take a share of it, and nothing can add to it.
        assert!(
            ratio <= 1.001 * white_only && ratio > 0.05 * white_only,
            "{ratio} {white_only}"
        );
    }
}
