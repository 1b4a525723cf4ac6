//! A coefficient of a lot beside its limit.

use super::device::Device;
use crate::command::decode;
use allanite::diagnosis::Verdict;
use allanite_host::{
    limit::Limit,
    lot::{Capability, Decision, ErrorModel, Measurement, Sample, acceptance_limit},
    stationarity::is_disturbed,
    units,
};
use allanite_log::unit::Unit;
use schemars::JsonSchema;
use serde::Serialize;

/// The shares of devices below the percentiles that are told.
const SHARES: [f64; 3] = [0.05, 0.5, 0.95];

/// A coefficient of an axis with its limit. Numbers are in `unit`.
#[derive(Serialize, JsonSchema)]
pub(super) struct Limited {
    pub(super) axis: String,
    pub(super) effect: &'static str,
    pub(super) unit: String,
    pub(super) limit: f64,
    /// A device passes whose value is at most this, if its uncertainty is usual for the lot. `null` if there are too
    /// few devices, or if none would pass.
    pub(super) accepted_up_to: Option<f64>,
    /// The limit less that value.
    pub(super) guard_band: Option<f64>,
    pub(super) passed: usize,
    pub(super) guarded: usize,
    pub(super) misfit: usize,
    pub(super) not_stationary: usize,
    pub(super) not_valid: usize,
    pub(super) failed: usize,
    /// How many of those that passed are expected to be above the limit, by their own uncertainties.
    pub(super) expected_false_passes: f64,
    /// How many of those that failed are expected to be within the limit.
    pub(super) expected_false_failures: f64,
    /// The number of devices in which it is measured, on which the rest is based.
    pub(super) measured: usize,
    /// Percentiles: 5, 50 and 95 %.
    pub(super) percentiles: Option<[f64; 3]>,
    /// The process capability of the logarithms.
    pub(super) cpk: Option<f64>,
    /// Its 95 % interval.
    pub(super) cpk_interval: Option<[f64; 2]>,
}

/// How a limit is applied to the devices of a lot.
pub(super) struct Rule {
    pub(super) limit: Limit,
    /// For each axis, the error of the square of a device at the limit; zero if the lot does not tell it.
    errors: Vec<f64>,
    risk: f64,
}

impl Rule {
    /// The rule for a limit of these devices.
    pub(super) fn of(devices: &[Device], limit: Limit, risk: f64) -> Self {
        let axes = devices.iter().map(|device| device.certificate.axes.len());
        let errors = (0..axes.max().unwrap_or(0)).map(|axis| {
            let place = (axis, limit.effect.name());
            let known = devices.iter().filter_map(|one| one.measurement(place));
            let model = ErrorModel::of(&known.collect::<Vec<_>>());
            model.map_or(0.0, |model| model.error(limit.value * limit.value))
        });
        Self {
            limit,
            errors: errors.collect(),
            risk,
        }
    }

    /// The number of axes of the lot.
    pub(super) fn axes(&self) -> usize {
        self.errors.len()
    }

    /// The error of the square of a device at the limit.
    fn error(&self, axis: usize) -> f64 {
        self.errors.get(axis).copied().unwrap_or(0.0)
    }

    /// The probability that a coefficient of which this is known keeps the limit.
    pub(super) fn conformity(&self, axis: usize, known: Option<Measurement>) -> Option<f64> {
        known.map(|one| one.conformity(self.limit.value, self.error(axis)))
    }

    /// What is decided of an axis of a device. A certificate without the coefficient decides nothing.
    pub(super) fn decision(&self, device: &Device, axis: usize) -> Decision {
        let certified = device.certificate.axes.get(axis);
        match certified.and_then(|axis| axis.verdict) {
            Some(Verdict::Invalid(_)) => Decision::Invalid,
            _ if certified.is_some_and(is_disturbed) => Decision::NotStationary,
            Some(Verdict::Unexplained | Verdict::Incomplete) => Decision::Misfit,
            _ => {
                let known = device.measurement((axis, self.limit.effect.name()));
                known.map_or(Decision::Guarded, |one| {
                    one.decision(self.limit.value, self.error(axis), self.risk)
                })
            }
        }
    }
}

impl Limited {
    /// The devices that have this axis beside a limit.
    pub(super) fn of(devices: &[Device], unit: Unit, axis: usize, rule: &Rule) -> Self {
        let (limit, error) = (rule.limit, rule.error(axis));
        let place = (axis, limit.effect.name());
        let with_axis = devices
            .iter()
            .filter(|device| device.certificate.axes.len() > axis);
        let of_axis: Vec<(Decision, Option<Measurement>)> = with_axis
            .map(|device| (rule.decision(device, axis), device.measurement(place)))
            .collect();
        let known: Vec<Option<Measurement>> = of_axis.iter().map(|(_, known)| *known).collect();
        let decided: Vec<(Decision, f64)> = of_axis
            .iter()
            .map(|(decision, one)| {
                let conformity = one.map_or(0.5, |one| one.conformity(limit.value, error));
                (*decision, conformity)
            })
            .collect();
        let with = |wanted| decided.iter().filter(move |(one, _)| *one == wanted);
        let measured = || known.iter().flatten().filter(|one| one.is_measured);
        let values = Sample::of(measured().map(Measurement::value));
        let accepted = (error > 0.0).then(|| acceptance_limit(limit.value, error, rule.risk));
        let accepted = accepted.flatten();
        let capability = Capability::of(&values, limit.value);
        Self {
            axis: decode::axis_name(axis),
            effect: limit.effect.name(),
            unit: units::unit(unit, limit.effect.half_seconds()),
            limit: limit.value,
            accepted_up_to: accepted,
            guard_band: accepted.map(|accepted| limit.value - accepted),
            passed: with(Decision::Passed).count(),
            guarded: with(Decision::Guarded).count(),
            misfit: with(Decision::Misfit).count(),
            not_stationary: with(Decision::NotStationary).count(),
            not_valid: with(Decision::Invalid).count(),
            failed: with(Decision::Failed).count(),
            expected_false_passes: total(with(Decision::Passed).map(|(_, within)| 1.0 - within)),
            expected_false_failures: total(with(Decision::Failed).map(|(_, within)| *within)),
            measured: values.values().len(),
            percentiles: percentiles(&values),
            cpk: capability.map(|one| one.value),
            cpk_interval: capability.map(|one| one.interval),
        }
    }
}

/// The sum of numbers. That of none by `sum` is −0, which is printed so.
fn total(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |sum, number| sum + number)
}

fn percentiles(values: &Sample) -> Option<[f64; 3]> {
    let [low, median, high] = SHARES.map(|share| values.quantile(share));
    Some([low?, median?, high?])
}
