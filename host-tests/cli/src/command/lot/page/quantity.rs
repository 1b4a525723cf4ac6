//! A coefficient of an axis in a lot, in the unit in which a page shows it.

use crate::command::{
    decode,
    lot::{judgement::Judged, limited::Rule},
};
use allanite_host::{
    lot::{Decision, Measurement},
    units,
    words::plain,
};

/// A coefficient that has a limit, with what is known of it in every device.
pub(super) struct Quantity<'a> {
    /// The effect in words.
    pub(super) effect: String,
    pub(super) axis: String,
    /// The customary unit, or that of the certificates where there is none.
    pub(super) unit: String,
    /// The factor from the unit of the certificates.
    pub(super) factor: f64,
    pub(super) limit: f64,
    /// The largest value with which a device of usual uncertainty passes.
    pub(super) accepted_up_to: Option<f64>,
    /// The devices, in their order.
    pub(super) devices: Vec<Point<'a>>,
}

/// A coefficient of one device.
pub(super) struct Point<'a> {
    pub(super) device: &'a str,
    pub(super) decision: Decision,
    /// What is known of it, in the unit of the certificates; `None` if nothing is.
    pub(super) known: Option<Measurement>,
    /// What was known earlier.
    pub(super) earlier: Option<Measurement>,
    /// Whether it has drifted since then.
    pub(super) has_drifted: bool,
}

impl Quantity<'_> {
    /// The value that a device measures, in the unit of the page.
    pub(super) fn value(&self, known: Option<Measurement>) -> Option<f64> {
        let known = known.filter(|one| one.is_measured)?;
        Some(self.factor * known.value())
    }

    /// The values of the devices that measure it.
    pub(super) fn values(&self) -> impl Iterator<Item = f64> {
        self.devices.iter().filter_map(|one| self.value(one.known))
    }
}

/// The factor to the unit in which a page shows a coefficient, and the name of that unit.
pub(super) fn shown_unit(judged: &Judged<'_>, half_seconds: i8) -> (f64, String) {
    let own = || (1.0, units::unit(judged.unit, half_seconds));
    let customary = units::customary(judged.unit, half_seconds);
    customary.map_or_else(own, |(factor, name)| (factor, name.to_owned()))
}

/// The coefficients that have limits: every axis of every limit.
pub(super) fn quantities<'a>(judged: &Judged<'a>) -> Vec<Quantity<'a>> {
    let of_rule = |rule: &'a Rule| (0..rule.axes()).map(move |axis| (rule, axis));
    let places = judged.rules.iter().flat_map(of_rule);
    places
        .map(|(rule, axis)| quantity(judged, rule, axis))
        .collect()
}

fn quantity<'a>(judged: &Judged<'a>, rule: &Rule, axis: usize) -> Quantity<'a> {
    let effect = rule.limit.effect;
    let (factor, unit) = shown_unit(judged, effect.half_seconds());
    let place = (axis, effect.name());
    let name = decode::axis_name(axis);
    let mut limited = judged.lot.limits.iter();
    let limited = limited.find(|one| one.axis == name && one.effect == effect.name());
    let drifted = judged.lot.drifted.iter();
    let drifted: Vec<&str> = drifted
        .filter(|one| one.axis == name && one.effect == effect.name())
        .map(|one| one.device.as_str())
        .collect();
    let with_axis = judged
        .devices
        .iter()
        .filter(|device| device.certificate.axes.len() > axis);
    let devices = with_axis.map(|device| {
        let known = device.measurement(place);
        let earlier = judged.before.get(device.id.as_str());
        Point {
            device: &device.id,
            decision: rule.decision(device, axis),
            known,
            earlier: earlier.and_then(|earlier| earlier.measurement(place)),
            has_drifted: drifted.contains(&device.id.as_str()),
        }
    });
    Quantity {
        effect: plain(effect.name()),
        axis: name,
        unit,
        factor,
        limit: factor * rule.limit.value,
        accepted_up_to: limited.and_then(|one| one.accepted_up_to.map(|value| factor * value)),
        devices: devices.collect(),
    }
}
