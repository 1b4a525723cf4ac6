//! Where the results of several files are written.

use allanite_log::failure::{Failure, Place};
use std::{
    collections::HashMap,
    path::{Path, PathBuf},
};

/// The name of a file without its extension; `.csv.gz` counts as one extension.
pub(crate) fn stem(path: &Path) -> PathBuf {
    let stem = Path::new(path.file_stem().unwrap_or_default());
    match stem.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("csv") => stem.with_extension(""),
        _ => stem.to_owned(),
    }
}

/// The output path of each input: the output itself, or a file of this extension in it if it is a folder. `verb` is what to do
/// with inputs one by one, in the remedy.
///
/// # Errors
/// When the output is no folder but there are several inputs, or when two inputs would get the same path.
pub(crate) fn places(
    inputs: &[PathBuf],
    output: &Path,
    extension: &str,
    verb: &str,
) -> Result<HashMap<PathBuf, PathBuf>, Failure> {
    if !output.is_dir() && inputs.len() > 1 {
        return Err(Place::file(output).failure(
            "several logs need a folder as output, and this one does not exist",
            "create the folder first",
        ));
    }
    let mut places: HashMap<PathBuf, PathBuf> = HashMap::new();
    for input in inputs {
        let place = if output.is_dir() {
            let mut name = stem(input).into_os_string();
            name.push(".");
            name.push(extension);
            output.join(name)
        } else {
            output.to_owned()
        };
        if places.values().any(|other| *other == place) {
            return Err(Place::file(&place).failure(
                "two logs would write this file",
                format!("{verb} them one by one, each with its own --output"),
            ));
        }
        places.insert(input.clone(), place);
    }
    Ok(places)
}
