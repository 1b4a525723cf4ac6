//! Which effect is missing: what a model lacks is found, added, and the curve judged again.
//!
//! A [`Diagnosis`] goes through these stages, one file each: a model is *judged* (fitted and compared with
//! the curve), covariates are asked whether the rate *follows* them, the list of effects is *scanned* for
//! shapes that would help, the best of these are *tried* in full, pairs of effects are *swapped* for one
//! that was added alone, the best candidate is *chosen*, and told from its *mirror* image of the same Allan
//! variance. Each stage hands a value to the next.

mod alternative;
mod chosen;
mod evidence;
mod followed;
mod judged;
mod mirrored;
mod options;
mod run;
mod scanned;
mod step;
mod swapped;
#[cfg(test)]
mod tests;
mod trial;
mod tried;
mod verdict;

pub use alternative::alternative;
pub use evidence::Evidence;
pub use options::Options;
pub use run::{Diagnosis, Progress};
pub use step::{Addition, Candidate, FollowedCovariate, MAX_AMBIGUOUS, MAX_CANDIDATES, Step, Swap};
pub use verdict::Verdict;
