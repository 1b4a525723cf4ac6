//! The data that the page draws.

use allanite_plot::{Figure, Frame, Line, Measured, Share};
use serde::Serialize;

/// A record in a frame, with its residuals.
#[derive(Serialize)]
pub(super) struct DrawnRecord {
    measured: Measured,
    z: Vec<f32>,
    /// What the model predicts at each of the points.
    expected: Vec<f32>,
    /// The positions of the residuals in their panel.
    up: Vec<f64>,
}

/// A model in a frame.
#[derive(Serialize)]
pub(super) struct DrawnModel {
    model: Line,
    shares: Vec<Share>,
}

/// A figure as a record with its residuals and as a model.
pub(super) fn drawn(figure: Figure, frame: &Frame) -> (DrawnRecord, DrawnModel) {
    let up = figure
        .z
        .iter()
        .map(|z| frame.up(f64::from(*z)).clamp(0.0, 1.0));
    let record = DrawnRecord {
        up: up.collect(),
        measured: figure.measured,
        z: figure.z,
        expected: figure.expected,
    };
    let model = DrawnModel {
        model: figure.model,
        shares: figure.shares,
    };
    (record, model)
}
