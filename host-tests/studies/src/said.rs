//! What a diagnosis says of a record, beside what is hidden in it.

use super::{
    OCTAVES,
    hidden_effect::{added, steps},
    measured::Measured,
};
use allanite::{
    Coefficient, Model,
    diagnosis::{Options, Step, Verdict},
    effect::CATALOGUE,
    fit::State,
};
use allanite_host::freeform::diagnose_freely;
use allanite_log::BINS;

/// Effects that are told by the same word: filters that pass the same band.
const LOW_PASSES: [&str; 4] = ["low_pass", "digital_low_pass", "cascade", "output_low_pass"];

/// What is said of a record.
#[derive(Clone, Debug)]
pub struct Said {
    /// The effects that are named, each with those that would explain the record as well. Mirrors are such ones.
    pub named: Vec<(&'static str, Vec<&'static str>)>,
    /// The shape parameters of each.
    pub shapes: Vec<Vec<f64>>,
    /// The verdict; `None` if the diagnosis failed.
    pub verdict: Option<Verdict>,
    /// The coefficients of the last model, with their symbols.
    pub coefficients: Vec<(&'static str, Coefficient)>,
    /// The shape parameters of the last model, with their intervals: name, value, lower and upper end.
    pub intervals: Vec<(&'static str, [f64; 3])>,
    /// Whether χ² of a step is larger than that of the step before.
    pub rises: bool,
}

/// How what is said compares with what is hidden.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Compared {
    /// All that is hidden is named, and nothing else.
    pub exact: bool,
    /// So it is if what is said to explain the record as well counts too.
    pub among: bool,
    /// Something is named that is not hidden, and nothing hidden is an alternative to it.
    pub wrong: bool,
    /// Something hidden is neither named nor an alternative.
    pub missing: bool,
}

impl Said {
    /// Diagnoses a record.
    pub fn of(measured: &Measured) -> Self {
        let (steps, verdict) = steps(measured, Options::default());
        Self::of_steps(&steps, verdict)
    }

    /// Diagnoses a record as the command line does, with low passes of any form.
    pub fn freely(measured: &Measured) -> Self {
        let model = Model::ieee_952();
        let options = Options::default();
        match diagnose_freely(measured.record(), &model, &CATALOGUE, options) {
            Ok((steps, verdict)) => Self::of_steps(&steps, Some(verdict)),
            Err(_) => Self::of_steps(&[], None),
        }
    }

    fn of_steps(steps: &[Step<OCTAVES, BINS>], verdict: Option<Verdict>) -> Self {
        let added = added(steps);
        let last = steps.last();
        let coefficients = last.map(|step| {
            let terms = step.model.terms().iter().zip(&step.fit.coefficients);
            terms.map(|(term, found)| (term.effect.description().symbol, *found))
        });
        let intervals = last.map(|step| {
            let shapes = step.fit.shape.iter();
            shapes.map(|shape| (shape.name, [shape.value, shape.lower, shape.upper]))
        });
        let shapes = added.iter().map(|(term, _)| {
            let names = term.effect.parameters().len();
            term.parameters.iter().take(names).copied().collect()
        });
        let mut pairs = steps.windows(2);
        let rises = pairs.any(|pair| pair[1].fit.chi_squared > pair[0].fit.chi_squared);
        Self {
            rises,
            shapes: shapes.collect(),
            coefficients: coefficients.into_iter().flatten().collect(),
            intervals: intervals.into_iter().flatten().collect(),
            verdict,
            named: added
                .into_iter()
                .map(|(term, others)| (term.effect.name(), others))
                .collect(),
        }
    }

    /// The coefficient with this symbol.
    pub fn coefficient(&self, symbol: &str) -> Option<&Coefficient> {
        let found = self.coefficients.iter().find(|(name, _)| *name == symbol);
        found.map(|(_, coefficient)| coefficient)
    }

