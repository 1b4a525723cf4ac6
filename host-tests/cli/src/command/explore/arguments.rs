//! The options of `explore`.

use crate::command::{
    examples,
    input::record::{CovariateArguments, LogArguments},
};
use clap::Args;
use std::path::PathBuf;

/// Try effects by hand on a page: sliders move their shapes, and curve, χ² and coefficients follow
///
/// The page is one HTML file. It carries the program and the records that are named, needs no server and no network, and may
/// be sent to others.
#[derive(Debug, Args)]
#[command(after_help = examples::EXPLORE)]
pub(in crate::command) struct Arguments {
    /// Logs (text, .npy, .ulg, or a bag of ROS), or curve files (.json) that `measure` wrote
    #[arg(required = true, value_name = "INPUT")]
    pub(super) inputs: Vec<PathBuf>,
    /// The page to write: .html [default: one among the temporary files, which is opened in the browser]
    #[arg(long, short, value_name = "PAGE.html")]
    pub(super) output: Option<PathBuf>,
    /// Open the page in the browser
    #[arg(long)]
    pub(super) open: bool,
    /// The empty page, as `cargo xtask page` builds it [default: the one beside the program]
    #[arg(long, value_name = "FILE.html")]
    pub(super) page: Option<PathBuf>,
    /// Print the records as a page needs them
    #[arg(long, hide = true)]
    pub(super) session: bool,
    #[command(flatten)]
    pub(super) covariates: CovariateArguments,
    #[command(flatten)]
    pub(super) about_log: LogArguments,
}
