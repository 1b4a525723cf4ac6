//! Which effect is missing: a diagnosis finds what a model lacks, adds it, and judges the curve again.
//!
//! A [`Diagnosis`] judges a model, tests whether the rate follows a covariate, and searches for what is missing: several
//! hypotheses are kept side by side, each a story of the whole record, until the likelihood decides between them. What was
//! found is narrated step by step, the largest fall of the error first.

mod alternative;
mod corrected;
mod followed;
mod judged;
mod mirrored;
mod narrated;
mod options;
mod polished;
mod run;
pub(crate) mod search;
mod shaped;
mod step;
#[cfg(test)]
mod tests;
mod verdict;
mod width;

pub use alternative::alternative;
pub use options::Options;
pub use run::{Diagnosis, Progress};
pub use shaped::fit_shapes;
pub use step::{
    Addition, Beside, Candidate, FollowedCovariate, MAX_AMBIGUOUS, MAX_CANDIDATES, Step,
};
pub use verdict::Verdict;
pub use width::line_width;

/// What a search says, for experiments.
#[doc(hidden)]
pub fn lab<const K: usize, const B: usize>(
    record: crate::Record<'_, K, B>,
    effects: &[&'static dyn crate::effect::Effect],
    filter: Option<crate::Term>,
    added: &[crate::Term],
    each: &mut dyn FnMut(&[crate::Term], crate::Real, crate::Real),
) {
    let observation = search::Observation::new(record.observed(), record.course, |bin| {
        bin.effective_segments()
    });
    let mut search = search::Search::<B>::NEW;
    let model = crate::Model::ieee_952();
    search.lab(&observation, &model, effects, filter, added, each);
}
