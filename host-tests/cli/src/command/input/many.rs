//! Work on many files at once, on all cores, with results in the order of the arguments.

use crate::command::output::progress;
use allanite_log::failure::{Failure, one_line, report};
use clap::Args;
use rayon::iter::{ParallelBridge, ParallelIterator};
use schemars::JsonSchema;
use serde::Serialize;
use std::{
    collections::BTreeMap,
    io::{self, Write},
    path::{Path, PathBuf},
    sync::mpsc::sync_channel,
    thread,
};

/// Number of results that may wait to be put in order. Chosen by hand.
const ON_THE_WAY: usize = 64;

/// The input files, and the form of the output.
#[derive(Debug, Args)]
pub(crate) struct FilesArguments {
    /// Logs (text, .npy, .ulg, or a bag of ROS), or curve files (.json) that `measure` wrote
    #[arg(required = true, value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,
    /// Print the result as JSON
    #[arg(long, conflicts_with = "json_lines")]
    pub(crate) json: bool,
    /// Print each file's JSON object on a line of its own, as soon as it and all files before it are
    /// done
    #[arg(long)]
    pub(crate) json_lines: bool,
}

impl FilesArguments {
    /// The only file, or `None` if there are several.
    pub(crate) fn single(&self) -> Option<&Path> {
        match self.inputs.as_slice() {
            [only] => Some(only),
            _ => None,
        }
    }
}

/// The findings of a command in one file, axis by axis.
pub(crate) trait Findings: Sized + Send {
    /// The JSON document: a struct with named fields.
    type Document<'a>: Serialize + JsonSchema
    where
        Self: 'a;

    /// The findings as a JSON document.
    fn document(&self) -> Self::Document<'_>;

    /// Prints the findings as text.
    fn print(&self, output: &mut impl Write) -> io::Result<()>;

    /// Prints the findings of several files as text. By default each file follows the one before it,
    /// below its name.
    fn print_many(found: &[(&Path, Self)], output: &mut impl Write) -> io::Result<()> {
        for (i, (path, one)) in found.iter().enumerate() {
            if i > 0 {
                writeln!(output)?;
            }
            writeln!(output, "{}", shown(path))?;
            one.print(output)?;
        }
        Ok(())
    }
}

/// A file's name without line breaks.
pub(crate) fn shown(path: &Path) -> String {
    one_line(&path.to_string_lossy())
}

/// One file has its document; several have `files`, in the order of the arguments. Programs that read it skip properties that they
/// do not know.
#[derive(Serialize, JsonSchema)]
#[serde(untagged)]
#[schemars(inline)]
enum Printed<D> {
    One(D),
    Several { files: Vec<Outcome<D>> },
}

/// A file with its document, or with the message of its failure. It is a line of `--json-lines`.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "file")]
struct Outcome<D> {
    /// The file, as in the arguments.
    file: String,
    #[serde(flatten)]
    result: Found<D>,
}

#[derive(Serialize, JsonSchema)]
#[serde(untagged)]
#[schemars(inline)]
enum Found<D> {
    Axes(D),
    Failed {
        /// Why the file has no result.
        error: String,
    },
}

impl<D> Outcome<D> {
    fn found(path: &Path, document: D) -> Self {
        Self {
            file: path.to_string_lossy().into_owned(),
            result: Found::Axes(document),
        }
    }

    fn failed(path: &Path, failure: &Failure) -> Self {
        Self {
            file: path.to_string_lossy().into_owned(),
            result: Found::Failed {
                error: failure.to_string(),
            },
        }
    }
}

/// The schema of what a command with these findings prints.
#[cfg(not(target_family = "wasm"))]
pub(crate) fn schema<F: Findings + 'static>(title: &str) -> schemars::Schema {
    allanite_host::schema::of::<Printed<F::Document<'static>>>(title)
}

