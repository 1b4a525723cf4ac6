//! How a coefficient changes from device to device, in the order in which they were given, and since they were measured before.

use super::{
    quantity::{Point, Quantity},
    scale::Scale,
    sheet::{ACROSS, UP, across, at, dots, named_across, picture, up},
};
use allanite_host::{
    lot::{Decision, Sample},
    number::number,
};
use maud::{Markup, html};

/// Up to so many devices are dots; more are groups with their median and percentiles.
const MOST_DOTS: usize = 200;

/// The number of groups.
const GROUPS: usize = 50;

/// So many devices are named in a picture.
const NAMED: usize = 5;

/// So many devices are looked at for them.
const LOOKED_AT: usize = 100;

/// The width and the height of a name.
const LABEL: (f64, f64) = (62.0, 13.0);

/// The coefficient over the devices in their order. A production that drifts shows here.
pub(super) fn in_order(quantity: &Quantity<'_>) -> Markup {
    let Some(scale) = Scale::of(quantity.values().chain([quantity.limit]), UP) else {
        return html! {};
    };
    let last = quantity.devices.len().max(2) - 1;
    let x = |i: usize| ACROSS.0 + (ACROSS.1 - ACROSS.0) * i as f64 / last as f64;
    let placed = |wanted: Decision| {
        let all = quantity.devices.iter().enumerate();
        all.filter(move |(_, one)| one.decision == wanted)
            .filter_map(|(i, one)| Some((x(i), scale.place(quantity.value(one.known)?))))
    };
    let is_grouped = quantity.devices.len() > MOST_DOTS;
    let content = html! {
        (up(&scale, &quantity.unit))
        @if is_grouped {
            (groups(quantity, &scale, x))
        } @else {
            (dots("pass", placed(Decision::Passed)))
            (dots("guard", placed(Decision::Guarded)))
            (dots("none", placed(Decision::Misfit)))
        }
        (dots(if is_grouped { "fail small" } else { "fail" }, placed(Decision::Failed)))
        @let y = at(scale.place(quantity.limit));
        line.limit x1=(at(ACROSS.0)) x2=(at(ACROSS.1)) y1=(y) y2=(y) {}
        (labels(worst(quantity, &scale, x)))
        @for (i, anchor) in [(0, "start"), (last, "end")] {
            text.tick x=(at(x(i))) y=(at(UP.0 + 14.0)) text-anchor=(anchor) {
                (quantity.devices.get(i).map_or("", |one| one.device))
            }
        }
        (named_across("devices in their order"))
    };
    let (effect, axis) = (&quantity.effect, &quantity.axis);
    let name = format!("{effect} of axis {axis} over the devices in their order");
    picture(&name, &content)
}

/// The devices that are farthest above the limit, with their places.
fn worst<'a>(
    quantity: &Quantity<'a>,
    scale: &Scale,
    x: impl Fn(usize) -> f64,
) -> Vec<(&'a str, f64, f64)> {
    let all = quantity.devices.iter().enumerate();
    let mut failed: Vec<(f64, usize, &'a str)> = all
        .filter(|(_, one)| one.decision == Decision::Failed)
        .filter_map(|(i, one)| Some((quantity.value(one.known)?, i, one.device)))
        .collect();
    failed.sort_by(|(one, ..), (other, ..)| other.total_cmp(one));
    let named = failed.into_iter();
    named
        .map(|(value, i, device)| (device, x(i), scale.place(value)))
        .collect()
}

/// The names of some devices at their dots, so far apart that none covers another one.
fn labels(devices: Vec<(&str, f64, f64)>) -> Markup {
    let mut named: Vec<(&str, f64, f64)> = Vec::new();
    for (device, x, y) in devices.into_iter().take(LOOKED_AT) {
        let covers = |(_, other_x, other_y): &(&str, f64, f64)| {
            (x - other_x).abs() < 2.0 * LABEL.0 && (y - other_y).abs() < LABEL.1
        };
        if named.len() < NAMED && !named.iter().any(covers) {
            named.push((device, x, y));
        }
    }
    html! {
        @for (device, x, y) in named { (label(device, x, y)) }
    }
}

/// The name of a device beside its dot, on the side on which there is room.
fn label(device: &str, x: f64, y: f64) -> Markup {
    let is_right = x > f64::midpoint(ACROSS.0, ACROSS.1);
    html! {
        text.tick x=(at(if is_right { x - 6.0 } else { x + 6.0 })) y=(at(y + 4.0))
            text-anchor=(if is_right { "end" } else { "start" }) { (device) }
    }
}

/// Medians and the band from 5 to 95 % of groups of devices.
fn groups(quantity: &Quantity<'_>, scale: &Scale, x: impl Fn(usize) -> f64) -> Markup {
    let length = quantity.devices.len().div_ceil(GROUPS);
    let (mut upper, mut lower, mut middle) = (Vec::new(), Vec::new(), Vec::new());
    for (i, group) in quantity.devices.chunks(length).enumerate() {
        let values = Sample::of(group.iter().filter_map(|one| quantity.value(one.known)));
        let at_x = at(x(i * length + group.len() / 2));
        let place = |share| values.quantile(share).map(|value| at(scale.place(value)));
        if let (Some(low), Some(median), Some(high)) = (place(0.05), place(0.5), place(0.95)) {
            upper.push(format!("{at_x},{high}"));
            lower.push(format!("{at_x},{low}"));
            middle.push(format!("{at_x},{median}"));
        }
    }
    lower.reverse();
    upper.extend(lower);
    html! {
        polygon.band points=(upper.join(" ")) {}
        polyline.median points=(middle.join(" ")) {}
    }
}

/// The coefficient now over that before. `None` without devices that measured it both times.
pub(super) fn since(quantity: &Quantity<'_>) -> Option<Markup> {
    let pair = |one: &Point<'_>| {
        let before = quantity.value(one.earlier)?;
        Some((before, quantity.value(one.known)?))
    };
    let both = quantity.devices.iter().filter_map(pair);
    let all: Vec<f64> = both.flat_map(|(before, now)| [before, now]).collect();
    let (x, y) = (
        Scale::of(all.iter().copied(), ACROSS)?,
        Scale::of(all.iter().copied(), UP)?,
    );
    let placed = |has_drifted: bool| {
        let of_kind = quantity.devices.iter();
        let of_kind = of_kind.filter(move |one| one.has_drifted == has_drifted);
        of_kind.filter_map(|one| {
            let (before, now) = pair(one)?;
            Some((one.device, x.place(before), y.place(now)))
        })
    };
    let places = |has_drifted| placed(has_drifted).map(|(_, x, y)| (x, y));
    let (effect, axis, unit) = (&quantity.effect, &quantity.axis, &quantity.unit);
    let content = html! {
        (across(&x, &format!("earlier, {unit}")))
        (up(&y, &format!("now, {unit}")))
        line.median x1=(at(ACROSS.0)) x2=(at(ACROSS.1)) y1=(at(UP.0)) y2=(at(UP.1)) {}
        (dots("plain", places(false)))
        (dots("fail", places(true)))
        (labels(placed(true).collect()))
    };
    let count = placed(true).count();
    let name = format!(
        "{effect} of axis {axis} now over that before, in {} devices, of which {} have drifted",
        number(all.len() as f64 / 2.0),
        count
    );
    Some(picture(&name, &content))
}
