//! The five terms fitted to an axis.

use super::judged::Judged;
use crate::{
    curve_file::AxisCurve,
    diagnose::{diagnosed::Diagnosed, scope::Scope},
    disturbance::invalid,
    judgement::Judgement,
    limit::LimitArgument,
    record,
    tried::{self, TriedCovariate},
    words,
};
use allanite::{
    Curve, Model, Record,
    fit::{Fit, Method, Options, fit},
    integrity::Reason,
};
use allanite_log::{Evidence, OCTAVES, failure::Failure};
use clap::ValueEnum;
use schemars::JsonSchema;
use std::path::Path;

/// The names of the methods, which differ in how they weight the octaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, JsonSchema)]
#[schemars(rename_all = "kebab-case", inline)]
pub enum MethodName {
    /// Unweighted, unconstrained least squares, as a baseline
    Ordinary,
    /// The same without the octaves whose relative error exceeds 25 %
    AccuratePart,
    /// The standard error of each octave is its relative accuracy times its value; unconstrained
    RelativeAccuracy,
    /// The weight of each octave follows from its number of clusters; unconstrained, for comparison only
    ClusterCount,
    /// The weights follow from the covariance of the curve; coefficients cannot be negative
    Covariance,
}

impl MethodName {
    const fn method(self) -> Method {
        match self {
            Self::Ordinary => Method::Ordinary,
            Self::AccuratePart => Method::AccuratePart,
            Self::RelativeAccuracy => Method::RelativeAccuracy,
            Self::ClusterCount => Method::ClusterCount,
            Self::Covariance => Method::Covariance,
        }
    }

    /// The method as the option spells it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ordinary => "ordinary",
            Self::AccuratePart => "accurate-part",
            Self::RelativeAccuracy => "relative-accuracy",
            Self::ClusterCount => "cluster-count",
            Self::Covariance => "covariance",
        }
    }
}

/// An axis with its curve and its fit.
pub struct Fitted {
    /// The curve, as it is stored.
    pub axis: AxisCurve,
    /// The curve as the library's type.
    pub curve: Curve<OCTAVES>,
    /// The model.
    pub model: Model,
    /// The method that weighted the octaves.
    pub method: MethodName,
    /// The fit.
    pub fit: Fit,
    /// Why the curve is not valid.
    pub reason: Option<Reason>,
    /// The same in words.
    pub invalid: Option<String>,
    /// The covariates that were tried.
    pub tried: Vec<TriedCovariate>,
    /// What the limits that were asked for say.
    pub limits: Vec<Judged>,
    /// The verdict of the diagnosis; `None` if none was made.
    pub judgement: Option<Judgement>,
}

impl Fitted {
    /// Fits a model, which is the five terms or has them behind a known filter, to an axis of a file.
    ///
    /// # Errors
    /// When the curve cannot be fitted; the failure names the file and the axis.
    pub fn new(
        path: &Path,
        axis: AxisCurve,
        model: &Model,
        method: MethodName,
    ) -> Result<Self, Failure> {
        let options = Options {
            method: method.method(),
            ..Options::default()
        };
        let fitted = axis.curve().and_then(|curve| {
            let spectrum = axis.spectrum()?;
            let observed = Record::new(&curve, &spectrum);
            let fit = fit(observed, model, options)?;
            Ok((curve, fit))
        });
        match fitted {
            Ok((curve, fit)) => Ok(Self {
                axis,
                curve,
                model: model.clone(),
                method,
                fit,
                reason: None,
                invalid: None,
                tried: Vec::new(),
                limits: Vec::new(),
                judgement: None,
            }),
            Err(error) => Err(record::library_failure(path, &axis.axis, error)),
        }
    }

