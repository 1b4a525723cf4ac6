//! The output of commands: files, progress, and the words, numbers and units of tables and JSON
//! documents.

pub(super) mod cell;
pub(super) mod disturbance;
pub(super) mod drawn_frame;
pub(super) mod event_json;
pub(super) mod file;
pub(super) mod glossary;
pub(super) mod model_json;
pub(super) mod places;
pub(super) mod progress;
pub(super) mod rounding;
pub(super) mod shell;
pub(super) mod temporary;
pub(super) mod wrapped;
