//! A diagnosis as figures, which `diagnose` prints, `plot` draws and `report` shows.

use super::diagnosed::Diagnosed;
use allanite::{Scale, diagnosis::Step, spectrum::Spectrum};
use allanite_host::{confidence::relative_errors, words};
use allanite_log::{BINS, OCTAVES};
use allanite_plot::{CourseFigure, Figure, Frame, Mark, Quantity, View};

/// What the figures of all steps of a diagnosis have in common.
pub(crate) struct Pictures<'a> {
    diagnosed: &'a Diagnosed,
    spectrum: Spectrum<BINS>,
    /// The standard errors of the octaves, relative to their variances. They are those of the last model, which comes
    /// closest to the record, so that the bars are the same in every step.
    errors: Vec<f64>,
}

impl<'a> Pictures<'a> {
    pub(crate) fn of(diagnosed: &'a Diagnosed) -> Self {
        // The diagnosis has fitted this curve and this spectrum already, so that neither fails here.
        let errors = diagnosed.steps.last().and_then(|last| {
            let (curve, _) = diagnosed.observed_in(last).ok()?;
            Some(relative_errors(&curve, &last.model, &last.fit))
        });
        Self {
            diagnosed,
            spectrum: diagnosed.axis.spectrum().unwrap_or(Spectrum::EMPTY),
            errors: errors.unwrap_or_default(),
        }
    }

    /// The frames of what the record has: with room for every step, so that the error is seen to fall.
    pub(crate) fn frames(&self) -> Vec<Frame> {
        let comparisons = self.diagnosed.steps.iter().map(|step| &step.comparison);
        let bins = self.spectrum.bins();
        Quantity::ALL
            .into_iter()
            .filter(|quantity| *quantity == Quantity::Deviation || !bins.is_empty())
            .map(|quantity| Frame::of(quantity, comparisons.clone()))
            .collect()
    }

    /// The figure of a step, or of a candidate.
    pub(crate) fn figure(&self, step: &Step<OCTAVES, BINS>, frame: &Frame) -> Figure {
        // The levels of the spectrum that a covariate reaches are left out of the step.
        let observed = self.diagnosed.observed_in(step);
        let spectrum = observed.map_or(Spectrum::EMPTY, |(_, spectrum)| spectrum);
        let view = View {
            model: &step.model,
            fit: &step.fit,
            comparison: &step.comparison,
            spectrum: &spectrum,
            errors: &self.errors,
            interval_s: 1.0 / self.diagnosed.axis.rate_hz,
        };
        Figure::new(&view, frame)
    }

    /// The record over time, if it is known.
    pub(crate) fn course(&self) -> Option<CourseFigure> {
        course(self.diagnosed)
    }
}

/// The record of a diagnosis over time, if it is known.
pub(crate) fn course(diagnosed: &Diagnosed) -> Option<CourseFigure> {
    let axis = &diagnosed.axis;
    let course = diagnosed.course.as_ref()?;
    let scale = Scale::new(axis.rate_per_count, axis.rate_hz).ok()?;
    // A record with motion is not valid, and has no other events.
    let motion = diagnosed.motion().map(|motion| Mark {
        at_s: motion.at_s,
        words: "motion".into(),
    });
    let events = motion.chain(diagnosed.stationarity.events.iter().map(|event| Mark {
        at_s: event.at_s,
        words: words::brief_event(event, axis.unit),
    }));
    let columns = &diagnosed.columns;
    CourseFigure::new(course, scale, axis.unit, columns, events.collect())
}
