//! Effects as options of the command line: `EFFECT[:parameter=value,…]`.

use crate::failure::{Failure, quoted};
use allanite::effect::{CATALOGUE, Effect, MAX_PARAMETERS, Parameter, Span};

/// The effect that an option names, with the values that have not been taken from it yet.
#[derive(Clone, Debug)]
pub(super) struct EffectArgument<'a> {
    option: &'static str,
    pub(super) name: &'a str,
    values: Vec<(&'a str, f64)>,
    /// Names of the parameters that the command has looked for.
    known: Vec<&'static str>,
}

impl<'a> EffectArgument<'a> {
    /// Splits the text of an option such as `--with`.
    ///
    /// # Errors
    /// When a parameter has no value, a value that is not a finite number, or two values.
    pub(super) fn parse(option: &'static str, text: &'a str) -> Result<Self, Failure> {
        let (name, list) = text.split_once(':').unwrap_or((text, ""));
        let mut values: Vec<(&str, f64)> = Vec::new();
        for pair in list.split(',').filter(|pair| !pair.trim().is_empty()) {
            let (parameter, value) = pair.split_once('=').ok_or_else(|| {
                Failure::option(
                    format!("{option} {name}: {} has no value", quoted(pair.as_bytes())),
                    "write EFFECT:parameter=value,…",
                )
            })?;
            let (parameter, value) = (parameter.trim(), value.trim());
            let number = value.parse::<f64>().ok().filter(|value| value.is_finite());
            let Some(number) = number else {
                return Err(Failure::option(
                    format!(
                        "{option} {name}: {parameter}={} is not a finite number",
                        quoted(value.as_bytes())
                    ),
                    "give a number, such as 0.3",
                ));
            };
            if values.iter().any(|(other, _)| *other == parameter) {
                return Err(Failure::option(
                    format!("{option} {name}: {parameter} is given twice"),
                    "give it once",
                ));
            }
            values.push((parameter, number));
        }
        Ok(Self {
            option,
            name: name.trim(),
            values,
            known: Vec::new(),
        })
    }

    /// The failure of this option, with what is wrong and the remedy.
    pub(super) fn failure(&self, what: impl std::fmt::Display, remedy: &str) -> Failure {
        Failure::option(format!("{} {}: {what}", self.option, self.name), remedy)
    }

