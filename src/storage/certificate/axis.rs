//! The part of a certificate that describes one axis.

use super::{EffectCode, Findings};
use crate::{
    Error, Model, Record,
    detection::{MAX_RANGES, Range, is_of_shape},
    diagnosis::{Step, Verdict},
    fit::{Correlations, Fit, State},
    limits::MAX_PARAMETERS,
    list,
    numerics::real::{double, real, single},
    theory::{effect::IEEE_952, model::MAX_EFFECTS},
};
use heapless::Vec;

/// A fit and its verdict, in single precision, whose rounding is far below the uncertainty of any record.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AxisCertificate {
    /// The terms of the model, in the order of the model.
    pub terms: Vec<CertifiedTerm, MAX_EFFECTS>,
    /// The correlations of the terms' squared coefficients.
    pub correlations: Correlations,
    /// χ² of the fit; NaN for a method without error model.
    pub chi_squared: f64,
    /// The degrees of freedom of the fit.
    pub degrees_of_freedom: u16,
    /// The probability of a larger χ² if the model is true; NaN if there is none.
    pub p_value: f64,
    /// The tolerance granted to the model, relative to its variance.
    pub tolerance: f32,
    /// The verdict of a diagnosis; `None` if there was no diagnosis.
    pub verdict: Option<Verdict>,
    /// The sizes of effects that the record would have shown. Empty until they are pushed.
    pub limits: Vec<CertifiedLimit, MAX_RANGES>,
    /// What a diagnosis found besides the terms of the model.
    pub findings: Findings,
}

/// A term of a model: an effect with its coefficient and its shape.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CertifiedTerm {
    /// The effect.
    pub effect: EffectCode,
    /// The best value of the coefficient, in rate unit · s^(half_seconds/2) of the effect.
    pub value: f32,
    /// The lower end of the 95 % interval; zero unless the coefficient was measured.
    pub lower: f32,
    /// The upper end of the 95 % interval, or the one-sided 95 % bound; infinite if the record cannot
    /// distinguish the effect from others.
    pub upper: f32,
    /// The standard error of the squared coefficient; infinite if `upper` is infinite.
    pub square_error: f32,
    /// Whether the coefficient was measured.
    pub state: CertifiedState,
    /// The shape parameters, in the order in which the effect names them.
    pub shape: Vec<CertifiedShape, MAX_PARAMETERS>,
}

/// The [`State`] of a coefficient, in single precision.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum CertifiedState {
    /// The 95 % interval excludes zero.
    Measured,
    /// `upper` is a one-sided 95 % bound.
    UpperBound,
    /// The record says nothing about the coefficient.
    NotObservable {
        /// The length of a record that would measure it, in seconds; `None` if no length would.
        after_s: Option<f32>,
    },
}

/// A shape parameter, in its own unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CertifiedShape {
    /// The best value.
    pub value: f32,
    /// The lower end of the 95 % interval; NaN if the parameter was not fitted.
    pub lower: f32,
    /// The upper end of the 95 % interval; NaN if the parameter was not fitted.
    pub upper: f32,
}

/// The size of an effect that a record would have shown with a probability of 95 %, as the ranges of
/// [`Ranges`](crate::detection::Ranges) have it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CertifiedLimit {
    /// The effect.
    pub effect: EffectCode,
    /// The limit: a coefficient in rate unit · s^(half_seconds/2) of the effect, or the first shape parameter of
    /// a filter in its own unit.
    pub size: f32,
    /// The lowest value of the effect's first shape parameter to which the limit applies; zero if the effect
    /// has none or if the limit is that of this parameter.
    pub low: f32,
    /// The highest value.
    pub high: f32,
}

impl CertifiedLimit {
    /// The limit of a range.
    pub fn of(range: &Range) -> Self {
        Self {
            effect: EffectCode::of(range.effect),
            size: single(range.size),
            low: single(range.ends.0),
            high: single(range.ends.1),
        }
    }

    /// The range, if the effect belongs to the catalogue.
    pub fn range(&self) -> Option<Range> {
        let effect = self.effect.effect()?;
        Some(Range {
            effect,
            ends: (real(self.low), real(self.high)),
            size: real(self.size),
            is_of_shape: is_of_shape(effect),
        })
    }
}

