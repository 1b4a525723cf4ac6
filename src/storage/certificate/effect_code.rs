//! The number that stands for an effect in a certificate.

use crate::theory::effect::{CATALOGUE, CODES, Effect, FIRST_OWN_CODE};

/// An effect in a certificate: the [`code`](crate::effect::Description::code) of its description.
///
/// Codes from 1 to 127 belong to the catalogue, and codes from 128 on to effects outside of it. Code 0
/// stands for an effect that has no code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EffectCode(u8);

impl EffectCode {
    /// An effect that has no code.
    pub const OTHER: Self = Self(0);

    /// The code of an effect. An effect outside of the catalogue that claims a code of the catalogue gets
    /// [`OTHER`](Self::OTHER).
    pub fn of(effect: &dyn Effect) -> Self {
        let description = effect.description();
        let known = CODES.contains(&(description.code, description.name));
        if known || description.code >= FIRST_OWN_CODE {
            Self(description.code)
        } else {
            Self::OTHER
        }
    }

    /// The effect with a number in a certificate; `None` if this version does not know the number, although
    /// it belongs to the catalogue's range.
    pub(super) fn from_number(number: u8) -> Option<Self> {
        let known = CODES.iter().any(|&(code, _)| code == number);
        let is_own = number == Self::OTHER.0 || number >= FIRST_OWN_CODE;
        (known || is_own).then_some(Self(number))
    }

    /// The number in the certificate.
    pub const fn number(self) -> u8 {
        self.0
    }

    /// The name of the effect, or `other` for an effect outside of the catalogue.
    pub fn name(self) -> &'static str {
        let known = CODES.iter().find(|(code, _)| *code == self.0);
        known.map_or("other", |(_, name)| name)
    }

    /// The effect of the catalogue that has the code; `None` if the effect is outside of it.
    pub fn effect(self) -> Option<&'static dyn Effect> {
        self.effect_of(&CATALOGUE)
    }

    /// The effect in a list that has the code. The list may hold effects outside of the catalogue. The result
    /// is `None` for [`OTHER`](Self::OTHER), and if no effect in the list has the code.
    pub fn effect_of(self, effects: &[&'static dyn Effect]) -> Option<&'static dyn Effect> {
        let mut effects = effects.iter().copied();
        effects.find(|effect| self != Self::OTHER && Self::of(*effect) == self)
    }
}
