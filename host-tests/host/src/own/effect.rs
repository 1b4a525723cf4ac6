//! An effect that a formula describes.

use super::{
    covariance::Covariance,
    density::Density,
    formula::Formula,
    kind::Kind,
    sampled::{self, Process},
    value::{NAME, Value},
};
use allanite::{
    curve::Span,
    effect::{
        Description, Distribution, Effect, Explanation, MAX_PARAMETERS, Parameter, SampledShape,
        SearchRange,
    },
};
use std::sync::{Mutex, PoisonError};

/// The name of the coefficient.
pub(super) const SIZE: &str = "size";
/// The factor by which the search goes beyond a first value on either side, where no range is given.
const BEYOND: f64 = 30.0;
/// The values that a search tries for each factor of two. Chosen by hand, as many as for a resonance of low quality.
const STEPS_PER_OCTAVE: f64 = 4.0;

/// An effect that a formula describes.
pub struct FormulaEffect {
    pub(super) kind: Kind,
    formula: Formula,
    /// The formula as it was written.
    text: String,
    pub(super) description: &'static Description,
    explanation: Explanation,
    /// The ranges of the parameters in which they are looked for.
    ranges: Vec<[f64; 2]>,
}

/// All effects that were made. They live as long as the program, because models refer to them, so that the same text gives the
/// same effect.
static MADE: Mutex<Vec<&'static FormulaEffect>> = Mutex::new(Vec::new());

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

impl FormulaEffect {
    /// The effect of a formula, which is the one that was made before where all is the same.
    pub(super) fn made(
        kind: Kind,
        formula: Formula,
        text: &str,
        (name, names): (&str, &[String]),
        values: &[Value],
    ) -> &'static Self {
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
            return same;
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
        effect
    }

    /// The value of the formula.
    pub(super) fn at(&self, x: f64, parameters: &[f64]) -> f64 {
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

/// The values that a search tries.
pub(super) fn range(ranges: &[[f64; 2]], parameter: usize) -> Option<SearchRange> {
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
        sampled::covariance(key, lag, || self.process(parameters, shape.interval_s))
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
