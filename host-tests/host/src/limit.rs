//! A limit of a coefficient, as an option of the command line.

use crate::units;
use allanite::{
    effect::{CATALOGUE, Effect, IEEE_952},
    self_test::BIAS,
};
use allanite_log::{
    failure::{Failure, quoted},
    unit::Unit,
};

/// What a limit is of.
#[derive(Clone, Copy)]
pub enum Limited {
    /// The coefficient of an effect.
    Coefficient(&'static dyn Effect),
    /// The mean rate, of either sign.
    Bias,
}

/// The largest value that a coefficient or the mean rate may have, as it was given.
#[derive(Clone)]
pub struct LimitArgument {
    text: String,
    limited: Limited,
    value: f64,
    /// The name of the unit; empty for that of the input.
    unit: String,
}

/// The largest value that a coefficient may have, in the unit of the input.
#[derive(Clone, Copy)]
pub struct Limit {
    /// The effect.
    pub effect: &'static dyn Effect,
    /// The limit, in rate unit · s^(half_seconds/2) of the effect.
    pub value: f64,
}

impl LimitArgument {
    /// Reads `EFFECT=VALUE` or `EFFECT=VALUE UNIT`, where the blank may be left out.
    ///
    /// # Errors
    /// When there is no such effect, or the value is not a positive number.
    pub fn parse(text: &str) -> Result<Self, Failure> {
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
        let limited = match found {
            Some(effect) => Limited::Coefficient(effect),
            None if name == BIAS => Limited::Bias,
            None => {
                return Err(refused(
                    text,
                    "there is no such effect",
                    "give a symbol such as N, a name such as angle_random_walk, or bias",
                ));
            }
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
            limited,
            value,
            unit: unit.to_owned(),
        })
    }

    /// Reads limits, at most one for each effect.
    ///
    /// # Errors
    /// As of [`parse`](Self::parse), and when an effect has two limits.
    pub fn all(texts: &[String]) -> Result<Vec<Self>, Failure> {
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
    pub fn of_another_model(&self) -> Failure {
        let what = format!("the five terms do not have the effect {}", self.name());
        refused(&self.text, &what, "limit Q, N, B, K or R")
    }

    /// What it is of.
    pub const fn limited(&self) -> Limited {
        self.limited
    }

    /// The name of the effect, or that of the bias.
    pub fn name(&self) -> &'static str {
        match self.limited {
            Limited::Coefficient(effect) => effect.name(),
            Limited::Bias => BIAS,
        }
    }

    /// The limit of a coefficient for rates in this unit.
    ///
    /// # Errors
    /// When the coefficient has no such unit, or it is a limit of the bias.
    pub fn of_unit(&self, unit: Unit) -> Result<Limit, Failure> {
        match self.limited {
            Limited::Coefficient(effect) => Ok(Limit {
                effect,
                value: self.value_in(unit)?,
            }),
            Limited::Bias => Err(refused(
                &self.text,
                "a lot is that of coefficients, and a certificate has no mean rate",
                "judge each log by `fit --limit bias=VALUE`",
            )),
        }
    }

    /// The largest value for rates in this unit.
    ///
    /// # Errors
    /// When the quantity has no such unit.
    pub fn value_in(&self, unit: Unit) -> Result<f64, Failure> {
        let half_seconds = match self.limited {
            Limited::Coefficient(effect) => effect.half_seconds(),
            Limited::Bias => 0,
        };
        let own = units::unit(unit, half_seconds);
        let customary = units::customary(unit, half_seconds);
        let given = plain(&self.unit);
        let factor = match customary {
            _ if given.is_empty() || given == plain(&own) => 1.0,
            Some((factor, name)) if given == plain(name) => factor,
            _ => {
                let also = customary.map_or(String::new(), |(_, name)| format!(" or {name}"));
                return Err(refused(
                    &self.text,
                    &format!("{} has no such unit", self.name()),
                    &format!("give it in {own}{also}"),
                ));
            }
        };
        Ok(self.value / factor)
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
        let limit = LimitArgument::parse(text).and_then(|one| one.value_in(Unit::DegreesPerSecond));
        limit.map_err(|failure| failure.to_string())
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
            ("bias=0.005", 0.005),
            ("bias = 18 deg/h", 0.005),
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
            ("bias=3°/√h", "give it in deg/s or °/h"),
        ] {
            let refusal = value(text).unwrap_err();
            assert!(refusal.contains(what), "{text}: {refusal}");
        }
    }
}
