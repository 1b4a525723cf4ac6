//! The frame of a figure, as the pages of `report` and `explore` draw it.

use allanite_host::units;
use allanite_log::unit::Unit;
use allanite_plot::{Frame, Quantity};
use serde::Serialize;

/// The frame of a figure. The units come first that of the log, then the customary one.
#[derive(Serialize)]
pub(crate) struct DrawnFrame {
    quantity: Quantity,
    name: &'static str,
    /// The titles of the axes, the name and unit of the horizontal coordinate, and what a point is called.
    across: &'static str,
    coordinate: (&'static str, &'static str),
    up: &'static str,
    point: &'static str,
    units: Vec<DrawnUnit>,
    /// Ends and ticks of the horizontal axis, in seconds or Hz.
    x: [f64; 2],
    ticks: Vec<(f64, String)>,
    /// Ends of the vertical axis, in the log's unit.
    y: [f64; 2],
    /// The positions of residuals and their labels, from 0 at the bottom of the panel to 1 at its top.
    residuals: Vec<(f64, String)>,
    /// The band of residuals that are not noticeable, in the same positions.
    band: [f64; 2],
}

/// A unit of the vertical axis, with the factor from the log's unit.
#[derive(Serialize)]
struct DrawnUnit {
    name: String,
    factor: f64,
    ticks: Vec<(f64, String)>,
}

/// The frame in the units of the records.
pub(crate) fn frame(unit: Unit, frame: &Frame) -> DrawnFrame {
    let quantity = frame.quantity;
    let customary = match quantity {
        Quantity::Deviation => units::customary(unit, 0),
        Quantity::Density => units::customary_density(unit),
    };
    let customary = customary.map(|(factor, name)| (factor, name.to_owned()));
    let units = std::iter::once((1.0, quantity.unit(unit))).chain(customary);
    let residuals = frame.residuals().into_iter();
    DrawnFrame {
        quantity,
        name: quantity.name(),
        across: quantity.across(),
        coordinate: quantity.coordinate(),
        up: quantity.up(),
        point: quantity.point(),
        units: units
            .map(|(factor, name)| DrawnUnit {
                name,
                factor,
                ticks: frame.y.scaled(factor).labelled(),
            })
            .collect(),
        x: [frame.x.low, frame.x.high],
        ticks: frame.across(),
        y: [frame.y.low, frame.y.high],
        residuals: residuals.map(|(z, label)| (frame.up(z), label)).collect(),
        band: [-2.0, 2.0].map(|z| frame.up(z)),
    }
}
