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

use crate::failure::Failure;
use std::io::Write;

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
