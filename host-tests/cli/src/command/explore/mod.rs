//! `explore`: a page on which effects are tried by hand. The page carries this program and its records, and asks the
//! program by the hidden command `ask`; so it needs no server.

mod answer;
mod arguments;
pub(super) mod ask;
mod catalogue;
mod download;
mod figure;
mod fitted;
#[cfg(not(target_family = "wasm"))]
mod page;
mod question;
mod record;
mod session;
mod shell;
mod taken_out;
mod thought;

pub(super) use arguments::Arguments;
pub use question::What;
pub use session::Session;

use super::diagnose::diagnosed::OfPage;
use allanite_log::failure::Failure;
use std::{io::Write, path::Path};

/// What a report carries so that its readers can try effects in it.
pub(super) struct Carried {
    /// The empty page: what stands before the records and behind them.
    pub(super) page: [String; 2],
    /// The records.
    pub(super) session: String,
}

/// The empty page that a report can carry: this one, or that of the program if it is built. A page carries no other.
///
/// # Errors
/// When this one cannot be read, or is not an empty page of this version.
pub(super) fn empty_page(page: Option<&Path>) -> Result<Option<[String; 2]>, Failure> {
    #[cfg(not(target_family = "wasm"))]
    return page::empty_page(page);
    #[cfg(target_family = "wasm")]
    match page {
        Some(_) => Err(Failure::option("a page carries no other", "omit --page")),
        None => Ok(None),
    }
}

/// The page with these records.
///
/// # Errors
/// When an axis cannot be compared without what follows its covariates.
pub(super) fn carried(
    page: [String; 2],
    input: &Path,
    diagnosed: &[OfPage],
) -> Result<Carried, Failure> {
    let session = session::of_diagnosed(input, diagnosed)?;
    Ok(Carried { page, session })
}

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let document = session::document(arguments)?;
    if arguments.session {
        return writeln!(output, "{document}").map_err(|error| Failure::standard_output(&error));
    }
    #[cfg(not(target_family = "wasm"))]
    return page::write(arguments, &document, output);
    #[cfg(target_family = "wasm")]
    Err(Failure::option(
        "a page cannot write another page",
        "give --session",
    ))
}
