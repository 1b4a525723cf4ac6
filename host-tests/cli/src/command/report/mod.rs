//! `report`: writes a diagnosis as an HTML page.

mod json;
mod page;

use crate::command::{
    diagnose::arguments::DiagnosisArguments,
    examples, explore,
    output::{file::OutputFile, written::print_written},
};
use allanite_host::diagnose;
use allanite_log::failure::{Failure, Place};
use clap::Args;
use std::{
    io::{self, Write},
    path::{Path, PathBuf},
};

/// Write the diagnosis as an interactive page: one HTML file that needs no other file
#[derive(Debug, Args)]
#[command(after_help = examples::REPORT)]
pub(super) struct Arguments {
    #[command(flatten)]
    diagnosis: DiagnosisArguments,
    /// The page to write: .html
    #[arg(long, short, value_name = "REPORT.html")]
    output: PathBuf,
    /// Leave out the program with which readers of the page can try effects, which takes 1.5 MB
    #[arg(long, conflicts_with = "page")]
    plain: bool,
    /// The empty page with that program, as `cargo xtask page` builds it [default: the one beside the program, if it is there]
    #[arg(long, value_name = "FILE.html")]
    page: Option<PathBuf>,
}

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let place = || Place::file(&arguments.output);
    if !is_page(&arguments.output) {
        return Err(place().failure("a page must end in .html", "rename the output"));
    }
    // The file comes first, so that an output that cannot be written is refused before the diagnosis.
    let mut file = OutputFile::create(&arguments.output, [&*arguments.diagnosis.input])?;
    // What a reader tries begins with the five terms.
    let can_carry = !arguments.plain && arguments.diagnosis.is_plain();
    if arguments.page.is_some() && !can_carry {
        return Err(Failure::option(
            "on the page of --page, effects are tried without --filter and --max-effects",
            "omit one of them",
        ));
    }
    let empty = can_carry.then(|| explore::empty_page(arguments.page.as_deref()));
    let (carried, diagnosed) = match empty.transpose()?.flatten() {
        Some(empty) => {
            let diagnosed = arguments.diagnosis.diagnosed_for_page()?;
            let carried = explore::carried(empty, &arguments.diagnosis.input, &diagnosed)?;
            let diagnosed = diagnosed.into_iter().map(|(diagnosed, _)| diagnosed);
            (Some(carried), diagnosed.collect())
        }
        None => (None, arguments.diagnosis.diagnosed()?),
    };
    let fail = |error: io::Error| place().io(&error);
    let pictured = json::document(&diagnosed);
    let mut text = Vec::new();
    diagnose::text::print(&diagnosed, &mut text).map_err(fail)?;
    let page = page::page(&page::Content {
        input: &arguments.diagnosis.input,
        diagnosed: &diagnosed,
        json: &serde_json::to_string(&pictured).map_err(|error| fail(error.into()))?,
        text: &String::from_utf8_lossy(&text),
        carried: carried.as_ref(),
    });
    file.write_all(page.as_bytes()).map_err(fail)?;
    file.commit()?;
    let next = match carried {
        Some(_) => "open it in a browser, where effects can be tried by hand",
        None => "open it in a browser; `explore` changes the effects by hand",
    };
    print_written(
        &diagnosed.iter().collect::<Vec<_>>(),
        (&arguments.output, next),
        output,
    )
}

fn is_page(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("html"))
}
