//! Effects of a user's own, as formulas: `density: 1/(1 + (f/corner_hz)^2); corner_hz=0.1..30`.

mod covariance;
mod density;
mod file;
mod formula;
mod refusal;
#[cfg(test)]
mod tests;

use allanite::{
    curve::Span,
    effect::{
        CATALOGUE, Description, Distribution, Effect, Explanation, Flaw, MAX_PARAMETERS, Parameter,
        SampledShape, SearchRange, check,
    },
};
use allanite_log::failure::{Failure, quoted};
use covariance::Covariance;
use density::Density;
use formula::Formula;
use refusal::Refusal;
use std::{
    collections::HashMap,
    sync::{Mutex, PoisonError},
};

/// The name of an effect that is given none.
const NAME: &str = "own";
/// The name of the coefficient.
const SIZE: &str = "size";
/// The factor by which the search goes beyond a first value on either side, where no range is given.
const BEYOND: f64 = 30.0;
/// The values that a search tries for each factor of two. Chosen by hand, as many as for a resonance of low quality.
const STEPS_PER_OCTAVE: f64 = 4.0;
/// The lowest frequency, and lag, at which a formula is examined, and the rise over an octave there that no Allan variance has: 2³,
/// less one percent.
const LOWEST_HZ: f64 = 1e-7;
const STEEPEST: f64 = 7.92;
/// Shapes whose covariances are kept. A search goes from shape to shape, and asks of each for many lags.
const KEPT: usize = 16;

/// The name of an effect, and the values of its parameters by their names.
type Values<'a> = (String, Vec<(&'a str, Value)>);

/// What a formula is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// The power spectral density over the frequency `f` in Hz, relative to white noise with an angle random walk of one.
    Density,
    /// The autocovariance of the rate over the lag `t` in seconds.
    Covariance,
}

impl Kind {
    const ALL: [Self; 2] = [Self::Density, Self::Covariance];

    const fn name(self) -> &'static str {
        match self {
            Self::Density => "density",
            Self::Covariance => "covariance",
        }
    }

    const fn variable(self) -> &'static str {
        match self {
            Self::Density => "f",
            Self::Covariance => "t",
        }
    }

    const fn half_seconds(self) -> i8 {
        match self {
            Self::Density => 1,
            Self::Covariance => 0,
        }
    }
}

/// An effect that a formula describes.
pub struct FormulaEffect {
    kind: Kind,
    formula: Formula,
    /// The formula as it was written.
    text: String,
    description: &'static Description,
    explanation: Explanation,
    /// The ranges of the parameters in which they are looked for.
    ranges: Vec<[f64; 2]>,
}

/// An effect in a shape, by the address of its description, and by the bits of the sample interval and of the parameters.
type Key = (usize, [u64; 1 + MAX_PARAMETERS]);

/// A shape, sampled, and its covariances by the bits of the lag.
struct Sampled {
    key: Key,
    process: Process,
    lags: HashMap<u64, f64>,
}

/// The last shapes of all effects, in the order in which they came, so that memory stays bounded however many formulas there are.
static SAMPLED: Mutex<Vec<Sampled>> = Mutex::new(Vec::new());

enum Process {
    Density(Density),
    Covariance(Covariance<Box<dyn Fn(f64) -> f64 + Send>>),
}

/// All effects that were made. They live as long as the program, because models refer to them, so that the same text gives the
/// same effect.
static MADE: Mutex<Vec<&'static FormulaEffect>> = Mutex::new(Vec::new());

/// An effect with the shape that a text gives it.
pub struct Given {
    /// The effect.
    pub effect: &'static FormulaEffect,
    /// The parameters: what they are, or where a search begins. Zeros for a search in the whole range.
    pub parameters: [f64; MAX_PARAMETERS],
    /// Whether they are to be fitted.
    pub is_fitted: bool,
    /// The coefficient, if the text gives it.
    pub size: Option<f64>,
}

/// A value in the list behind a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Value {
    Known(f64),
    Begin(f64),
    Range([f64; 2]),
}

/// Whether a text is that of a formula, and not of an effect of the catalogue.
pub fn is_formula(text: &str) -> bool {
    kind_of(text).is_some()
}

fn kind_of(text: &str) -> Option<(Kind, &str)> {
    let (name, rest) = text.split_once(':')?;
    let kind = Kind::ALL
        .into_iter()
        .find(|kind| kind.name() == name.trim())?;
    Some((kind, rest))
}