impl AxisCertificate {
    /// The certificate of an axis of which nothing is known yet.
    pub fn empty() -> Self {
        Self {
            terms: Vec::new(),
            correlations: Correlations::UNKNOWN,
            chi_squared: f64::NAN,
            degrees_of_freedom: 0,
            p_value: f64::NAN,
            tolerance: 0.0,
            verdict: None,
            limits: Vec::new(),
            findings: Findings::default(),
        }
    }

    /// The certificate of a fit of this model to this curve, or to a curve and its spectrum. Its verdict is `None` until
    /// it is set, it has no limits of detection until they are pushed, and no findings.
    ///
    /// This weighs the octaves once more for the correlations, at a few per cent of the cost of a fit.
    ///
    /// # Errors
    /// The errors of [`Fit::correlations`].
    pub fn new<'a, const K: usize, const B: usize>(
        record: impl Into<Record<'a, K, B>>,
        model: &Model,
        fit: &Fit,
    ) -> Result<Self, Error> {
        let mut axis = Self::empty();
        axis.set(record.into(), model, fit)?;
        Ok(axis)
    }

    /// Takes over a step of a diagnosis of this curve, or of this curve and its spectrum: the model and its fit, the
    /// covariates that the rate follows, the effects that are in doubt, and where the spectrum differs. Called for every
    /// step, it leaves the certificate of the last one, with the doubts of the steps before. The verdict, the limits of
    /// detection and the [events](Findings::set_events) stay as they are.
    ///
    /// This costs as much as [`new`](Self::new).
    ///
    /// # Errors
    /// The errors of [`Fit::correlations`].
    ///
    /// # Example
    ///
    /// ```
    /// use allanite::{Curve, Model, Real, diagnosis::{Diagnosis, Options}, effect::CATALOGUE, storage::AxisCertificate};
    /// use core::ops::ControlFlow;
    ///
    /// // White noise behind a filter that is shorter than two samples.
    /// let octaves = (0..12).map(|k| (1 << k, (160_000 >> k) - 7, (1.0 - 0.4 / (1 << k) as Real) / (1 << k) as Real));
    /// let curve = Curve::<12>::new(100.0, octaves)?;
    /// let (model, options) = (Model::ieee_952(), Options::default());
    /// let mut diagnosis = Diagnosis::new(&curve, &model, &CATALOGUE, options);
    /// let mut pause = || ControlFlow::Continue(()); // feed the watchdog, take the next samples
    /// let mut axis = AxisCertificate::empty();
    /// let mut taken = Ok(());
    /// let verdict = diagnosis.run(|step| taken = axis.take(&curve, step), &mut pause)?;
    /// taken?;
    /// axis.verdict = verdict;
    /// assert!(axis.found().count() > 0 && !axis.findings.doubts.is_empty());
    /// # Ok::<(), allanite::Error>(())
    /// ```
    pub fn take<'a, const K: usize, const B: usize>(
        &mut self,
        record: impl Into<Record<'a, K, B>>,
        step: &Step<K, B>,
    ) -> Result<(), Error> {
        self.set(record.into(), &step.model, &step.fit)?;
        let terms = &self.terms;
        let holds = |code: EffectCode| terms.iter().any(|term| term.effect == code);
        self.findings.take(step, holds);
        Ok(())
    }

    fn set<const K: usize, const B: usize>(
        &mut self,
        record: Record<'_, K, B>,
        model: &Model,
        fit: &Fit,
    ) -> Result<(), Error> {
        self.correlations = fit.correlations(record, model)?;
        let terms = (0..fit.coefficients.len()).filter_map(|i| term(model, fit, i));
        self.terms = list::fill(terms);
        self.chi_squared = double(fit.chi_squared);
        self.degrees_of_freedom = fit.degrees_of_freedom.min(usize::from(u16::MAX)) as u16;
        self.p_value = double(fit.p_value);
        self.tolerance = single(fit.tolerance);
        Ok(())
    }

    /// The covariance of the squared coefficients of terms `i` and `j`; NaN if it is not known.
    pub fn covariance(&self, i: usize, j: usize) -> f64 {
        let error = |i: usize| {
            let term = self.terms.get(i);
            term.map_or(f64::NAN, |term| f64::from(term.square_error))
        };
        double(self.correlations.get(i, j)) * error(i) * error(j)
    }

    /// The effects other than the five of IEEE Std 952.
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
