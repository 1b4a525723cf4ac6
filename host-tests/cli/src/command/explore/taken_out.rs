//! A record without what follows its covariates, such as the temperature.

use allanite::{Curve, spectrum::Spectrum};
use allanite_host::{curve_file::SpectrumLevels, diagnose::diagnosed::Diagnosed};
use allanite_log::{BINS, OCTAVES};
use serde::{Deserialize, Serialize};

/// The curve and the spectrum without what follows the covariates, and what explains them.
#[derive(Serialize, Deserialize)]
pub(super) struct TakenOut {
    /// The covariates in words.
    pub(super) words: String,
    /// How much of χ² it explains: the sum of the squares of the slopes in standard errors.
    pub(super) chi2: f64,
    /// Averaging factor, number of differences and variance of every octave.
    octaves: Vec<(u32, u64, f64)>,
    spectrum: SpectrumLevels,
}

impl TakenOut {
    /// What a diagnosis subtracted in its last step; `None` if that is nothing.
    ///
    /// # Errors
    /// When the library refuses the curve of the record.
    pub(super) fn of(diagnosed: &Diagnosed) -> Result<Option<Self>, allanite::Error> {
        let Some(last) = diagnosed.steps.last() else {
            return Ok(None);
        };
        let Some((words, chi2)) = diagnosed.dependence() else {
            return Ok(None);
        };
        let (curve, spectrum) = diagnosed.observed_in(last)?;
        let octaves = curve.points().iter();
        Ok(Some(Self {
            words,
            chi2,
            octaves: octaves
                .map(|point| (point.m, point.differences, point.variance))
                .collect(),
            spectrum: SpectrumLevels::of(&spectrum),
        }))
    }

    /// The curve and the spectrum as the library's types.
    ///
    /// # Errors
    /// When the library refuses a number.
    pub(super) fn observed(
        &self,
        rate_hz: f64,
    ) -> Result<(Curve<OCTAVES>, Spectrum<BINS>), allanite::Error> {
        let curve = Curve::new(rate_hz, self.octaves.iter().copied())?;
        Ok((curve, self.spectrum.spectrum(rate_hz)?))
    }
}
