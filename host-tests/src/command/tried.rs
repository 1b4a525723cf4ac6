//! The covariates that were tried, with what was found of each.

use crate::{
    command::output::number::{number, rounded_up},
    diagnosis::diagnose,
    log::{BINS, OCTAVES, is_degrees_column},
    unit::Unit,
};
use allanite::{
    Error, Model, Record,
    covariate::Slope,
    diagnosis::{Options, Step},
};
use serde::Serialize;

/// A covariate that was tried.
pub(crate) struct TriedCovariate {
    pub(crate) channel: String,
    found: Found,
}

/// What was found of a covariate.
enum Found {
    /// The rate follows it.
    Acts(Slope),
    /// The rate does not follow it with a slope that stands out.
    Nothing(Slope),
    /// It takes the same course as a covariate that the rate follows.
    SameAs(String),
    /// It never changes.
    Constant,
}

/// A covariate that was tried, in JSON.
#[derive(Serialize)]
pub(crate) struct Document {
    channel: String,
    /// Whether the rate follows it.
    acts: bool,
    /// The slope in rate units per unit of the covariate, with its 95 % interval; `null` if it cannot be told.
    slope: Option<f64>,
    slope_lower: Option<f64>,
    slope_upper: Option<f64>,
    z: Option<f64>,
}

/// What a step of the diagnosis of a record tells of every covariate.
pub(crate) fn tried(
    record: &Record<'_, OCTAVES, BINS>,
    names: &[String],
    step: &Step<OCTAVES, BINS>,
) -> Vec<TriedCovariate> {
    let octaves = &step.comparison.octaves;
    let noise = |k: usize| octaves.get(k).map_or(f64::NAN, |octave| octave.model);
    let points = record.curve.points();
    let followed = step.covariate.as_ref();
    let one = |at: usize| {
        let beside = followed.and_then(|followed| followed.beside);
        if let Some(followed) = followed.filter(|followed| followed.index == at) {
            return Found::Acts(followed.slope);
        }
        if let Some(beside) = beside.filter(|beside| beside.index == at) {
            return Found::Acts(beside.slope);
        }
        // What follows the other covariate of a pair is no part of this one's slope.
        let other = followed.and_then(|followed| {
            let both = [followed.index, at];
            let mut pairs = record.pairs.iter();
            let pair = pairs.find(|pair| both.iter().all(|one| pair.covariates.contains(one)))?;
            Some((pair, followed.index))
        });
        let slope = match other {
            None => Slope::of(&record.covariates[at], points, noise),
            Some((pair, acting)) => {
                let Some([first, second]) = pair.slopes(record.covariates, points, noise) else {
                    return Found::SameAs(names[acting].clone());
                };
                Some(if pair.covariates[0] == at {
                    first
                } else {
                    second
                })
            }
        };
        slope.map_or(Found::Constant, Found::Nothing)
    };
    let named = names.iter().take(record.covariates.len()).enumerate();
    named
        .map(|(at, name)| TriedCovariate {
            channel: name.clone(),
            found: one(at),
        })
        .collect()
}

/// What a record tells of every covariate beside a model, without any search for effects.
///
/// # Errors
/// Those of a fit.
pub(crate) fn beside_model(
    record: Record<'_, OCTAVES, BINS>,
    names: &[String],
    model: &Model,
) -> Result<Vec<TriedCovariate>, Error> {
    if record.covariates.is_empty() || record.invalid.is_some() {
        return Ok(Vec::new());
    }
    let mut last = None;
    diagnose(record, model, &[], Options::default(), |step| {
        last = Some(step.clone());
    })?;
    let last = last.as_ref();
    Ok(last.map_or(Vec::new(), |step| tried(&record, names, step)))
}

impl TriedCovariate {
    /// Whether the rate follows the covariate.
    pub(crate) const fn acts(&self) -> bool {
        matches!(self.found, Found::Acts(_))
    }

    /// The result in a sentence.
    pub(crate) fn words(&self, unit: Unit) -> String {
        let Self { channel, found } = self;
        let per = per(channel, unit);
        match found {
            Found::Acts(slope) => {
                let (lower, upper) = slope.interval();
                format!(
                    "{channel}: the rate follows it with {} {per} ({} … {}), 95 % interval",
                    number(slope.value),
                    number(lower),
                    number(upper)
                )
            }
            Found::Nothing(slope) => {
                let (lower, upper) = slope.interval();
                let most = rounded_up(lower.abs().max(upper.abs()));
                format!("{channel}: no dependence above {most} {per}")
            }
            Found::SameAs(other) => {
                format!(
                    "{channel}: takes the same course as {other}, so that the two cannot be told apart"
                )
            }
            Found::Constant => format!("{channel}: never changes"),
        }
    }

    pub(crate) fn document(&self) -> Document {
        let slope = match &self.found {
            Found::Acts(slope) | Found::Nothing(slope) => Some(slope),
            Found::SameAs(_) | Found::Constant => None,
        };
        let interval = slope.map(Slope::interval);
        Document {
            channel: self.channel.clone(),
            acts: self.acts(),
            slope: slope.map(|slope| slope.value),
            slope_lower: interval.map(|(lower, _)| lower),
            slope_upper: interval.map(|(_, upper)| upper),
            z: slope.map(Slope::z),
        }
    }
}

/// The unit of a slope: `deg/s/K` for a temperature in degrees Celsius or kelvin, and `deg/s per unit of x` for a
/// column without a known unit.
fn per(channel: &str, unit: Unit) -> String {
    let inner = channel.strip_prefix("rate(");
    let (column, is_rate) = match inner.and_then(|inner| inner.strip_suffix(')')) {
        Some(column) => (column, true),
        None => (channel, false),
    };
    match (is_degrees_column(column), is_rate) {
        (true, false) => format!("{unit}/K"),
        (true, true) => format!("{unit} per K/s"),
        (false, _) => format!("{unit} per unit"),
    }
}
