//! Fourth stage: the best candidate is added if it is worth its parameters. This file holds the rule of
//! ambiguity.

use super::step::{Candidate, MAX_AMBIGUOUS};
use crate::real::Real;
use heapless::Vec;

/// What is chosen from the candidates of a step.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Chosen {
    /// Effects that explain the curve about as well as those of the best candidate.
    pub(super) ambiguous: Vec<&'static str, MAX_AMBIGUOUS>,
}

/// Chooses the first of the candidates, which are sorted by their improvement, if its improvement
/// reaches `threshold`. Candidates whose improvement is less than `ambiguity` below that of the first
/// one make it ambiguous: the result names the effects that they bring and the first one does not.
pub(super) fn choose(candidates: &[Candidate], threshold: Real, ambiguity: Real) -> Option<Chosen> {
    let (first, others) = candidates.split_first()?;
    if first.improvement < threshold {
        return None;
    }
    let dropped = first.swap.map(|swap| swap.dropped.name());
    let brought = first.brings(dropped);
    let mut ambiguous = Vec::new();
    let close = |other: &&Candidate| other.improvement > first.improvement - ambiguity;
    // An effect that leads over its special case has excluded it.
    let others = others
        .iter()
        .filter(|other| !other.is_special_case_of(first));
    for other in others.filter(close) {
        for name in other.brings(dropped).into_iter().flatten() {
            if !brought.contains(&Some(name)) && !ambiguous.contains(&name) {
                // There is a place for every name that candidates can bring.
                let _ = ambiguous.push(name);
            }
        }
    }
    Some(Chosen { ambiguous })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        diagnosis::step::Swap,
        effect::{DecimationFilter, Effect, LowPass, Resonance, Sinusoid},
        model::Term,
    };

    fn candidate(effect: &'static dyn Effect, improvement: Real) -> Candidate {
        Candidate {
            term: Term::new(effect),
            swap: None,
            coefficient: 1.0,
            chi_squared: 10.0,
            improvement,
        }
    }

    fn names(chosen: Option<Chosen>) -> Option<Vec<&'static str, MAX_AMBIGUOUS>> {
        chosen.map(|chosen| chosen.ambiguous)
    }

    #[test]
    fn no_candidate_is_chosen_below_the_threshold() {
        assert_eq!(choose(&[], 8.0, 6.0), None);
        assert_eq!(choose(&[candidate(&Sinusoid, 7.9)], 8.0, 6.0), None);
        let chosen = choose(&[candidate(&Sinusoid, 8.0)], 8.0, 6.0);
        assert_eq!(names(chosen), Some(Vec::new()));
    }

    #[test]
    fn candidates_within_the_ambiguity_are_named_and_others_are_not() {
        let candidates = [
            candidate(&Sinusoid, 100.0),
            candidate(&Resonance, 94.1),
            candidate(&LowPass, 93.9),
        ];
        let ambiguous = names(choose(&candidates, 8.0, 6.0)).unwrap_or_default();
        assert_eq!(ambiguous, ["resonance"]);
    }

    #[test]
    fn candidates_that_keep_the_dropped_effect_make_a_swap_ambiguous() {
        let swap = Swap {
            dropped: &Resonance,
            taken: &LowPass,
        };
        let best = Candidate {
            swap: Some(swap),
            ..candidate(&Sinusoid, 50.0)
        };
        // Without the swap, the dropped effect stays in the model.
        let candidates = [best, candidate(&DecimationFilter, 49.0)];
        let ambiguous = names(choose(&candidates, 8.0, 6.0)).unwrap_or_default();
        assert_eq!(ambiguous, ["decimation_filter", "resonance"]);
    }
}
