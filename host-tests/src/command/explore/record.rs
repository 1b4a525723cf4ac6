//! The records that are explored: the axes of all inputs.

use super::arguments::Arguments;
use crate::{
    command::{
        compare::compared::Compared,
        input::many::shown,
        input::record::{self, is_curve, library_failure},
        output::words,
    },
    curve_file::AxisCurve,
    failure::Failure,
    log::{BINS, Evidence, OCTAVES},
};
use allanite::{Comparison, Curve, Model, effect::Span, spectrum::Spectrum};
use serde_json::Value;
use std::{
    path::{Path, PathBuf},
    sync::OnceLock,
};

/// An axis of an input.
pub(super) struct LoadedRecord {
    pub(super) path: PathBuf,
    pub(super) axis: AxisCurve,
    pub(super) curve: Curve<OCTAVES>,
    pub(super) spectrum: Spectrum<BINS>,
    /// What the input tells beside the curve.
    pub(super) evidence: Evidence,
    /// The record beside the five terms. The frames of all figures have room for it, so that they rest while the model
    /// changes.
    pub(super) five: Comparison<OCTAVES, BINS>,
    /// What the diagnosis thinks of the record, once it was asked.
    pub(super) diagnosed: OnceLock<Result<Value, String>>,
}

impl LoadedRecord {
    /// Reads the axes of all inputs.
    ///
    /// # Errors
    /// When an input cannot be read, or an axis cannot be fitted.
    pub(super) fn read(arguments: &Arguments) -> Result<Vec<Self>, Failure> {
        let mut records = Vec::new();
        for path in &arguments.inputs {
            let covariates = &arguments.covariates;
            let axes = record::read_with_evidence(path, &arguments.about_log, covariates)?;
            for (axis, evidence) in axes {
                let name = axis.axis.clone();
                let record = Self::new(path, axis, evidence);
                records.push(record.map_err(|error| library_failure(path, &name, error))?);
            }
        }
        Ok(records)
    }

    fn new(path: &Path, axis: AxisCurve, evidence: Evidence) -> Result<Self, allanite::Error> {
        let five = Compared::new(axis.clone(), &Model::ieee_952(), None)?;
        Ok(Self {
            path: path.to_owned(),
            curve: axis.curve()?,
            spectrum: five.spectrum,
            five: five.comparison,
            axis,
            evidence,
            diagnosed: OnceLock::new(),
        })
    }

    /// The name of the record beside those of other inputs.
    pub(super) fn name(&self) -> String {
        let file = self.path.file_name().unwrap_or(self.path.as_os_str());
        format!("{} of {}", self.axis.axis, shown(Path::new(file)))
    }

    /// The size of the record in words.
    pub(super) fn size(&self) -> String {
        let axis = &self.axis;
        words::record(axis.samples, axis.rate_hz, axis.octaves.len())
    }

    /// Whether the input is a curve file, which has neither covariates nor a course.
    pub(super) fn is_curve(&self) -> bool {
        is_curve(&self.path)
    }

    /// The times that the record covers.
    pub(super) fn span(&self) -> Span {
        Span {
            interval_s: self.curve.interval_s(),
            longest_tau_s: self.curve.points().last().map_or(0.0, |point| point.tau_s),
        }
    }
}
