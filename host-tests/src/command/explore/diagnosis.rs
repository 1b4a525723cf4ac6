//! What the diagnosis thinks of a record, in JSON.

use super::{question::with, record::LoadedRecord};
use crate::command::{
    diagnose::{
        diagnosed::Diagnosed,
        found::Found,
        words::{Finding, lead},
    },
    input::record::library_failure,
};
use allanite::{Model, effect::IEEE_952};
use serde::Serialize;
use serde_json::Value;

/// The diagnosis of a record, and the model with which it ends in the words of `compare`.
#[derive(Serialize)]
struct Thought {
    lead: String,
    findings: Vec<Found>,
    notes: Vec<String>,
    with: Vec<String>,
    without: Vec<String>,
    /// What the model does not have, because it is subtracted from the curve.
    beyond: Option<String>,
}

/// Diagnoses a record, or tells again what was found.
///
/// # Errors
/// When the record cannot be fitted, in a line.
pub(super) fn diagnosis(record: &LoadedRecord) -> Result<&Value, String> {
    let thought = record.diagnosed.get_or_init(|| think(record));
    thought.as_ref().map_err(Clone::clone)
}

fn think(record: &LoadedRecord) -> Result<Value, String> {
    let (axis, evidence) = (record.axis.clone(), record.evidence.clone());
    let diagnosed = Diagnosed::new(axis, evidence, &Model::ieee_952(), None)
        .map_err(|error| library_failure(&record.path, &record.axis.axis, error).to_string())?;
    let pairs = diagnosed.steps.windows(2);
    let findings = pairs.filter_map(|pair| Finding::new(&diagnosed, &pair[0], &pair[1]));
    let last = diagnosed.steps.last();
    let five = Model::ieee_952();
    let (mut with_texts, mut without) = (Vec::new(), Vec::new());
    if let Some(last) = last {
        let terms = last.model.terms().iter();
        let is_new = |name: &str| five.position(name).is_none();
        with_texts.extend(terms.filter(|term| is_new(term.effect.name())).map(with));
        let is_replaced = |name: &str| {
            let mut terms = last.model.terms().iter();
            terms.any(|term| {
                term.effect
                    .replaces()
                    .is_some_and(|replaced| replaced.name() == name)
            })
        };
        let names = IEEE_952.iter().map(|effect| effect.name());
        let gone = names.filter(|name| last.model.position(name).is_none() && !is_replaced(name));
        without.extend(gone.map(str::to_owned));
    }
    let beyond = last.and_then(|last| last.covariate).map(|followed| {
        let names = diagnosed.covariate(&followed).join(" and ");
        format!("what follows {names} is subtracted from the curve, which is not done on this page")
    });
    let thought = Thought {
        lead: lead(&diagnosed),
        findings: findings.map(Found::from).collect(),
        notes: diagnosed.notes(),
        with: with_texts,
        without,
        beyond,
    };
    serde_json::to_value(thought).map_err(|error| error.to_string())
}
