//! What the diagnosis thinks of a record, in JSON.

use super::question::with;
use crate::command::diagnose::{
    diagnosed::Diagnosed,
    found::Found,
    words::{Finding, lead},
};
use allanite::{Model, effect::IEEE_952};
use serde::Serialize;

/// The diagnosis of a record, and the model with which it ends in the words of `compare`.
#[derive(Serialize)]
pub(super) struct Thought {
    lead: String,
    findings: Vec<Found>,
    notes: Vec<String>,
    with: Vec<String>,
    without: Vec<String>,
    /// Whether the covariates are taken out.
    taken_out: bool,
}

/// Tells what was found.
pub(super) fn think(diagnosed: &Diagnosed) -> Thought {
    let pairs = diagnosed.steps.windows(2);
    let findings = pairs.filter_map(|pair| Finding::new(diagnosed, &pair[0], &pair[1]));
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
    Thought {
        lead: lead(diagnosed),
        findings: findings.map(Found::from).collect(),
        notes: diagnosed.notes(),
        with: with_texts,
        without,
        taken_out: last.is_some_and(|last| last.covariate.is_some()),
    }
}
