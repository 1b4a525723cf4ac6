//! What a record is, decided once: every command that says whether a model explains a record asks here.

use crate::{curve_file::AxisCurve, diagnose::diagnosed::Diagnosed, verdict, words};
use allanite::{
    Coefficient, Model,
    diagnosis::Verdict,
    effect::Effect,
    fit::{Fit, State},
};

/// The verdict of a diagnosis on an axis, as a command says it that does not show the diagnosis.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// The verdict, as it is written in files.
    pub name: &'static str,
    /// Whether the model that was asked about explains the record. `None` if the record is too short to tell.
    pub adequate: Option<bool>,
    /// The names of the effects and the covariate that the model lacks.
    pub missing: Vec<&'static str>,
    /// What happened during the record, in a sentence.
    pub event: Option<String>,
    /// The model that explains the record, and its fit; `None` if no model does.
    explained: Option<(Model, Fit)>,
}

impl Judgement {
    /// The verdict of a diagnosis.
    pub fn of(diagnosed: &Diagnosed) -> Self {
        let is_disturbed = diagnosed.stationarity.is_disturbed();
        let event = diagnosed.stationarity.strongest(diagnosed.axis.unit);
        let adequate = match diagnosed.verdict {
            _ if is_disturbed => Some(false),
            Verdict::Adequate => Some(true),
            Verdict::TooShort => None,
            _ => Some(false),
        };
        let explains = match diagnosed.verdict {
            _ if is_disturbed => false,
            Verdict::Adequate | Verdict::Improved | Verdict::TooShort => true,
            _ => false,
        };
        let last = diagnosed.steps.last().filter(|_| explains);
        Self {
            name: diagnosed.verdict_name(),
            adequate,
            missing: diagnosed.missing().collect(),
            event: event.filter(|_| is_disturbed),
            explained: last.map(|last| (last.model.clone(), last.fit.clone())),
        }
    }

    /// The coefficient of an effect in the model that explains the record. A filter stands for the white noise that it
    /// replaces. `None` if no model explains the record, or it has no such effect.
    pub fn coefficient(&self, effect: &str) -> Option<&Coefficient> {
        let (model, fit) = self.explained.as_ref()?;
        let replaces = |effect: &'static dyn Effect, name: &str| {
            effect.replaces().is_some_and(|other| other.name() == name)
        };
        let mut terms = model.terms().iter();
        // White noise beside a filter enters behind it, and is not what the filter passes.
        let at = terms
            .position(|term| replaces(term.effect, effect))
            .or_else(|| model.position(effect))?;
        fit.coefficients.get(at)
    }

    /// The standard error of the mean of so many samples, in rate units: their Allan deviation in the model that explains the
    /// record, or that of its longest octave if none does.
    pub fn error_of_mean(&self, axis: &AxisCurve) -> Option<f64> {
        let of_octave = || Some(axis.octaves.last()?.variance);
        let of_model = self.explained.as_ref().map(|(model, fit)| {
            let coefficients = fit.coefficients.iter();
            let shown = |found: &Coefficient| match found.state {
                State::Measured => found.value * found.value,
                _ => 0.0,
            };
            let squares: Vec<f64> = coefficients.map(shown).collect();
            let samples = u32::try_from(axis.samples).unwrap_or(u32::MAX);
            model.variance(&squares, samples, 1.0 / axis.rate_hz)
        });
        let variance = of_model.filter(|&variance| variance > 0.0);
        variance.or_else(of_octave).map(f64::sqrt)
    }

    /// The model that was asked about, in a sentence below its table. `behind` names the filter that it has.
    pub fn sentence(&self, behind: &str) -> String {
        if let Some(event) = &self.event {
            return verdict::of_a_mixture(event);
        }
        let missing = self.missing.iter().map(|name| words::in_sentence(name));
        verdict::of_five_terms(behind, self.adequate, &words::list_of(missing.collect()))
    }
}
