//! Tables of other programs in binary. Each is rewritten as the text that logs are read from, in a temporary file, so that
//! names, units, stamps and values are judged in one place.

mod ardupilot;
mod arrays;
mod arrow;
mod betaflight;
mod hdf5;
mod matlab;
mod workbook;

use super::{
    Options,
    converted::{Converted, MOST_TEXT, MOST_TIMES, Text},
    source::TableKind as Kind,
};
use crate::failure::{Failure, Place, one_line, quoted};
use indicatif::ProgressBar;
use std::{
    fmt, io,
    panic::{self, AssertUnwindSafe},
    path::Path,
};

/// The remedy of a damaged file.
const COPY: &str = "copy or record the file again";

/// The reason why a table cannot be rewritten.
enum Wrong {
    /// The file cannot be read, or the temporary file cannot be written.
    Io(io::Error),
    /// What the crate of the format says about the file.
    Damaged(String),
    /// What is wrong, and the remedy.
    Unfit(String, String),
}

impl From<io::Error> for Wrong {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl Wrong {
    fn damaged(error: impl fmt::Display) -> Self {
        Self::Damaged(error.to_string())
    }

    fn unfit(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Unfit(what.into(), remedy.into())
    }
}

/// Rewrites a table as text.
///
/// # Errors
/// When the file is damaged, holds no table of numbers, or holds several without a choice.
pub(in crate::log) fn convert(
    path: &Path,
    kind: Kind,
    options: &Options,
    progress: &ProgressBar,
) -> Result<Converted, Failure> {
    let here = || Place::file(path);
    let size = path.metadata().map_or(0, |file| file.len());
    progress.set_length(size);
    let mut text = Text::new(path, size)?;
    let topic = options.topic.as_deref();
    let convert = || match kind {
        Kind::Ardupilot => ardupilot::convert(path, topic, &mut text),
        Kind::Arrow | Kind::Parquet => arrow::convert(path, kind, topic, &mut text),
        Kind::Betaflight => betaflight::convert(path, topic, &mut text),
        Kind::Hdf5 => hdf5::convert(path, topic, &mut text),
        Kind::Matlab => matlab::convert(path, topic, &mut text),
        Kind::Workbook => workbook::convert(path, topic, &mut text),
    };
    let converted = quietly(convert);
    let note = converted.map_err(|wrong| match wrong {
        Wrong::Io(error) => text.failure(&error),
        Wrong::Damaged(what) => here().failure(format!("damaged: {}", one_line(&what)), COPY),
        Wrong::Unfit(what, remedy) => here().failure(what, remedy),
    })?;
    text.finish(note)
}

/// Runs a reader of another project. Some of them panic at damaged files, which is reported like any other damage.
fn quietly<T>(read: impl FnOnce() -> Result<T, Wrong>) -> Result<T, Wrong> {
    let hook = panic::take_hook();
    panic::set_hook(Box::new(|_| {}));
    let read = panic::catch_unwind(AssertUnwindSafe(read));
    panic::set_hook(hook);
    read.unwrap_or_else(|_| Err(Wrong::damaged("its parts contradict each other")))
}

/// A table in a file that may hold several.
struct Candidate {
    name: String,
    rows: u64,
}

/// The place of the table that is asked for, or else of the one with the most rows, and a note that names the others.
fn choose(
    candidates: &[Candidate],
    topic: Option<&str>,
    what: &str,
) -> Result<(usize, Option<String>), Wrong> {
    let shown = |candidates: &[&Candidate]| {
        let shown = candidates.iter().take(20);
        let shown = shown.map(|one| format!("{} ({} rows)", one_line(&one.name), one.rows));
        shown.collect::<Vec<_>>().join(", ")
    };
    let all: Vec<&Candidate> = candidates.iter().collect();
    if let Some(wanted) = topic {
        let found = candidates.iter().position(|one| one.name == wanted);
        return found.map(|place| (place, None)).ok_or_else(|| {
            Wrong::unfit(
                format!("no {what} is named {}", quoted(wanted.as_bytes())),
                format!("choose with --topic from {}", shown(&all)),
            )
        });
    }
    let most = candidates.iter().map(|one| one.rows).max();
    let best: Vec<usize> = (0..candidates.len())
        .filter(|&place| Some(candidates[place].rows) == most)
        .collect();
    match best[..] {
        [] => Err(Wrong::unfit(
            format!("no {what} with numbers"),
            "export the log as CSV",
        )),
        [only] => {
            let others = all.iter().copied().filter(|one| one.name != all[only].name);
            let others = shown(&others.collect::<Vec<_>>());
            let note = format!(
                "{what} {}; others: {others} (choose with --topic)",
                one_line(&all[only].name)
            );
            Ok((only, (!others.is_empty()).then_some(note)))
        }
        _ => {
            let best: Vec<_> = best.iter().map(|&place| all[place]).collect();
            Err(Wrong::unfit(
                format!("{} {what}s fit equally well: {}", best.len(), shown(&best)),
                "choose one with --topic",
            ))
        }
    }
}
