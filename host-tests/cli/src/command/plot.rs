//! `plot`: draws a record beside a model as a picture.

use crate::command::{
    diagnose::arguments::DiagnosisArguments,
    examples,
    output::{file::OutputFile, written::print_written},
};
use allanite_host::diagnose::drawing::{Shown, What, chosen, drawn};
use allanite_log::failure::{Failure, Place};
use clap::Args;
use std::{io::Write, path::Path, path::PathBuf};

/// Draw the Allan deviation and the spectrum with the last model of `diagnose`, the differences, and the rate over time
///
/// The spectrum is drawn as amplitude spectral density (ASD), the root of the one-sided power spectral density (PSD).
#[derive(Debug, Args)]
#[command(after_help = examples::PLOT)]
pub(super) struct Arguments {
    #[command(flatten)]
    diagnosis: DiagnosisArguments,
    /// The picture to write: .svg or .png
    #[arg(long, short, value_name = "CURVE.svg|CURVE.png")]
    output: PathBuf,
    #[command(flatten)]
    shown: ShownArguments,
}

/// What is drawn of a diagnosis.
#[derive(Debug, Args)]
struct ShownArguments {
    /// The axis to draw [default: all axes, one below the other]
    #[arg(long, value_name = "NAME")]
    axis: Option<String>,
    /// The step of the diagnosis whose model to draw, 0 for the five terms; an axis with fewer steps
    /// shows its last [default: the last]
    #[arg(long, value_name = "N")]
    step: Option<usize>,
    /// What to draw [default: all that the record has; a curve file has no rate over time]
    #[arg(long, value_delimiter = ',', value_name = "WHAT,…")]
    what: Vec<What>,
}

impl ShownArguments {
    fn shown(&self) -> Shown {
        Shown {
            axis: self.axis.clone(),
            step: self.step,
            what: self.what.clone(),
        }
    }
}

/// The part of the program that a build without the feature `pictures` leaves out.
const PNG: &str = "drawing .png pictures";

/// The most axes in a picture of pixels. Each takes up to thirty megabytes.
const MOST_AXES: usize = 6;

#[derive(Clone, Copy)]
enum Format {
    Svg,
    Png,
}

impl Format {
    fn of(path: &Path) -> Result<Self, Failure> {
        let extension = path.extension().and_then(|extension| extension.to_str());
        match extension.map(str::to_ascii_lowercase).as_deref() {
            Some("svg") => Ok(Self::Svg),
            Some("png") if cfg!(feature = "pictures") => Ok(Self::Png),
            Some("png") => Err(Failure::not_built_in(PNG)),
            _ => Err(Place::file(path)
                .failure("a picture must end in .svg or .png", "rename the output")),
        }
    }
}

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let format = Format::of(&arguments.output)?;
    // The file comes first, so that an output that cannot be written is refused before the diagnosis.
    let mut file = OutputFile::create(&arguments.output, [&*arguments.diagnosis.input])?;
    let diagnosed = arguments.diagnosis.diagnosed()?;
    let (input, shown) = (&arguments.diagnosis.input, &arguments.shown.shown());
    let chosen = chosen(&diagnosed, input, shown)?;
    if matches!(format, Format::Png) && chosen.len() > MOST_AXES {
        return Err(Place::file(&arguments.output).failure(
            format!(
                "the picture would have {} axes, more than {MOST_AXES}",
                chosen.len()
            ),
            "draw one axis with --axis, or an .svg",
        ));
    }
    let drawing = drawn(&chosen, input, shown)?;
    let place = || Place::file(&arguments.output);
    let bytes = match format {
        Format::Svg => drawing.into_bytes(),
        Format::Png => png(&drawing, place())?,
    };
    let written = file.write_all(&bytes);
    written.map_err(|error| place().io(&error))?;
    file.commit()?;
    let next = "`diagnose` tells the steps in words, and `report` on a page";
    print_written(&chosen, (&arguments.output, next), output)
}

#[cfg(feature = "pictures")]
fn png(drawing: &str, place: Place) -> Result<Vec<u8>, Failure> {
    allanite_plot::png(drawing)
        .map_err(|error| place.failure(error, "draw one axis with --axis, or an .svg"))
}

#[cfg(not(feature = "pictures"))]
fn png(_: &str, _: Place) -> Result<Vec<u8>, Failure> {
    Err(Failure::not_built_in(PNG))
}
