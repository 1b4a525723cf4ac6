//! What a record would have shown: the size of every effect that a diagnosis did not find, and that it would
//! have found with a probability of 95 %.

mod expected;
mod limit;
mod power;
mod range;
mod run;
mod trial;

pub use limit::Limit;
pub use range::{MAX_RANGES, Range, Ranges};
pub use run::{Detection, Progress};

#[cfg(feature = "storage")]
pub(crate) use limit::is_of_shape;

#[cfg(test)]
mod tests;
