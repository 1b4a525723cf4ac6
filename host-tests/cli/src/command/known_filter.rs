//! The filter that is known to be in a sensor's signal path, as an option of the command line.

use allanite::Model;
use allanite_host::known_filter;
use allanite_log::failure::Failure;
use clap::Args;

/// The option for a filter that is known.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct KnownFilter {
    /// A filter on the white noise that is known from the sensor's data sheet or its settings, such as
    /// `low_pass:cutoff_hz=42,poles=2` or `decimation_filter:width_s=0.014,stages=2`, a CIC. It replaces angle random walk
    /// in the model from the start, and its shape is not fitted
    #[arg(long, value_name = "FILTER:parameter=value,…")]
    pub(crate) filter: Option<String>,
}

impl KnownFilter {
    /// Whether no filter is known.
    pub(crate) const fn is_none(&self) -> bool {
        self.filter.is_none()
    }

    /// The five terms, behind the filter if there is one.
    ///
    /// # Errors
    /// When the effect is unknown or no filter, or lacks a parameter.
    pub(crate) fn model(&self) -> Result<Model, Failure> {
        known_filter::model(self.filter.as_deref())
    }
}
