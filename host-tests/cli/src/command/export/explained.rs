//! The axes of a record with the model that is exported: what the diagnosis finds, the five terms, or what was asked for.

use super::arguments::{Arguments, ModelName};
use crate::command::{input::record, output::progress};
use allanite::{
    Comparison, Curve, Error, Model, course::Course, covariate::Slope, diagnosis::Verdict,
    fit::Fit, spectrum::Spectrum,
};
use allanite_host::{
    compare::compared::Compared,
    curve_file::AxisCurve,
    dependence::candidates::Candidate,
    diagnose::{
        diagnosed::Diagnosed,
        scope::Scope,
        words::{unexplained, verdict},
    },
    disturbance::invalid as words_of_invalid,
    fit::fitted::{Fitted, MethodName},
    known_filter,
    tried::TriedCovariate,
    verdict::in_comment,
    words,
};
use allanite_log::{
    BINS, Evidence, OCTAVES,
    failure::{Failure, Place, one_line, report},
    unit::Sensor,
};
use std::path::Path;

/// A series that the rate follows, with the mean of its column where the log has one.
pub(super) struct Dependence {
    pub(super) slope: Slope,
    pub(super) series: Candidate,
    pub(super) mean: Option<f64>,
}

/// An axis and the model that explains it.
pub(super) struct Explained {
    pub(super) axis: AxisCurve,
    /// The curve and the spectrum that the model was fitted to: without what follows a covariate.
    pub(super) curve: Curve<OCTAVES>,
    pub(super) spectrum: Spectrum<BINS>,
    pub(super) model: Model,
    pub(super) fit: Fit,
    /// The model in words: `five terms + sinusoid`.
    pub(super) model_name: String,
    /// What is to be subtracted before the noise is that of the model.
    pub(super) dependences: Vec<Dependence>,
    /// The conclusion in a sentence.
    pub(super) verdict: String,
    /// Why a filter should not trust the model although the samples are valid: the diagnosis left something unexplained.
    unexplained: Option<String>,
    /// Why the samples are not valid.
    invalid: Option<String>,
    /// What the user should know before the numbers are used.
    warnings: Vec<String>,
    pub(super) course: Option<Course>,
}

/// Reads the input and explains every axis of a sensor.
///
/// # Errors
/// When the input cannot be read or fitted, is of the other sensor, or when an axis is not valid or not explained and no
/// option allows that.
pub(super) fn explained(arguments: &Arguments, sensor: Sensor) -> Result<Vec<Explained>, Failure> {
    let path = &arguments.input;
    let model = arguments.effects.model()?;
    let choice = arguments.choice();
    let about_log = match sensor {
        Sensor::Gyro => arguments.about_log.clone(),
        Sensor::Accelerometer => arguments.about_log.of_sensor(sensor)?,
    };
    let axes = record::read_with_evidence(path, &about_log, &arguments.covariates)?;
    let explain = |(axis, evidence): (AxisCurve, Evidence)| {
        if axis.unit.sensor() != sensor {
            let (found, remedy) = match sensor {
                Sensor::Gyro => (
                    "an accelerometer",
                    "export a gyro; `fit` prints the coefficients of an accelerometer",
                ),
                Sensor::Accelerometer => (
                    "a gyro",
                    "drop --accelerometer, and give its densities with options",
                ),
            };
            let what = format!("axis {} is from {found}, in {}", axis.axis, axis.unit);
            return Err(Place::file(path).failure(what, remedy));
        }
        let name = axis.axis.clone();
        let fail = |error| record::library_failure(path, &name, error);
        let explained = match choice {
            ModelName::Diagnosed => Explained::diagnosed(axis, evidence, &model).map_err(fail)?,
            ModelName::FiveTerms => Explained::five_terms(path, axis, &model, evidence)?,
            ModelName::Asked => Explained::asked(axis, &model, &evidence).map_err(fail)?,
        };
        explained.allowed(arguments)?;
        Ok(explained)
    };
    axes.into_iter().map(explain).collect()
}

impl Explained {
    /// The last model of a diagnosis.
    fn diagnosed(axis: AxisCurve, evidence: Evidence, model: &Model) -> Result<Self, Error> {
        let mut diagnosed = Diagnosed::without_limits(axis, evidence, model, &Scope::default())?;
        let (verdict, invalid) = (verdict(&diagnosed), diagnosed.invalid());
        let last = diagnosed.steps.len().saturating_sub(1);
        let model_name = diagnosed.model_name(last);
        // A diagnosis has one step at least: the model that it begins with.
        let Some(step) = diagnosed.steps.pop() else {
            return Err(Error::Singular);
        };
        let (curve, spectrum) = diagnosed.observed_in(&step)?;
        let slopes = step.covariate.as_ref();
        let slopes = slopes.map_or(Vec::new(), |followed| diagnosed.slopes(followed));
        let dependences = slopes.into_iter().map(|(slope, series)| Dependence {
            slope,
            series: series.clone(),
            mean: mean(&diagnosed.columns, &series.column),
        });
        let unexplained = match diagnosed.verdict {
            Verdict::Unexplained | Verdict::Incomplete => Some(rest(&step.comparison)),
            _ if diagnosed.stationarity.is_disturbed() => {
                diagnosed.stationarity.strongest(diagnosed.axis.unit)
            }
            _ => None,
        };
        Ok(Self {
            dependences: dependences.collect(),
            unexplained,
            warnings: Vec::new(),
            course: diagnosed.course.take(),
            axis: diagnosed.axis,
            curve,
            spectrum,
            model: step.model,
            fit: step.fit,
            model_name,
            verdict,
            invalid,
        })
    }

