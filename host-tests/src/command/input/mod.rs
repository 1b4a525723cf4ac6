//! What commands are given: records and curves, many files at once.

pub(super) mod many;
pub(super) mod record;
