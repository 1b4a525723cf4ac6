//! Studies which name a hidden effect of a fixed size gets, and what is named beside it.

use super::{
    RATE_HZ,
    hidden_effect::{Outcome, diagnose},
};
use allanite::effect::MAX_PARAMETERS;
use allanite_host::{
    quantile::quantile,
    simulate::{Hidden, Preset},
};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// The number of samples of a record, which is 22 minutes long.
pub const SAMPLES: usize = 1 << 17;

/// The effects of a case: name, shape, and size. The size is that of the coefficient, in standard deviations of the
/// white noise of a sample; an effect that replaces white noise keeps its coefficient.
type Case = &'static [(&'static str, [f64; MAX_PARAMETERS], f64)];

/// The effects that are hidden.
pub const CASES: [Case; 21] = [
    &[],
    &[("sinusoid", [0.3, 0.0, 0.0], 0.2)],
    &[("sinusoid", [7.7, 0.0, 0.0], 0.2)],
    &[("sinusoid", [33.0, 0.0, 0.0], 0.2)],
    &[("sinusoid", [33.0, 0.0, 0.0], 1.0)],
    &[
        ("sinusoid", [7.7, 0.0, 0.0], 0.4),
        ("sinusoid", [0.9, 0.0, 0.0], 0.2),
    ],
    &[("resonance", [5.0, 3.0, 0.0], 1.0)],
    &[("resonance", [20.0, 20.0, 0.0], 0.5)],
    &[("low_pass", [0.02, 1.0, 0.0], 1.0)],
    &[("low_pass", [0.02, 2.0, 0.0], 1.0)],
    &[("low_pass", [0.02, 3.0, 0.0], 1.0)],
    &[("low_pass", [0.02, 4.0, 0.0], 1.0)],
    &[("notch", [30.0, 2.0, 0.0], 1.0)],
    &[("decimation_filter", [0.03, 1.0, 0.0], 1.0)],
    // Two boxcars of three samples: the width counts the single boxcar that spreads a pulse as far.
    &[("decimation_filter", [0.042_426, 2.0, 0.0], 1.0)],
    &[("gauss_markov", [0.1, 0.0, 0.0], 0.3)],
    &[("gauss_markov", [1.0, 0.0, 0.0], 0.3)],
    &[("random_telegraph", [0.1, 0.0, 0.0], 0.5)],
    &[("random_telegraph", [1.0, 0.0, 0.0], 0.5)],
    &[("power_law", [1.5, 0.0, 0.0], 0.1)],
    &[
        ("resonance", [20.0, 14.0, 0.0], 0.8),
        ("decimation_filter", [0.0165, 2.0, 0.0], 1.0),
    ],
];

/// What was named in the records of one case.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// The number of records.
    pub records: usize,
    /// The hidden effects and nothing else, and nothing ambiguous.
    pub alone: usize,
    /// The hidden effects and nothing else, but another effect would explain the record as well.
    pub ambiguous: usize,
    /// The hidden effects, and another one beside them.
    pub beside: usize,
    /// Other effects, without one that is hidden.
    pub wrong: usize,
    /// Nothing.
    pub nothing: usize,
    /// The median and the 95 % quantile of the relative error of the first effect's shape parameters.
    pub errors: Vec<(f64, f64)>,
    /// What was named otherwise, and how often.
    pub names: BTreeMap<String, usize>,
}

/// Diagnoses records of a case. An effect that the preset lacks what it replaces for is left out.
pub fn study(preset: Preset, case: Case, records: u64) -> Tally {
    let base = preset.coefficients();
    let white = base.angle_random_walk * RATE_HZ.sqrt();
    let effect = |&(name, parameters, size): &(&str, [f64; MAX_PARAMETERS], f64)| {
        let mut hidden = Hidden::new(name, parameters, base.angle_random_walk)?;
        if !hidden.replaces_white_noise() {
            hidden.coefficient = size * white;
        }
        Some(hidden)
    };
    let hidden: Vec<Hidden> = case.iter().filter_map(effect).collect();
    let outcomes: Vec<Outcome> = (0..records)
        .into_par_iter()
        .map(|seed| diagnose(base, &hidden, SAMPLES, seed))
        .collect();
    let mut expected: Vec<&str> = hidden.iter().map(|one| one.effect.name()).collect();
    expected.sort_unstable();
    let mut tally = Tally::default();
    let mut errors = [const { Vec::new() }; MAX_PARAMETERS];
    for outcome in &outcomes {
        tally.records += 1;
        let mut named: Vec<&str> = outcome
            .added
            .iter()
            .map(|(term, _)| term.effect.name())
            .collect();
        named.sort_unstable();
        let is_ambiguous = outcome.added.iter().any(|(_, others)| !others.is_empty());
        let has_all = {
            let mut rest = named.clone();
            expected.iter().all(|name| {
                let at = rest.iter().position(|other| other == name);
                at.map(|at| rest.remove(at)).is_some()
            })
        };
        let place = if named == expected {
            if is_ambiguous {
                &mut tally.ambiguous
            } else {
                &mut tally.alone
            }
        } else if named.is_empty() {
            &mut tally.nothing
        } else if has_all {
            &mut tally.beside
        } else {
            &mut tally.wrong
        };
        *place += 1;
        if named != expected || is_ambiguous {
            let others = outcome
                .added
                .iter()
                .flat_map(|(_, others)| others.iter().copied());
            let others: Vec<&str> = others.collect();
            let mut name = if named.is_empty() {
                "nothing".to_owned()
            } else {
                named.join(" + ")
            };
            if !others.is_empty() {
                name += &format!(" or {}", others.join(", "));
            }
            *tally.names.entry(name).or_default() += 1;
        }
        let Some(first) = hidden.first() else {
            continue;
        };
        let mut terms = outcome.model.terms().iter();
        if let Some(term) = terms.find(|term| term.effect.name() == first.effect.name()) {
            for (j, errors) in errors.iter_mut().enumerate() {
                let truth = first.parameters[j];
                if truth > 0.0 {
                    errors.push((term.parameters[j] / truth - 1.0).abs());
                }
            }
        }
    }
    tally.errors = errors
        .into_iter()
        .filter(|errors: &Vec<f64>| !errors.is_empty())
        .map(|mut errors| {
            errors.sort_by(f64::total_cmp);
            (quantile(&errors, 0.5), quantile(&errors, 0.95))
        })
        .collect();
    tally
}
