//! Reads a log with the reader of its format.

#[cfg(not(target_family = "wasm"))]
use super::cached::Cached;
#[cfg(any(feature = "bags", feature = "tables"))]
use super::converted::Converted;
use super::{
    Axis, Covariates, Log, Options, csv, npy, part, parts,
    reading::{Watched, read_table},
    source::Format,
    ulog,
};
#[cfg(feature = "bags")]
use super::{bag, bag_folder};
#[cfg(feature = "tables")]
use super::{table::Table as _, tables, typed::Typed};
use crate::{
    failure::{Failure, Place},
    regular_file::Hold,
};
use indicatif::ProgressBar;
use std::path::Path;

/// Reads a log. `progress` follows the bytes that are read from the file.
///
/// # Errors
/// Any bad input is reported with the file, the row and the remedy.
pub fn read(path: &Path, options: &Options, progress: &ProgressBar) -> Result<Log, Failure> {
    read_parts(path, options, None, None, progress).map(|(log, _)| log)
}

/// Reads a log together with the evidence beside each curve: the kurtosis, the integrity, and the
/// covariance with covariates.
///
/// # Errors
/// The errors are those of [`read`]. A covariate that is not a column, or that is an axis, is an
/// error too.
pub fn read_with_evidence(
    path: &Path,
    options: &Options,
    covariates: &Covariates,
    progress: &ProgressBar,
) -> Result<Log, Failure> {
    let watch = Watched {
        covariates,
        moments: true,
        spectrogram: false,
        first_sample: None,
    };
    read_parts(path, options, None, Some(watch), progress).map(|(log, _)| log)
}

/// As [`read_with_evidence`], together with the spectrogram, which only a page shows.
///
/// # Errors
/// The errors are those of [`read_with_evidence`].
pub fn read_for_page(
    path: &Path,
    options: &Options,
    covariates: &Covariates,
    progress: &ProgressBar,
) -> Result<Log, Failure> {
    let watch = Watched {
        covariates,
        moments: true,
        spectrogram: true,
        first_sample: None,
    };
    read_parts(path, options, None, Some(watch), progress).map(|(log, _)| log)
}

/// As [`read_with_evidence`] without the kurtosis, of a log that is a part of a longer record and begins with its sample
/// `first_sample`, together with what rejoins it with the parts beside it.
///
/// # Errors
/// The errors are those of [`read_with_evidence`]. A log whose samples have no known numbers in the record is refused, and so is
/// one whose values are no whole numbers.
pub fn read_part(
    path: &Path,
    options: &Options,
    first_sample: u64,
    progress: &ProgressBar,
) -> Result<Log, Failure> {
    if !options.cuts.is_empty() {
        return Err(part::refused(path, "--from, --to and --drop cut it"));
    }
    let watch = Watched {
        covariates: &Covariates::Chosen(Vec::new()),
        moments: false,
        spectrogram: false,
        first_sample: Some(first_sample),
    };
    read_parts(path, options, None, Some(watch), progress).map(|(log, _)| log)
}

