//! A record in memory.

use super::{
    comparison::Comparison,
    diagnosis::Diagnosis,
    document::{json, no_axis, text, unwritten},
    options::{Fitting, Reading, Search},
    own::Own,
    stored,
};
use crate::{
    compare::model::ModelChoice,
    curve_file::{AxisCurve, CurveFile},
    disturbance::invalid,
    fit::{
        self,
        fitted::{Fitted, Settings},
    },
    known_filter, record,
};
use allanite_log::{
    self as log, Arrays, Evidence, Log, failure::Failure, pieces::Pieces, unit::Unit,
};
use indicatif::ProgressBar;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// The axes of a log or of arrays, as everything that a diagnosis needs. It has no samples.
#[derive(Clone)]
pub struct Record {
    path: PathBuf,
    axes: Vec<(AxisCurve, Evidence)>,
    notes: Vec<String>,
}

/// What a record tells of itself.
#[derive(Serialize)]
struct Description<'a> {
    path: String,
    axes: Vec<Axis<'a>>,
    notes: &'a [String],
}

#[derive(Serialize)]
struct Axis<'a> {
    #[serde(flatten)]
    curve: &'a AxisCurve,
    /// Why the curve is not valid, in words.
    invalid: Option<String>,
    covariates: Vec<&'a str>,
}

/// The five terms fitted to all axes of a record.
pub struct Fits(Vec<Fitted>);

impl Fits {
    /// What was found, axis by axis, as `fit --json` prints it.
    pub fn document(&self) -> fit::json::Document<'_> {
        fit::json::document(&self.0)
    }

    /// The document that `fit --json` prints.
    ///
    /// # Errors
    /// None occurs, because all numbers can be written.
    pub fn json(&self) -> Result<String, Failure> {
        json(&self.document())
    }

    /// The text that `fit` prints.
    ///
    /// # Errors
    /// None occurs, because the text is in memory.
    pub fn text(&self) -> Result<String, Failure> {
        text(|output| fit::table::print(&self.0, output))
    }
}

impl Record {
    /// Reads a log or a curve file. `progress` follows the bytes, and ends the reading when it is ended itself.
    ///
    /// # Errors
    /// As of the commands.
    pub fn read(path: &Path, reading: &Reading, progress: &ProgressBar) -> Result<Self, Failure> {
        let Reading {
            log: options,
            covariates,
        } = reading;
        if record::is_curve(path) {
            return Ok(Self {
                axes: record::curves_without_evidence(path, options, covariates)?,
                path: path.to_owned(),
                notes: Vec::new(),
            });
        }
        let log = log::read_with_evidence(path, options, covariates, progress)?;
        Self::of_log(path, log)
    }

    /// Reads arrays in memory.
    ///
    /// # Errors
    /// As of the commands.
    pub fn of_arrays(
        arrays: &Arrays<'_>,
        reading: &Reading,
        progress: &ProgressBar,
    ) -> Result<Self, Failure> {
        let log = log::read_arrays(arrays, &reading.log, &reading.covariates, progress)?;
        Self::of_log(arrays.path(), log)
    }

    /// The record of axes that were read in pieces.
    ///
    /// # Errors
    /// When an axis has too few samples, or the axes differ in rate.
    pub fn of_pieces(axes: &[(String, Pieces)], unit: Unit) -> Result<Self, Failure> {
        let Some((first, pieces)) = axes.first() else {
            return Err(Failure::option(
                "there is no axis",
                "give the pieces of one",
            ));
        };
        if let Some((axis, other)) = axes
            .iter()
            .find(|(_, other)| other.rate_hz() != pieces.rate_hz())
        {
            let (one, other) = (pieces.rate_hz(), other.rate_hz());
            return Err(Failure::option(
                format!("axis {axis} has the rate {other}, and axis {first} {one}"),
                "give axes of one sensor",
            ));
        }
        let curve = |(axis, pieces): &(String, Pieces)| AxisCurve::part(pieces.clone(), axis, unit);
        Ok(Self {
            path: PathBuf::from("pieces"),
            axes: record::of_curves(
                axes.iter()
                    .map(curve)
                    .collect::<Result<Vec<_>, Failure>>()?,
            ),
            notes: Vec::new(),
        })
    }