    /// Fits a model to an axis of a file as [`new`](Self::new) does, and tries the covariates of its evidence.
    ///
    /// # Errors
    /// As of [`new`](Self::new).
    pub fn with_evidence(
        path: &Path,
        axis: AxisCurve,
        model: &Model,
        method: MethodName,
        evidence: Evidence,
    ) -> Result<Self, Failure> {
        let fitted = Self::new(path, axis, model, method)?;
        let name = &fitted.axis.axis;
        let reason = evidence.invalid;
        let spectrum = fitted.axis.spectrum();
        let tried = spectrum
            .and_then(|spectrum| tried::beside_model(&fitted.curve, &spectrum, &evidence, model));
        let disturbance = evidence.disturbance.as_ref();
        let unit = fitted.axis.unit;
        Ok(Self {
            reason,
            invalid: reason
                .map(|reason| invalid(&reason, disturbance, (name, fitted.axis.rate_hz, unit))),
            tried: tried.map_err(|error| record::library_failure(path, name, error))?,
            ..fitted
        })
    }

    /// Whether the model explains a valid record, as a diagnosis decides, or the fit alone if none was made. `None` if the
    /// record does not tell, or the method has no errors.
    pub fn is_adequate(&self) -> Option<bool> {
        match (&self.judgement, self.method) {
            _ if !self.is_valid() => Some(false),
            (Some(judgement), MethodName::Covariance) => judgement.adequate,
            (None, MethodName::Covariance) => self.fit.is_adequate(),
            _ => None,
        }
    }

    /// Whether the curve is valid.
    pub const fn is_valid(&self) -> bool {
        self.invalid.is_none()
    }

    /// Notes on what was recorded alongside, a sentence each.
    pub fn covariate_notes(&self) -> Vec<String> {
        // Where a model does not explain the record, a slope that does not stand out may do so beside another one.
        let explains = self.fit.is_adequate() != Some(false);
        let tells = explains || self.tried.iter().any(TriedCovariate::acts);
        let (told, untold): (Vec<_>, Vec<_>) = self.tried.iter().partition(|_| tells);
        let note = |tried: &TriedCovariate| {
            let remedy = if tried.acts() {
                "; the coefficients include what follows it, and `diagnose` subtracts it"
            } else {
                ""
            };
            format!("tried {}{remedy}", tried.words(self.axis.unit))
        };
        let columns = untold.iter().map(|tried| tried.channel.clone()).collect();
        let hidden = (!untold.is_empty()).then(|| {
            format!(
                "whether the rate follows {} is told by `diagnose`, because this model hides it",
                words::list_of(columns)
            )
        });
        told.into_iter().map(note).chain(hidden).collect()
    }
}

/// How axes are fitted.
pub struct Settings<'a> {
    /// The five terms, behind a known filter if there is one.
    pub model: &'a Model,
    /// The method that weights the octaves.
    pub method: MethodName,
    /// The largest values that coefficients may have.
    pub limits: &'a [LimitArgument],
}

/// Fits all axes of a file.
///
/// # Errors
/// When an axis cannot be fitted, or a limit is of another model or unit.
pub fn fitted(
    path: &Path,
    axes: Vec<(AxisCurve, Evidence)>,
    settings: &Settings<'_>,
) -> Result<Vec<Fitted>, Failure> {
    let fit = |(axis, evidence): (AxisCurve, Evidence)| {
        let (model, method) = (settings.model, settings.method);
        let diagnosed =
            Diagnosed::without_limits(axis.clone(), evidence.clone(), model, &Scope::default());
        let diagnosed =
            diagnosed.map_err(|error| record::library_failure(path, &axis.axis, error))?;
        let judgement = Judgement::of(&diagnosed);
        let mut fitted = Fitted::with_evidence(path, axis, model, method, evidence)?;
        let (fit, is_valid) = (&fitted.fit, fitted.is_valid());
        fitted.limits = Judged::all(fit, &judgement, is_valid, &fitted.axis, settings.limits)?;
        fitted.judgement = Some(judgement);
        Ok(fitted)
    };
    axes.into_iter().map(fit).collect()
}