    /// The five terms, or those behind a known filter.
    fn five_terms(
        path: &Path,
        axis: AxisCurve,
        model: &Model,
        mut evidence: Evidence,
    ) -> Result<Self, Failure> {
        let course = evidence.course.take();
        let fitted = Fitted::with_evidence(path, axis, model, MethodName::Covariance, evidence)?;
        let spectrum = fitted.axis.spectrum();
        let spectrum =
            spectrum.map_err(|error| record::library_failure(path, &fitted.axis.axis, error))?;
        let acts = fitted.tried.iter().any(TriedCovariate::acts);
        let warnings = fitted.covariate_notes().into_iter().filter(|_| acts);
        Ok(Self {
            warnings: warnings.collect(),
            model_name: known_filter::terms(&fitted.model),
            verdict: in_comment(&fitted.fit),
            axis: fitted.axis,
            curve: fitted.curve,
            spectrum,
            model: fitted.model,
            fit: fitted.fit,
            dependences: Vec::new(),
            unexplained: None,
            invalid: fitted.invalid,
            course,
        })
    }

    /// The model that was asked for.
    fn asked(axis: AxisCurve, model: &Model, evidence: &Evidence) -> Result<Self, Error> {
        let disturbance = evidence.disturbance.as_ref();
        let place = (axis.axis.as_str(), axis.rate_hz, axis.unit);
        let invalid = evidence.invalid.as_ref();
        let invalid = invalid.map(|reason| words_of_invalid(reason, disturbance, place));
        let curve = axis.curve()?;
        let compared = Compared::new(axis, model, None)?;
        let names = compared.model.terms().iter();
        let names = names.map(|term| words::plain(term.effect.name()));
        Ok(Self {
            model_name: names.collect::<Vec<_>>().join(" + "),
            verdict: in_comment(&compared.fit),
            axis: compared.axis,
            curve,
            spectrum: compared.spectrum,
            model: compared.model,
            fit: compared.fit,
            dependences: Vec::new(),
            unexplained: None,
            invalid,
            warnings: Vec::new(),
            course: evidence.course.clone(),
        })
    }

    /// Refuses an axis that is not valid or not explained, unless that is allowed, and reports what is allowed.
    fn allowed(&self, arguments: &Arguments) -> Result<(), Failure> {
        let path = &arguments.input;
        let name = &self.axis.axis;
        let invalid = self.invalid.iter().map(|reason| {
            (
                format!("axis {name}: {reason}"),
                arguments.despite_invalid,
                "record again, or export all the same with --despite-invalid",
            )
        });
        let unexplained = self.unexplained.iter().map(|rest| {
            (
                format!("axis {name}: the diagnosis leaves something unexplained: {rest}"),
                arguments.despite_unexplained,
                "see `diagnose`; --despite-unexplained exports it all the same, best with --overbound, and --model \
                 five-terms leaves the diagnosis out",
            )
        });
        // A record that is not valid was not diagnosed.
        for (what, is_allowed, remedy) in invalid.chain(unexplained).take(1) {
            if !is_allowed {
                return Err(Place::file(path).failure(what, remedy));
            }
            say(path, &what);
        }
        for warning in &self.warnings {
            say(path, &format!("axis {name}: {warning}"));
        }
        Ok(())
    }
}

/// Prints a line on standard error, unless it is to be quiet.
fn say(path: &Path, what: &str) {
    if !progress::is_quiet() {
        report(format_args!("{}{}", Place::file(path), one_line(what)));
    }
}

/// Where a record differs from its model most: in octaves, or else in the spectrum.
fn rest(comparison: &Comparison<OCTAVES, BINS>) -> String {
    let bands = unexplained(comparison);
    match comparison.stretches().next() {
        None if !bands.is_empty() => format!("the spectrum is {}", bands.join(", ")),
        _ => comparison.to_string(),
    }
}

/// The mean of a column over the blocks of a record.
fn mean(columns: &[(String, Vec<f64>)], name: &str) -> Option<f64> {
    let (_, means) = columns.iter().find(|(column, _)| column == name)?;
    let means: Vec<f64> = means.iter().copied().filter(|x| x.is_finite()).collect();
    (!means.is_empty()).then(|| means.iter().sum::<f64>() / means.len() as f64)
}
