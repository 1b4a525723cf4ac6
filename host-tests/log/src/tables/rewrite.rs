//! Writes the text of a table with the reader of its format.

use super::{
    ardupilot, arrow, arrow_rows::Written, betaflight, hdf5, matlab, workbook, wrong::Wrong,
};
use crate::{
    converted::Text,
    failure::{Failure, Place, one_line},
    source::TableKind as Kind,
};
use std::{
    fs::File,
    panic::{self, AssertUnwindSafe},
    path::Path,
};

/// The remedy of a damaged file.
const COPY: &str = "copy or record the file again";

/// Writes the text of a table to a file, and its numbers to another one if that is given and the text would be long.
pub(super) fn rewrite(
    path: &Path,
    kind: Kind,
    topic: Option<&str>,
    (text, values): (&Path, Option<&Path>),
) -> Result<Written, Failure> {
    let here = || Place::file(path);
    let size = path.metadata().map_or(0, |file| file.len());
    let to = |file: &Path| {
        let file = File::create(file).map_err(|error| here().io(&error))?;
        Ok(Text::to(path, size, file))
    };
    let mut text = to(text)?;
    let values = values.map(to).transpose()?;
    let convert = || {
        let note = match kind {
            Kind::Arrow | Kind::Parquet => {
                let layout = arrow::convert(path, kind, topic, (&mut text, values))?;
                return Ok((None, layout));
            }
            Kind::Ardupilot => ardupilot::convert(path, topic, &mut text)?,
            Kind::Betaflight => betaflight::convert(path, topic, &mut text)?,
            Kind::Hdf5 => return hdf5::convert(path, topic, (&mut text, values)),
            Kind::Matlab => return matlab::convert(path, topic, (&mut text, values)),
            Kind::Workbook => workbook::convert(path, topic, &mut text)?,
        };
        Ok((note, None))
    };
    let converted = quietly(convert);
    let written = converted.map_err(|wrong| match wrong {
        Wrong::Io(error) => text.failure(&error),
        Wrong::Damaged(what) => here().failure(format!("damaged: {}", one_line(&what)), COPY),
        Wrong::Unfit(what, remedy) => here().failure(what, remedy),
    })?;
    text.finish()?;
    Ok(written)
}

/// Runs a reader of another project. Some of them panic at damaged files, which is reported like any other damage.
fn quietly<T>(read: impl FnOnce() -> Result<T, Wrong>) -> Result<T, Wrong> {
    let hook = panic::take_hook();
    panic::set_hook(Box::new(|_| {}));
    let read = panic::catch_unwind(AssertUnwindSafe(read));
    panic::set_hook(hook);
    read.unwrap_or_else(|_| Err(Wrong::damaged("its parts contradict each other")))
}
