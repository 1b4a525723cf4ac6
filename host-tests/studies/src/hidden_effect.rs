//! Studies whether a hidden effect is found and named.

use super::{OCTAVES, RATE_HZ, expected_curve, measured::Measured, theory::squares};
use allanite::{
    Comparison, Model, Record, Term,
    diagnosis::{Addition, Step, Verdict},
    effect::{BiasInstability, CATALOGUE, EXPLAINED, Effect, IEEE_952, MAX_PARAMETERS},
    fit::{Fit, Options, fit},
};
use allanite_host::{
    diagnosis,
    quantile::quantile,
    simulate::{Coefficients, Hidden, Preset, Simulator},
};
use allanite_log::BINS;
use rayon::prelude::*;

/// The number of samples of a record, which is 11 minutes long.
pub const SAMPLES: usize = 1 << 16;

/// The strength of a hidden effect: the expected χ² of the five-term fit less its degrees of
/// freedom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strength {
    /// The five-term fit has a median p-value of 1e-6 or less.
    Moderate,
    /// The five-term fit has a χ² of 300 or more.
    Strong,
}

impl Strength {
    /// Both strengths.
    pub const ALL: [Self; 2] = [Self::Moderate, Self::Strong];

    fn noncentrality(self) -> f64 {
        match self {
            Self::Moderate => 50.0,
            Self::Strong => 400.0,
        }
    }
}

/// The names and shapes of the effects that are hidden: the typical shapes of every effect in the
/// catalogue beyond the five terms that a diagnosis looks for.
pub fn cases() -> impl Iterator<Item = (&'static str, [f64; MAX_PARAMETERS])> {
    let is_term = |name: &str| IEEE_952.iter().any(|term| term.name() == name);
    let effects = EXPLAINED
        .into_iter()
        .map(|effect| (effect.description().name, effect.typical_shapes()));
    effects
        .filter(move |(name, _)| !is_term(name))
        .flat_map(|(name, shapes)| shapes.iter().map(move |shape| (name, *shape)))
}

