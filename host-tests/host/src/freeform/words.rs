//! What is said of a filter of another form.

use super::NAME;
use crate::{
    known_filter::is_filter,
    number::{number, probability},
    words::plain,
};
use allanite::{
    diagnosis::Step,
    effect::{AngleRandomWalk, Effect},
};
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
    /// Whether that model is adequate, and whether the other one is.
    pub explains: [bool; 2],
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
        let is_white = |effect: &dyn Effect| effect.name() == AngleRandomWalk.description().name;
        // White noise alone is what the filter filters; besides another filter it is an effect of its own.
        let mut effects = named.clone();
        let is_filtered = effects.any(is_filter);
        let without = named.filter(|effect| {
            let is_added = !effect.parameters().is_empty() || is_filtered && is_white(*effect);
            is_added && with.model.position(effect.name()).is_none()
        });
        Some(Self {
            cutoff_hz: fitted.map_or(given, |shape| shape.value),
            angle_random_walk: [white.value, white.lower, white.upper],
            chi_squared: with.fit.chi_squared,
            p_value: with.fit.p_value,
            explains: [with, other].map(|step| step.fit.is_adequate() == Some(true)),
            without: without.map(|effect| effect.name()).collect(),
        })
    }

    /// One sentence, with N in its unit.
    pub fn words(&self, unit: Unit) -> String {
        let [value, lower, upper] = self.angle_random_walk.map(number);
        let names: Vec<String> = self.without.iter().map(|name| plain(name)).collect();
        let without = match names.split_last() {
            None => String::new(),
            Some((last, [])) => format!(" without {last}"),
            Some((last, others)) => format!(" without {} and {last}", others.join(", ")),
        };
        let explains = match self.explains {
            [true, true] => "explains the record as well",
            [true, false] => "explains the record",
            [false, _] => "explains more of the record",
        };
        format!(
            "a low pass of another form {explains}{without}: half of the power is left at {} Hz, N {value} ({lower} … {upper}) {unit}/√Hz, χ² {:.1}, p {}. Read which filters the sensor and its driver run",
            number(self.cutoff_hz),
            self.chi_squared,
            probability(self.p_value),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_filter_that_leaves_something_is_not_called_an_explanation() {
        let mut one = Freeform {
            cutoff_hz: 7.135,
            angle_random_walk: [0.00492, 0.004742, 0.005071],
            chi_squared: 93.6,
            p_value: 0.819,
            explains: [true, false],
            without: vec!["output_low_pass", "resonance", "gauss_markov"],
        };
        let words = one.words(Unit::DegreesPerSecond);
        let start = "a low pass of another form explains the record without output low pass, resonance and Gauss–Markov: half of the power is left at 7.135 Hz, N 0.004920 (0.004742 … 0.005071) deg/s/√Hz, χ² 93.6, p = 0.819. ";
        assert!(words.starts_with(start), "{words}");
        (one.explains, one.p_value) = ([false, false], 0.002);
        one.without.truncate(1);
        let words = one.words(Unit::DegreesPerSecond);
        let start =
            "a low pass of another form explains more of the record without output low pass: ";
        assert!(words.starts_with(start), "{words}");
    }
}
