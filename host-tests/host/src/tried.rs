//! The covariates that were tried, with what was found of each.

use crate::{
    dependence::{
        candidates::{Bound, Candidate, Candidates, Form, seconds},
        lag::{Lag, Unresolved},
    },
    diagnosis::diagnose,
    number::{number, rounded_up, two_digits},
};
use allanite::{
    Curve, Error, Model,
    covariate::Slope,
    diagnosis::{Options, Step},
    spectrum::Spectrum,
};
use allanite_log::{self as log, BINS, OCTAVES, failure::plural, is_degrees_column, unit::Unit};
use schemars::JsonSchema;
use serde::Serialize;

/// A covariate that was tried.
pub struct TriedCovariate {
    /// The column, or its rate of change.
    pub channel: String,
    /// The column of the log that it is formed from, and how.
    column: String,
    form: Form,
    found: Found,
}

/// What was found of a covariate.
enum Found {
    /// The rate follows it. It may do so with a lag that the record does not tell.
    Acts(Slope, Option<Unresolved>),
    /// The rate follows it with a lag.
    ActsBehind(Box<Lag>),
    /// The rate does not follow it with a slope that stands out.
    Nothing(Slope, Option<Bound>),
    /// The rate follows another covariate, and not this one beside it.
    NothingBeside(Slope, String),
    /// It takes the same course as a covariate that the rate follows.
    SameAs(String),
    /// What it does is a part of what another covariate of the same column does.
    PartOf(String),
    /// It changes in so many steps, which are too few to tell that the rate does not follow what is between them.
    Seldom(usize),
    /// It never changes.
    Constant,
}

/// A covariate that was tried, in JSON.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "covariate")]
pub struct Document {
    /// The column of the log, or what is formed from it.
    channel: String,
    /// Whether the rate follows it.
    acts: bool,
    /// The slope in rate units per unit of the covariate, with its 95 % interval; `null` if it cannot be told.
    slope: Option<f64>,
    slope_lower: Option<f64>,
    slope_upper: Option<f64>,
    /// The slope over its standard error.
    z: Option<f64>,
    /// The lag with which the rate follows it, with its 95 % interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    lag_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    lag_lower_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    lag_upper_s: Option<f64>,
    /// The largest amplitude of the rate per unit of the covariate that the record does not exclude, whatever the
    /// phase, where no dependence shows.
    #[serde(skip_serializing_if = "Option::is_none")]
    most: Option<f64>,
}