/// The effect of a case at the given strength. The search varies the amplitude, or the first shape
/// parameter for an effect that replaces white noise, until the five-term χ² is as large as
/// required. Returns `None` if no value is large enough, as for a filter on a gyro without white
/// noise.
pub fn hide(
    name: &str,
    parameters: [f64; MAX_PARAMETERS],
    preset: Preset,
    strength: Strength,
) -> Option<Hidden> {
    let base = preset.coefficients();
    let template = Hidden::new(name, parameters, base.angle_random_walk)?;
    let at = |size: f64| {
        let mut hidden = template;
        if hidden.replaces_white_noise() {
            hidden.parameters[0] = size;
        } else {
            hidden.coefficient = size;
        }
        hidden
    };
    let (mut low, mut high) = if template.replaces_white_noise() {
        (0.1 / RATE_HZ, 30.0 / RATE_HZ)
    } else {
        (1e-3 * base.angle_random_walk, 1e3 * base.angle_random_walk)
    };
    let target = strength.noncentrality();
    if expected_chi_squared(&at(high), base) < target {
        return None;
    }
    for _ in 0..30 {
        let middle = (low * high).sqrt();
        if expected_chi_squared(&at(middle), base) < target {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(at(high))
}

/// The χ² of the five-term fit on the expected curve with a hidden effect.
fn expected_chi_squared(hidden: &Hidden, base: Coefficients) -> f64 {
    let model = Model::ieee_952();
    let mut squares = squares(base);
    if hidden.replaces_white_noise() {
        squares[1] = 0.0;
    }
    if hidden.replaces(&BiasInstability) {
        squares[2] = 0.0;
    }
    let term = Term {
        parameters: hidden.parameters,
        ..Term::new(hidden.effect)
    };
    let shape = term.sampled_shape(1.0 / RATE_HZ);
    let curve = expected_curve(SAMPLES, |m| {
        let effect = hidden.effect.variance(f64::from(m), &shape) * hidden.coefficient.powi(2);
        model.variance(&squares, m, 1.0 / RATE_HZ) + effect
    });
    fit(&curve, &model, Options::default()).map_or(0.0, |fit| fit.chi_squared)
}

/// The result of a diagnosis of one record.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The χ² and the p-value of the five-term fit.
    pub first: (f64, f64),
    /// The effects that were added, each with the names of the effects that explain the curve as
    /// well.
    pub added: Vec<(Term, Vec<&'static str>)>,
    /// The fit of the last model.
    pub fit: Fit,
    /// The last model.
    pub model: Model,
    /// The root-mean-square misfit before and after the diagnosis, in percent, on the record and on
    /// a second one.
    pub rms: [(f64, f64); 2],
    /// The χ² before and after the diagnosis, on the second record.
    pub held_out: (f64, f64),
    /// The verdict, or `None` if the diagnosis failed.
    pub verdict: Option<Verdict>,
}

/// Diagnoses a simulated record, and judges the result on a second record of the same gyro.
pub fn diagnose(base: Coefficients, hidden: &[Hidden], samples: usize, seed: u64) -> Outcome {
    let options = allanite::diagnosis::Options::default();
    diagnose_with(base, hidden, samples, seed, options)
}

/// As [`diagnose`], with these options.
pub fn diagnose_with(
    base: Coefficients,
    hidden: &[Hidden],
    samples: usize,
    seed: u64,
    options: allanite::diagnosis::Options,
) -> Outcome {
    let mut simulator = Simulator::with_hidden(base, hidden, RATE_HZ, seed);
    let [measured, other] = std::array::from_fn(|_| Measured::of(&mut simulator, base, samples));
    let (steps, verdict) = steps(&measured, options);
    let (first, last) = (&steps[0], &steps[steps.len() - 1]);
    let on_other = |step: &Step<OCTAVES, BINS>| {
        let tolerance = Options::default().tolerance;
        let other = Record::new(&other.curve, &other.spectrum);
        let comparison = Comparison::held_out(other, &step.model, &step.fit, tolerance);
        comparison.map_or((f64::NAN, f64::NAN), |c| (c.rms_percent, c.chi_squared))
    };
    let (before, after) = (on_other(first), on_other(last));
    Outcome {
        first: (first.fit.chi_squared, first.fit.p_value),
        added: added(&steps),
        fit: last.fit.clone(),
        model: last.model.clone(),
        rms: [
            (first.comparison.rms_percent, last.comparison.rms_percent),
            (before.0, after.0),
        ],
        held_out: (before.1, after.1),
        verdict,
    }
}

/// The steps of a diagnosis of a record, and its verdict.
pub(super) fn steps(
    measured: &Measured,
    options: allanite::diagnosis::Options,
) -> (Vec<Step<OCTAVES, BINS>>, Option<Verdict>) {
    let mut steps = Vec::new();
    let (record, model) = (measured.record(), Model::ieee_952());
    let verdict = diagnosis::diagnose(record, &model, &CATALOGUE, options, |step| {
        steps.push(step.clone());
    });
    (steps, verdict.ok())
}

/// The effects that the steps added, each with the names of those that explain the record as well.
pub(super) fn added(steps: &[Step<OCTAVES, BINS>]) -> Vec<(Term, Vec<&'static str>)> {
    let added = steps.iter().filter_map(|step| match step.added {
        Some(Addition::Effect(term)) => Some((term, step.ambiguous.to_vec())),
        _ => None,
    });
    added.collect()
}

/// The counts and errors over the records of one case.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// The number of records.
    pub records: usize,
    /// The median χ² and p-value of the five-term fit.
    pub median: (f64, f64),
    /// The number of records in which the effect was named alone.
    pub right: usize,
    /// The number of records in which the effect was named together with others that explain the
    /// curve as well.
    pub ambiguous: usize,
    /// The number of records in which only other effects were named.
    pub wrong: usize,
    /// The number of records in which no effect was named.
    pub missed: usize,
    /// The median relative error of each shape parameter.
    pub parameter_error: Vec<f64>,
    /// The share of the shape parameters' intervals that contain the true value.
    pub parameter_coverage: Vec<f64>,
    /// The median relative error of the coefficient.
    pub coefficient_error: f64,
    /// The share of the coefficient's intervals that contain the true value.
    pub coefficient_coverage: f64,
    /// The median root-mean-square misfit before and after the diagnosis, in percent, on the record
    /// and on a second one.
    pub rms: [(f64, f64); 2],
    /// The share of records whose χ² on a second record falls, among those in which the effect was
    /// found.
    pub held_out_falls: f64,
}

/// Diagnoses `records` records with a hidden effect.
pub fn study(preset: Preset, hidden: &Hidden, records: u64) -> Tally {
    let base = preset.coefficients();
    let outcomes: Vec<Outcome> = (0..records)
        .into_par_iter()
        .map(|seed| diagnose(base, &[*hidden], SAMPLES, seed))
        .collect();
    tally(&outcomes, hidden)
}

fn tally(outcomes: &[Outcome], hidden: &Hidden) -> Tally {
    let name = hidden.effect.name();
    let mut tally = Tally {
        records: outcomes.len(),
        median: (
            median(outcomes.iter().map(|o| o.first.0)),
            median(outcomes.iter().map(|o| o.first.1)),
        ),
        rms: [0, 1].map(|i| {
            (
                median(outcomes.iter().map(|o| o.rms[i].0)),
                median(outcomes.iter().map(|o| o.rms[i].1)),
            )
        }),
        ..Tally::default()
    };
    let mut found = Vec::new();
    for outcome in outcomes {
        let added = outcome.added.iter();
        let exact = added
            .clone()
            .find(|(term, _)| same(term.effect, hidden.effect));
        let named = added.clone().any(|(_, others)| others.contains(&name));
        match exact {
            Some((_, others)) if others.is_empty() => tally.right += 1,
            Some(_) => tally.ambiguous += 1,
            None if named => tally.ambiguous += 1,
            None if outcome.added.is_empty() => tally.missed += 1,
            None => tally.wrong += 1,
        }
        if exact.is_some() {
            found.push(outcome);
        }
    }
    let falls = found.iter().filter(|o| o.held_out.1 < o.held_out.0).count();
    tally.held_out_falls = falls as f64 / found.len().max(1) as f64;
    let coefficients = || {
        found.iter().filter_map(|o| {
            let at = o.model.position(name)?;
            Some(o.fit.coefficients[at])
        })
    };
    tally.coefficient_error =
        median(coefficients().map(|c| (c.value / hidden.coefficient - 1.0).abs()));
    tally.coefficient_coverage =
        share(coefficients().map(|c| (c.lower..=c.upper).contains(&hidden.coefficient)));
    for (j, parameter) in hidden.effect.parameters().iter().enumerate() {
        let truth = hidden.parameters[j];
        let estimates = || {
            found.iter().filter_map(|o| {
                let at = o.model.position(name)?;
                o.fit
                    .shape
                    .iter()
                    .find(|s| s.term == at && s.name == parameter.name)
                    .copied()
            })
        };
        tally
            .parameter_error
            .push(median(estimates().map(|s| (s.value / truth - 1.0).abs())));
        tally.parameter_coverage.push(share(
            estimates().map(|s| (s.lower..=s.upper).contains(&truth)),
        ));
    }
    tally
}

fn same(a: &dyn Effect, b: &dyn Effect) -> bool {
    a.name() == b.name()
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    if values.is_empty() {
        return f64::NAN;
    }
    values.sort_by(f64::total_cmp);
    quantile(&values, 0.5)
}

fn share(values: impl Iterator<Item = bool>) -> f64 {
    let values: Vec<bool> = values.collect();
    values.iter().filter(|&&value| value).count() as f64 / values.len().max(1) as f64
}

/// The share of records in which an effect is named although none is hidden, and how often each
/// effect is the first to be named.
pub fn false_alarms(preset: Preset, records: u64) -> (f64, Vec<(&'static str, usize)>) {
    let claims: Vec<&'static str> = (0..records)
        .into_par_iter()
        .filter_map(|seed| {
            let outcome = diagnose(preset.coefficients(), &[], SAMPLES, seed);
            outcome.added.first().map(|(term, _)| term.effect.name())
        })
        .collect();
    let mut counts: Vec<(&'static str, usize)> = Vec::new();
    for name in &claims {
        match counts.iter_mut().find(|(other, _)| other == name) {
            Some((_, count)) => *count += 1,
            None => counts.push((name, 1)),
        }
    }
    (claims.len() as f64 / records as f64, counts)
}

/// The share of records in which both of two strong hidden effects are found.
pub fn both_found(preset: Preset, records: u64) -> Option<f64> {
    let base = preset.coefficients();
    let one = hide("sinusoid", [7.7, 0.0, 0.0], preset, Strength::Strong)?;
    let other = hide(
        "decimation_filter",
        [0.03, 2.0, 0.0],
        preset,
        Strength::Strong,
    )?;
    let both = |&seed: &u64| {
        let outcome = diagnose(base, &[one, other], SAMPLES, seed);
        let named = |hidden: &Hidden| {
            let name = hidden.effect.name();
            let mut added = outcome.added.iter();
            added.any(|(term, others)| term.effect.name() == name || others.contains(&name))
        };
        named(&one) && named(&other)
    };
    let count = (0..records).into_par_iter().filter(both).count();
    Some(count as f64 / records as f64)
}
