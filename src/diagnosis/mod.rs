//! Which effect is missing: a diagnosis finds what a model lacks, adds it, and judges the curve again.
//!
//! A [`Diagnosis`] judges a model, tests whether the rate follows a covariate, and searches for what is missing: several
//! hypotheses are kept in parallel, each an explanation of the whole record, until the likelihood decides between them. The
//! effects found are reported step by step, the largest fall of the error first.

mod alternative;
mod assessment;
mod correction;
mod covariate_regression;
mod dependence;
mod extended;
mod falling;
mod mirror;
mod options;
mod polish;
mod run;
pub(crate) mod search;
mod shapes;
mod step;
mod story;
#[cfg(test)]
mod tests;
mod verdict;
mod width;

pub use alternative::alternative;
pub use dependence::Dependence;
pub use options::Options;
pub use run::{Diagnosis, Progress};
pub use shapes::fit_shapes;
pub use step::{
    Addition, Candidate, FollowedCovariate, MAX_AMBIGUOUS, MAX_CANDIDATES, SecondCovariate, Step,
};
pub use verdict::Verdict;
pub use width::line_width;