/// Reads a log as two: the last `share` of its rows is kept apart as the second. The file is read
/// twice, the first time for its length.
///
/// # Errors
/// The errors are those of [`read`], for both parts.
pub fn read_in_two(
    path: &Path,
    options: &Options,
    share: f64,
    progress: &ProgressBar,
) -> Result<(Log, Log), Failure> {
    // Both times the file is read to the same length.
    let _hold = Hold::new(path);
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

/// Reads the first rows of a log, and the axes of the remaining rows. Without a number of first
/// rows, all rows are read and there are no remaining axes. A log that grows meanwhile is read to the length that it had
/// at first, or to the end of its last complete line there; one that becomes shorter is refused.
fn read_parts(
    path: &Path,
    options: &Options,
    first: Option<u64>,
    watch: Option<Watched>,
    progress: &ProgressBar,
) -> Result<(Log, Vec<Axis>), Failure> {
    let format = Format::of(path)?;
    if !format.has_topics() && options.topic.is_some() {
        return Err(Place::file(path).failure("this kind of log has no topics", "omit --topic"));
    }
    let hold = Hold::new(path);
    let read = || read_format(path, format, options, (first, watch), progress);
    let mut read_so_far = read();
    let (held, now) = hold.lengths();
    if path.is_file() && now < held {
        return Err(Place::file(path).failure(
            "it became shorter while it was read",
            "end what writes to it, and read it again",
        ));
    }
    let grew = path.is_file() && now > held;
    let is_text = format == Format::Text { gzip: false };
    if grew && is_text && hold.cut_to_line()? {
        read_so_far = read();
    }
    let (mut log, rest) = read_so_far?;
    if grew {
        let (held, _) = hold.lengths();
        log.notes.push(format!(
            "it grew while it was read: the first {held} bytes are the record"
        ));
    }
    Ok((log, rest))
}

/// The failure of `--rows` for a log whose rows are not chosen.
fn rows_of_text(path: &Path) -> Failure {
    Place::file(path).failure(
        "--rows chooses among the rows of text and of tables",
        "omit it, or export the log as text",
    )
}

/// Reads a log of a known format.
fn read_format(
    path: &Path,
    format: Format,
    options: &Options,
    wanted: (Option<u64>, Option<Watched>),
    progress: &ProgressBar,
) -> Result<(Log, Vec<Axis>), Failure> {
    match format {
        Format::Text { gzip } => {
            let text = csv::Csv::open(path, gzip, options)?;
            // In a page, a temporary file would be memory.
            #[cfg(not(target_family = "wasm"))]
            let text = Cached::new(text, path.metadata().map_or(0, |file| file.len()));
            read_table(&text, path, options, wanted, progress)
        }
        Format::Parts => {
            let (joined, note) = parts::join(path, progress)?;
            let text = csv::Csv::open_as(path, &joined, false, options)?;
            let (mut log, rest) = read_table(&text, path, options, wanted, progress)?;
            log.notes.insert(0, note);
            Ok((log, rest))
        }
        #[cfg(not(feature = "tables"))]
        Format::Table(_) => Err(Failure::not_built_in("reading tables in binary").about(path)),
        #[cfg(feature = "tables")]
        Format::Table(kind) => {
            // The rows of one sensor are chosen among those of the text.
            let in_parts = options.rows.is_none();
            let convert = |in_parts| tables::convert(path, kind, options, in_parts, progress);
            let table = convert(in_parts)?;
            let Some(numbers) = &table.numbers else {
                return read_converted(&table, path, options, wanted, progress);
            };
            let text = csv::Csv::open_as(path, &table.text, false, options)?;
            if text.is_edited() || text.columns().looks.len() != numbers.layout.columns.len() {
                return read_converted(&convert(false)?, path, options, wanted, progress);
            }
            let whole = || {
                let table = convert(false)?;
                let text = csv::Csv::open_as(path, &table.text, false, options)?;
                Ok((text, table.text))
            };
            let typed = Typed::new(path, text, numbers, &whole);
            let (mut log, rest) = read_table(&typed, path, options, wanted, progress)?;
            log.notes.extend(table.note);
            Ok((log, rest))
        }
        Format::Npy | Format::Ulog if options.rows.is_some() => Err(rows_of_text(path)),
        Format::Npy => read_table(&npy::Npy::open(path)?, path, options, wanted, progress),
        Format::Ulog => {
            let log = ulog::Ulog::open(path, options, progress)?;
            read_table(&log, path, options, wanted, progress)
        }
        #[cfg(not(feature = "bags"))]
        Format::Mcap | Format::Ros1 | Format::Sqlite | Format::Folder => {
            Err(Failure::not_built_in("reading bags").about(path))
        }
        #[cfg(feature = "bags")]
        Format::Mcap | Format::Ros1 | Format::Sqlite | Format::Folder => {
            let files = bag_folder::files(path, format)?;
            let _holds: Vec<Hold> = files.1.iter().map(|file| Hold::new(file)).collect();
            let others = bag::other_messages(path, (files.0, &files.1), options, progress)?;
            if let Some(table) = others {
                return read_converted(&table, path, options, wanted, progress);
            }
            if options.rows.is_some() {
                return Err(rows_of_text(path));
            }
            let bag = bag::Bag::open(path, files, options, progress)?;
            read_table(&bag, path, options, wanted, progress)
        }
    }
}

/// Reads the text that was made of a log in another format.
#[cfg(any(feature = "bags", feature = "tables"))]
fn read_converted(
    table: &Converted,
    path: &Path,
    options: &Options,
    wanted: (Option<u64>, Option<Watched>),
    progress: &ProgressBar,
) -> Result<(Log, Vec<Axis>), Failure> {
    // What was left out may be what is missing.
    let explained = |failure: Failure| match table.left_out() {
        Some(left_out) => failure.and(left_out),
        None => failure,
    };
    let text = csv::Csv::open_as(path, &table.text, false, options);
    let text = text.map_err(explained)?;
    let read = read_table(&text, path, options, wanted, progress);
    let (mut log, rest) = read.map_err(explained)?;
    log.notes.extend(table.note.clone());
    Ok((log, rest))
}
