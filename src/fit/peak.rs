//! The largest peak of a spectrum above a model.

use super::{problem::Problem, weights::Weights};
use crate::{
    math,
    nnls::Vector,
    real::{Real, consts::FRAC_1_SQRT_2, real},
};

/// A model is not adequate if the probability of its peak is below this, whatever its χ² is. A line adds little to a
/// χ² of a hundred bins. Chosen by hand: true models are then called inadequate in one more of 1000 records.
pub(super) const LEAST_P: Real = 1e-3;

/// The bin of a spectrum that lies farthest above a model.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Peak {
    /// The frequency of the bin, in Hz.
    pub frequency_hz: Real,
    /// How far the density lies above the model's, in standard deviations of a normal distribution. The cube root of
    /// a density is nearly normal (Wilson & Hilferty 1931, PNAS 17, 684), while the density itself is not.
    pub z: Real,
    /// The probability that any of the bins lies as far above the model if the model is true.
    pub p_value: Real,
}

impl Peak {
    /// The peak of the problem's spectrum above the model with these squared coefficients; `None` if there is no
    /// spectrum.
    #[inline(never)]
    pub(super) fn of<const K: usize, const B: usize>(
        problem: &Problem<'_, K, B>,
        weights: &Weights<K, B>,
        squares: &Vector,
    ) -> Option<Self> {
        if B == 0 {
            return None;
        }
        let rows = problem.rows().skip(problem.points.len());
        let mut highest: Option<(Real, Real)> = None;
        for (row, bin) in rows.zip(problem.bins) {
            let error = weights.relative_error(row);
            let per_degree = error * error / 9.0;
            let ratio = problem.measured(row) / problem.variance(row, squares);
            let root = math::exp(math::log(ratio) / 3.0);
            let z = (root - 1.0 + per_degree) * 3.0 / error;
            if highest.is_none_or(|(_, highest)| z > highest) {
                highest = Some((bin.frequency_hz, z));
            }
        }
        let (frequency_hz, z) = highest?;
        let one = 0.5 * math::erfc(z * FRAC_1_SQRT_2);
        Some(Self {
            frequency_hz,
            z,
            p_value: (real(problem.bins.len()) * one).min(1.0),
        })
    }

    /// Whether a true model has such a peak too rarely.
    pub(super) fn is_significant(&self) -> bool {
        self.p_value < LEAST_P
    }
}
