//! Effects as options of the command line: `EFFECT[:parameter=value,…]`.

use crate::own;
use allanite::{
    Term,
    effect::{CATALOGUE, Domain, Effect, MAX_PARAMETERS, Parameter},
};
use allanite_log::failure::{Failure, did_you_mean, quoted};

/// The effect that an option names, with the values that have not been taken from it yet.
#[derive(Clone, Debug)]
pub struct EffectArgument<'a> {
    option: &'static str,
    /// The name of the effect.
    pub name: &'a str,
    values: Vec<(&'a str, f64)>,
    /// Names of the parameters that are written `parameter~value`: the fit of a shape begins there.
    begins: Vec<&'a str>,
    /// Names of the parameters that the command has looked for.
    known: Vec<&'static str>,
}

/// The shape of an effect that a model is to have.
pub enum Shape {
    /// It is known, and kept.
    Known([f64; MAX_PARAMETERS]),
    /// It is fitted from there on, and looked for in the whole range if its numbers are zero. Whole numbers above zero
    /// are kept.
    Fitted([f64; MAX_PARAMETERS]),
}

impl<'a> EffectArgument<'a> {
    /// Splits the text of an option such as `--with`.
    ///
    /// # Errors
    /// When a parameter has no value, a value that is not a finite number, or two values.
    pub fn parse(option: &'static str, text: &'a str) -> Result<Self, Failure> {
        let (name, list) = text.split_once(':').unwrap_or((text, ""));
        let mut values: Vec<(&str, f64)> = Vec::new();
        let mut begins = Vec::new();
        for pair in list.split(',').filter(|pair| !pair.trim().is_empty()) {
            let (parameter, value) = pair.split_once(['=', '~']).ok_or_else(|| {
                Failure::option(
                    format!("{option} {name}: {} has no value", quoted(pair.as_bytes())),
                    "write EFFECT:parameter=value,…",
                )
            })?;
            let is_begin = pair.as_bytes().get(parameter.len()) == Some(&b'~');
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
            if is_begin {
                begins.push(parameter);
            }
        }
        Ok(Self {
            option,
            name: name.trim(),
            values,
            begins,
            known: Vec::new(),
        })
    }

    /// The name of the effect in the text of an option: `own` for a formula that gives it none.
    pub fn name_in(text: &str) -> &str {
        own::name_in(text).unwrap_or_else(|| text.split(':').next().unwrap_or_default().trim())
    }

    /// The failure of this option, with what is wrong and the remedy.
    pub fn failure(&self, what: impl std::fmt::Display, remedy: &str) -> Failure {
        Failure::option(format!("{} {}: {what}", self.option, self.name), remedy)
    }