/// The name of the effect in a text that is a formula; `None` for another text.
pub fn name_in(text: &str) -> Option<&str> {
    let (_, rest) = kind_of(text)?;
    let names = rest.split(';').skip(1).filter_map(|part| {
        let (own, name) = part.split_once('=')?;
        (own.trim() == "name").then(|| name.trim())
    });
    Some(names.last().unwrap_or(NAME))
}

/// The effect of this description, if it was made of a formula.
pub fn find(effect: &dyn Effect) -> Option<&'static FormulaEffect> {
    let made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    let mut made = made.iter().copied();
    made.find(|one| std::ptr::eq(one.description, effect.description()))
}

/// The last effect of this name that was made of a formula.
pub fn named(name: &str) -> Option<&'static FormulaEffect> {
    let made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    let mut made = made.iter().rev().copied();
    made.find(|one| one.description.name == name)
}

impl Given {
    /// Reads an option such as `--with`, whose text [is a formula](is_formula).
    ///
    /// # Errors
    /// When the formula is not understood, a parameter has no value, or the effect is none that a record can have.
    pub fn parse(option: &str, text: &str) -> Result<Self, Failure> {
        let Some((kind, rest)) = kind_of(text) else {
            return Err(Failure::option(
                format!("{option} {}: no formula", quoted(text.as_bytes())),
                "write density: … or covariance: …",
            ));
        };
        let fail = |(what, remedy): Refusal| {
            Failure::option(format!("{option} {}: {what}", kind.name()), remedy)
        };
        let mut parts = rest.split(';');
        let formula = parts.next().unwrap_or_default().trim();
        let mut names = Vec::new();
        let read = match formula.strip_prefix('@') {
            Some(path) => Formula::through(file::points(path.trim())?),
            None => Formula::parse(formula, kind.variable(), &mut names).map_err(fail)?,
        };
        let (name, mut values) = values(parts).map_err(fail)?;
        let size = values.iter().position(|(name, _)| *name == SIZE);
        let size = match size.map(|at| values.remove(at).1) {
            None => None,
            Some(Value::Known(size)) => Some(size),
            Some(_) => {
                let what = "size is a number".to_owned();
                return Err(fail((what, "write size=VALUE".into())));
            }
        };
        let values = in_order(&names, &values).map_err(fail)?;
        let mut parameters = [0.0; MAX_PARAMETERS];
        for (parameter, value) in parameters.iter_mut().zip(&values) {
            match value {
                Value::Known(value) | Value::Begin(value) => *parameter = *value,
                Value::Range(_) => {}
            }
        }
        let is_fitted = match values.first() {
            None | Some(Value::Known(_)) => false,
            Some(_) => true,
        };
        let effect = FormulaEffect::made(kind, read, formula, (&name, &names), &values);
        let given = Self {
            effect: effect.map_err(fail)?,
            parameters,
            is_fitted,
            size,
        };
        given.effect.examine(&values).map_err(fail)?;
        Ok(given)
    }
}

