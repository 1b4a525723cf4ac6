//! Records, fits, diagnoses and comparisons in memory, for other programs: the package for Python and the functions of fleets wrap
//! them.
//!
//! Their options and results are types. The documents are those that the commands print with `--json`, and the texts those that
//! they print without.

mod comparison;
mod deviations;
mod diagnosis;
mod document;
mod effect;
pub mod options;
mod own;
mod record;
mod recording;
mod stored;

pub use comparison::Comparison;
pub use deviations::deviations;
pub use diagnosis::Diagnosis;
pub use effect::{check_effect, effect_name};
pub use own::{Covariance, Own};
pub use record::Record;
pub use recording::Recording;
