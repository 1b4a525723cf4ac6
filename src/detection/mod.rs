//! What a record would have shown: the size from which on a diagnosis would have found an effect, with a
//! probability of 95 %, for every effect of a list that is not in the model.
//!
//! A diagnosis that finds nothing says what that is worth by these limits. They are those of its own test: an effect is
//! added if `−2 ln L` falls by more than the effect's parameters and its price. An effect of a given size shifts the rows of
//! a record; the part that the model's coefficients and shapes cannot follow is the noncentrality of the fall. The limit is
//! the size whose fall is large enough in 95 % of the records.
//!
//! [`Detection`] goes through the effects and their shapes, [`Limit`] is what it finds for one shape, and
//! [`Ranges`] puts the limits of neighbouring shapes together.
//!
//! There is no limit where an effect cannot be distinguished from the model up to a hundred times the record itself, such as
//! for a sinusoid whose period is longer than the record.

mod excess;
mod limit;
mod range;
mod run;

pub use limit::Limit;
pub use range::{MAX_RANGES, Range, Ranges};
pub use run::Detection;

#[cfg(feature = "storage")]
pub(crate) use limit::is_of_shape;

#[cfg(test)]
mod tests;
