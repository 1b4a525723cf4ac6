//! The files that a lot is written to.

#[cfg(feature = "tables")]
use super::parquet;
use super::{csv, judgement::Judged, page, table};
use crate::command::output::file::OutputFile;
use allanite_log::failure::{Failure, Place};
use std::{
    io::{self, Write as _},
    path::{Path, PathBuf},
};

/// The part of the program that a build without the feature `tables` leaves out.
const PARQUET: &str = "writing Parquet";

/// What is written, by the extension of the file.
#[derive(Clone, Copy)]
enum Format {
    Csv,
    Parquet,
    Page,
}

impl Format {
    fn of(path: &Path) -> Result<Self, Failure> {
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        match extension.to_lowercase().as_str() {
            "csv" => Ok(Self::Csv),
            "parquet" if cfg!(feature = "tables") => Ok(Self::Parquet),
            "parquet" => Err(Failure::not_built_in(PARQUET)),
            "html" => Ok(Self::Page),
            _ => Err(Place::file(path).failure(
                "the results of a lot are a .csv, a .parquet or an .html",
                "rename the output",
            )),
        }
    }
}

/// A file that has been begun.
pub(super) struct Output {
    path: PathBuf,
    format: Format,
    file: OutputFile,
}

impl Output {
    /// Begins a file.
    ///
    /// # Errors
    /// When its extension is none of those that are written, or it cannot be written.
    pub(super) fn create(path: &Path, inputs: &[&Path]) -> Result<Self, Failure> {
        Ok(Self {
            path: path.to_owned(),
            format: Format::of(path)?,
            file: OutputFile::create(path, inputs.iter().copied())?,
        })
    }

    /// Writes and completes the file.
    ///
    /// # Errors
    /// When it cannot be written.
    pub(super) fn write(mut self, judged: &Judged<'_>) -> Result<(), Failure> {
        let written = match self.format {
            Format::Csv => csv::write(&table::columns(judged), &mut self.file),
            Format::Parquet => parquet(judged, &mut self.file),
            Format::Page => self.file.write_all(page::page(judged).as_bytes()),
        };
        written.map_err(|error| Place::file(&self.path).io(&error))?;
        self.file.commit()
    }
}

#[cfg(feature = "tables")]
fn parquet(judged: &Judged<'_>, file: &mut OutputFile) -> io::Result<()> {
    parquet::write(table::columns(judged), file)
}

/// `Format::of` has refused the file.
#[cfg(not(feature = "tables"))]
fn parquet(_: &Judged<'_>, _: &mut OutputFile) -> io::Result<()> {
    Err(io::Error::other(PARQUET))
}
