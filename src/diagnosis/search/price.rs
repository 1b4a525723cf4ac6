//! What an effect costs beyond its parameters.

use super::kind::{continuous, has_frequency, is_drifting, is_filter, is_line};
use crate::{numerics::real::Real, theory::model::Term};

/// The prices are above what the best effect of each kind gains on clean records by chance, beyond two for each parameter.
/// `cargo xtask study clean` measures how often that happens.
const LINE: Real = 14.0;
const RESONANCE: Real = 13.0;
/// A resonance of a quality above [`NARROW`] has as many places as a line.
const NARROW_RESONANCE: Real = 17.0;
const NARROW: Real = 25.0;
/// A resonance of a quality below one has no peak, and with other noise imitates every filter.
const BROAD_RESONANCE: Real = 19.0;
const BROAD: Real = 1.0;
/// An oscillation whose frequency moved has to lead over one that stayed.
const DRIFTING: Real = 17.0;
/// Of 2000 clean records, three gain more with slow noise.
const NOISE: Real = 6.6;
/// Octaves alone show slow noise by a few numbers, which scatter together.
const NOISE_IN_OCTAVES: Real = 8.0;
/// Noise of another kind, such as a power law, competes with all of the five terms.
const OTHER_NOISE: Real = 9.0;
/// Noise that is correlated over fewer than [`FAST`] samples competes with every filter.
const FAST_NOISE: Real = 15.5;
const FAST: Real = 20.0;
const FILTER: Real = 12.0;
/// A filter that has another one as its special case has to lead over it.
const SPECIAL_FILTER: Real = 13.5;
/// Several equal stages imitate one pole at the sample rate, which is preferred.
const STAGES: Real = 15.0;
/// A filter of two shapes has more places, and one that imitates others has to lead over them.
const SHAPED_FILTER: Real = 14.0;
const SHAPED_SPECIAL_FILTER: Real = 18.0;

/// The threshold at which the prices are those above. Another threshold changes all of them by as much.
pub(crate) const THRESHOLD: Real = 8.0;

/// The price of an effect, for samples that are `interval_s` seconds apart, in a record with a spectrum or without.
pub(crate) fn price(term: &Term, interval_s: Real, threshold: Real, has_bins: bool) -> Real {
    usual(term, interval_s, has_bins) + threshold - THRESHOLD
}

fn usual(term: &Term, interval_s: Real, has_bins: bool) -> Real {
    let effect = term.effect;
    if is_filter(effect) {
        let last = effect.parameters().last();
        if effect.description().special_case.is_some() && last.is_some_and(|p| p.name == "stages") {
            return STAGES;
        }
        return match (continuous(effect), effect.description().special_case) {
            (0 | 1, None) => FILTER,
            (0 | 1, Some(_)) => SPECIAL_FILTER,
            (_, None) => SHAPED_FILTER,
            (_, Some(_)) => SHAPED_SPECIAL_FILTER,
        };
    }
    let noise = if has_bins { NOISE } else { NOISE_IN_OCTAVES };
    if effect.parameters().is_empty() {
        return noise;
    }
    if is_line(effect) {
        return LINE;
    }
    if is_drifting(effect) {
        return DRIFTING;
    }
    if has_frequency(effect) {
        return if term.parameter(1) > NARROW {
            NARROW_RESONANCE
        } else if term.parameter(1) < BROAD {
            BROAD_RESONANCE
        } else {
            RESONANCE
        };
    }
    let is_time = effect
        .parameters()
        .first()
        .is_some_and(|first| first.unit == "s");
    if !is_time {
        return OTHER_NOISE;
    }
    if term.parameter(0) < FAST * interval_s {
        FAST_NOISE
    } else {
        noise
    }
}
