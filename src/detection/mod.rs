//! What a record would have shown: the size of every effect that a diagnosis did not find, and that it would
//! have found with a probability of 95 %.

mod expected;
mod limit;
mod power;
mod run;
mod trial;

pub use limit::Limit;
pub use run::{Detection, Progress};