/// The name of the effect and the values of its parameters, which follow the formula.
fn values<'a>(parts: impl Iterator<Item = &'a str>) -> Result<Values<'a>, Refusal> {
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
fn in_order(names: &[String], values: &[(&str, Value)]) -> Result<Vec<Value>, Refusal> {
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

impl FormulaEffect {
    /// The effect of a formula, which is the one that was made before where all is the same.
    fn made(
        kind: Kind,
        formula: Formula,
        text: &str,
        (name, names): (&str, &[String]),
        values: &[Value],
    ) -> Result<&'static Self, Refusal> {
        let ranges: Vec<[f64; 2]> = values
            .iter()
            .map(|value| match value {
                Value::Known(value) | Value::Begin(value) => [value / BEYOND, value * BEYOND],
                Value::Range(ends) => *ends,
            })
            .collect();
        let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
        let same = made.iter().copied().find(|one| {
            let mut pairs = one.ranges.iter().zip(values);
            one.kind == kind
                && one.formula == formula
                && one.description.name == name
                && one.text == text
                && pairs.all(|(range, value)| match value {
                    Value::Known(_) => true,
                    Value::Begin(value) => (range[0]..=range[1]).contains(value),
                    Value::Range(ends) => ends == range,
                })
        });
        if let Some(same) = same {
            return Ok(same);
        }
        let leaked = |text: &str| -> &'static str { Box::leak(text.to_owned().into_boxed_str()) };
        let parameters: Vec<Parameter> = names
            .iter()
            .map(|name| Parameter {
                name: leaked(name),
                unit: match name {
                    name if name.ends_with("_hz") => "Hz",
                    name if name.ends_with("_s") => "s",
                    _ => "",
                },
                is_whole: false,
                search_range: |_| SearchRange {
                    low: 1e-9,
                    high: 1e9,
                    steps_per_octave: 1.0,
                },
                reciprocal: None,
            })
            .collect();
        let description = Description {
            name: leaked(name),
            symbol: "c",
            coefficient: SIZE,
            half_seconds: kind.half_seconds(),
            reference_s: None,
            parameters: parameters.leak(),
            code: 0,
            replaces: None,
            mirror: None,
            special_case: None,
            distribution: Distribution::Gaussian,
        };
        let effect: &'static Self = Box::leak(Box::new(Self {
            kind,
            formula,
            text: text.to_owned(),
            description: Box::leak(Box::new(description)),
            explanation: Explanation {
                what: leaked(&format!("own noise: {} {text}", kind.name())),
                origin: "what the formula was written for",
                check: "what the formula follows from: change that, and see whether the parameters move",
            },
            ranges,
        }));
        made.push(effect);
        Ok(effect)
    }

    /// Whether a record can have the effect, at these values: its formula gives numbers, no density is below zero, and neither is
    /// a variance.
    fn examine(&'static self, values: &[Value]) -> Result<(), Refusal> {
        let ranges: Vec<[f64; 2]> = values
            .iter()
            .map(|value| match value {
                Value::Known(value) | Value::Begin(value) => [*value; 2],
                Value::Range(ends) => *ends,
            })
            .collect();
        let middle: Vec<f64> = ranges
            .iter()
            .map(|[low, high]| (low * high).sqrt())
            .collect();
        self.examine_at(&middle)?;
        for (at, ends) in ranges.iter().enumerate() {
            for end in ends {
                let mut shape = middle.clone();
                shape[at] = *end;
                self.examine_at(&shape)?;
            }
        }
        match check(&Examined {
            effect: self,
            ranges,
        }) {
            // The formula itself gives the coefficient its unit.
            Ok(()) | Err(Flaw::Interval { .. }) => Ok(()),
            Err(Flaw::NotFinite { m, .. }) => Err((
                format!("at 100 Hz the Allan variance of {m} samples is negative or no number"),
                match self.kind {
                    Kind::Density => "give a density that is smaller at low frequency",
                    Kind::Covariance => "give a covariance that some noise has, such as exp(-t/4)",
                }
                .into(),
            )),
            Err(flaw) => Err((flaw.to_string(), "write another formula".into())),
        }
    }

    fn examine_at(&self, parameters: &[f64]) -> Result<(), Refusal> {
        let (variable, unit) = match self.kind {
            Kind::Density => ("f", "Hz"),
            Kind::Covariance => ("t", "s"),
        };
        let at = |x: f64| self.at(x, parameters);
        let shape = || {
            let pairs = self.description.parameters.iter().zip(parameters);
            let pairs: Vec<String> = pairs
                .map(|(one, value)| format!("{}={value}", one.name))
                .collect();
            match pairs.as_slice() {
                [] => String::new(),
                pairs => format!(", {}", pairs.join(", ")),
            }
        };
        let is_density = self.kind == Kind::Density;
        // From the longest record to the fastest sensor.
        for step in 0..=1200 {
            let x = LOWEST_HZ * 10.0_f64.powf(f64::from(step) / 100.0);
            let value = at(x);
            if !value.is_finite() || is_density && value < 0.0 {
                return Err((
                    format!("at {variable} = {x:.3} {unit}{} the {} is {value}", shape(), self.kind.name()),
                    match is_density {
                        true => "give a density that is a number, 0 or above, for every frequency above 0".into(),
                        false => "give numbers for every lag".into(),
                    },
                ));
            }
        }
        let [lowest, next] = [LOWEST_HZ, 2.0 * LOWEST_HZ].map(at);
        if is_density && lowest > STEEPEST * next {
            return Err((
                format!(
                    "towards f = 0{} the density rises as f^-3 or faster",
                    shape()
                ),
                "give one that rises less: no Allan variance exists beyond that".into(),
            ));
        }
        let zero = at(0.0);
        let is_variance = zero.is_finite() && zero > 0.0;
        if !(is_density || is_variance) {
            return Err((
                format!("at t = 0{} the covariance is {zero}", shape()),
                "give a variance above 0 there".into(),
            ));
        }
        Ok(())
    }

    fn at(&self, x: f64, parameters: &[f64]) -> f64 {
        let mut numbers = [x; 1 + MAX_PARAMETERS];
        for (number, parameter) in numbers.iter_mut().skip(1).zip(parameters) {
            *number = *parameter;
        }
        self.formula.value(&numbers)
    }

    /// What the effect is, in words.
    pub const fn explanation(&self) -> Explanation {
        self.explanation
    }

    /// The formula and the name, without the parameters.
    pub fn formula(&self) -> String {
        let text = format!("{}: {}", self.kind.name(), self.text);
        match self.description.name {
            NAME => text,
            name => format!("{text}; name={name}"),
        }
    }

    /// The text of an option that gives this effect with these parameters.
    pub fn written(&self, parameters: &[f64], is_fitted: bool) -> String {
        let mut text = self.formula();
        let pairs = self.description.parameters.iter().zip(parameters);
        for ((parameter, value), range) in pairs.zip(&self.ranges) {
            text += &match (is_fitted, *value > 0.0) {
                (true, false) => format!("; {}={}..{}", parameter.name, range[0], range[1]),
                (true, true) => format!("; {}~{value}", parameter.name),
                (false, _) => format!("; {}={value}", parameter.name),
            };
        }
        text
    }
}

