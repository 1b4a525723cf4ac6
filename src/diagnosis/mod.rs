//! Which effect is missing: a diagnosis finds what a model lacks, adds it, and judges the curve again.
//!
//! A [`Diagnosis`] goes through the following stages, each in a file of its own. A model is *judged*:
//! it is fitted and compared with the curve. An earlier addition that it does not need any more is
//! *dropped*. Covariates are tested for whether the rate *follows* them.
//! The list of effects is *scanned* for shapes that would help. The best of these are *tried* in full.
//! Pairs of effects are *swapped* for an effect that was added alone. The best candidate is *chosen*,
//! and told from its *mirror*, which has the same Allan variance. Each stage hands a value to the next.

mod alternative;
mod chosen;
mod corrected;
mod dropped;
mod evidence;
mod followed;
mod judged;
mod mirrored;
mod options;
mod run;
mod scanned;
mod shaped;
mod step;
mod swapped;
#[cfg(test)]
mod tests;
mod trial;
mod tried;
mod verdict;
mod width;

pub use alternative::alternative;
pub use evidence::Evidence;
pub use options::Options;
pub use run::{Diagnosis, Progress};
pub use shaped::fit_shapes;
pub use step::{
    Addition, Beside, Candidate, FollowedCovariate, MAX_AMBIGUOUS, MAX_CANDIDATES, Step, Swap,
};
pub use verdict::Verdict;
pub use width::line_width;

pub(crate) use scanned::place;
pub(crate) use step::cost;
