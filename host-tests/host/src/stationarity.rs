//! Whether the record is stationary: what happened during it, and what that did to the coefficients.

use crate::{
    verdict,
    words::{self, damage},
};
use allanite::{
    Curve, Error, Model, Scale,
    course::{Course, Event, What, analyse_without},
    fit::{Fit, Options, fit},
    storage::{AxisCertificate, CertifiedEvent},
};
use allanite_log::unit::Unit;

/// A change of the noise by less than this share of it changes the coefficients by no more. Chosen by hand.
const SLIGHT: f64 = 0.05;

/// What happened during a record.
#[derive(Default)]
pub struct Stationarity {
    /// The events, the earliest first. Empty for a curve file, which has no course, and for a record that is not
    /// valid.
    pub events: Vec<Event>,
    /// The curve with and without what steps and a warm-up add to it, if there were any.
    pub shifted: Option<Shifted>,
}

/// The fits of a model to the octaves of a record in which the mean rate changed.
pub struct Shifted {
    model: Model,
    /// As the record is.
    pub with: Fit,
    /// Without what the steps and the warm-up add to the curve.
    pub without: Fit,
}

/// Whether an event hardly changes the coefficients.
fn is_slight(event: &Event) -> bool {
    matches!(event.what, What::NoiseChange) && (event.size - 1.0).abs() < SLIGHT
}

/// Whether something happened that the coefficients of a certificate do not stand for.
pub fn is_disturbed(axis: &AxisCertificate) -> bool {
    let mut events = axis.findings.events.iter().flatten();
    !events.all(|event| is_slight(&event.event()))
}

impl Stationarity {
    /// Looks for events beside the noise of a model. `followed` is what follows a covariate, in the blocks of the
    /// course; the curve is without it.
    ///
    /// # Errors
    /// When the curve cannot be fitted.
    pub fn of<const K: usize>(
        course: &Course,
        scale: Scale,
        curve: &Curve<K>,
        model: &Model,
        followed: &[f64],
    ) -> Result<Self, Error> {
        let options = Options::default();
        let analysis = analyse_without(curve, model, course, scale, followed, options)?;
        let events: Vec<Event> = analysis.events.iter().copied().collect();
        let is_shift = |event: &Event| matches!(event.what, What::Step | What::WarmUp { .. });
        let shifted = if events.iter().any(is_shift) {
            Some(Shifted {
                model: model.clone(),
                with: fit(curve, model, options)?,
                without: analysis.fit,
            })
        } else {
            None
        };
        Ok(Self { events, shifted })
    }

    /// The events that a certificate has.
    pub fn certified(axis: &AxisCertificate) -> Self {
        let events = axis.findings.events.iter().flatten();
        Self {
            events: events.map(CertifiedEvent::event).collect(),
            shifted: None,
        }
    }

    /// Whether something happened that the coefficients do not stand for.
    pub fn is_disturbed(&self) -> bool {
        !self.events.iter().all(is_slight)
    }

    /// The strongest event, in a sentence.
    pub fn strongest(&self, unit: Unit) -> Option<String> {
        let size = |event: &&Event| event.z.abs();
        let strongest = self
            .events
            .iter()
            .max_by(|one, other| size(one).total_cmp(&size(other)));
        strongest.map(|event| words::event(event, unit))
    }

    /// Notes on the events, one line each.
    pub fn notes(&self, unit: Unit) -> Vec<String> {
        let mut notes: Vec<String> = self
            .events
            .iter()
            .map(|event| words::event(event, unit))
            .collect();
        if self.is_disturbed() {
            notes.push(verdict::MIXTURE.into());
        }
        if let Some(Shifted {
            model,
            with,
            without,
        }) = &self.shifted
        {
            notes.push(format!(
                "without the change of the rate, the χ² of the octaves is {:.1} instead of {:.1}",
                without.chi_squared, with.chi_squared
            ));
            let changed = damage((model, with), (model, without), unit);
            notes.extend(
                changed
                    .into_iter()
                    .map(|changed| format!("because of it, {changed}")),
            );
        }
        notes
    }
}
