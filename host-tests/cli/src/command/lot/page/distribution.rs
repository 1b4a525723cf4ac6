//! How a coefficient is distributed among the devices, beside its limit.

use super::{
    quantity::Quantity,
    scale::Scale,
    sheet::{ACROSS, UP, across, at, picture, short},
};
use allanite_host::{
    lot::{Decision, Sample},
    number::number,
};
use maud::{Markup, html};

/// The decisions in the order in which they are stacked, with their classes.
const STACKED: [(Decision, &str); 4] = [
    (Decision::Passed, "pass"),
    (Decision::Guarded, "guard"),
    (Decision::Misfit, "none"),
    (Decision::Failed, "fail"),
];

/// The least and the largest number of bars.
const BARS: (usize, usize) = (12, 44);

/// A histogram of the devices that measure the coefficient.
pub(super) fn distribution(quantity: &Quantity<'_>) -> Markup {
    let limit = quantity.limit;
    let values = quantity.values().chain([limit]);
    let Some(scale) = Scale::of(values, ACROSS) else {
        return html! {};
    };
    let measured = quantity.values().count();
    let bars = ((measured as f64).sqrt() as usize * 2).clamp(BARS.0, BARS.1);
    let width = (ACROSS.1 - ACROSS.0) / bars as f64;
    // The limit lies between two bars, so that none has devices on both of its sides.
    let first = (scale.place(limit) - ACROSS.0) % width - width;
    let mut counts = vec![[0_usize; STACKED.len()]; bars + 2];
    for one in &quantity.devices {
        let Some(value) = quantity.value(one.known) else {
            continue;
        };
        let bar = ((scale.place(value) - ACROSS.0 - first) / width) as usize;
        let kind = STACKED
            .iter()
            .position(|(decision, _)| *decision == one.decision);
        if let (Some(counts), Some(kind)) = (counts.get_mut(bar), kind) {
            counts[kind] += 1;
        }
    }
    // The ends of a bar, which the scale cuts off.
    let ends = |bar: usize| {
        let from = ACROSS.0 + first + width * bar as f64;
        (from.max(ACROSS.0), (from + width).min(ACROSS.1))
    };
    let most = counts.iter().map(|all| all.iter().sum::<usize>()).max();
    let most = most.unwrap_or(0).max(1);
    let height = |count: usize| (UP.0 - UP.1) * count as f64 / most as f64;
    let content = html! {
        (across(&scale, &quantity.unit))
        text.tick x="2" y="13" { "devices" }
        text.tick x=(at(ACROSS.0 - 5.0)) y=(at(UP.1 + 4.0)) text-anchor="end" { (most) }
        text.tick x=(at(ACROSS.0 - 5.0)) y=(at(UP.0 + 4.0)) text-anchor="end" { "0" }
        @for (i, all) in counts.iter().enumerate() {
            @for (kind, (_, class)) in STACKED.iter().enumerate() {
                @let below: usize = all[..kind].iter().sum();
                @if all[kind] > 0 {
                    @let (from, to) = ends(i);
                    rect class=(class) x=(at(from + 0.5)) width=(at((to - from - 1.0).max(0.5)))
                        y=(at(UP.0 - height(below + all[kind]))) height=(at(height(all[kind]))) {}
                }
            }
        }
        line.base x1=(at(ACROSS.0)) x2=(at(ACROSS.1)) y1=(at(UP.0)) y2=(at(UP.0)) {}
        @if let Some(accepted) = quantity.accepted_up_to {
            @let x = at(scale.place(accepted));
            line.accept x1=(x) x2=(x) y1=(at(UP.0)) y2=(at(UP.1)) {}
        }
        (limit_mark(&scale, limit))
    };
    picture(&name(quantity, measured), &content)
}

fn limit_mark(scale: &Scale, limit: f64) -> Markup {
    let x = scale.place(limit);
    // The word stands on the side on which there is room.
    let (anchor, shift) = if x > f64::midpoint(ACROSS.0, ACROSS.1) {
        ("end", -4.0)
    } else {
        ("start", 4.0)
    };
    html! {
        line.limit x1=(at(x)) x2=(at(x)) y1=(at(UP.0)) y2=(at(UP.1 - 8.0)) {}
        text.limit-word x=(at(x + shift)) y=(at(UP.1 - 2.0)) text-anchor=(anchor) {
            "limit " (short(limit))
        }
    }
}

/// What the picture shows, in a sentence.
fn name(quantity: &Quantity<'_>, measured: usize) -> String {
    let values = Sample::of(quantity.values());
    let [low, high] = [0.0, 1.0].map(|share| values.quantile(share).map_or("–".into(), number));
    let (effect, axis, unit) = (&quantity.effect, &quantity.axis, &quantity.unit);
    format!(
        "{effect} of axis {axis} in {measured} devices, from {low} to {high} {unit}; the limit is {}",
        number(quantity.limit)
    )
}
