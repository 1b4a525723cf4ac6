//! The methods and options of a fit.

use crate::{limits, numerics::real::Real};

/// A model with a lower p-value is not adequate: if it were true, a χ² as large would come out in one
/// of a hundred records. Fit, comparison and diagnosis share this threshold.
pub const ADEQUATE_P: Real = limits::ADEQUATE_P as Real;

/// How octaves are weighted, and whether squared coefficients may be negative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Method {
    /// Unweighted least squares on σ², unconstrained. This is the baseline (Lv, Liu, Lai & Huang 2015,
    /// eq. 7). It is dominated by the longest averaging times, which are the least certain.
    Ordinary,
    /// `Ordinary` on the accurate part of the curve only: octaves whose relative accuracy
    /// `δ = 1/√(2(N/m − 1))` exceeds 25 % are left out, which are those of fewer than nine clusters. This
    /// is the usual remedy for the uncertainty of the longest averaging times. The limit is chosen by
    /// hand. In 60 simulated records of each gyro of `cargo xtask study paper`, a limit of 10 % left too
    /// little of the curve to show a rate ramp, and one of 33 % nearly doubled the error of the rate random
    /// walk of two of them.
    AccuratePart,
    /// The weighted least squares of Lv, Liu, Lai & Huang 2015, unconstrained. Every octave has a
    /// standard error of its relative accuracy `δ = 1/√(2(N/m − 1))` times its value.
    RelativeAccuracy,
    /// Weights δ⁻² that do not depend on the value, unconstrained. It is here for comparison only,
    /// because it does worse than `RelativeAccuracy`, and for good gyros worse than `Ordinary`.
    ClusterCount,
    /// Generalised least squares with the full covariance of the curve at the fitted model. Squared
    /// coefficients cannot be negative.
    #[default]
    Covariance,
}

/// The options of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Options {
    /// How octaves are weighted, and whether squared coefficients may be negative.
    pub method: Method,
    /// How far an octave of the model may be off, relative to its variance. The default is 0.01: a
    /// million samples show 0.1 %, and no model is that true. The tolerance is added in quadrature to
    /// the diagonal of the covariance. It is granted only for a curve whose scatter alone does not
    /// explain the misfit (p < [`ADEQUATE_P`](crate::fit::ADEQUATE_P)), so that an adequate model keeps
    /// the full weight of every octave. Only `Method::Covariance` uses it.
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
