//! `merge`: joins the curves of parts of a record.

use crate::command::{
    examples,
    input::many,
    measure::{check_name, summarize, write},
    output::file::OutputFile,
};
use allanite_host::curve_file::{AxisCurve, CurveFile};
use allanite_log::failure::{Failure, Place, quoted};
use clap::Args;
use std::{
    io::Write,
    path::{Path, PathBuf},
};

/// Merge the curves of parts of a record, measured apart, as if a gap lay between the parts
#[derive(Debug, Args)]
#[command(after_help = examples::MERGE)]
pub(super) struct Arguments {
    /// Curve files of measure, or of merge; their order changes nothing
    #[arg(required = true, value_name = "CURVE.json")]
    curves: Vec<PathBuf>,
    /// The curve file to write, .json
    #[arg(long, short, value_name = "ALL.json")]
    output: PathBuf,
}

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    check_name(&arguments.output)?;
    let paths = &arguments.curves;
    let mut place = OutputFile::create(&arguments.output, paths.iter().map(PathBuf::as_path))?;
    let mut files = Vec::new();
    let mut failures = Vec::new();
    many::each(paths, CurveFile::read, |path, file| {
        match file {
            Ok(file) => files.push((path, file)),
            Err(failure) => failures.push(failure),
        }
        Ok(())
    })?;
    // A curve without one of its parts would be taken for the whole.
    many::failed(failures)?;
    let merged = CurveFile::new(merged(&files)?);
    write(&mut place, &arguments.output, &merged)?;
    place.commit()?;
    let printed = summarize(None, &merged.axes, output);
    printed.map_err(|error| Failure::standard_output(&error))
}

/// Whether two files have the same record: the same sums in every octave of every axis. No two records of noise do.
fn is_same(file: &CurveFile, other: &CurveFile) -> bool {
    let is_in = |axis: &AxisCurve| {
        let mut axes = other.axes.iter().filter(|one| one.axis == axis.axis);
        axes.any(|one| one.samples == axis.samples && one.octaves == axis.octaves)
    };
    file.axes.iter().all(is_in)
}

/// The merged curve of every axis of the first file. Every file has the same axes.
fn merged(files: &[(&Path, CurveFile)]) -> Result<Vec<AxisCurve>, Failure> {
    let Some((_, first)) = files.first() else {
        return Ok(Vec::new());
    };
    for (path, file) in files {
        for (ours, theirs) in [(first, file), (file, first)] {
            let lacking = |axis: &&AxisCurve| !theirs.axes.iter().any(|one| one.axis == axis.axis);
            if let Some(axis) = ours.axes.iter().find(lacking) {
                let name = quoted(axis.axis.as_bytes());
                return Err(Place::file(path).failure(
                    format!("axis {name} is in one of this file and the first one only"),
                    "merge curves of the same axes",
                ));
            }
        }
    }
    for (at, (path, file)) in files.iter().enumerate() {
        if let Some((other, _)) = files[..at].iter().find(|(_, other)| is_same(file, other)) {
            let other = quoted(other.as_os_str().as_encoded_bytes());
            return Err(Place::file(path).failure(
                format!("it has the same record as {other}"),
                "leave one of them out: a record counts once",
            ));
        }
    }
    let of_axis = |axis: &AxisCurve| {
        let same = |file: &CurveFile| file.axes.iter().find(|one| one.axis == axis.axis).cloned();
        let parts: Vec<AxisCurve> = files.iter().filter_map(|(_, file)| same(file)).collect();
        AxisCurve::merged(&parts).map_err(|(part, what)| {
            let path = files.get(part).map_or(Path::new(""), |(path, _)| path);
            let name = quoted(axis.axis.as_bytes());
            Place::file(path).failure(
                format!("axis {name}: {what}"),
                "merge curves of one sensor, measured with the same --rate, --unit and --scale",
            )
        })
    };
    first.axes.iter().map(of_axis).collect()
}
