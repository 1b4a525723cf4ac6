//! Whether a record can have the effect of a formula.

use super::{
    effect::{FormulaEffect, range},
    kind::Kind,
    refusal::Refusal,
    value::Value,
};
use allanite::{
    curve::Span,
    effect::{Description, Effect, Flaw, SampledShape, SearchRange, check},
};

/// The lowest frequency, and lag, at which a formula is examined, and the rise over an octave there that no Allan variance has: 2³,
/// less one percent.
const LOWEST_HZ: f64 = 1e-7;
const STEEPEST: f64 = 7.92;

/// Whether a record can have the effect, at these values: its formula gives numbers, no density is below zero, and neither is
/// a variance.
pub(super) fn examine(effect: &'static FormulaEffect, values: &[Value]) -> Result<(), Refusal> {
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
    examine_at(effect, &middle)?;
    for (at, ends) in ranges.iter().enumerate() {
        for end in ends {
            let mut shape = middle.clone();
            shape[at] = *end;
            examine_at(effect, &shape)?;
        }
    }
    match check(&Examined { effect, ranges }) {
        // The formula itself gives the coefficient its unit.
        Ok(()) | Err(Flaw::Interval { .. }) => Ok(()),
        Err(Flaw::NotFinite { m, .. }) => Err((
            format!("at 100 Hz the Allan variance of {m} samples is negative or no number"),
            match effect.kind {
                Kind::Density => "give a density that is smaller at low frequency",
                Kind::Covariance => "give a covariance that some noise has, such as exp(-t/4)",
            }
            .into(),
        )),
        Err(flaw) => Err((flaw.to_string(), "write another formula".into())),
    }
}

fn examine_at(effect: &FormulaEffect, parameters: &[f64]) -> Result<(), Refusal> {
    let (variable, unit) = match effect.kind {
        Kind::Density => ("f", "Hz"),
        Kind::Covariance => ("t", "s"),
    };
    let at = |x: f64| effect.at(x, parameters);
    let shape = || {
        let pairs = effect.description.parameters.iter().zip(parameters);
        let pairs: Vec<String> = pairs
            .map(|(one, value)| format!("{}={value}", one.name))
            .collect();
        match pairs.as_slice() {
            [] => String::new(),
            pairs => format!(", {}", pairs.join(", ")),
        }
    };
    let is_density = effect.kind == Kind::Density;
    // From the longest record to the fastest sensor.
    for step in 0..=1200 {
        let x = LOWEST_HZ * 10.0_f64.powf(f64::from(step) / 100.0);
        let value = at(x);
        if !value.is_finite() || is_density && value < 0.0 {
            return Err((
                format!(
                    "at {variable} = {x:.3} {unit}{} the {} is {value}",
                    shape(),
                    effect.kind.name()
                ),
                match is_density {
                    true => {
                        "give a density that is a number, 0 or above, for every frequency above 0"
                            .into()
                    }
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
