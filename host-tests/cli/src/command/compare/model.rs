//! The model of `compare`, as options of the command line.

use crate::command::known_filter::KnownFilter;
use allanite::Model;
use allanite_host::compare::model::ModelChoice;
use allanite_log::failure::Failure;
use clap::Args;

/// Effects to add and terms to leave out.
#[derive(Debug, Args)]
pub(in crate::command) struct ModelArguments {
    /// Add an effect; its coefficient is fitted. `sinusoid:frequency_hz=0.3` and
    /// `decimation_filter:width_s=0.014,stages=2` have a known shape. The shape of `sinusoid` is fitted, wherever it
    /// is in its range, and that of `sinusoid:frequency_hz~0.3` from 0.3 Hz on. If the effect replaces a term, that
    /// term is removed. An effect of your own is a formula, of the power spectral density over the frequency f in Hz, or of
    /// the autocovariance over the lag t in seconds: `density: 1/(1 + (f/corner_hz)^2); corner_hz=0.1..30`
    #[arg(long, value_name = "EFFECT")]
    with: Vec<String>,
    /// Leave out a term, such as `rate_ramp`
    #[arg(long, value_name = "EFFECT")]
    without: Vec<String>,
    #[command(flatten)]
    filter: KnownFilter,
}

impl ModelArguments {
    /// Whether the options change the five terms by more than a known filter.
    pub(in crate::command) fn changes(&self) -> bool {
        !self.with.is_empty() || !self.without.is_empty()
    }

    /// Builds the model.
    ///
    /// # Errors
    /// As of [`ModelChoice::model`].
    pub(in crate::command) fn model(&self) -> Result<Model, Failure> {
        let choice = ModelChoice {
            with: self.with.clone(),
            without: self.without.clone(),
            filter: self.filter.filter.clone(),
        };
        choice.model()
    }
}
