//! `plot`: draws a record beside a model as a picture.

use crate::command::{
    diagnose::{
        conclusion::print_written,
        diagnosed::{Diagnosed, DiagnosisArguments},
        pictures::Pictures,
        words::shown_p,
    },
    examples,
    output::file::OutputFile,
};
use allanite_host::words;
use allanite_log::failure::{Failure, Place, quoted};
use allanite_plot::{Drawing, Quantity, svg};
use clap::{Args, ValueEnum};
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
    shown: Shown,
}

/// What is drawn of a diagnosis.
#[derive(Debug, Args)]
pub(super) struct Shown {
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

/// A part of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum What {
    /// The Allan deviation over the averaging time, with its residual
    Deviation,
    /// The density over the frequency, with its residual
    Spectrum,
    /// The rate, the noise and recorded columns over time, with events
    Rate,
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
    let (input, shown) = (&arguments.diagnosis.input, &arguments.shown);
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

/// The drawing of these axes, as the text of an SVG file.
///
/// # Errors
/// When an axis has nothing of what is to be drawn.
pub(super) fn drawn(chosen: &[&Diagnosed], input: &Path, shown: &Shown) -> Result<String, Failure> {
    let drawings = chosen.iter();
    let drawings = drawings.map(|diagnosed| drawing(diagnosed, input, shown));
    Ok(svg(&drawings.collect::<Result<Vec<_>, _>>()?))
}

/// The axis that the option names, or all axes.
///
/// # Errors
/// When there is no such axis.
pub(super) fn chosen<'a>(
    diagnosed: &'a [Diagnosed],
    input: &Path,
    shown: &Shown,
) -> Result<Vec<&'a Diagnosed>, Failure> {
    let Some(name) = &shown.axis else {
        return Ok(diagnosed.iter().collect());
    };
    let chosen = diagnosed.iter().find(|one| one.axis.axis == *name);
    let names = || {
        let names = diagnosed.iter().map(|one| one.axis.axis.as_str());
        names.collect::<Vec<_>>().join(", ")
    };
    let chosen = chosen.ok_or_else(|| {
        Place::file(input).failure(
            format!("there is no axis {}", quoted(name.as_bytes())),
            format!("choose from {}", names()),
        )
    })?;
    Ok(vec![chosen])
}

/// The drawing of a step, or of the last step if the diagnosis has fewer.
fn drawing(diagnosed: &Diagnosed, input: &Path, shown: &Shown) -> Result<Drawing, Failure> {
    let last = diagnosed.steps.len() - 1;
    let at = shown.step.map_or(last, |step| step.min(last));
    let step = &diagnosed.steps[at];
    let axis = &diagnosed.axis;
    let record = words::record(axis.samples, axis.rate_hz, axis.octaves.len());
    let pictures = Pictures::of(diagnosed);
    let wanted = |what: What| shown.what.is_empty() || shown.what.contains(&what);
    let frames = pictures.frames().into_iter();
    let frames = frames.filter(|frame| {
        wanted(match frame.quantity {
            Quantity::Deviation => What::Deviation,
            Quantity::Density => What::Spectrum,
        })
    });
    let drawing = Drawing {
        title: format!("{}: {}", axis.axis, diagnosed.model_name(at)),
        subtitle: format!(
            "χ² {:.1}, {} degrees of freedom, p {}; {record}",
            step.fit.chi_squared,
            step.fit.degrees_of_freedom,
            shown_p(step.fit.p_value),
        ),
        warning: diagnosed.invalid(),
        unit: axis.unit,
        figures: frames
            .map(|frame| (pictures.figure(step, &frame), frame))
            .filter(|(figure, _)| !figure.measured.x.is_empty())
            .collect(),
        course: pictures.course().filter(|_| wanted(What::Rate)),
    };
    if drawing.figures.is_empty() && drawing.course.is_none() {
        let what = format!("axis {} has nothing of what is to be drawn", axis.axis);
        let remedy = "give the log instead of a curve file, record longer, or leave out --what";
        return Err(Place::file(input).failure(what, remedy));
    }
    Ok(drawing)
}
