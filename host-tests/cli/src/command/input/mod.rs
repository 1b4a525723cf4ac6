//! The inputs of commands: records, curve files, and many files at once.

pub(super) mod many;
pub(super) mod record;
pub(super) mod standard_input;
