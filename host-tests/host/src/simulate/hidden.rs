//! Effects beyond the five terms that are hidden in a simulated record.

use super::{
    Random, Source, deterministic::Deterministic, filtered::Filtered, gaussian::Gaussian,
    markov::Markov, swept::Swept, two_levels::TwoLevels,
};
use allanite::effect::{
    AngleRandomWalk, CATALOGUE, Distribution, Effect, MAX_PARAMETERS, SampledShape, padded,
};

/// An effect with its shape and its coefficient, in the rate unit of the record.
///
/// Any effect can be hidden, even one that is not in the catalogue. Its kernel and its
/// [`Distribution`] determine how to draw it.
#[derive(Clone, Copy)]
pub struct Hidden {
    /// The effect.
    pub effect: &'static dyn Effect,
    /// Its shape parameters.
    pub parameters: [f64; MAX_PARAMETERS],
    /// Its coefficient.
    pub coefficient: f64,
}

impl Hidden {
    /// The effect of the catalogue with this name, or `None` if there is none. Parameters that are not given are zero.
    pub fn new<const N: usize>(name: &str, parameters: [f64; N], coefficient: f64) -> Option<Self> {
        let effect = CATALOGUE.into_iter().find(|effect| effect.name() == name)?;
        Some(Self {
            effect,
            parameters: padded(parameters),
            coefficient,
        })
    }

    /// The source that draws a realisation of the effect. A frequency that drifts runs up and down once in `sweep_s`
    /// seconds.
    pub(super) fn source(
        &self,
        interval_s: f64,
        sweep_s: f64,
        random: &mut Random,
    ) -> Box<dyn Source> {
        let (effect, coefficient) = (self.effect, self.coefficient);
        let shape = SampledShape {
            interval_s,
            parameters: self.parameters,
        };
        if let Some(response) = effect.response(1.0, &shape) {
            return Box::new(Deterministic::new(
                response,
                coefficient,
                interval_s,
                random,
            ));
        }
        if let Some(filtered) = Filtered::new(effect, &shape, coefficient, random) {
            return Box::new(filtered);
        }
        if let Some(markov) = Markov::new(effect, &shape, coefficient, random) {
            return Box::new(markov);
        }
        let distribution = effect.description().distribution;
        if distribution == Distribution::TwoLevels {
            return Box::new(TwoLevels::new(effect, &shape, coefficient, random));
        }
        if distribution == Distribution::Swept {
            let period = sweep_s / interval_s;
            if let Some(swept) = Swept::new(effect, &shape, coefficient, period, random) {
                return Box::new(swept);
            }
        }
        Box::new(Gaussian::new(effect, &shape, coefficient, random))
    }

    /// Whether the effect replaces the white noise of the record.
    pub fn replaces_white_noise(&self) -> bool {
        self.replaces(&AngleRandomWalk)
    }

    /// Whether the effect takes the place of this one.
    pub fn replaces(&self, other: &dyn Effect) -> bool {
        let replaced = self.effect.replaces();
        replaced.is_some_and(|effect| effect.name() == other.name())
    }
}
