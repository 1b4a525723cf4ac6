//! What a record would have shown: the size from which on a diagnosis would have found an effect, with a
//! probability of 95 %, for every effect of a list that is not in the model.
//!
//! A diagnosis calls a model adequate if χ² is plausible. These limits say what that is worth. An effect with the
//! squared coefficient β shifts the curve by β a, where `a` are its Allan variances. The part of the shift that
//! the model's coefficients and shapes cannot follow is the root of the noncentrality of χ². A diagnosis adds an
//! effect if χ² exceeds its 1 % quantile and the effect lowers the score by more than a threshold, and the limit
//! is the β with which both happen in 95 % of the records.
//!
//! [`Detection`] goes through the effects and their shapes, [`Limit`] is what it finds for one shape, and
//! [`Ranges`] puts the limits of neighbouring shapes together. The file `expected` fits the model to the curve
//! that is expected with the effect, `power` computes the probability, and `trial` searches for the limit.
//!
//! There is no limit where an effect cannot be told from the model up to the size of the curve itself, such as
//! for a sinusoid whose period is longer than the longest octaves.
//!
//! In 1000 records of 2^16 samples of a consumer gyro for each effect, an effect at its limit shows in 94 to 97 % of
//! those with octaves alone, and in 95 to 98 % of those with a spectrum (`cargo xtask study detection`).

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
