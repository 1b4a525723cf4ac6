//! The page as a file: the empty page, which carries the program, with the records in it.

use super::arguments::Arguments;
use crate::command::output::{file::OutputFile, progress};
use allanite_log::{
    failure::{Failure, Place, report},
    regular_file,
};
use std::{
    fs,
    io::{self, Read, Write},
    path::{Path, PathBuf},
};

/// The name of the empty page.
const NAME: &str = "allanite.html";

/// The place of the records in the empty page.
const PLACE: &str = r#"<script type="application/json" id="session">"#;

/// The largest empty page, in bytes. Chosen by hand.
const LARGEST: u64 = 1 << 24;

/// Writes the page, and opens it unless it was to be written only.
pub(super) fn write(
    arguments: &Arguments,
    document: &str,
    output: &mut impl Write,
) -> Result<(), Failure> {
    let page = arguments.page.clone().map_or_else(beside, Ok)?;
    let [before, behind] = empty(&page)?;
    // Without `<`, no text in the records can end the script element.
    let document = document.replace('<', "\\u003c");
    let page = [&before, &*document, &behind].concat();
    let path = match &arguments.output {
        Some(path) => {
            let inputs = arguments.inputs.iter().map(PathBuf::as_path);
            let mut file = OutputFile::create(path, inputs)?;
            file.write_all(page.as_bytes())
                .map_err(|error| Place::file(path).io(&error))?;
            file.commit()?;
            path.clone()
        }
        None => temporary(&page)?,
    };
    let shown = allanite_log::failure::one_line(&path.to_string_lossy());
    writeln!(output, "{shown}")
        .and_then(|()| output.flush())
        .map_err(|error| Failure::standard_output(&error))?;
    if arguments.open || arguments.output.is_none() {
        if let Err(error) = open::that_detached(&path) {
            report(format_args!(
                "no browser could be opened ({error}); open the file above"
            ));
        }
    } else if !progress::is_quiet() {
        report("open this file in a browser");
    }
    Ok(())
}

/// The empty page that was built or installed with the program.
fn beside() -> Result<PathBuf, Failure> {
    let program = std::env::current_exe().ok();
    let folder = program.as_deref().and_then(Path::parent);
    let places = ["", "..", "../share/allanite"];
    let mut places = places
        .iter()
        .filter_map(|place| Some(folder?.join(place).join(NAME)));
    places.find(|path| path.is_file()).ok_or_else(|| {
        Failure::option(
            "the page that carries the program is not built yet",
            "`cargo xtask page` builds it in two minutes; or name it with --page",
        )
    })
}

/// This empty page, or the one that was built or installed with the program, if it is there and of this version.
pub(super) fn empty_page(page: Option<&Path>) -> Result<Option<[String; 2]>, Failure> {
    match page {
        Some(page) => empty(page).map(Some),
        None => Ok(beside().ok().and_then(|page| empty(&page).ok())),
    }
}

/// The empty page: what stands before the records and behind them.
fn empty(path: &Path) -> Result<[String; 2], Failure> {
    let (file, _) = regular_file::open(path)?;
    let mut page = String::new();
    file.take(LARGEST)
        .read_to_string(&mut page)
        .map_err(|error| Place::file(path).io(&error))?;
    let wrong = |what: &str| {
        Place::file(path).failure(
            what,
            "build the page of this version with `cargo xtask page`",
        )
    };
    let version = concat!("content=\"allanite ", env!("CARGO_PKG_VERSION"), "\"");
    if !page.contains(version) {
        return Err(wrong("is not the page of this version"));
    }
    let (before, behind) = page
        .split_once(PLACE)
        .ok_or_else(|| wrong("has no place for records"))?;
    Ok([format!("{before}{PLACE}"), behind.to_owned()])
}

/// Writes a page among the temporary files, for this user alone.
fn temporary(page: &str) -> Result<PathBuf, Failure> {
    let write = || -> io::Result<PathBuf> {
        let mut file = tempfile::Builder::new()
            .prefix("allanite-")
            .suffix(".html")
            .tempfile()?;
        file.write_all(page.as_bytes())?;
        let (_, path) = file.keep()?;
        fs::canonicalize(path)
    };
    write().map_err(|error| {
        Failure::option(
            format!("no temporary page can be written: {error}"),
            "name a file with --output",
        )
    })
}
