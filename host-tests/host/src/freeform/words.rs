//! What is said of a filter of another form.

use super::NAME;
use crate::{
    number::{number, probability},
    words::plain,
};
use allanite::diagnosis::Step;
use allanite_log::unit::Unit;

/// A low pass of another form that explains a record without some of the effects that were named.
#[derive(Clone, Debug, PartialEq)]
pub struct Freeform {
    /// The frequency in Hz at which half of the power is left.
    pub cutoff_hz: f64,
    /// The angle random walk in front of the filter and the ends of its interval, in the unit of the rate times √s.
    pub angle_random_walk: [f64; 3],
    /// χ² of the model with the filter.
    pub chi_squared: f64,
    /// The probability of a larger χ² if that model is true.
    pub p_value: f64,
    /// The effects of the other model that this one does without.
    pub without: Vec<&'static str>,
}

impl Freeform {
    /// What the last step with the filter says, where another diagnosis ended with this step. `None` without the filter.
    pub fn of<const K: usize, const B: usize>(
        with: &Step<K, B>,
        other: &Step<K, B>,
    ) -> Option<Self> {
        let mut terms = with.model.terms().iter();
        let place = terms.position(|term| term.effect.name() == NAME)?;
        let white = with.fit.coefficients.get(place)?;
        let mut shapes = with.fit.shape.iter();
        let fitted = shapes.find(|shape| shape.term == place);
        let given = with.model.terms().get(place)?.parameters[0];
        let named = other.model.terms().iter().map(|term| term.effect);
        let without = named.filter(|effect| {
            let is_term = effect.parameters().is_empty() && effect.name() != "angle_random_walk";
            !is_term && with.model.position(effect.name()).is_none()
        });
        Some(Self {
            cutoff_hz: fitted.map_or(given, |shape| shape.value),
            angle_random_walk: [white.value, white.lower, white.upper],
            chi_squared: with.fit.chi_squared,
            p_value: with.fit.p_value,
            without: without.map(|effect| effect.name()).collect(),
        })
    }

    /// One sentence, with N in its unit.
    pub fn words(&self, unit: Unit) -> String {
        let [value, lower, upper] = self.angle_random_walk.map(number);
        let without: Vec<String> = self.without.iter().map(|name| plain(name)).collect();
        let without = match without.is_empty() {
            true => String::new(),
            false => format!(" without {}", without.join(" and ")),
        };
        format!(
            "a low pass of another form explains the record{without}: half of the power is left at {} Hz, N {value} ({lower} … {upper}) {unit}/√Hz, χ² {:.1}, p {}. Read which filters the sensor and its driver run",
            number(self.cutoff_hz),
            self.chi_squared,
            probability(self.p_value),
        )
    }
}
