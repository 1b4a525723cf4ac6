//! The judgement of a lot.

use super::{
    limit::Limit,
    statistics::{Values, significant},
};
use crate::{
    command::{decode, output::units},
    confidence::share_is_at_most,
    unit::Unit,
};
use allanite::storage::{Certificate, CertifiedState, CertifiedTerm};
use serde::Serialize;
use std::{
    collections::{BTreeMap, BTreeSet},
    path::PathBuf,
};

/// A device of a lot.
pub(super) struct Device {
    pub(super) id: String,
    pub(super) unit: Unit,
    pub(super) file: PathBuf,
    pub(super) certificate: Certificate,
}

/// What one coefficient of one axis is called.
type Place = (usize, &'static str);

impl Device {
    /// The terms of all axes, each with its place.
    fn terms(&self) -> impl Iterator<Item = (Place, &CertifiedTerm)> {
        let axes = self.certificate.axes.iter().enumerate();
        axes.flat_map(|(i, axis)| {
            axis.terms
                .iter()
                .map(move |term| ((i, term.effect.name()), term))
        })
    }

    fn term(&self, place: Place) -> Option<&CertifiedTerm> {
        self.terms()
            .find(|(other, _)| *other == place)
            .map(|(_, term)| term)
    }
}

/// A device beside a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Verdict {
    Passed,
    /// The interval includes the limit, or the certificate does not have the coefficient.
    Guarded,
    Failed,
}

/// The verdict on a term. The decision rule is that of guarded acceptance (JCGM 106:2012, 8.3.2).
fn verdict(term: Option<&CertifiedTerm>, limit: f64) -> Verdict {
    let Some(term) = term else {
        return Verdict::Guarded;
    };
    match term.state {
        CertifiedState::NotObservable { .. } => Verdict::Guarded,
        _ if f64::from(term.upper) <= limit => Verdict::Passed,
        _ if f64::from(term.lower) > limit => Verdict::Failed,
        _ => Verdict::Guarded,
    }
}

/// The judgement of a lot. Coefficients are in the unit that is told beside them.
#[derive(Serialize)]
pub(super) struct Lot {
    pub(super) devices: usize,
    /// Devices by their worst coefficient.
    pub(super) passed: usize,
    pub(super) guarded: usize,
    pub(super) failed: usize,
    /// The share of devices that passed, and the ends of its 95 % interval (Clopper & Pearson 1934).
    pub(super) yield_share: f64,
    pub(super) yield_interval: [f64; 2],
    pub(super) limits: Vec<Limited>,
    pub(super) failures: Vec<Failing>,
    pub(super) outliers: Vec<Outlier>,
    /// The number of devices of which there is an earlier certificate.
    pub(super) compared: usize,
    /// The number of standard errors from which on a coefficient has drifted.
    pub(super) significant: f64,
    pub(super) drifted: Vec<Drift>,
    /// How many devices have an effect that the five terms lack.
    pub(super) found: BTreeMap<&'static str, usize>,
}

/// A coefficient of one axis beside its limit.
#[derive(Serialize)]
pub(super) struct Limited {
    pub(super) axis: String,
    pub(super) effect: &'static str,
    pub(super) unit: String,
    pub(super) limit: f64,
    pub(super) passed: usize,
    pub(super) guarded: usize,
    pub(super) failed: usize,
    /// The number of devices in which it is measured.
    pub(super) measured: usize,
    /// Percentiles of the measured values: 2.5, 50 and 97.5 %.
    pub(super) percentiles: Option<[f64; 3]>,
    pub(super) cpk: Option<f64>,
    /// The median distance from a value to the upper end of its interval: a device whose value lies that far below the
    /// limit usually passes.
    pub(super) guard_band: Option<f64>,
}

/// A device that failed a limit.
#[derive(Serialize)]
pub(super) struct Failing {
    pub(super) device: String,
    pub(super) axis: String,
    pub(super) effect: &'static str,
    pub(super) value: f64,
    pub(super) interval: [f64; 2],
    pub(super) unit: String,
}

/// A device whose coefficient is far from those of the others, its whole 95 % interval included.
#[derive(Serialize)]
pub(super) struct Outlier {
    pub(super) device: String,
    pub(super) axis: String,
    pub(super) effect: &'static str,
    pub(super) value: f64,
    pub(super) median: f64,
    pub(super) unit: String,
}

/// A device whose coefficient has changed since its earlier certificate.
#[derive(Serialize)]
pub(super) struct Drift {
    pub(super) device: String,
    pub(super) axis: String,
    pub(super) effect: &'static str,
    pub(super) before: f64,
    pub(super) now: f64,
    /// The change of the squared coefficient in standard errors of it.
    pub(super) z: f64,
    pub(super) unit: String,
}

fn is_measured(term: &CertifiedTerm) -> bool {
    term.state == CertifiedState::Measured
}

fn unit(term: &CertifiedTerm, unit: Unit) -> String {
    let effect = term.effect.effect();
    effect.map_or(String::new(), |effect| {
        units::unit(unit, effect.half_seconds())
    })
}

