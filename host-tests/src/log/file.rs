//! A log, read by the reader that its extension names.

#[cfg(feature = "bags")]
use super::bag;
use super::{
    Axis, CovariateChoice, Log, Options, csv, npy, reading::read_table, source::Format, ulog,
};
use crate::failure::{Failure, Place};
use indicatif::ProgressBar;
use std::path::Path;

/// Reads a log; `progress` follows the bytes of its file.
///
/// # Errors
/// Of every kind of bad input, the file, the row and the remedy.
pub fn read(path: &Path, options: &Options, progress: &ProgressBar) -> Result<Log, Failure> {
    read_parts(path, options, None, None, progress).map(|(log, _)| log)
}

/// Reads a log, and beside the curves kurtosis, integrity and what the axes share with covariates.
///
/// # Errors
/// As of [`read`], and where a covariate is no column or an axis.
pub fn read_with_evidence(
    path: &Path,
    options: &Options,
    covariates: &[CovariateChoice],
    progress: &ProgressBar,
) -> Result<Log, Failure> {
    let (log, _) = read_parts(path, options, None, Some(covariates), progress)?;
    Ok(log)
}

/// Reads a log whose last `share` is kept apart: as two logs. It is read twice, first for its
/// length.
///
/// # Errors
/// As of [`read`], for both parts.
pub fn read_in_two(
    path: &Path,
    options: &Options,
    share: f64,
    progress: &ProgressBar,
) -> Result<(Log, Log), Failure> {
    let whole = read(path, options, progress)?;
    let samples = whole.axes.iter().map(|axis| axis.accumulator.samples());
    let first = samples.max().unwrap_or(0) as f64 * (1.0 - share);
    let (log, rest) = read_parts(path, options, Some(first.round() as u64), None, progress)?;
    let rest = Log {
        axes: rest,
        ..log.clone()
    };
    Ok((log, rest))
}

/// The first rows of a log, and the axes of the rest; all rows, and no axes.
fn read_parts(
    path: &Path,
    options: &Options,
    first: Option<u64>,
    watch: Option<&[CovariateChoice]>,
    progress: &ProgressBar,
) -> Result<(Log, Vec<Axis>), Failure> {
    let parts = (first, watch);
    let format = Format::of(path)?;
    if !format.has_topics() && options.topic.is_some() {
        return Err(Place::file(path).failure("has no topics", "leave --topic"));
    }
    match format {
        Format::Csv { .. } => read_table(&csv::Csv::open(path)?, path, options, parts, progress),
        Format::Npy => read_table(&npy::Npy::open(path)?, path, options, parts, progress),
        #[cfg(not(feature = "bags"))]
        Format::Mcap => Err(Failure::not_built_in("reading .mcap files")),
        #[cfg(feature = "bags")]
        Format::Mcap => {
            let bag = bag::Bag::open(path, options, progress)?;
            read_table(&bag, path, options, parts, progress)
        }
        Format::Ulog => {
            let log = ulog::Ulog::open(path, options, progress)?;
            read_table(&log, path, options, parts, progress)
        }
    }
}