    /// The effect of the catalogue that has this name.
    ///
    /// # Errors
    /// When there is no such effect.
    pub fn effect(&self) -> Result<&'static dyn Effect, Failure> {
        let mut catalogue = CATALOGUE.into_iter();
        catalogue
            .find(|effect| effect.name() == self.name)
            .ok_or_else(|| {
                let names = CATALOGUE.map(|effect| effect.name());
                let hint = did_you_mean(self.name, names);
                Failure::option(
                    format!(
                        "{} {}: no such effect",
                        self.option,
                        quoted(self.name.as_bytes())
                    ),
                    format!("{hint}choose from {}", names.join(", ")),
                )
            })
    }

    /// Takes the value of that name, if there is one.
    pub fn take(&mut self, name: &'static str) -> Option<f64> {
        self.known.push(name);
        let at = self.values.iter().position(|(other, _)| *other == name)?;
        Some(self.values.swap_remove(at).1)
    }

    /// Takes the value of that name, if there is one.
    ///
    /// # Errors
    /// When the value is not positive.
    pub fn take_positive(&mut self, name: &'static str) -> Result<Option<f64>, Failure> {
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
    pub fn require(&mut self, name: &'static str) -> Result<f64, Failure> {
        let value = self.take_positive(name)?;
        value.ok_or_else(|| {
            let remedy = format!("write {}:{name}=VALUE", self.name);
            self.failure(format!("{name} is missing"), &remedy)
        })
    }

    /// Takes the shape of an effect of a model. It is fitted if no parameter is given but whole numbers, or if the
    /// parameters are written with `~`.
    ///
    /// # Errors
    /// As of [`Self::shape`], and when the parameters are written in both ways.
    pub fn known_or_fitted(&mut self, effect: &'static dyn Effect) -> Result<Shape, Failure> {
        self.check_names(effect)?;
        let parameters = effect.parameters();
        let is_whole = |name: &str| {
            let mut whole = parameters.iter().filter(|parameter| parameter.is_whole);
            whole.any(|parameter| parameter.name == name)
        };
        let given = |name: &str| self.values.iter().any(|(other, _)| *other == name);
        let mut fractions = parameters.iter().filter(|parameter| !parameter.is_whole);
        let is_open = fractions.all(|parameter| {
            let reciprocal = parameter.reciprocal.map(|other| other.name);
            !(given(parameter.name) || reciprocal.is_some_and(given))
        });
        if let Some(name) = self.begins.iter().find(|name| is_whole(name)) {
            let what = format!("{name} is a whole number, which is not fitted");
            let remedy = format!("write {name}=VALUE, or leave it out");
            return Err(self.failure(what, &remedy));
        }
        let begins = std::mem::take(&mut self.begins);
        let coefficient = effect.coefficient();
        let mut fixed = self.values.iter().map(|(name, _)| *name);
        let fixed =
            fixed.find(|name| !is_whole(name) && *name != coefficient && !begins.contains(name));
        if let Some((begin, fixed)) = begins.first().zip(fixed) {
            let what = format!("{begin} is to be fitted, and {fixed} is not");
            return Err(self.failure(what, "write ~ for both, or = for both"));
        }
        if parameters.iter().all(|parameter| parameter.is_whole) || !is_open {
            let shape = self.shape(effect)?;
            return Ok(match begins.is_empty() {
                true => Shape::Known(shape),
                false => Shape::Fitted(shape),
            });
        }
        // Only whole numbers are given, if any.
        let mut shape = [0.0; MAX_PARAMETERS];
        for (value, parameter) in shape.iter_mut().zip(parameters) {
            if self.values.iter().any(|(name, _)| *name == parameter.name) {
                *value = self.parameter(parameter)?;
            }
        }
        Ok(Shape::Fitted(shape))
    }

    /// Refuses a name that is no parameter of the effect.
    fn check_names(&self, effect: &'static dyn Effect) -> Result<(), Failure> {
        let parameters = effect.parameters().iter();
        let names = parameters.flat_map(|parameter| {
            let reciprocal = parameter.reciprocal.map(|other| other.name);
            reciprocal.into_iter().chain([parameter.name])
        });
        let names: Vec<&str> = names.collect();
        let is_known = |name: &str| names.contains(&name) || name == effect.coefficient();
        match self.values.iter().find(|(name, _)| !is_known(name)) {
            Some((name, _)) => Err(self.no_parameter(name, &names)),
            None => Ok(()),
        }
    }

    fn no_parameter(&self, name: &str, known: &[&str]) -> Failure {
        let what = format!("there is no parameter {}", quoted(name.as_bytes()));
        let remedy = match known {
            [] => "give no parameters".into(),
            known => {
                let hint = did_you_mean(name, known.iter().copied());
                format!("{hint}choose from {}", known.join(", "))
            }
        };
        self.failure(what, &remedy)
    }

    /// Takes a shape parameter. A whole number is the least one unless given: one pole, two stages of a cascade.
    fn parameter(&mut self, parameter: &Parameter) -> Result<f64, Failure> {
        match parameter.domain() {
            Domain::Whole { low, high } => self.whole(parameter.name, low, high),
            Domain::Positive => self.value(parameter),
        }
    }

    fn whole(&mut self, name: &'static str, low: f64, high: f64) -> Result<f64, Failure> {
        let value = self.take(name).unwrap_or(low);
        if value.fract() != 0.0 || !(low..=high).contains(&value) {
            let remedy = format!("give a whole number, {low} to {high}");
            return Err(self.failure(format!("{name}={value} is impossible"), &remedy));
        }
        Ok(value)
    }

    /// Takes the shape parameters of an effect. A parameter that is a whole number is the least one unless given.
    ///
    /// # Errors
    /// When another parameter is missing, a value is out of range, or a name is no parameter.
    pub fn shape(&mut self, effect: &'static dyn Effect) -> Result<[f64; MAX_PARAMETERS], Failure> {
        self.check_names(effect)?;
        let mut shape = [0.0; MAX_PARAMETERS];
        for (i, parameter) in effect.parameters().iter().enumerate() {
            shape[i] = self.parameter(parameter)?;
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
    /// When a value is left that the effect has no parameter for, or one is to be fitted that is not.
    pub fn finish(self) -> Result<(), Failure> {
        if let Some((name, _)) = self.values.first() {
            return Err(self.no_parameter(name, &self.known));
        }
        match self.begins.first() {
            Some(name) => {
                let remedy = format!("write {name}=VALUE");
                Err(self.failure(format!("{name} is not fitted here"), &remedy))
            }
            None => Ok(()),
        }
    }
}

/// The text of an option that gives a term: its shape, with `~` if it is fitted.
pub fn written(term: &Term) -> String {
    if let Some(own) = own::find(term.effect) {
        return own.written(&term.parameters, term.fitted);
    }
    let parameters = term.effect.parameters().iter().zip(term.parameters);
    let pairs = parameters.map(|(parameter, value)| {
        let sign = if term.fitted && !parameter.is_whole {
            '~'
        } else {
            '='
        };
        format!("{}{sign}{value}", parameter.name)
    });
    let pairs: Vec<String> = pairs.collect();
    match pairs.is_empty() {
        true => term.effect.name().to_owned(),
        false => format!("{}:{}", term.effect.name(), pairs.join(",")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use allanite::effect::DecimationFilter;

    fn shape(text: &str) -> Result<[f64; MAX_PARAMETERS], String> {
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
            Ok([0.014, 2.0, 0.0])
        );
        assert_eq!(
            shape("decimation_filter:width_s=0.02"),
            Ok([0.02, 1.0, 0.0])
        );
        assert_eq!(shape("rate_ramp"), Ok([0.0; MAX_PARAMETERS]));
        // A cut-off of 42 Hz is that of a time constant of 1/(2π 42 Hz).
        let [time_constant_s, poles, _] = shape("low_pass:cutoff_hz=42,poles=2").expect("a shape");
        assert!((time_constant_s - 0.003_789_403_5).abs() < 1e-10);
        assert_eq!(poles, 2.0);
        assert_eq!(DecimationFilter.description().parameters[0].name, "width_s");
    }

    #[test]
    fn every_bad_option_is_refused_with_its_remedy() {
        for (text, message) in [
            (
                "sinusiod:frequency_hz=1",
                "\"sinusiod\": no such effect; did you mean sinusoid? choose from quantization",
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