/// Does `work` on every file and prints the findings. A file that fails has its line on standard error
/// and does not stop the others.
///
/// # Errors
/// The last failure is returned; the other failures have been printed.
pub(crate) fn run<F: Findings>(
    files: &FilesArguments,
    work: impl Fn(&Path) -> Result<F, Failure> + Sync,
    output: &mut impl Write,
) -> Result<(), Failure> {
    let (mut found, mut failures) = (Vec::new(), Vec::new());
    each(&files.inputs, work, |path, result| {
        if files.json_lines {
            let line = match &result {
                Ok(one) => serde_json::to_string(&Outcome::found(path, one.document())),
                Err(failure) => {
                    serde_json::to_string(&Outcome::<F::Document<'_>>::failed(path, failure))
                }
            };
            let printed = line.map_err(io::Error::from);
            let printed = printed.and_then(|line| writeln!(output, "{line}"));
            let flushed = printed.and_then(|()| output.flush());
            flushed.map_err(|error| Failure::standard_output(&error))?;
            failures.extend(result.err().map(|failure| (path, failure)));
        } else {
            match result {
                Ok(one) => found.push((path, one)),
                Err(failure) => failures.push((path, failure)),
            }
        }
        Ok(())
    })?;
    if !files.json_lines {
        let printed = print(files, &found, &failures, output);
        let printed = printed.and_then(|()| output.flush());
        printed.map_err(|error| Failure::standard_output(&error))?;
    }
    failed(failures.into_iter().map(|(_, failure)| failure).collect())
}

/// Prints the findings: those of a single file alone, those of several files together.
fn print<F: Findings>(
    files: &FilesArguments,
    found: &[(&Path, F)],
    failures: &[(&Path, Failure)],
    output: &mut impl Write,
) -> io::Result<()> {
    if files.single().is_some() {
        let Some((_, only)) = found.first() else {
            return Ok(());
        };
        if !files.json {
            return only.print(output);
        }
        serde_json::to_writer(&mut *output, &Printed::One(only.document()))?;
        return writeln!(output);
    }
    if !files.json {
        return F::print_many(found, output);
    }
    // The order is that of the arguments. Each argument is in exactly one of the two lists.
    let (mut found, mut failures) = (found.iter().peekable(), failures.iter());
    let outcomes: Vec<Outcome<F::Document<'_>>> = files
        .inputs
        .iter()
        .filter_map(
            |input| match found.next_if(|(path, _)| std::ptr::eq(*path, input.as_path())) {
                Some((path, one)) => Some(Outcome::found(path, one.document())),
                None => failures
                    .next()
                    .map(|(path, failure)| Outcome::failed(path, failure)),
            },
        )
        .collect();
    serde_json::to_writer(&mut *output, &Printed::Several { files: outcomes })?;
    writeln!(output)
}

/// Does `work` on every file, on all cores, and hands the results over in the order of the files.
///
/// # Errors
/// Only those of `done`, which end the work early.
pub(crate) fn each<'a, T: Send>(
    files: &'a [PathBuf],
    work: impl Fn(&Path) -> Result<T, Failure> + Sync,
    mut done: impl FnMut(&'a Path, Result<T, Failure>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    if let [only] = files {
        return done(only, work(only));
    }
    progress::share_terminal();
    let bar = progress::files(files.len() as u64);
    let (results, incoming) = sync_channel(ON_THE_WAY);
    let work = &work;
    let outcome = thread::scope(|scope| {
        let started = thread::Builder::new().spawn_scoped(scope, move || {
            // Files are begun in order as cores become free, so that early files are done early. Once
            // the receiver is gone, no further file is begun.
            let _ = files
                .iter()
                .enumerate()
                .par_bridge()
                .try_for_each_with(results, |results, (i, file)| results.send((i, work(file))));
        });
        if started.is_err() {
            // Where no thread can be started, as in a page, the files follow each other.
            return files.iter().try_for_each(|file| done(file, work(file)));
        }
        let mut waiting = BTreeMap::new();
        let mut next = 0;
        // An early return drops the receiver, which ends the workers.
        for (i, result) in incoming {
            waiting.insert(i, result);
            while let Some(result) = waiting.remove(&next) {
                done(&files[next], result)?;
                next += 1;
                bar.inc(1);
            }
        }
        Ok(())
    });
    bar.finish_and_clear();
    outcome
}

/// Prints all failures but the last, one line each.
///
/// # Errors
/// The last failure is returned, if there is any.
pub(crate) fn failed(mut failures: Vec<Failure>) -> Result<(), Failure> {
    let Some(last) = failures.pop() else {
        return Ok(());
    };
    for failure in failures {
        report(failure);
    }
    Err(last)
}