/// What a step of a diagnosis tells of every covariate that was asked for, and of others that act. `curve` is that of
/// the record.
pub fn tried(
    curve: &Curve<OCTAVES>,
    candidates: &Candidates,
    step: &Step<OCTAVES, BINS>,
) -> Vec<TriedCovariate> {
    let octaves = &step.comparison.octaves;
    let noise = |k: usize| octaves.get(k).map_or(f64::NAN, |octave| octave.model);
    let points = curve.points();
    let (crosses, pairs) = (&candidates.crosses, &candidates.pairs);
    let followed = step.covariate.as_ref();
    let slopes = followed.map_or(Vec::new(), |followed| candidates.slopes(followed));
    let acting = |at: usize| {
        let mut slopes = slopes.iter();
        let is_it = |candidate: &Candidate| std::ptr::eq(candidate, &raw const candidates.all[at]);
        slopes.find_map(|(slope, candidate)| is_it(candidate).then_some(*slope))
    };
    // The column behind a lag, if the rate follows that.
    let behind = |column: &str| {
        let all = candidates.all.iter().enumerate();
        let mut lagged = all.filter_map(|(at, other)| match &other.form {
            Form::Behind(lag) if other.column == column => Some((acting(at)?, lag)),
            _ => None,
        });
        let (slope, lag) = lagged.next()?;
        Some(Lag {
            slope,
            ..lag.as_ref().clone()
        })
    };
    let one = |at: usize, candidate: &Candidate| {
        if let Some(slope) = acting(at) {
            return Found::Acts(slope, candidate.unresolved.filter(|_| slopes.len() == 1));
        }
        if let (Form::Itself, Some(lag)) = (&candidate.form, behind(&candidate.column)) {
            return Found::ActsBehind(Box::new(lag));
        }
        let others = candidates.all.iter().enumerate();
        let mut of_column = others.filter(|(at, other)| {
            other.column == candidate.column && !other.asked && acting(*at).is_some()
        });
        // What follows the other covariate of a pair is no part of this one's slope.
        let other = followed.and_then(|followed| {
            let both = [followed.index, at];
            let mut pairs = pairs.iter();
            let pair = pairs.find(|pair| both.iter().all(|one| pair.covariates.contains(one)))?;
            Some((pair, followed.index))
        });
        let slope = match other {
            None => {
                if let Some((_, acts)) = of_column.next() {
                    return Found::PartOf(acts.name.clone());
                }
                Slope::of(&crosses[at], points, noise)
            }
            Some((pair, acting)) => {
                let other = candidates.all[acting].name.clone();
                return match pair.slopes(crosses, points, noise) {
                    None => Found::SameAs(other),
                    Some([first, _]) if pair.covariates[0] == at => {
                        Found::NothingBeside(first, other)
                    }
                    Some([_, second]) => Found::NothingBeside(second, other),
                };
            }
        };
        let bound = || {
            let is_alone = followed.is_none() && matches!(candidate.form, Form::Itself);
            is_alone.then(|| candidates.bound(curve, at, noise))?
        };
        slope.map_or(Found::Constant, |slope| match candidate.seldom {
            Some(steps) => Found::Seldom(steps),
            None => Found::Nothing(slope, bound()),
        })
    };
    let all = candidates.all.iter().enumerate();
    let told = all.filter(|(at, candidate)| match candidate.form {
        Form::Behind(_) => false,
        _ => candidate.asked || acting(*at).is_some(),
    });
    told.map(|(at, candidate)| TriedCovariate {
        channel: candidate.name.clone(),
        column: candidate.column.clone(),
        form: candidate.form.clone(),
        found: one(at, candidate),
    })
    .collect()
}

/// What a record tells of every covariate beside a model, without any search for effects.
///
/// # Errors
/// Those of a fit.
pub fn beside_model(
    curve: &Curve<OCTAVES>,
    spectrum: &Spectrum<BINS>,
    evidence: &log::Evidence,
    model: &Model,
) -> Result<Vec<TriedCovariate>, Error> {
    if evidence.covariates.is_empty() || evidence.invalid.is_some() {
        return Ok(Vec::new());
    }
    let candidates = Candidates::new(curve, spectrum, model, evidence)?;
    let record = candidates.record(curve, spectrum);
    let mut last = None;
    diagnose(record, model, &[], Options::default(), |step| {
        last = Some(step.clone());
    })?;
    let last = last.as_ref();
    Ok(last.map_or(Vec::new(), |step| tried(curve, &candidates, step)))
}

impl TriedCovariate {
    /// Whether the rate follows the covariate.
    pub const fn acts(&self) -> bool {
        matches!(self.found, Found::Acts(..) | Found::ActsBehind(_))
    }

    /// The largest slope on a column itself that is not excluded, where no dependence on it shows.
    pub fn most(&self, column: &str) -> Option<f64> {
        match &self.found {
            Found::Nothing(slope, bound)
                if self.column == column && matches!(self.form, Form::Itself) =>
            {
                let (lower, upper) = slope.interval();
                let alone = lower.abs().max(upper.abs());
                Some(bound.as_ref().map_or(alone, |bound| bound.most))
            }
            _ => None,
        }
    }

