//! What a command says that has written a diagnosis to a file.

use super::progress;
use allanite_host::diagnose::{conclusion::lines, diagnosed::Diagnosed};
use allanite_log::failure::{Failure, one_line};
use std::{io::Write, path::Path};

/// Prints the conclusion of what was written to a file, unless the program is to be quiet, with what to do next.
///
/// # Errors
/// When standard output cannot be written.
pub(crate) fn print_written(
    diagnosed: &[&Diagnosed],
    (path, next): (&Path, &str),
    output: &mut impl Write,
) -> Result<(), Failure> {
    if progress::is_quiet() {
        return Ok(());
    }
    let mut lines = lines(diagnosed);
    lines.push(format!(
        "wrote {}: {next}",
        one_line(&path.to_string_lossy())
    ));
    let mut lines = lines.iter();
    lines
        .try_for_each(|line| writeln!(output, "{line}"))
        .map_err(|error| Failure::standard_output(&error))
}
