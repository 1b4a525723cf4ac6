//! The result of a fit.

use super::{
    method::{ADEQUATE_P, Method},
    peak::Peak,
};
use crate::{
    fit::coefficient::Coefficient,
    limits::{MAX_EFFECTS, MAX_SHAPE},
    numerics::real::Real,
};
use heapless::Vec;

/// A fitted shape parameter, with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ShapeEstimate {
    /// Place of the effect in the model.
    pub term: usize,
    /// The parameter's name, such as `frequency_hz`.
    pub name: &'static str,
    /// Best value.
    pub value: Real,
    /// Lower end of the interval.
    pub lower: Real,
    /// Upper end of the interval.
    pub upper: Real,
}

/// Coefficients of a model, with what they are worth.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fit {
    /// How the octaves were weighted.
    pub method: Method,
    /// The coefficients, one for each effect of the model, in its order.
    pub coefficients: Vec<Coefficient, MAX_EFFECTS>,
    /// The shape parameters that were fitted.
    pub shape: Vec<ShapeEstimate, MAX_SHAPE>,
    /// χ²: the squared residuals in units of their covariance, `r'C⁻¹r − 2 Σ(measured/model − 1)`. The sum corrects for
    /// the covariance, which follows the measurement (Farrington 1996). NaN for `Ordinary`, `AccuratePart` and
    /// `ClusterCount`, which have no error model. Too large for `RelativeAccuracy`, which takes the octaves for
    /// independent. Where a true model has so large a [deviance](Self::deviance) in less than one of a thousand records, it is the
    /// deviance, which falls with each effect that is added.
    pub chi_squared: Real,
    /// The number of octaves that the method uses, less the number of coefficients above zero and of their fitted shape
    /// parameters.
    pub degrees_of_freedom: usize,
    /// The squared deviance residuals in units of their correlation. It is about as large as χ² for a true model, and larger
    /// for one that lies far above the measurement, which χ² by the model's own covariance hardly sees. NaN for all methods but `Covariance`.
    pub deviance: Real,
    /// Probability of a larger χ² if the model is true; ten times that probability where it is the deviance. NaN without χ² or
    /// without degrees of freedom.
    pub p_value: Real,
    /// The largest peak of the spectrum above the model; `None` if no spectrum was fitted.
    pub peak: Option<Peak>,
    /// `−2 ln L = r'C⁻¹r + ln det C`, up to a constant. It ranks models of one curve. NaN where χ² is
    /// NaN.
    pub minus_two_log_likelihood: Real,
    /// The tolerance that was granted, which is [`Options::tolerance`](super::Options::tolerance) or 0.
    pub tolerance: Real,
    /// The share that the correlations had to lose before the covariance was positive definite; usually
    /// 0.
    pub shrinkage: Real,
    /// The factor by which the intervals, the bounds and the standard errors are widened because the model
    /// is not adequate: √(χ²/degrees of freedom) (Birge 1932). It is 1 for an adequate model.
    pub birge_ratio: Real,
}

impl Fit {
    /// A fit of nothing yet.
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const EMPTY: Self = Self {
        method: Method::Ordinary,
        coefficients: Vec::new(),
        shape: Vec::new(),
        chi_squared: 0.0,
        degrees_of_freedom: 0,
        deviance: 0.0,
        p_value: 0.0,
        peak: None,
        minus_two_log_likelihood: 0.0,
        tolerance: 0.0,
        shrinkage: 0.0,
        birge_ratio: 0.0,
    };

    /// Whether the model explains the record: `Some(true)` if the p-value is [`ADEQUATE_P`] or more, and no
    /// peak of the spectrum has a probability below 0.001. `None` if there is no p-value, because the curve is too short or the method has no error model.
    pub fn is_adequate(&self) -> Option<bool> {
        let is_high = self.peak.is_some_and(|peak| peak.is_significant());
        (!self.p_value.is_nan()).then_some(self.p_value >= ADEQUATE_P && !is_high)
    }

    /// The squared coefficients, for [`Model::variance`](crate::Model::variance).
    pub fn squares(&self) -> [Real; MAX_EFFECTS] {
        let mut squares = [0.0; MAX_EFFECTS];
        for (square, coefficient) in squares.iter_mut().zip(&self.coefficients) {
            *square = coefficient.square;
        }
        squares
    }
}