    /// The result in a sentence.
    pub fn words(&self, unit: Unit) -> String {
        let Self {
            channel,
            column,
            form,
            found,
        } = self;
        let per = per(column, form, unit);
        match found {
            Found::Acts(slope, unresolved) => {
                let slope = interval(slope, &per);
                let lag = unresolved.map_or(String::new(), |unresolved| {
                    let longest = seconds(unresolved.longest_s);
                    format!("; a lag of up to {longest} is not excluded")
                });
                format!("{channel}: the rate follows it with {slope}{lag}")
            }
            Found::ActsBehind(lag) => format!(
                "{column}: the rate follows it with a lag of {} ({} … {}), and with {}",
                seconds(lag.lag_s),
                seconds(lag.lower_s),
                seconds(lag.upper_s),
                interval(&lag.slope, &per)
            ),
            Found::NothingBeside(slope, other) => {
                format!(
                    "{channel}: no dependence above {} {per} beside {other}",
                    most(slope)
                )
            }
            Found::Nothing(slope, bound) => match bound {
                Some(bound) => format!(
                    "{channel}: no dependence above {} {per}, with a lag or without, at its main period of {} s",
                    rounded_up(bound.most),
                    two_digits(bound.period_s)
                ),
                None => format!("{channel}: no dependence above {} {per}", most(slope)),
            },
            Found::SameAs(other) => {
                format!(
                    "{channel}: takes the same course as {other}, so that the two cannot be told apart"
                )
            }
            Found::PartOf(other) => format!("{channel}: the rate follows {other} instead"),
            Found::Seldom(steps) => {
                let steps = plural(*steps as u64, "step");
                let what = match form {
                    Form::Itself => "",
                    _ => "its column ",
                };
                format!("{channel}: {what}changes in {steps}, too few to exclude a dependence")
            }
            Found::Constant => format!("{channel}: never changes"),
        }
    }

    /// As documents have it.
    pub fn document(&self) -> Document {
        let (slope, lag, bound) = match &self.found {
            Found::Acts(slope, _) => (Some(slope), None, None),
            Found::Nothing(slope, bound) => (Some(slope), None, bound.as_ref()),
            Found::NothingBeside(slope, _) => (Some(slope), None, None),
            Found::ActsBehind(lag) => (Some(&lag.slope), Some(lag.as_ref()), None),
            Found::SameAs(_) | Found::PartOf(_) | Found::Seldom(_) | Found::Constant => {
                (None, None, None)
            }
        };
        let interval = slope.map(Slope::interval);
        Document {
            channel: self.channel.clone(),
            acts: self.acts(),
            slope: slope.map(|slope| slope.value),
            slope_lower: interval.map(|(lower, _)| lower),
            slope_upper: interval.map(|(_, upper)| upper),
            z: slope.map(Slope::z),
            lag_s: lag.map(|lag| lag.lag_s),
            lag_lower_s: lag.map(|lag| lag.lower_s),
            lag_upper_s: lag.map(|lag| lag.upper_s),
            most: bound.map(|bound| bound.most),
        }
    }
}

/// The largest slope that the interval does not exclude.
fn most(slope: &Slope) -> String {
    let (lower, upper) = slope.interval();
    rounded_up(lower.abs().max(upper.abs()))
}

/// A slope with its unit and its interval.
fn interval(slope: &Slope, per: &str) -> String {
    let (lower, upper) = slope.interval();
    format!(
        "{} {per} ({} … {}), 95 % interval",
        number(slope.value),
        number(lower),
        number(upper)
    )
}

/// The unit of a slope: `deg/s per K` for a temperature in degrees Celsius or kelvin, and `deg/s per unit` for a column
/// without a known unit.
pub fn per(column: &str, form: &Form, unit: Unit) -> String {
    match (is_degrees_column(column), form) {
        (true, Form::Itself | Form::Behind(_)) => format!("{unit} per K"),
        (true, Form::RateOfChange) => format!("{unit} per K/s"),
        (true, Form::Square { .. }) => format!("{unit} per K²"),
        (false, Form::Square { .. }) => format!("{unit} per unit²"),
        (false, _) => format!("{unit} per unit"),
    }
}
