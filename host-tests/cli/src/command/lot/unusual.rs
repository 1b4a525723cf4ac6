//! Devices that are unlike the others, or unlike they were.

use super::device::{Device, Place};
use crate::command::decode;
use allanite::storage::CertifiedTerm;
use allanite_host::{
    lot::{Fences, Measurement, difference, threshold},
    units,
};
use allanite_log::unit::Unit;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// A device whose coefficient is far from those of the others, its whole 95 % interval included.
#[derive(Serialize, JsonSchema)]
pub(super) struct Outlier {
    pub(super) device: String,
    pub(super) axis: String,
    pub(super) effect: &'static str,
    pub(super) value: f64,
    /// The median of the devices, or of their upper bounds where most of them have these only.
    pub(super) median: f64,
    /// Whether it is that of bounds.
    pub(super) median_is_bound: bool,
    pub(super) unit: String,
}

/// The devices of a lot beside their earlier certificates.
pub(super) struct Drifts {
    /// The number of devices of which there is an earlier certificate.
    pub(super) devices: usize,
    /// The number of coefficients that were compared.
    pub(super) comparisons: usize,
    /// The number of standard errors from which on a difference is a drift.
    pub(super) threshold: f64,
    /// Those that are, the most significant one first.
    pub(super) drifted: Vec<Drift>,
}

/// A device whose coefficient has changed since its earlier certificate.
#[derive(Serialize, JsonSchema)]
pub(super) struct Drift {
    pub(super) device: String,
    pub(super) axis: String,
    pub(super) effect: &'static str,
    pub(super) before: f64,
    /// The upper bound, if it was not measured.
    pub(super) before_bound: Option<f64>,
    pub(super) now: f64,
    pub(super) now_bound: Option<f64>,
    /// The change in standard errors of it.
    pub(super) z: f64,
    pub(super) unit: String,
}

/// The upper bound of a coefficient that is not measured.
fn bound(one: &Measurement) -> Option<f64> {
    (!one.is_measured).then(|| one.upper())
}

/// The unit of a term's coefficient.
pub(super) fn unit_of(term: &CertifiedTerm, unit: Unit) -> String {
    let effect = term.effect.effect();
    effect.map_or(String::new(), |effect| {
        units::unit(unit, effect.half_seconds())
    })
}

/// The outliers of a lot, in every coefficient of every axis, the farthest one first.
pub(super) fn outliers(devices: &[Device]) -> Vec<Outlier> {
    let places: BTreeSet<Place> = devices
        .iter()
        .flat_map(|device| device.terms().map(|(place, _)| place))
        .collect();
    let mut outliers = Vec::new();
    for place in places {
        let mut known = Vec::new();
        for device in devices {
            let mut terms = device.terms();
            let term = terms.find(|(other, _)| *other == place);
            if let Some((term, one)) =
                term.and_then(|(_, term)| Some((term, Measurement::of(term)?)))
            {
                known.push((device, term, one));
            }
        }
        let measurements: Vec<Measurement> = known.iter().map(|(_, _, one)| *one).collect();
        let Some(fences) = Fences::of(&measurements) else {
            continue;
        };
        let out = known.into_iter().filter(|(_, _, one)| fences.exclude(one));
        outliers.extend(out.map(|(device, term, one)| {
            let outlier = Outlier {
                device: device.id.clone(),
                axis: decode::axis_name(place.0),
                effect: place.1,
                value: one.value(),
                median: fences.median,
                median_is_bound: fences.of_bounds,
                unit: unit_of(term, device.unit),
            };
            ((one.value() / fences.median).ln().abs(), outlier)
        }));
    }
    worst_first(outliers)
}

/// Findings in the descending order of how bad they are.
pub(super) fn worst_first<T>(mut findings: Vec<(f64, T)>) -> Vec<T> {
    findings.sort_by(|(one, _), (other, _)| other.total_cmp(one));
    findings.into_iter().map(|(_, finding)| finding).collect()
}

impl Drifts {
    /// Compares devices with their earlier certificates. Of several earlier ones of a device the last one counts.
    pub(super) fn of(devices: &[Device], earlier: &[Device]) -> Self {
        let before: BTreeMap<&str, &Device> =
            earlier.iter().map(|one| (one.id.as_str(), one)).collect();
        let (mut count, mut changes) = (0, Vec::new());
        for device in devices {
            let Some(before) = before.get(device.id.as_str()) else {
                continue;
            };
            count += 1;
            let [was, is] = [before, device].map(|one| one.certificate.conditions.duration_s);
            for (place, term) in device.terms() {
                let Some((before, now)) = before.measurement(place).zip(Measurement::of(term))
                else {
                    continue;
                };
                changes.push(Drift {
                    device: device.id.clone(),
                    axis: decode::axis_name(place.0),
                    effect: place.1,
                    before: before.value(),
                    before_bound: bound(&before),
                    now: now.value(),
                    now_bound: bound(&now),
                    z: difference(&before, &now, is / was),
                    unit: unit_of(term, device.unit),
                });
            }
        }
        let (comparisons, threshold) = (changes.len(), threshold(changes.len()));
        changes.retain(|change| change.z.abs() > threshold);
        let changes = changes.into_iter().map(|change| (change.z.abs(), change));
        let drifted = worst_first(changes.collect());
        Self {
            devices: count,
            comparisons,
            threshold,
            drifted,
        }
    }
}
