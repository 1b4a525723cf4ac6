//! The catalogue of effects, as the page lists it.

use super::record::SessionRecord;
use allanite::effect::{EXPLAINED, Effect, Explanation, IEEE_952};
use allanite_host::words;
use serde::Serialize;

/// An effect with its explanation.
#[derive(Serialize)]
pub(super) struct Listed {
    name: &'static str,
    plain: String,
    symbol: &'static str,
    what: &'static str,
    origin: &'static str,
    check: &'static str,
    /// The term of the model whose place the effect takes.
    replaces: Option<&'static str>,
    is_term: bool,
    parameters: Vec<ListedParameter>,
}

#[derive(Serialize)]
struct ListedParameter {
    name: &'static str,
    /// The name without its unit.
    plain: String,
    unit: &'static str,
    is_whole: bool,
    /// The search range in each record.
    ranges: Vec<[f64; 2]>,
}

/// Every effect that is known, with the ranges of its parameters in each of the records.
pub(super) fn catalogue(records: &[SessionRecord]) -> Vec<Listed> {
    let listed = EXPLAINED.into_iter();
    listed
        .map(|effect| listed_as(effect, effect.explanation(), records))
        .collect()
}

/// How an effect is listed.
pub(super) fn listed_as(
    effect: &dyn Effect,
    explanation: Explanation,
    records: &[SessionRecord],
) -> Listed {
    let name = effect.description().name;
    let parameters = effect.description().parameters.iter();
    let parameters = parameters
        .enumerate()
        .map(|(at, parameter)| ListedParameter {
            name: parameter.name,
            plain: words::without_unit(parameter.name, parameter.unit),
            unit: parameter.unit,
            is_whole: parameter.is_whole,
            ranges: records
                .iter()
                .map(|record| {
                    let range = effect.search_range(at, &record.span());
                    range.map_or([1.0; 2], |range| [range.low, range.high.max(range.low)])
                })
                .collect(),
        });
    Listed {
        name,
        plain: words::plain(name),
        symbol: effect.description().symbol,
        what: explanation.what,
        origin: explanation.origin,
        check: explanation.check,
        replaces: effect
            .description()
            .replaces
            .map(|replaced| replaced.name()),
        is_term: IEEE_952.iter().any(|term| term.name() == name),
        parameters: parameters.collect(),
    }
}
