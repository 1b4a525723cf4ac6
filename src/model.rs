//! A model: the effects that make up a curve.

use crate::{
    effect::{Effect, IEEE_952, Setting},
    error::Error,
};
use heapless::Vec;

/// Effects that one model has room for.
pub const MAX_EFFECTS: usize = 8;

/// A list of effects, each with a coefficient that a fit determines.
#[derive(Clone)]
pub struct Model {
    effects: Vec<&'static dyn Effect, MAX_EFFECTS>,
}

impl Model {
    /// Quantization, angle random walk, bias instability, rate random walk and rate ramp.
    pub fn ieee_952() -> Self {
        let mut effects = Vec::new();
        // Five fit into eight.
        let _ = effects.extend_from_slice(&IEEE_952);
        Self { effects }
    }

    /// A model of these effects.
    ///
    /// # Errors
    /// [`Error::TooManyEffects`] above [`MAX_EFFECTS`].
    pub fn new(effects: &[&'static dyn Effect]) -> Result<Self, Error> {
        let too_many = Error::TooManyEffects {
            capacity: MAX_EFFECTS,
        };
        let effects = Vec::from_slice(effects).map_err(|_| too_many)?;
        Ok(Self { effects })
    }

    /// The effects, in the order in which they were added.
    pub fn effects(&self) -> &[&'static dyn Effect] {
        &self.effects
    }

    /// Allan variance at an averaging factor, in rate units squared, for squared coefficients in
    /// the order of the effects.
    pub fn variance(&self, squares: &[f64], m: u32, setting: &Setting) -> f64 {
        let shares = self.effects.iter().zip(squares);
        shares
            .map(|(effect, square)| square * effect.variance(f64::from(m), setting))
            .sum()
    }
}

impl core::fmt::Debug for Model {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let names = self.effects.iter().map(|effect| effect.name());
        f.debug_list().entries(names).finish()
    }
}
