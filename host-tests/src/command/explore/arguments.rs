//! The options of `explore`.

use crate::command::{
    examples,
    input::record::{CovariateArguments, LogArguments},
};
use clap::Args;
use std::path::PathBuf;

/// Try effects by hand on a page: sliders move their shapes, and curve, χ² and coefficients follow
///
/// The page is served at a random port of the loopback address, with a random token in its address, and shows no file
/// but those that are named. Ctrl-C ends it.
#[derive(Debug, Args)]
#[command(after_help = examples::EXPLORE)]
pub(in crate::command) struct Arguments {
    /// Logs (.csv, .csv.gz, .npy, .mcap, .ulg), or curve files (.json) that `measure` wrote
    #[arg(required = true, value_name = "INPUT")]
    pub(super) inputs: Vec<PathBuf>,
    /// Open the page in the browser
    #[arg(long)]
    pub(super) open: bool,
    #[command(flatten)]
    pub(super) covariates: CovariateArguments,
    #[command(flatten)]
    pub(super) about_log: LogArguments,
}
