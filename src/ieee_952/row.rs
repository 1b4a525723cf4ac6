//! What is known of an octave.

use super::terms::TERMS;

/// What the curve says of an octave, and what a model does.
#[derive(Clone, Copy)]
pub(super) struct Row {
    /// The Allan variance, in units of the reference.
    pub(super) measured: f32,
    /// One over the number of differences, and the number of stretches over it.
    pub(super) per_difference: f32,
    pub(super) ends: f32,
    /// The model's variance, and each term's share of it in units of 2^-15.
    pub(super) model: f32,
    pub(super) shares: [u16; TERMS],
    /// The relative change of the model in the last round.
    pub(super) change: f32,
    /// One over the standard error, relative to the model.
    pub(super) certainty: f32,
    /// One over the standard error, in units of the reference.
    pub(super) weight: f32,
    /// One over the octave's diagonal element of the factor, in units of 2^-24.
    pub(super) reciprocal: i32,
    /// The whitened columns of the terms and of the curve, each in a unit of its own.
    pub(super) white: [i32; TERMS + 1],
}

impl Row {
    pub(super) const EMPTY: Self = Self {
        measured: 0.0,
        per_difference: 0.0,
        ends: 0.0,
        model: 0.0,
        shares: [0; TERMS],
        change: 0.0,
        certainty: 0.0,
        weight: 0.0,
        reciprocal: 0,
        white: [0; TERMS + 1],
    };
}