/// An effect in the ranges in which it is asked for.
struct Examined {
    effect: &'static FormulaEffect,
    ranges: Vec<[f64; 2]>,
}

impl Effect for Examined {
    fn description(&self) -> &'static Description {
        self.effect.description
    }

    fn search_range(&self, parameter: usize, _: &Span) -> Option<SearchRange> {
        range(&self.ranges, parameter)
    }

    fn kernel(&self, lag: f64, shape: &SampledShape) -> f64 {
        self.effect.kernel(lag, shape)
    }
}

/// The values that a search tries.
fn range(ranges: &[[f64; 2]], parameter: usize) -> Option<SearchRange> {
    let [low, high] = *ranges.get(parameter)?;
    Some(SearchRange {
        low,
        high,
        steps_per_octave: STEPS_PER_OCTAVE,
    })
}

impl Effect for FormulaEffect {
    fn description(&self) -> &'static Description {
        self.description
    }

    fn search_range(&self, parameter: usize, _: &Span) -> Option<SearchRange> {
        range(&self.ranges, parameter)
    }

    fn kernel(&self, lag: f64, shape: &SampledShape) -> f64 {
        let parameters = shape.parameters;
        let [a, b, c] = parameters.map(f64::to_bits);
        let place = std::ptr::from_ref(self.description).addr();
        let key = (place, [shape.interval_s.to_bits(), a, b, c]);
        let mut all = SAMPLED.lock().unwrap_or_else(PoisonError::into_inner);
        let at = all
            .iter()
            .position(|one| one.key == key)
            .unwrap_or_else(|| {
                if all.len() >= KEPT {
                    all.remove(0);
                }
                all.push(Sampled {
                    key,
                    process: self.process(parameters, shape.interval_s),
                    lags: HashMap::new(),
                });
                all.len() - 1
            });
        let sampled = &mut all[at];
        if let Some(&value) = sampled.lags.get(&lag.to_bits()) {
            return value;
        }
        let value = match &mut sampled.process {
            Process::Density(density) => density.covariance(lag),
            Process::Covariance(covariance) => covariance.covariance(lag),
        };
        sampled.lags.insert(lag.to_bits(), value);
        value
    }
}

impl FormulaEffect {
    fn process(&self, parameters: [f64; MAX_PARAMETERS], interval_s: f64) -> Process {
        match self.kind {
            Kind::Density => {
                Process::Density(Density::new(|f| self.at(f, &parameters), interval_s))
            }
            Kind::Covariance => {
                let formula = self.formula.clone();
                let [a, b, c] = parameters;
                let at = move |t: f64| formula.value(&[t, a, b, c]);
                Process::Covariance(Covariance::new(Box::new(at), interval_s))
            }
        }
    }
}
