//! What the page asks: a model, in the words of `compare`, and the records to see it beside.

use crate::command::{compare::model::ModelArguments, effect_argument::EffectArgument};
use allanite::{Model, Term};
use allanite_log::failure::Failure;
use clap::ValueEnum;
use serde::Deserialize;

pub(super) use crate::command::effect_argument::written as with;

/// What can be asked for about a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum What {
    /// The fit with its figures, in JSON.
    Fit,
    /// The figures, as SVG.
    Drawing,
    /// The points of the figures, as CSV.
    Table,
}

/// A model and the records beside which it is to be seen.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Question {
    /// The record to which the model is fitted.
    pub(super) record: usize,
    /// The records that judge the model: no coefficient is fitted to them.
    #[serde(default)]
    pub(super) judged: Vec<usize>,
    /// The values of `--with`.
    #[serde(default)]
    pub(super) with: Vec<String>,
    /// The values of `--without`.
    #[serde(default)]
    pub(super) without: Vec<String>,
    /// Whether what follows the covariates is taken out of the record.
    #[serde(default)]
    pub(super) taken_out: bool,
}

impl Question {
    /// Reads a question about some of so many records.
    ///
    /// # Errors
    /// When the JSON is not that of a question, or when there is no such record.
    pub(super) fn parse(json: &[u8], records: usize) -> Result<Self, Failure> {
        let mut question: Self = serde_json::from_slice(json).map_err(|error| {
            Failure::option(
                format!("the request is not understood: {error}"),
                "send a record, with and without",
            )
        })?;
        let asked = question.judged.iter().chain([&question.record]);
        if let Some(record) = asked.copied().find(|record| *record >= records) {
            return Err(Failure::option(
                format!("there is no record {record}"),
                format!("give a number from 0 to {}", records.saturating_sub(1)),
            ));
        }
        question.judged.sort_unstable();
        question.judged.dedup();
        question.judged.retain(|judged| *judged != question.record);
        Ok(question)
    }

    /// The model, as `compare` builds it.
    ///
    /// # Errors
    /// Those of `compare`.
    pub(super) fn model(&self) -> Result<Model, Failure> {
        ModelArguments::new(self.with.clone(), self.without.clone()).model()
    }

    /// The terms of a model that the values of `--with` added, in their order, each with its place.
    pub(super) fn added<'a>(&self, model: &'a Model) -> Vec<(usize, &'a Term)> {
        let mut taken = Vec::new();
        for text in &self.with {
            let name = EffectArgument::name_in(text);
            let mut terms = model.terms().iter().enumerate();
            let added = terms.find(|(place, term)| {
                term.effect.name() == name && !taken.iter().any(|(other, _)| other == place)
            });
            taken.extend(added);
        }
        taken
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn questions_are_read_in_the_words_of_compare_and_written_back_exactly() {
        let json = br#"{"record":1,"judged":[2,0,2,1],"with":["sinusoid:frequency_hz~19.3",
            "low_pass:cutoff_hz=20,poles=2","sinusoid:frequency_hz=0.1"],"without":["rate_ramp"]}"#;
        let question = Question::parse(json, 3).expect("a question");
        assert_eq!(question.judged, [0, 2]);
        let model = question.model().expect("a model");
        let added = question.added(&model);
        let places: Vec<usize> = added.iter().map(|(place, _)| *place).collect();
        assert_eq!(places, [4, 1, 5]);
        let written: Vec<String> = added.iter().map(|(_, term)| with(term)).collect();
        assert_eq!(written[0], "sinusoid:frequency_hz~19.3");
        assert!(
            written[1].starts_with("low_pass:time_constant_s=0.00795774"),
            "{}",
            written[1]
        );
        assert!(written[1].ends_with(",poles=2"));
        let again = ModelArguments::new(written, vec!["rate_ramp".into()]).model();
        let again = again.expect("the same model");
        for (one, other) in model.terms().iter().zip(again.terms()) {
            assert_eq!(one.effect.name(), other.effect.name());
            assert_eq!(
                (one.parameters, one.fitted),
                (other.parameters, other.fitted)
            );
        }
    }
}
