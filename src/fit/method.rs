//! How a curve is fitted.

use crate::{limits, real::Real};

/// A model whose p-value is lower is not adequate: a χ² as large would come out in one of a hundred
/// records if the model were true. Fit, comparison and diagnosis share this threshold.
pub const ADEQUATE_P: Real = limits::ADEQUATE_P as Real;

/// How octaves are weighted, and whether squared coefficients may be negative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Method {
    /// Unweighted least squares on σ², unconstrained: the baseline (Lv, Liu, Lai & Huang 2015,
    /// eq. 7). Long averaging times, the least certain, decide.
    Ordinary,
    /// The weighted least squares of Lv, Liu, Lai & Huang 2015, unconstrained: every octave's
    /// standard error is its relative accuracy `δ = 1/√(2(N/m − 1))` times its value.
    RelativeAccuracy,
    /// Weights δ⁻² without the value: for comparison only, it does worse than `Ordinary`.
    ClusterCount,
    /// Generalised least squares with the full covariance of the curve at the fitted model, and
    /// squared coefficients that cannot be negative.
    #[default]
    Covariance,
}

/// How to fit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Options {
    /// How octaves are weighted.
    pub method: Method,
    /// How far an octave of the model may be off, relative to its variance; 0.01 by default, because a
    /// million samples show 0.1 %, and no model is that true. It is added in quadrature to the diagonal
    /// of the covariance, and only for a curve whose scatter alone does not explain the misfit
    /// (p < [`ADEQUATE_P`](crate::fit::ADEQUATE_P)): an adequate model keeps the full weight of every
    /// octave. For `Method::Covariance`.
    pub tolerance: Real,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::Covariance,
            tolerance: 0.01,
        }
    }
}
