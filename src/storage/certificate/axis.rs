//! What a record keeps of an axis.

use super::EffectCode;
use crate::{
    Curve, Error, Model,
    diagnosis::Verdict,
    effect::IEEE_952,
    fit::{Correlations, Fit, State},
    limits::MAX_PARAMETERS,
    model::MAX_EFFECTS,
    real::{double, single},
};
use heapless::Vec;

/// A fit and what came of it, in single precision: far below what any record tells.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AxisCertificate {
    /// The model's terms, in its order.
    pub terms: Vec<CertifiedTerm, MAX_EFFECTS>,
    /// Correlations of their squared coefficients.
    pub correlations: Correlations,
    /// χ² of the fit; NaN for methods without error model.
    pub chi_squared: f64,
    /// Degrees of freedom.
    pub degrees_of_freedom: u16,
    /// Probability of a larger χ² if the model is true; NaN where there is none.
    pub p_value: f64,
    /// The tolerance that was granted to the model, relative to its variance.
    pub tolerance: f32,
    /// What a diagnosis said; `None` where there was none.
    pub verdict: Option<Verdict>,
}

/// A term of a model: an effect, its coefficient, its shape.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CertifiedTerm {
    /// The effect.
    pub effect: EffectCode,
    /// Best value of the coefficient, in rate unit · s^(half_seconds/2) of the effect.
    pub value: f32,
    /// Lower end of the 95 % interval; zero unless measured.
    pub lower: f32,
    /// Upper end of it, or the one-sided 95 % bound; infinite if the effect cannot be told from others.
    pub upper: f32,
    /// Standard error of the squared coefficient; infinite as `upper`.
    pub square_error: f32,
    /// Whether it was measured.
    pub state: CertifiedState,
    /// The shape parameters, in the order in which the effect names them.
    pub shape: Vec<CertifiedShape, MAX_PARAMETERS>,
}

/// [`State`] in single precision.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum CertifiedState {
    /// The 95 % interval excludes zero.
    Measured,
    /// `upper` bounds it, one-sided, at 95 %.
    UpperBound,
    /// The record says nothing of it.
    NotObservable {
        /// Length of a record, in seconds, that would measure it; `None` where none would.
        after_s: Option<f32>,
    },
}

/// A shape parameter, in its own unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CertifiedShape {
    /// Best value.
    pub value: f32,
    /// Lower end of the 95 % interval; NaN of one that was not fitted.
    pub lower: f32,
    /// Upper end of it.
    pub upper: f32,
}

impl AxisCertificate {
    /// What is kept of a fit of this model to this curve: the one that was asked about, or the last
    /// [`Step`](crate::Step) of a diagnosis. Its verdict is set apart.
    ///
    /// Weighs the octaves once more, for the correlations: a few per cent of what a fit costs.
    ///
    /// # Errors
    /// Of [`Fit::correlations`].
    pub fn new<const K: usize>(curve: &Curve<K>, model: &Model, fit: &Fit) -> Result<Self, Error> {
        Ok(Self {
            terms: (0..fit.coefficients.len())
                .filter_map(|i| term(model, fit, i))
                .collect(),
            correlations: fit.correlations(curve, model)?,
            chi_squared: double(fit.chi_squared),
            degrees_of_freedom: fit.degrees_of_freedom.min(usize::from(u16::MAX)) as u16,
            p_value: double(fit.p_value),
            tolerance: single(fit.tolerance),
            verdict: None,
        })
    }

    /// The covariance of two squared coefficients, by their places; NaN where it is not known.
    pub fn covariance(&self, i: usize, j: usize) -> f64 {
        let error = |i: usize| {
            let term = self.terms.get(i);
            term.map_or(f64::NAN, |term| f64::from(term.square_error))
        };
        double(self.correlations.get(i, j)) * error(i) * error(j)
    }

    /// The effects beyond the five of IEEE Std 952.
    pub fn found(&self) -> impl Iterator<Item = &CertifiedTerm> {
        let usual = |term: &&CertifiedTerm| {
            let mut names = IEEE_952.iter().map(|effect| effect.name());
            !names.any(|name| name == term.effect.name())
        };
        self.terms.iter().filter(usual)
    }
}

fn term(model: &Model, fit: &Fit, i: usize) -> Option<CertifiedTerm> {
    let (term, coefficient) = (model.terms().get(i)?, fit.coefficients.get(i)?);
    let parameters = term.effect.parameters().iter().zip(term.parameters);
    let shape = parameters.map(|(parameter, value)| {
        let mut estimates = fit.shape.iter();
        let estimate = estimates.find(|one| one.term == i && one.name == parameter.name);
        CertifiedShape {
            value: single(value),
            lower: estimate.map_or(f32::NAN, |one| single(one.lower)),
            upper: estimate.map_or(f32::NAN, |one| single(one.upper)),
        }
    });
    Some(CertifiedTerm {
        effect: EffectCode::of(term.effect),
        value: single(coefficient.value),
        lower: single(coefficient.lower),
        upper: single(coefficient.upper),
        square_error: single(coefficient.square_error),
        state: match coefficient.state {
            State::Measured => CertifiedState::Measured,
            State::UpperBound => CertifiedState::UpperBound,
            State::NotObservable { after_s } => CertifiedState::NotObservable {
                after_s: after_s.map(single),
            },
        },
        shape: shape.take(MAX_PARAMETERS).collect(),
    })
}