    /// Whether the interval of a coefficient contains its true value.
    pub fn covers(&self, symbol: &str, truth: f64) -> bool {
        let found = self.coefficient(symbol);
        found.is_some_and(|found| (found.lower..=found.upper).contains(&truth))
    }

    /// Whether a coefficient is called measured.
    pub fn measures(&self, symbol: &str) -> bool {
        let found = self.coefficient(symbol);
        found.is_some_and(|found| found.state == State::Measured)
    }

    /// Whether the diagnosis says that something is left that it has no name for, or fails.
    pub fn is_unexplained(&self) -> bool {
        !matches!(
            self.verdict,
            Some(Verdict::Adequate | Verdict::Improved | Verdict::TooShort)
        )
    }

    /// Compares with the names of what is hidden.
    pub fn compared(&self, hidden: &[&str]) -> Compared {
        let mut left: Vec<&str> = hidden.iter().map(|name| word(name)).collect();
        // What is named right is taken away first, so that alternatives stand for what is left.
        let mut rest = Vec::new();
        for (name, others) in &self.named {
            match left.iter().position(|hidden| *hidden == word(name)) {
                Some(place) => {
                    left.swap_remove(place);
                }
                None => rest.push(others),
            }
        }
        let exact = rest.is_empty() && left.is_empty();
        let mut wrong = false;
        for others in &rest {
            let is_meant = |hidden: &&str| others.iter().any(|other| word(other) == *hidden);
            match left.iter().position(is_meant) {
                Some(place) => {
                    left.swap_remove(place);
                }
                None => wrong = true,
            }
        }
        Compared {
            exact,
            among: !wrong && left.is_empty(),
            wrong,
            missing: !left.is_empty(),
        }
    }

    /// What is named, in words.
    pub fn words(&self) -> String {
        let one = |((name, others), shape): (&(&str, Vec<&str>), &Vec<f64>)| {
            let shape: Vec<String> = shape.iter().map(|value| format!("{value:.4}")).collect();
            let others = if others.is_empty() {
                String::new()
            } else {
                format!(" or {}", others.join(", "))
            };
            format!("{name}({}){others}", shape.join(", "))
        };
        let named: Vec<String> = self.named.iter().zip(&self.shapes).map(one).collect();
        match named.as_slice() {
            [] => "nothing".to_owned(),
            named => named.join(" + "),
        }
    }
}

/// The word by which an effect is told.
pub fn word(name: &str) -> &str {
    if LOW_PASSES.contains(&name) {
        "low_pass"
    } else {
        name
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(named: &[(&'static str, &[&'static str])]) -> Said {
        Said {
            named: named
                .iter()
                .map(|&(name, others)| (name, others.to_vec()))
                .collect(),
            shapes: vec![Vec::new(); named.len()],
            verdict: Some(Verdict::Improved),
            coefficients: Vec::new(),
            intervals: Vec::new(),
            rises: false,
        }
    }

    #[test]
    fn alternatives_stand_for_what_is_hidden_once() {
        let line = said(&[("sinusoid", &[])]);
        let exact = Compared {
            exact: true,
            among: true,
            ..Compared::default()
        };
        assert_eq!(line.compared(&["sinusoid"]), exact);
        let missing = Compared {
            missing: true,
            ..Compared::default()
        };
        assert_eq!(line.compared(&["sinusoid", "sinusoid"]), missing);
        let wrong = Compared {
            wrong: true,
            ..missing
        };
        assert_eq!(line.compared(&["low_pass"]), wrong);
        let either = said(&[("resonance", &["digital_low_pass"]), ("sinusoid", &[])]);
        let among = Compared {
            among: true,
            ..Compared::default()
        };
        assert_eq!(either.compared(&["cascade", "sinusoid"]), among);
        let beside = Compared {
            wrong: true,
            ..Compared::default()
        };
        assert_eq!(either.compared(&["sinusoid"]), beside);
    }
}
