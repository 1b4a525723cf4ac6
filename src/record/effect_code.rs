//! Effects as numbers that stay.

use crate::effect::{CATALOGUE, Effect};

/// The names of the codes from 1 on; a name that has a code keeps it in every version.
const NAMES: [&str; 11] = [
    "quantization",
    "angle_random_walk",
    "bias_instability",
    "rate_random_walk",
    "rate_ramp",
    "gauss_markov",
    "sinusoid",
    "resonance",
    "low_pass",
    "decimation_filter",
    "random_telegraph",
];

/// An effect in a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EffectCode(u8);

impl EffectCode {
    /// An effect of somebody's own.
    pub const OTHER: Self = Self(0);

    /// The code of a name; [`OTHER`](Self::OTHER) of one that the catalogue does not have.
    pub fn of(name: &str) -> Self {
        let place = NAMES.iter().position(|known| *known == name);
        Self(place.map_or(0, |place| place as u8 + 1))
    }

    /// The effect of a code that is known.
    pub(super) fn from_number(number: u8) -> Option<Self> {
        (usize::from(number) <= NAMES.len()).then_some(Self(number))
    }

    /// The code.
    pub const fn number(self) -> u8 {
        self.0
    }

    /// The effect's name; `other` for one that is not in the catalogue.
    pub fn name(self) -> &'static str {
        let place = usize::from(self.0).checked_sub(1);
        place
            .and_then(|place| NAMES.get(place))
            .copied()
            .unwrap_or("other")
    }

    /// The effect itself, with its units and what there is to say of it.
    pub fn effect(self) -> Option<&'static dyn Effect> {
        let mut known = CATALOGUE.iter().copied();
        known.find(|effect| effect.name() == self.name())
    }
}
