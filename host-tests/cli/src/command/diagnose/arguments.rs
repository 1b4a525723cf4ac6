//! The options of a diagnosis, which `diagnose`, `report` and `plot` share.

use crate::command::{
    input::record::{self, CovariateArguments, LogArguments},
    known_filter::KnownFilter,
};
use allanite_host::{
    curve_file::AxisCurve,
    diagnose::{diagnosed::Diagnosed, scope::Scope},
    record::library_failure,
};
use allanite_log::{Evidence, Spectrogram, failure::Failure};
use clap::Args;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::path::{Path, PathBuf};

/// The input of a diagnosis and its settings.
#[derive(Debug, Args)]
pub(crate) struct DiagnosisArguments {
    /// A log (text, .npy, .ulg, or a bag of ROS), or a curve file (.json) that `measure` wrote
    pub(crate) input: PathBuf,
    #[command(flatten)]
    settings: DiagnosisSettings,
}

impl DiagnosisArguments {
    /// Diagnoses every axis of the input.
    ///
    /// # Errors
    /// When the input cannot be read, or an axis cannot be fitted.
    pub(crate) fn diagnosed(&self) -> Result<Vec<Diagnosed>, Failure> {
        self.settings.diagnosed(&self.input)
    }

    /// Diagnoses every axis of the input, and keeps the spectrogram of each beside it, for a page that shows it.
    ///
    /// # Errors
    /// When the input cannot be read, or an axis cannot be fitted.
    pub(crate) fn diagnosed_for_page(&self) -> Result<Vec<OfPage>, Failure> {
        let DiagnosisSettings {
            about_log,
            covariates,
            ..
        } = &self.settings;
        let axes = record::read_for_page(&self.input, about_log, covariates)?;
        self.settings.diagnosed_of(&self.input, axes)
    }

    /// Whether the search begins with the five terms and ends where it ends by itself.
    pub(crate) fn is_plain(&self) -> bool {
        self.settings.max_effects.is_none()
            && self.settings.filter.is_none()
            && self.settings.own.is_empty()
    }
}

/// The settings of a diagnosis.
#[derive(Debug, Args)]
pub(crate) struct DiagnosisSettings {
    /// Largest number of effects to add [default: 4]
    #[arg(long, value_name = "N")]
    max_effects: Option<usize>,
    /// Look for an effect of your own too, beside those of the catalogue: its power spectral density over the frequency f in
    /// Hz, as in `density: 1/(1 + (f/corner_hz)^2); corner_hz=0.1..30`, or its autocovariance over the lag t in seconds
    #[arg(long = "try", value_name = "FORMULA")]
    own: Vec<String>,
    #[command(flatten)]
    covariates: CovariateArguments,
    #[command(flatten)]
    filter: KnownFilter,
    #[command(flatten)]
    about_log: LogArguments,
}

impl DiagnosisSettings {
    /// Diagnoses every axis of a record.
    pub(crate) fn diagnosed(&self, path: &Path) -> Result<Vec<Diagnosed>, Failure> {
        let axes = record::read_with_evidence(path, &self.about_log, &self.covariates)?;
        let diagnosed = self.diagnosed_of(path, axes)?.into_iter();
        Ok(diagnosed.map(|(diagnosed, _)| diagnosed).collect())
    }

    fn diagnosed_of(
        &self,
        path: &Path,
        axes: Vec<(AxisCurve, Evidence)>,
    ) -> Result<Vec<OfPage>, Failure> {
        let model = self.filter.model()?;
        let scope = Scope::new(self.max_effects, &self.own)?;
        let diagnose = |(axis, mut evidence): (AxisCurve, Evidence)| {
            let name = axis.axis.clone();
            let spectrogram = evidence.spectrogram.take();
            Diagnosed::new(axis, evidence, &model, &scope)
                .map(|diagnosed| (diagnosed, spectrogram))
                .map_err(|error| library_failure(path, &name, error))
        };
        // A page has no threads. The first failure is that of the first axis that has one.
        let diagnosed: Vec<_> = match cfg!(target_family = "wasm") {
            true => axes.into_iter().map(diagnose).collect(),
            false => axes.into_par_iter().map(diagnose).collect(),
        };
        diagnosed.into_iter().collect()
    }
}

/// An axis, and its spectrogram, if it is a log that is long enough.
pub(crate) type OfPage = (Diagnosed, Option<Spectrogram>);