    /// The record of a log that was read.
    ///
    /// # Errors
    /// When the sums of an axis are too large for a curve.
    pub(super) fn of_log(path: &Path, log: Log) -> Result<Self, Failure> {
        Ok(Self {
            path: path.to_owned(),
            axes: record::with_evidence(&log)?,
            notes: log.notes,
        })
    }

    /// Where the record comes from.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The curves of all axes, and what the reader noted, as JSON.
    ///
    /// # Errors
    /// None occurs, because all numbers can be written.
    pub fn describe(&self) -> Result<String, Failure> {
        let axis = |(curve, evidence): &'_ (AxisCurve, Evidence)| {
            let about = (curve.axis.as_str(), curve.rate_hz, curve.unit);
            let disturbance = evidence.disturbance.as_ref();
            let reason = evidence.invalid.as_ref();
            reason.map(|reason| invalid(reason, disturbance, about))
        };
        let axes = self.axes.iter().map(|one| Axis {
            curve: &one.0,
            invalid: axis(one),
            covariates: one.1.covariates.iter().map(|(name, _)| &**name).collect(),
        });
        json(&Description {
            path: self.path.to_string_lossy().into_owned(),
            axes: axes.collect(),
            notes: &self.notes,
        })
    }

    /// The curves as a curve file, as `measure` writes it.
    ///
    /// # Errors
    /// None occurs, because all numbers can be written.
    pub fn curve_file(&self) -> Result<String, Failure> {
        let axes = self.axes.iter().map(|(curve, _)| curve.clone()).collect();
        CurveFile::new(axes)
            .to_json()
            .map_err(|error| unwritten(&error))
    }

    /// Fits all axes.
    ///
    /// # Errors
    /// When the filter is none, or an axis cannot be fitted.
    pub fn fit(&self, fitting: &Fitting) -> Result<Fits, Failure> {
        let settings = Settings {
            model: &known_filter::model(fitting.filter.as_deref())?,
            method: fitting.method,
            limits: &fitting.limits,
        };
        fit::fitted::fitted(&self.path, self.axes.clone(), &settings).map(Fits)
    }

    /// Diagnoses all axes. `goes_on` is asked before each of them.
    ///
    /// # Errors
    /// When the filter is none, an axis cannot be fitted, or the work is not to go on.
    pub fn diagnose(
        &self,
        search: &Search,
        goes_on: &mut dyn FnMut(usize) -> bool,
    ) -> Result<Diagnosis, Failure> {
        Diagnosis::of(&self.path, self.axes.clone(), search, goes_on)
    }

    /// Fits a model to an axis, and compares it with the record.
    ///
    /// # Errors
    /// When there is no such axis, or the model cannot be built or fitted.
    pub fn compare(
        &self,
        axis: &str,
        model: &ModelChoice,
        own: &[&'static Own],
    ) -> Result<Comparison, Failure> {
        let (curve, _) = self.axis(axis)?;
        let fail = |error| record::library_failure(&self.path, axis, error);
        let observed = (
            curve.curve().map_err(fail)?,
            curve.spectrum().map_err(fail)?,
        );
        Comparison::of(&self.path, curve, observed, (model, own))
    }

    fn axis(&self, name: &str) -> Result<&(AxisCurve, Evidence), Failure> {
        let mut axes = self.axes.iter();
        axes.find(|(curve, _)| curve.axis == name).ok_or_else(|| {
            let names = self.axes.iter().map(|(curve, _)| curve.axis.as_str());
            no_axis(&self.path, name, names)
        })
    }

    /// The record as bytes, from which it can be read again.
    ///
    /// # Errors
    /// None occurs, because everything can be written.
    pub fn to_bytes(&self) -> Result<Vec<u8>, Failure> {
        stored::write(&self.path, &self.axes, &self.notes)
    }

    /// The record whose [bytes](Self::to_bytes) these are.
    ///
    /// # Errors
    /// When they are not those of a record.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Failure> {
        let (path, axes, notes) = stored::read(bytes)?;
        Ok(Self { path, axes, notes })
    }
}
