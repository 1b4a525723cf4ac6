//! The judgement of a lot.

use super::{
    device::{Device, is_invalid},
    limited::{Limited, Rule},
    unusual::{Drift, Drifts, Outlier, outliers, unit_of, worst_first},
};
use crate::command::decode;
use allanite::diagnosis::Verdict;
use allanite_host::{
    confidence::share_is_at_most,
    lot::{Decision, Measurement},
    schema::ReasonName,
    stationarity::{Stationarity, is_disturbed},
};
use allanite_log::unit::Unit;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// A lot with all that its judgement follows from.
pub(super) struct Judged<'a> {
    pub(super) devices: &'a [Device],
    /// The earlier results of these devices, by their identities.
    pub(super) before: &'a BTreeMap<&'a str, &'a Device>,
    pub(super) unit: Unit,
    pub(super) rules: &'a [Rule],
    pub(super) lot: &'a Lot,
}

/// The judgement of a lot. Coefficients are in the unit that is given with them. Programs that read it skip properties that they do
/// not know.
#[derive(Serialize, JsonSchema)]
pub(super) struct Lot {
    /// The number of devices.
    pub(super) devices: usize,
    /// The largest probability that a device at its limit passes, or fails.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub(super) risk: f64,
    /// Devices of which every coefficient passes.
    pub(super) passed: usize,
    /// Devices that a longer record may decide.
    pub(super) guarded: usize,
    /// Devices of which no model explains an axis, so that nothing is decided.
    pub(super) misfit: usize,
    /// Devices with a record in which something happened, so that nothing is decided.
    pub(super) not_stationary: usize,
    /// Devices with a record that is not one of a gyro at rest.
    pub(super) not_valid: usize,
    /// Devices with a coefficient above its limit.
    pub(super) failed: usize,
    /// The share of the devices that passed.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub(super) yield_share: f64,
    /// The ends of its 95 % interval (Clopper & Pearson 1934).
    pub(super) yield_interval: [f64; 2],
    /// Every axis of every limit.
    pub(super) limits: Vec<Limited>,
    /// Coefficients above their limits.
    pub(super) failures: Vec<Failing>,
    /// Coefficients in a guard band: a longer record may decide. The text has only their number.
    pub(super) undecided: Vec<Undecided>,
    /// Axes whose records are not valid. Nothing is decided of them, and they are left out of all that follows.
    pub(super) invalid: Vec<Invalid>,
    /// Axes during whose records something happened. They are left out as well.
    pub(super) disturbed: Vec<Disturbed>,
    /// Axes that a diagnosis did not explain. Nothing is decided of these either.
    pub(super) unexplained: Vec<Named>,
    /// Devices that are unlike the others.
    pub(super) outliers: Vec<Outlier>,
    /// The number of devices of which there is an earlier certificate.
    pub(super) compared: usize,
    /// The number of coefficients of them that were compared.
    pub(super) comparisons: usize,
    /// The number of standard errors from which on a coefficient has drifted.
    pub(super) drift_threshold: f64,
    /// Coefficients that have drifted, the most significant one first.
    pub(super) drifted: Vec<Drift>,
    /// How many devices have an effect that the five terms lack.
    pub(super) found: BTreeMap<&'static str, usize>,
}

/// A device that failed a limit.
#[derive(Serialize, JsonSchema)]
pub(super) struct Failing {
    pub(super) device: String,
    pub(super) axis: String,
    pub(super) effect: &'static str,
    pub(super) value: f64,
    /// The 95 % interval.
    pub(super) interval: [f64; 2],
    pub(super) unit: String,
}

/// A coefficient of a device that its record does not decide.
#[derive(Serialize, JsonSchema)]
pub(super) struct Undecided {
    pub(super) device: String,
    pub(super) axis: String,
    pub(super) effect: &'static str,
}

/// An axis of a device.
#[derive(Serialize, JsonSchema)]
pub(super) struct Named {
    pub(super) device: String,
    pub(super) axis: String,
}

/// An axis during whose record something happened.
#[derive(Serialize, JsonSchema)]
pub(super) struct Disturbed {
    pub(super) device: String,
    pub(super) axis: String,
    /// The strongest event, in words.
    pub(super) words: String,
}

/// An axis whose record is not valid.
#[derive(Serialize, JsonSchema)]
pub(super) struct Invalid {
    pub(super) device: String,
    pub(super) axis: String,
    /// Why, in a word and in a sentence.
    #[schemars(with = "ReasonName")]
    pub(super) reason: &'static str,
    pub(super) words: String,
}

