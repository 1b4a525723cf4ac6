//! The number that stands for an effect in a record.

use crate::effect::{CATALOGUE, CODES, Effect, FIRST_OWN_CODE};

/// An effect in a record: the [`code`](crate::effect::Description::code) of its description.
///
/// Codes from 1 to 127 belong to the catalogue, those from 128 on to effects outside of it, and 0
/// stands for an effect that has no code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EffectCode(u8);

impl EffectCode {
    /// An effect that has no code.
    pub const OTHER: Self = Self(0);

    /// The code of an effect; [`OTHER`](Self::OTHER) for one outside of the catalogue that claims a
    /// code of the catalogue.
    pub fn of(effect: &dyn Effect) -> Self {
        let description = effect.description();
        let known = CODES.contains(&(description.code, description.name));
        if known || description.code >= FIRST_OWN_CODE {
            Self(description.code)
        } else {
            Self::OTHER
        }
    }

    /// The effect that a record has under a number; `None` for a number of the catalogue that this
    /// version does not know.
    pub(super) fn from_number(number: u8) -> Option<Self> {
        let known = CODES.iter().any(|&(code, _)| code == number);
        let is_own = number == Self::OTHER.0 || number >= FIRST_OWN_CODE;
        (known || is_own).then_some(Self(number))
    }

    /// The number in the record.
    pub const fn number(self) -> u8 {
        self.0
    }

    /// The effect's name; `other` for one outside of the catalogue.
    pub fn name(self) -> &'static str {
        let known = CODES.iter().find(|(code, _)| *code == self.0);
        known.map_or("other", |(_, name)| name)
    }

    /// The effect of the catalogue that has the code; `None` for one outside of it.
    pub fn effect(self) -> Option<&'static dyn Effect> {
        self.effect_of(&CATALOGUE)
    }

    /// The effect of a list that has the code, for a list that holds effects outside of the catalogue.
    /// `None` for [`OTHER`](Self::OTHER), and where the list has no effect with the code.
    pub fn effect_of(self, effects: &[&'static dyn Effect]) -> Option<&'static dyn Effect> {
        let mut effects = effects.iter().copied();
        effects.find(|effect| self != Self::OTHER && Self::of(*effect) == self)
    }
}
