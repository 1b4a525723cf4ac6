//! The commands for other programs, which keep records and diagnoses in memory: the package for Python wraps it.
//!
//! Options are written as on the command line, `--rate=100`, and read by the same declarations. The documents are those that
//! the commands print with `--json`, and the texts those that they print without, so that both ways tell the same.

mod comparison;
mod deviations;
mod diagnosis;
mod document;
mod effect;
mod options;
mod own;
mod record;
mod recording;
mod stored;

pub use comparison::Comparison;
pub use deviations::deviations;
pub use diagnosis::Diagnosis;
pub use effect::check_effect;
pub use own::{Covariance, Own};
pub use record::Record;
pub use recording::Recording;