impl Lot {
    /// Judges devices by limits, and compares them with their earlier certificates. Of several earlier ones of a device
    /// the last one counts.
    pub(super) fn new(devices: &[Device], earlier: &[Device], limits: &[Limit]) -> Self {
        let worst = |device: &Device| {
            let axes = 0..device.certificate.axes.len();
            let verdicts = axes.flat_map(|axis| {
                limits
                    .iter()
                    .map(move |limit| verdict(device.term((axis, limit.effect)), limit.value))
            });
            // A certificate without axes says nothing.
            verdicts.max().unwrap_or(Verdict::Guarded)
        };
        let verdicts: Vec<Verdict> = devices.iter().map(worst).collect();
        let count = |wanted| {
            verdicts
                .iter()
                .filter(|verdict| **verdict == wanted)
                .count()
        };
        let (passed, all) = (count(Verdict::Passed), devices.len());
        let share = passed as f64 / all as f64;
        let at_most = |share| share_is_at_most(share, all as u64, 0.975);
        let (compared, significant, drifted) = drifted(devices, earlier);
        let axes = devices
            .iter()
            .map(|device| device.certificate.axes.len())
            .max();
        let places = |limit: &Limit| {
            (0..axes.unwrap_or(0))
                .map(|axis| (axis, *limit))
                .collect::<Vec<_>>()
        };
        Self {
            devices: all,
            passed,
            guarded: count(Verdict::Guarded),
            failed: count(Verdict::Failed),
            yield_share: share,
            // At either end lies half of the 5 %.
            yield_interval: [1.0 - at_most(1.0 - share), at_most(share)],
            limits: limits
                .iter()
                .flat_map(places)
                .map(|(axis, limit)| limited(devices, axis, limit))
                .collect(),
            failures: failures(devices, limits),
            outliers: outliers(devices),
            compared,
            significant,
            drifted,
            found: found(devices),
        }
    }
}

fn limited(devices: &[Device], axis: usize, limit: Limit) -> Limited {
    let place = (axis, limit.effect);
    let of_axis = devices
        .iter()
        .filter(|device| device.certificate.axes.len() > axis);
    let terms: Vec<Option<&CertifiedTerm>> = of_axis.map(|device| device.term(place)).collect();
    let count = |wanted| {
        let verdicts = terms.iter().map(|term| verdict(*term, limit.value));
        verdicts.filter(|verdict| *verdict == wanted).count()
    };
    let measured = || {
        terms
            .iter()
            .copied()
            .flatten()
            .filter(|term| is_measured(term))
    };
    let values = Values::of(measured().map(|term| f64::from(term.value)));
    let guards = Values::of(measured().map(|term| f64::from(term.upper) - f64::from(term.value)));
    let percentile = |percent| values.percentile(percent);
    let unit = devices.first().zip(terms.iter().copied().flatten().next());
    Limited {
        axis: decode::axis_name(axis),
        effect: limit.effect,
        unit: unit.map_or(String::new(), |(device, term)| {
            self::unit(term, device.unit)
        }),
        limit: limit.value,
        passed: count(Verdict::Passed),
        guarded: count(Verdict::Guarded),
        failed: count(Verdict::Failed),
        measured: values.len(),
        percentiles: percentile(2.5)
            .zip(percentile(50.0))
            .zip(percentile(97.5))
            .map(|((low, median), high)| [low, median, high]),
        cpk: values.capability(limit.value),
        guard_band: guards.percentile(50.0),
    }
}

fn failures(devices: &[Device], limits: &[Limit]) -> Vec<Failing> {
    let mut failures = Vec::new();
    for device in devices {
        for ((axis, effect), term) in device.terms() {
            let limit = limits.iter().find(|limit| limit.effect == effect);
            if limit.is_some_and(|limit| verdict(Some(term), limit.value) == Verdict::Failed) {
                failures.push(Failing {
                    device: device.id.clone(),
                    axis: decode::axis_name(axis),
                    effect,
                    value: f64::from(term.value),
                    interval: [term.lower, term.upper].map(f64::from),
                    unit: unit(term, device.unit),
                });
            }
        }
    }
    failures
}

fn outliers(devices: &[Device]) -> Vec<Outlier> {
    let places: BTreeSet<Place> = devices
        .iter()
        .flat_map(|device| device.terms().map(|(place, _)| place))
        .collect();
    let mut outliers = Vec::new();
    for place in places {
        let measured = || {
            devices.iter().filter_map(|device| {
                let term = device.term(place).filter(|term| is_measured(term))?;
                Some((device, term))
            })
        };
        let values = Values::of(measured().map(|(_, term)| f64::from(term.value)));
        let (Some((low, high)), Some(median)) = (values.fences(), values.percentile(50.0)) else {
            continue;
        };
        // A device whose own error is large is not far from the others.
        let out = measured()
            .filter(|(_, term)| f64::from(term.upper) < low || f64::from(term.lower) > high);
        outliers.extend(out.map(|(device, term)| Outlier {
            device: device.id.clone(),
            axis: decode::axis_name(place.0),
            effect: place.1,
            value: f64::from(term.value),
            median,
            unit: unit(term, device.unit),
        }));
    }
    outliers
}

/// The number of devices with an earlier certificate, the number of standard errors that a change must exceed, and the
/// changes that do.
fn drifted(devices: &[Device], earlier: &[Device]) -> (usize, f64, Vec<Drift>) {
    let before: BTreeMap<&str, &Device> =
        earlier.iter().map(|one| (one.id.as_str(), one)).collect();
    let mut changes = Vec::new();
    let mut compared = 0;
    for device in devices {
        let Some(before) = before.get(device.id.as_str()) else {
            continue;
        };
        compared += 1;
        for (place, now) in device.terms().filter(|(_, term)| is_measured(term)) {
            let Some(before) = before.term(place).filter(|term| is_measured(term)) else {
                continue;
            };
            let [was, is] = [before, now].map(|term| f64::from(term.value));
            let error = f64::from(before.square_error).hypot(f64::from(now.square_error));
            changes.push(Drift {
                device: device.id.clone(),
                axis: decode::axis_name(place.0),
                effect: place.1,
                before: was,
                now: is,
                z: (is * is - was * was) / error,
                unit: unit(now, device.unit),
            });
        }
    }
    let significant = significant(changes.len());
    changes.retain(|change| change.z.abs() > significant);
    (compared, significant, changes)
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
