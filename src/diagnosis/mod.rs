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
    curve: &crate::Curve<K>,
    spectrum: &crate::spectrum::Spectrum<B>,
    course: Option<&crate::course::CosineTransform>,
    effects: &[&'static dyn crate::effect::Effect],
    mut each: impl FnMut(&[crate::Term], crate::Real, crate::Real),
    pause: &mut dyn FnMut() -> core::ops::ControlFlow<()>,
) {
    let observed = crate::Observed::new(curve, spectrum);
    let observation = search::Observation::new(observed, course, |bin| bin.effective_segments());
    let mut search = search::Search::<B>::NEW;
    let model = crate::Model::ieee_952();
    if let core::ops::ControlFlow::Continue(found) =
        search.run(&observation, &model, effects, search::Limits { effects: 4, threshold: 8.0, ambiguity: 6.0 }, pause)
    {
        let mut tell = |hypothesis: &search::Hypothesis, beyond| {
            let terms: heapless::Vec<crate::Term, 4> = crate::list::fill(hypothesis.terms().copied());
            each(&terms, beyond, hypothesis.score);
        };
        tell(&found.best, 0.0);
        for (other, beyond) in &found.alternatives {
            tell(other, *beyond);
        }
        each(&[], crate::Real::INFINITY, found.plain);
    }
}
