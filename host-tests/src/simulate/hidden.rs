//! Effects beyond the five terms, hidden in a simulated record.

use super::{
    Random, Source,
    correlated::{Filtered, Pole, Sinusoid, Telegraph},
};
use allanite::effect::{CATALOGUE, Effect, MAX_PARAMETERS};
use std::f64::consts::PI;

/// An effect with its shape and its coefficient, in the rate unit of the record.
#[derive(Clone, Copy)]
pub struct Hidden {
    /// Which effect.
    pub effect: &'static dyn Effect,
    /// Its shape parameters.
    pub parameters: [f64; MAX_PARAMETERS],
    /// Its coefficient.
    pub coefficient: f64,
}

impl Hidden {
    /// An effect of the catalogue beyond the five terms, by name.
    pub fn new(name: &str, parameters: [f64; MAX_PARAMETERS], coefficient: f64) -> Option<Self> {
        let effect = CATALOGUE.into_iter().find(|effect| effect.name() == name)?;
        Some(Self {
            effect,
            parameters,
            coefficient,
        })
    }

    /// Its source; `None` for an effect that the simulator has no generator of.
    pub(super) fn source(&self, interval_s: f64, random: &mut Random) -> Option<Box<dyn Source>> {
        let (c, [first, second]) = (self.coefficient, self.parameters);
        Some(match self.effect.name() {
            "gauss_markov" => Box::new(Pole::new(c, first, 0.0, interval_s, random)),
            "resonance" => {
                let time_s = second / (PI * first);
                Box::new(Pole::new(c, time_s, first, interval_s, random))
            }
            "low_pass" => {
                let z = (-interval_s / first).exp();
                let rms = c * ((1.0 - z) / ((1.0 + z) * interval_s)).sqrt();
                Box::new(Pole::new(rms, first, 0.0, interval_s, random))
            }
            "decimation_filter" => {
                let stages = if second < 1.5 { 1 } else { 2 };
                let length_s = first / (stages as f64).sqrt();
                Box::new(Filtered::new(c, length_s, stages, interval_s, random))
            }
            "sinusoid" => Box::new(Sinusoid::new(c, first, interval_s, random)),
            "random_telegraph" => Box::new(Telegraph::new(c, first, interval_s, random)),
            _ => return None,
        })
    }

    /// Whether it takes the place of the white noise of the record.
    pub fn replaces_white_noise(&self) -> bool {
        self.effect
            .replaces()
            .is_some_and(|effect| effect.name() == "angle_random_walk")
    }
}
