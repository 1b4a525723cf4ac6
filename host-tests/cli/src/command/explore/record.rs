//! The records that are explored: the axes of all inputs.

use super::{
    arguments::Arguments,
    taken_out::TakenOut,
    thought::{Thought, think},
};
use crate::command::input::{
    many::shown,
    record::{self, is_curve, library_failure},
};
use allanite::{Curve, Model, effect::Span, spectrum::Spectrum};
use allanite_host::{
    curve_file::AxisCurve,
    diagnose::{diagnosed::Diagnosed, pictures, scope::Scope},
    words,
};
use allanite_log::{
    BINS, Evidence, OCTAVES, Spectrogram,
    failure::{Failure, one_line},
};
use allanite_plot::CourseFigure;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// An axis of an input, as a session keeps it.
#[derive(Serialize, Deserialize)]
pub(super) struct SessionRecord {
    /// The input.
    input: String,
    pub(super) axis: AxisCurve,
    /// The curve and the spectrum without what follows the covariates; `None` if the rate follows none.
    pub(super) taken_out: Option<TakenOut>,
}

/// What the page shows of a record without a question.
#[derive(Serialize)]
pub(super) struct ListedRecord {
    name: String,
    input: String,
    axis: String,
    size: String,
    unit: String,
    /// What can be taken out, in words.
    covariate: Option<String>,
    thought: Thought,
    course: Option<CourseFigure>,
    spectrogram: Option<Spectrogram>,
}

/// Reads and diagnoses the axes of all inputs.
///
/// # Errors
/// When an input cannot be read, or an axis cannot be fitted.
pub(super) fn read(arguments: &Arguments) -> Result<Vec<(SessionRecord, ListedRecord)>, Failure> {
    let mut all = Vec::new();
    for path in &arguments.inputs {
        let axes = record::read_for_page(path, &arguments.about_log, &arguments.covariates)?;
        all.extend(axes.into_iter().map(|axis| (path, axis)));
    }
    let diagnose = |(path, (axis, mut evidence)): (&PathBuf, (AxisCurve, Evidence))| {
        let spectrogram = evidence.spectrogram.take();
        let name = axis.axis.clone();
        let diagnosed = Diagnosed::new(axis, evidence, &Model::ieee_952(), &Scope::default());
        diagnosed
            .and_then(|diagnosed| explored(path, &diagnosed, spectrogram))
            .map_err(|error| library_failure(path, &name, error))
    };
    all.into_par_iter().map(diagnose).collect()
}

/// An axis that was diagnosed, as a session keeps it and as the page shows it.
pub(super) fn explored(
    path: &Path,
    diagnosed: &Diagnosed,
    spectrogram: Option<Spectrogram>,
) -> Result<(SessionRecord, ListedRecord), allanite::Error> {
    let taken_out = TakenOut::of(diagnosed)?;
    let (thought, course) = (think(diagnosed), pictures::course(diagnosed));
    let record = SessionRecord {
        input: path.to_string_lossy().into_owned(),
        axis: diagnosed.axis.clone(),
        taken_out,
    };
    let listed = ListedRecord {
        name: record.name(),
        input: one_line(&record.input),
        axis: record.axis.axis.clone(),
        size: record.size(),
        unit: record.axis.unit.to_string(),
        covariate: record.taken_out.as_ref().map(|taken| taken.words.clone()),
        thought,
        course,
        spectrogram,
    };
    Ok((record, listed))
}

impl SessionRecord {
    /// The input that the record is from.
    pub(super) fn path(&self) -> &Path {
        Path::new(&self.input)
    }

    /// Whether every number of the record is possible.
    pub(super) fn check(&self) -> Result<(), String> {
        self.axis.check()?;
        let taken_out = self.taken_out.as_ref();
        let observed = taken_out.map(|taken| taken.observed(self.axis.rate_hz));
        observed.transpose().map_err(|error| error.to_string())?;
        Ok(())
    }

    /// The curve and the spectrum, with or without what follows the covariates.
    pub(super) fn observed(
        &self,
        taken_out: bool,
    ) -> Result<(Curve<OCTAVES>, Spectrum<BINS>), allanite::Error> {
        match self.taken_out.as_ref().filter(|_| taken_out) {
            Some(taken) => taken.observed(self.axis.rate_hz),
            None => Ok((self.axis.curve()?, self.axis.spectrum()?)),
        }
    }

    /// The name of the record beside those of other inputs.
    pub(super) fn name(&self) -> String {
        let file = self.path().file_name().unwrap_or(self.input.as_ref());
        format!("{} of {}", self.axis.axis, shown(Path::new(file)))
    }

    /// The size of the record in words.
    pub(super) fn size(&self) -> String {
        let axis = &self.axis;
        words::record(axis.samples, axis.rate_hz, axis.octaves.len())
    }

    /// Whether the input is a curve file, which has neither covariates nor a course.
    pub(super) fn is_curve(&self) -> bool {
        is_curve(self.path())
    }

    /// The times that the record covers.
    pub(super) fn span(&self) -> Span {
        Span {
            interval_s: 1.0 / self.axis.rate_hz,
            longest_tau_s: self.axis.octaves.last().map_or(0.0, |octave| octave.tau_s),
        }
    }
}
