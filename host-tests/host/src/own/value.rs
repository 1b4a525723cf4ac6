//! The list behind a formula: its name, and the values of its parameters.

use super::refusal::Refusal;
use allanite::effect::{CATALOGUE, MAX_PARAMETERS};
use allanite_log::failure::quoted;

/// The name of an effect that is given none.
pub(super) const NAME: &str = "own";

/// The name of an effect, and the values of its parameters by their names.
type Values<'a> = (String, Vec<(&'a str, Value)>);

/// A value in the list behind a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value {
    Known(f64),
    Begin(f64),
    Range([f64; 2]),
}

/// The name of the effect and the values of its parameters, which follow the formula.
pub(super) fn values<'a>(parts: impl Iterator<Item = &'a str>) -> Result<Values<'a>, Refusal> {
    let mut name = NAME.to_owned();
    let mut values: Vec<(&str, Value)> = Vec::new();
    for part in parts.map(str::trim).filter(|part| !part.is_empty()) {
        let Some((own, text)) = part.split_once(['=', '~']) else {
            return Err((
                format!("{} has no value", quoted(part.as_bytes())),
                "write NAME=VALUE, NAME~VALUE or NAME=LOW..HIGH".into(),
            ));
        };
        let is_begin = part.as_bytes().get(own.len()) == Some(&b'~');
        let (own, text) = (own.trim(), text.trim());
        if own == "name" {
            let is_letter = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
            let is_taken = CATALOGUE.iter().any(|effect| effect.name() == text);
            if text.is_empty() || !text.chars().all(is_letter) || is_taken {
                return Err((
                    format!(
                        "{} is no name for an effect, or taken",
                        quoted(text.as_bytes())
                    ),
                    "use lower case and underscores".into(),
                ));
            }
            text.clone_into(&mut name);
            continue;
        }
        if values.iter().any(|(other, _)| *other == own) {
            return Err((format!("{own} is given twice"), "give it once".into()));
        }
        let number = |text: &str| {
            let number = text.trim().parse::<f64>().ok();
            let number = number.filter(|number| number.is_finite() && *number > 0.0);
            number.ok_or_else(|| {
                (
                    format!("{own}={} is no number above 0", quoted(text.as_bytes())),
                    "give a number, such as 0.3, or a range, such as 0.1..30".into(),
                )
            })
        };
        let value = match (text.split_once(".."), is_begin) {
            (Some((low, high)), false) => {
                let ends = [number(low)?, number(high)?];
                if ends[0] >= ends[1] {
                    return Err((
                        format!("{own}={text} is no range"),
                        "give the lower end first".into(),
                    ));
                }
                Value::Range(ends)
            }
            (_, true) => Value::Begin(number(text)?),
            (None, false) => Value::Known(number(text)?),
        };
        values.push((own, value));
    }
    Ok((name, values))
}

/// The values in the order in which the formula has its parameters.
pub(super) fn in_order(names: &[String], values: &[(&str, Value)]) -> Result<Vec<Value>, Refusal> {
    if let Some((name, _)) = values
        .iter()
        .find(|(name, _)| !names.iter().any(|own| own == name))
    {
        return Err((
            format!("the formula has no {}", quoted(name.as_bytes())),
            "leave it out".into(),
        ));
    }
    if names.len() > MAX_PARAMETERS {
        return Err((
            format!(
                "the formula has {} parameters: {}",
                names.len(),
                names.join(", ")
            ),
            format!("write numbers for all but {MAX_PARAMETERS}"),
        ));
    }
    let value = |name: &String| {
        let given = values.iter().find(|(own, _)| *own == name);
        given.map(|(_, value)| *value).ok_or_else(|| {
            (
                format!("{name} has no value"),
                format!("write a number, or add ; {name}=LOW..HIGH, in which it is fitted"),
            )
        })
    };
    let values = names.iter().map(value).collect::<Result<Vec<_>, _>>()?;
    let is_known = |value: &Value| matches!(value, Value::Known(_));
    let is_range = |value: &Value| matches!(value, Value::Range(_));
    let kinds = [is_known as fn(&Value) -> bool, is_range, |value| {
        matches!(value, Value::Begin(_))
    }];
    if !kinds.iter().any(|kind| values.iter().all(kind)) {
        return Err((
            "some parameters are known and others are not, or only some have a begin".into(),
            "write the known numbers into the formula, and ranges or begins for all others".into(),
        ));
    }
    Ok(values)
}