impl Lot {
    /// Judges devices by the rules of their limits at a risk, and compares them with their earlier certificates. Of several earlier ones of a
    /// device the last one counts.
    pub(super) fn new(
        devices: &[Device],
        earlier: &[Device],
        unit: Unit,
        rules: &[Rule],
        risk: f64,
    ) -> Self {
        let worst = |device: &Device| {
            let axes = 0..device.certificate.axes.len();
            let decisions =
                axes.flat_map(|axis| rules.iter().map(move |rule| rule.decision(device, axis)));
            // A certificate without axes says nothing.
            decisions.max().unwrap_or(Decision::Guarded)
        };
        let decisions: Vec<Decision> = devices.iter().map(worst).collect();
        let count = |wanted| decisions.iter().filter(|one| **one == wanted).count();
        let (passed, all) = (count(Decision::Passed), devices.len());
        let share = passed as f64 / all as f64;
        let at_most = |share| share_is_at_most(share, all as u64, 0.975);
        let drifts = Drifts::of(devices, earlier);
        let rows = rules.iter().flat_map(|rule| {
            (0..rule.axes()).map(move |axis| Limited::of(devices, unit, axis, rule))
        });
        Self {
            devices: all,
            risk,
            passed,
            guarded: count(Decision::Guarded),
            misfit: count(Decision::Misfit),
            not_stationary: count(Decision::NotStationary),
            not_valid: count(Decision::Invalid),
            failed: count(Decision::Failed),
            yield_share: share,
            // At either end lies half of the 5 %.
            yield_interval: [1.0 - at_most(1.0 - share), at_most(share)],
            limits: rows.collect(),
            failures: failures(devices, rules),
            undecided: undecided(devices, rules),
            invalid: invalid(devices),
            disturbed: disturbed(devices),
            unexplained: named(devices, |verdict| {
                matches!(verdict, Verdict::Unexplained | Verdict::Incomplete)
            }),
            outliers: outliers(devices),
            compared: drifts.devices,
            comparisons: drifts.comparisons,
            drift_threshold: drifts.threshold,
            drifted: drifts.drifted,
            found: found(devices),
        }
    }
}

/// The axes whose records are not valid, a line for those of a device that have one reason.
pub(super) fn reasons(invalid: &[Invalid]) -> Vec<String> {
    let is_same =
        |one: &Invalid, other: &Invalid| (&one.device, &one.words) == (&other.device, &other.words);
    let line = |axes: &[Invalid]| {
        let names: Vec<&str> = axes.iter().map(|one| one.axis.as_str()).collect();
        let first = axes.first()?;
        Some(format!(
            "{} {}: {}",
            first.device,
            names.join(", "),
            first.words
        ))
    };
    invalid.chunk_by(is_same).filter_map(line).collect()
}

fn named(devices: &[Device], wanted: fn(Verdict) -> bool) -> Vec<Named> {
    let axes = devices.iter().flat_map(|device| {
        device.axes_with(wanted).map(|axis| Named {
            device: device.id.clone(),
            axis: decode::axis_name(axis),
        })
    });
    axes.collect()
}

/// The valid axes during whose records something happened.
fn disturbed(devices: &[Device]) -> Vec<Disturbed> {
    let axes = devices.iter().flat_map(|device| {
        let axes = device.certificate.axes.iter().enumerate();
        let disturbed = axes.filter(|(_, axis)| !is_invalid(axis) && is_disturbed(axis));
        disturbed.map(|(place, axis)| Disturbed {
            device: device.id.clone(),
            axis: decode::axis_name(place),
            words: Stationarity::certified(axis)
                .strongest(device.unit)
                .unwrap_or_default(),
        })
    });
    axes.collect()
}

/// The axes whose records are not valid.
fn invalid(devices: &[Device]) -> Vec<Invalid> {
    let axes = devices.iter().flat_map(|device| {
        let axes = device.certificate.axes.iter().enumerate();
        axes.filter_map(|(place, axis)| match axis.verdict {
            Some(Verdict::Invalid(reason)) => Some(Invalid {
                device: device.id.clone(),
                axis: decode::axis_name(place),
                reason: reason.name(),
                words: reason.to_string(),
            }),
            _ => None,
        })
    });
    axes.collect()
}

/// Devices beyond their limits, the farthest one first.
fn failures(devices: &[Device], rules: &[Rule]) -> Vec<Failing> {
    let mut failures: Vec<(f64, Failing)> = Vec::new();
    for device in devices {
        for ((axis, effect), term) in device.terms() {
            let rule = rules.iter().find(|rule| rule.limit.effect.name() == effect);
            let Some((rule, known)) = rule.zip(Measurement::of(term)) else {
                continue;
            };
            if rule.decision(device, axis) == Decision::Failed {
                let failing = Failing {
                    device: device.id.clone(),
                    axis: decode::axis_name(axis),
                    effect,
                    value: known.value(),
                    interval: [known.lower(), known.upper()],
                    unit: unit_of(term, device.unit),
                };
                failures.push((known.value() / rule.limit.value, failing));
            }
        }
    }
    worst_first(failures)
}

fn undecided(devices: &[Device], rules: &[Rule]) -> Vec<Undecided> {
    let mut undecided = Vec::new();
    for device in devices {
        for axis in 0..device.certificate.axes.len() {
            for rule in rules {
                let effect = rule.limit.effect.name();
                if rule.decision(device, axis) == Decision::Guarded {
                    undecided.push(Undecided {
                        device: device.id.clone(),
                        axis: decode::axis_name(axis),
                        effect,
                    });
                }
            }
        }
    }
    undecided
}

fn found(devices: &[Device]) -> BTreeMap<&'static str, usize> {
    let mut found = BTreeMap::new();
    for device in devices {
        let axes = device.certificate.axes.iter();
        let names: BTreeSet<&str> = axes
            .flat_map(|axis| axis.found().map(|term| term.effect.name()))
            .collect();
        for name in names {
            *found.entry(name).or_default() += 1;
        }
    }
    found
}
