//! A limit of a coefficient, as an option of the command line.

use allanite::effect::{CATALOGUE, Effect, IEEE_952};
use allanite_host::units;
use allanite_log::{
    failure::{Failure, quoted},
    unit::Unit,
};

/// The largest value that a coefficient may have, as it was given.
#[derive(Clone)]
pub(crate) struct LimitArgument {
    text: String,
    effect: &'static dyn Effect,
    value: f64,
    /// The name of the unit; empty for that of the input.
    unit: String,
}

/// The largest value that a coefficient may have, in the unit of the input.
#[derive(Clone, Copy)]
pub(crate) struct Limit {
    /// The effect.
    pub(crate) effect: &'static dyn Effect,
    /// The limit, in rate unit · s^(half_seconds/2) of the effect.
    pub(crate) value: f64,
}

impl LimitArgument {
    /// Reads `EFFECT=VALUE` or `EFFECT=VALUE UNIT`, where the blank may be left out.
    ///
    /// # Errors
    /// When there is no such effect, or the value is not a positive number.
    pub(crate) fn parse(text: &str) -> Result<Self, Failure> {
        let Some((name, value)) = text.split_once('=') else {
            return Err(refused(
                text,
                "there is no value",
                "write EFFECT=VALUE, such as N=0.005",
            ));
        };
        let mut effects = IEEE_952.into_iter().chain(CATALOGUE);
        let name = name.trim();
        let found = effects.find(|effect| effect.name() == name || effect.symbol() == name);
        let Some(effect) = found else {
            return Err(refused(
                text,
                "there is no such effect",
                "give a symbol such as N, or a name such as angle_random_walk",
            ));
        };
        let (number, unit) = split(value.trim());
        let Some(value) = number.filter(|value| value.is_finite() && *value > 0.0) else {
            return Err(refused(
                text,
                "the value is not a positive number",
                "give a number such as 0.005",
            ));
        };
        Ok(Self {
            text: text.to_owned(),
            effect,
            value,
            unit: unit.to_owned(),
        })
    }

    /// Reads limits, at most one for each effect.
    ///
    /// # Errors
    /// As of [`parse`](Self::parse), and when an effect has two limits.
    pub(crate) fn all(texts: &[String]) -> Result<Vec<Self>, Failure> {
        let mut limits: Vec<Self> = Vec::new();
        for text in texts {
            let limit = Self::parse(text)?;
            if limits.iter().any(|other| other.name() == limit.name()) {
                let name = limit.name();
                return Err(Failure::option(
                    format!("--limit {text}: {name} has two limits"),
                    "give one",
                ));
            }
            limits.push(limit);
        }
        Ok(limits)
    }

    /// The failure of a limit whose effect is not fitted.
    pub(crate) fn of_another_model(&self) -> Failure {
        let what = format!("the five terms do not have the effect {}", self.name());
        refused(&self.text, &what, "limit Q, N, B, K or R")
    }

    /// The name of the effect.
    pub(crate) fn name(&self) -> &'static str {
        self.effect.name()
    }

    /// The limit for rates in this unit.
    ///
    /// # Errors
    /// When the coefficient has no such unit.
    pub(crate) fn of_unit(&self, unit: Unit) -> Result<Limit, Failure> {
        let (effect, own) = (self.effect, units::unit(unit, self.effect.half_seconds()));
        let customary = units::customary(unit, effect.half_seconds());
        let given = plain(&self.unit);
        let factor = match customary {
            _ if given.is_empty() || given == plain(&own) => 1.0,
            Some((factor, name)) if given == plain(name) => factor,
            _ => {
                let also = customary.map_or(String::new(), |(_, name)| format!(" or {name}"));
                return Err(refused(
                    &self.text,
                    &format!("{} has no such unit", effect.name()),
                    &format!("give it in {own}{also}"),
                ));
            }
        };
        Ok(Limit {
            effect,
            value: self.value / factor,
        })
    }
}

fn refused(text: &str, what: &str, remedy: &str) -> Failure {
    let shown = quoted(text.as_bytes());
    Failure::option(format!("--limit {shown}: {what}"), remedy)
}

/// The longest number that a text begins with, and the rest.
fn split(text: &str) -> (Option<f64>, &str) {
    let ends = text.char_indices().map(|(i, one)| i + one.len_utf8());
    let mut numbers = ends.filter_map(|end| Some((text[..end].parse().ok()?, end)));
    match numbers.next_back() {
        Some((number, end)) => (Some(number), text[end..].trim_start()),
        None => (None, text),
    }
}

/// A unit in letters that every keyboard has, without brackets and blanks: `deg/sqrth` for `°/√h`.
fn plain(unit: &str) -> String {
    let mut plain = String::new();
    for one in unit.chars() {
        match one {
            '°' => plain.push_str("deg"),
            '√' => plain.push_str("sqrt"),
            '²' => plain.push_str("^2"),
            '³' => plain.push_str("^3"),
            'µ' | 'μ' => plain.push('u'),
            '·' => plain.push('*'),
            '(' | ')' | ' ' => {}
            other => plain.push(other),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> Result<f64, String> {
        let limit = LimitArgument::parse(text).and_then(|one| one.of_unit(Unit::DegreesPerSecond));
        limit
            .map(|limit| limit.value)
            .map_err(|failure| failure.to_string())
    }

    #[test]
    fn limits_have_the_unit_of_the_certificate_or_the_customary_one() {
        for (text, expected) in [
            ("N=0.005", 0.005),
            ("angle_random_walk=5e-3", 0.005),
            ("N=0.005deg/s/√Hz", 0.005),
            ("N=0.3°/√h", 0.005),
            ("N=0.3 deg/sqrt(h)", 0.005),
            ("B = 18 deg/h", 0.005),
            ("B=18°/h", 0.005),
            ("B=0.005 deg/s", 0.005),
            ("Q=18 arcsec", 0.005),
            ("R=64800°/h²", 0.005),
            ("K=1.08e3 deg/h^1.5", 0.005),
        ] {
            let found = value(text).unwrap();
            assert!((found / expected - 1.0).abs() < 1e-12, "{text}: {found}");
        }
    }

    #[test]
    fn what_is_no_limit_is_refused_with_what_would_be_one() {
        for (text, what) in [
            ("N", "there is no value"),
            ("Z=1", "there is no such effect"),
            ("N=-1", "is not a positive number"),
            ("N=nan", "is not a positive number"),
            ("N=deg/s", "is not a positive number"),
            ("N=0.3 °/h", "give it in deg/s/√Hz or °/√h"),
        ] {
            let refusal = value(text).unwrap_err();
            assert!(refusal.contains(what), "{text}: {refusal}");
        }
    }
}
