//! Statistics of a lot: what the measured coefficients of many devices say about a limit, about each other, and about
//! earlier measurements of the same devices.
//!
//! Everything here works on the squares of coefficients or on their logarithms. A fit is linear in the squares, so that
//! their errors are nearly normal. The devices of a lot differ by factors, so that logarithms of coefficients are nearly
//! normal among them.

mod capability;
mod conformity;
mod drift;
mod error_model;
mod measurement;
mod outlier;
mod sample;

pub use capability::Capability;
pub use conformity::{Decision, acceptance_limit};
pub use drift::{difference, threshold};
pub use error_model::ErrorModel;
pub use measurement::Measurement;
pub use outlier::Fences;
pub use sample::Sample;

use statrs::distribution::{ContinuousCDF as _, Normal};

/// The number of standard errors that a normal variable exceeds with this probability, which is above 0.
fn quantile_above(probability: f64) -> f64 {
    // The quantile from the side of small probabilities keeps its digits.
    -Normal::standard().inverse_cdf(probability)
}
