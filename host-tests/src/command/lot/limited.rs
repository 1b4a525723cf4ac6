//! A coefficient of a lot beside its limit.

use super::{device::Device, limit::Limit};
use crate::{
    command::{decode, output::units},
    lot::{Capability, Decision, Measurement, Sample, acceptance_limit},
    unit::Unit,
};
use serde::Serialize;

/// The shares of devices below the percentiles that are told.
const SHARES: [f64; 3] = [0.05, 0.5, 0.95];

/// A coefficient of one axis beside its limit. Numbers are in the unit that is told.
#[derive(Serialize)]
pub(super) struct Limited {
    pub(super) axis: String,
    pub(super) effect: &'static str,
    pub(super) unit: String,
    pub(super) limit: f64,
    /// A device passes whose value is at most this, if its uncertainty is that of the median device. `None` if no
    /// device measures the coefficient.
    pub(super) accepted_up_to: Option<f64>,
    /// The limit less that value.
    pub(super) guard_band: Option<f64>,
    pub(super) passed: usize,
    pub(super) guarded: usize,
    pub(super) failed: usize,
    /// How many of those that passed are expected to be above the limit, by their own uncertainties.
    pub(super) expected_false_passes: f64,
    /// How many of those that failed are expected to be within the limit.
    pub(super) expected_false_failures: f64,
    /// The number of devices in which it is measured, of which the rest tells.
    pub(super) measured: usize,
    /// Percentiles: 5, 50 and 95 %.
    pub(super) percentiles: Option<[f64; 3]>,
    pub(super) cpk: Option<f64>,
    /// Its 95 % interval.
    pub(super) cpk_interval: Option<[f64; 2]>,
}

/// What is decided of a coefficient of which this is known. A certificate without the coefficient decides nothing.
pub(super) fn decision(known: Option<Measurement>, limit: f64, risk: f64) -> Decision {
    known.map_or(Decision::Guarded, |one| one.decision(limit, risk))
}

impl Limited {
    /// The devices that have this axis beside a limit.
    pub(super) fn of(devices: &[Device], unit: Unit, axis: usize, limit: Limit, risk: f64) -> Self {
        let place = (axis, limit.effect.name());
        let with_axis = devices
            .iter()
            .filter(|device| device.certificate.axes.len() > axis);
        let known: Vec<Option<Measurement>> =
            with_axis.map(|device| device.measurement(place)).collect();
        let decided: Vec<(Decision, f64)> = known
            .iter()
            .map(|one| {
                let conformity = one.map_or(0.5, |one| one.conformity(limit.value));
                (decision(*one, limit.value, risk), conformity)
            })
            .collect();
        let with = |wanted| decided.iter().filter(move |(one, _)| *one == wanted);
        let measured = || known.iter().flatten().filter(|one| one.is_measured);
        let values = Sample::of(measured().map(Measurement::value));
        let relative = Sample::of(measured().map(|one| one.above / one.square)).median();
        let accepted = relative.map(|relative| acceptance_limit(limit.value, relative, risk));
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
            failed: with(Decision::Failed).count(),
            expected_false_passes: with(Decision::Passed).map(|(_, within)| 1.0 - within).sum(),
            expected_false_failures: with(Decision::Failed).map(|(_, within)| within).sum(),
            measured: values.values().len(),
            percentiles: percentiles(&values),
            cpk: capability.map(|one| one.value),
            cpk_interval: capability.map(|one| one.interval),
        }
    }
}

fn percentiles(values: &Sample) -> Option<[f64; 3]> {
    let [low, median, high] = SHARES.map(|share| values.quantile(share));
    Some([low?, median?, high?])
}
