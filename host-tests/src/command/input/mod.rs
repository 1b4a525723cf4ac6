//! What commands are given: records and curves, many files at once, effects with their parameters.

pub(super) mod effect_argument;
pub(super) mod many;
pub(super) mod record;
