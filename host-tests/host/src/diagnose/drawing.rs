//! The drawing of a diagnosis: each axis with its last model, or with that of a step.

use super::{diagnosed::Diagnosed, pictures::Pictures, words::shown_p};
use crate::words;
use allanite_log::failure::{Failure, Place, quoted};
use allanite_plot::{Drawing, Quantity, svg};
use std::path::Path;

/// What is drawn of a diagnosis.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// The axis to draw; all of them without one.
    pub axis: Option<String>,
    /// The step whose model to draw, 0 for the five terms. An axis with fewer steps shows its last, and so it does without one.
    pub step: Option<usize>,
    /// What to draw; everything that the record has if it is empty.
    pub what: Vec<What>,
}

/// A part of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum What {
    /// The Allan deviation over the averaging time, with its residual
    Deviation,
    /// The density over the frequency, with its residual
    Spectrum,
    /// The rate, the noise and recorded columns over time, with events
    Rate,
}

/// The drawing of these axes, as the text of an SVG file.
///
/// # Errors
/// When an axis has nothing of what is to be drawn.
pub fn drawn(chosen: &[&Diagnosed], input: &Path, shown: &Shown) -> Result<String, Failure> {
    let drawings = chosen.iter();
    let drawings = drawings.map(|diagnosed| drawing(diagnosed, input, shown));
    Ok(svg(&drawings.collect::<Result<Vec<_>, _>>()?))
}

/// The axis that the option names, or all axes.
///
/// # Errors
/// When there is no such axis.
pub fn chosen<'a>(
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
