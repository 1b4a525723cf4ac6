//! A model beside a record, in memory.

use super::{document::json, own::Own};
use crate::{
    compare::{compared::Compared, json::document, model::ModelChoice, visible::check_visible},
    confidence::relative_errors,
    curve_file::AxisCurve,
    diagnose::words::shown_p,
    effect_argument,
    known_filter::{self, known_filter},
    record::library_failure,
    words,
};
use allanite::{Curve, Model, Term, spectrum::Spectrum};
use allanite_log::{BINS, OCTAVES, failure::Failure};
use allanite_plot::{Drawing, Figure, Frame, Quantity, View, svg};
use std::path::Path;

/// A model that was fitted to an axis, and its comparison with the record.
pub struct Comparison {
    compared: Compared,
    curve: Curve<OCTAVES>,
    /// The comparison with the five terms, which needs as much room in a picture.
    five: Compared,
}

impl Comparison {
    /// Fits the model that is chosen to this curve and this spectrum of an axis.
    pub(super) fn of(
        path: &Path,
        axis: &AxisCurve,
        (curve, spectrum): (Curve<OCTAVES>, Spectrum<BINS>),
        (choice, own): (&ModelChoice, &[&'static Own]),
    ) -> Result<Self, Failure> {
        let mut model = choice.model()?;
        for &effect in own {
            model.put(Term::new(effect)).map_err(|error| {
                Failure::option(format!("{}: {error:#}", effect.name()), error.remedy())
            })?;
        }
        check_visible(&model, &curve)?;
        let fail = |error| library_failure(path, &axis.axis, error);
        let compared = |model: &Model| {
            let observed = (curve.clone(), spectrum.clone());
            Compared::beside(axis.clone(), observed, model).map_err(fail)
        };
        Ok(Self {
            compared: compared(&model)?,
            five: compared(&Model::ieee_952())?,
            curve,
        })
    }

    /// The document of the axis that `compare --json` prints.
    ///
    /// # Errors
    /// None occurs, because all numbers can be written.
    pub fn json(&self) -> Result<String, Failure> {
        json(&document(std::slice::from_ref(&self.compared)))
    }

    /// The effects of the model with their fitted shapes, in the options of `compare`.
    pub fn effects(&self) -> Vec<String> {
        let terms = self.compared.model.terms().iter();
        terms.map(effect_argument::written).collect()
    }

    /// The model in words: `five terms without rate ramp + sinusoid`.
    pub fn name(&self) -> String {
        let model = &self.compared.model;
        let five = Model::ieee_952();
        let terms = model.terms().iter();
        let is_replaced = |name: &str| {
            let mut replaced = terms.clone().filter_map(|term| term.effect.replaces());
            replaced.any(|replaced| replaced.name() == name)
        };
        let names = five.terms().iter().map(|term| term.effect.name());
        let gone = names.filter(|name| model.position(name).is_none() && !is_replaced(name));
        let gone: Vec<String> = gone.map(words::plain).collect();
        let without = match gone.as_slice() {
            [] => String::new(),
            gone => format!(" without {}", words::list_of(gone.to_vec())),
        };
        let given = known_filter(model).map(|term| term.effect.name());
        let added = terms
            .clone()
            .map(|term| term.effect.name())
            .filter(|name| five.position(name).is_none() && given != Some(*name));
        let added: String = added
            .map(|name| format!(" + {}", words::plain(name)))
            .collect();
        format!("{}{without}{added}", known_filter::terms(model))
    }

    /// The picture of the record beside the model, as the text of an SVG file.
    pub fn svg(&self) -> String {
        let Compared {
            axis,
            model,
            fit,
            comparison,
            spectrum,
            ..
        } = &self.compared;
        let view = View {
            model,
            fit,
            comparison,
            spectrum,
            errors: &relative_errors(&self.curve, model, fit),
            interval_s: self.curve.interval_s(),
        };
        let both = [&self.five.comparison, comparison];
        let frames = Quantity::ALL
            .into_iter()
            .filter(|quantity| *quantity == Quantity::Deviation || !comparison.bins.is_empty())
            .map(|quantity| Frame::of(quantity, both));
        svg(&[Drawing {
            title: format!("{}: {}", axis.axis, self.name()),
            subtitle: format!(
                "χ² {:.1}, {} degrees of freedom, p {}; {}",
                comparison.chi_squared,
                comparison.degrees_of_freedom,
                shown_p(comparison.p_value),
                words::record(axis.samples, axis.rate_hz, axis.octaves.len()),
            ),
            warning: None,
            unit: axis.unit,
            figures: frames
                .map(|frame| (Figure::new(&view, &frame), frame))
                .collect(),
            course: None,
        }])
    }
}