    /// The effect of the catalogue that has this name.
    ///
    /// # Errors
    /// When there is no such effect.
    pub(super) fn effect(&self) -> Result<&'static dyn Effect, Failure> {
        let mut catalogue = CATALOGUE.into_iter();
        catalogue
            .find(|effect| effect.name() == self.name)
            .ok_or_else(|| {
                let names = CATALOGUE.map(|effect| effect.name()).join(", ");
                Failure::option(
                    format!(
                        "{} {}: no such effect",
                        self.option,
                        quoted(self.name.as_bytes())
                    ),
                    format!("choose from {names}"),
                )
            })
    }

    /// Takes the value of that name, if there is one.
    pub(super) fn take(&mut self, name: &'static str) -> Option<f64> {
        self.known.push(name);
        let at = self.values.iter().position(|(other, _)| *other == name)?;
        Some(self.values.swap_remove(at).1)
    }

    /// Takes the value of that name, if there is one.
    ///
    /// # Errors
    /// When the value is not positive.
    pub(super) fn take_positive(&mut self, name: &'static str) -> Result<Option<f64>, Failure> {
        match self.take(name) {
            Some(value) if value <= 0.0 => Err(self.failure(
                format!("{name}={value} is impossible"),
                "give a number above 0",
            )),
            value => Ok(value),
        }
    }

    /// Takes the value of that name.
    ///
    /// # Errors
    /// When the value is missing or not positive.
    pub(super) fn require(&mut self, name: &'static str) -> Result<f64, Failure> {
        let value = self.take_positive(name)?;
        value.ok_or_else(|| {
            let remedy = format!("write {}:{name}=VALUE", self.name);
            self.failure(format!("{name} is missing"), &remedy)
        })
    }

    /// Takes the shape parameters of an effect. A parameter that is a whole number is 1 unless given.
    ///
    /// # Errors
    /// When another parameter is missing, or a value is out of range.
    pub(super) fn shape(
        &mut self,
        effect: &'static dyn Effect,
    ) -> Result<[f64; MAX_PARAMETERS], Failure> {
        /// Any span will do: the range of a whole number does not depend on it.
        const ANY: Span = Span {
            interval_s: 1.0,
            longest_tau_s: 1.0,
        };
        let mut shape = [0.0; MAX_PARAMETERS];
        for (i, parameter) in effect.parameters().iter().enumerate() {
            shape[i] = if parameter.is_whole {
                let value = self.take(parameter.name).unwrap_or(1.0);
                let range = (parameter.search_range)(&ANY);
                if value.fract() != 0.0 || !(range.low..=range.high).contains(&value) {
                    let remedy = format!("give a whole number, {} to {}", range.low, range.high);
                    let what = format!("{}={value} is impossible", parameter.name);
                    return Err(self.failure(what, &remedy));
                }
                value
            } else {
                self.value(parameter)?
            };
        }
        Ok(shape)
    }

    /// Takes a shape parameter, which may be given by its reciprocal.
    fn value(&mut self, parameter: &Parameter) -> Result<f64, Failure> {
        let Some(reciprocal) = parameter.reciprocal else {
            return self.require(parameter.name);
        };
        let own = self.take_positive(parameter.name)?;
        let other = self.take_positive(reciprocal.name)?;
        match (own, other) {
            (Some(value), None) => Ok(value),
            (None, Some(value)) => Ok(reciprocal.product / value),
            (Some(_), Some(_)) => {
                let names = format!("{} and {}", parameter.name, reciprocal.name);
                Err(self.failure(format!("{names} give the same"), "give one of them"))
            }
            (None, None) => {
                let what = format!("{} or {} is missing", reciprocal.name, parameter.name);
                let remedy = format!("write {}:{}=VALUE", self.name, reciprocal.name);
                Err(self.failure(what, &remedy))
            }
        }
    }

    /// Ends the reading of the option.
    ///
    /// # Errors
    /// When a value is left that the effect has no parameter for.
    pub(super) fn finish(self) -> Result<(), Failure> {
        let Some((name, _)) = self.values.first() else {
            return Ok(());
        };
        let what = format!("there is no parameter {}", quoted(name.as_bytes()));
        let remedy = if self.known.is_empty() {
            "give no parameters".into()
        } else {
            format!("choose from {}", self.known.join(", "))
        };
        Err(self.failure(what, &remedy))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use allanite::effect::DecimationFilter;

    fn shape(text: &str) -> Result<[f64; 2], String> {
        let mut argument =
            EffectArgument::parse("--with", text).map_err(|error| error.to_string())?;
        let effect = argument.effect().map_err(|error| error.to_string())?;
        let shape = argument.shape(effect).map_err(|error| error.to_string())?;
        argument
            .finish()
            .map(|()| shape)
            .map_err(|error| error.to_string())
    }

    #[test]
    fn shape_is_read_by_name_in_any_order() {
        assert_eq!(
            shape("decimation_filter:stages=2,width_s=0.014"),
            Ok([0.014, 2.0])
        );
        assert_eq!(shape("decimation_filter:width_s=0.02"), Ok([0.02, 1.0]));
        assert_eq!(shape("rate_ramp"), Ok([0.0, 0.0]));
        // A cut-off of 42 Hz is that of a time constant of 1/(2π 42 Hz).
        let [time_constant_s, poles] = shape("low_pass:cutoff_hz=42,poles=2").expect("a shape");
        assert!((time_constant_s - 0.003_789_403_5).abs() < 1e-10);
        assert_eq!(poles, 2.0);
        assert_eq!(DecimationFilter.description().parameters[0].name, "width_s");
    }

    #[test]
    fn every_bad_option_is_refused_with_its_remedy() {
        for (text, message) in [
            (
                "sinusiod:frequency_hz=1",
                "\"sinusiod\": no such effect; choose from quantization",
            ),
            (
                "sinusoid",
                "frequency_hz is missing; write sinusoid:frequency_hz=VALUE",
            ),
            ("sinusoid:frequency_hz", "\"frequency_hz\" has no value"),
            (
                "sinusoid:frequency_hz=fast",
                "frequency_hz=\"fast\" is not a finite number",
            ),
            (
                "sinusoid:frequency_hz=0",
                "frequency_hz=0 is impossible; give a number above 0",
            ),
            (
                "sinusoid:frequency_hz=1,quality=2",
                "there is no parameter \"quality\"; choose from frequency_hz",
            ),
            (
                "sinusoid:frequency_hz=1,frequency_hz=2",
                "frequency_hz is given twice",
            ),
            (
                "decimation_filter:width_s=1,stages=1.5",
                "stages=1.5 is impossible; give a whole number, 1 to 2",
            ),
            (
                "low_pass:poles=2",
                "cutoff_hz or time_constant_s is missing; write low_pass:cutoff_hz=VALUE",
            ),
            (
                "low_pass:cutoff_hz=20,time_constant_s=0.01",
                "time_constant_s and cutoff_hz give the same; give one of them",
            ),
            (
                "rate_ramp:slope=1",
                "there is no parameter \"slope\"; give no parameters",
            ),
        ] {
            let refused = shape(text).unwrap_err();
            assert!(refused.contains(message), "{text}: {refused}");
            assert!(refused.starts_with("--with "), "{refused}");
        }
    }
}
