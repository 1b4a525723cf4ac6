//! The answer to a question: a fit with its figures, in JSON.

use super::{
    catalogue::{Listed, listed_as},
    figure::{self, DrawnModel, DrawnRecord},
    fitted::Fitted,
    question::{Question, with},
    shell,
};
use crate::command::output::drawn_frame::{self, DrawnFrame};
use allanite::{Coefficient, Comparison, fit::State};
use allanite_host::{
    diagnose::words::{disagreement, shown_p},
    fit::table::state,
    number::number,
    own, units, words,
};
use allanite_log::{BINS, OCTAVES, unit::Unit};
use allanite_plot::{Figure, Frame};
use serde::Serialize;

/// A fit with its figures.
#[derive(Serialize)]
pub(super) struct Answer {
    #[serde(flatten)]
    verdict: GoodnessOfFit,
    /// The error, which falls from model to model: χ², and what follows the covariates as long as it is not taken out.
    error: f64,
    adequate: Option<bool>,
    /// The added effects with their shapes, in the order of the question.
    added: Vec<Added>,
    coefficients: Vec<Shown>,
    /// By how much the intervals are widened, if they are.
    widened: Option<String>,
    frames: Vec<DrawnFrame>,
    /// The record in each frame.
    records: Vec<DrawnRecord>,
    /// The model in each frame.
    models: Vec<DrawnModel>,
    judged: Vec<Judged>,
    /// The command line that gives the same fit.
    command: String,
}

/// How well a model explains a record.
#[derive(Serialize)]
struct GoodnessOfFit {
    chi2: f64,
    dof: usize,
    p: String,
    p_value: f64,
    rms_percent: f64,
    words: String,
}

/// An added effect.
#[derive(Serialize)]
struct Added {
    with: String,
    effect: &'static str,
    /// The formula of an effect of the user's own, without its parameters.
    formula: Option<String>,
    /// How such an effect is listed.
    own: Option<Listed>,
    fitted: bool,
    parameters: Vec<f64>,
    /// The 95 % intervals of fitted parameters.
    intervals: Vec<Option<[f64; 2]>>,
}

/// A coefficient in the units in which it is shown: that of the log, and the customary one.
#[derive(Serialize)]
struct Shown {
    effect: &'static str,
    name: String,
    symbol: &'static str,
    state: &'static str,
    words: String,
    value: f64,
    upper: f64,
    units: Vec<[String; 3]>,
}

/// A record that judges the model.
#[derive(Serialize)]
struct Judged {
    record: usize,
    #[serde(flatten)]
    verdict: GoodnessOfFit,
    records: Vec<DrawnRecord>,
}

/// Answers a question. `about_log` are the options about logs for the command line.
pub(super) fn answer(fitted: &Fitted, question: &Question, about_log: &[String]) -> Answer {
    let record = fitted.record;
    let unit = record.axis.unit;
    let frames = fitted.frames();
    let (records, models) = drawn(fitted.figures(&frames), &frames).into_iter().unzip();
    let added = added(fitted, question);
    let options: Vec<String> = added.iter().map(|added| added.with.clone()).collect();
    let about_log = if record.is_curve() { &[] } else { about_log };
    let judged = fitted.judged.iter().enumerate();
    let judged = judged.map(|(at, one)| {
        let drawn = drawn(fitted.judged_figures(at, &frames), &frames);
        Judged {
            record: one.number,
            verdict: verdict(&one.comparison),
            records: drawn.into_iter().map(|(record, _)| record).collect(),
        }
    });
    Answer {
        verdict: verdict(&fitted.comparison),
        error: fitted.error(),
        adequate: fitted.fit.is_adequate(),
        command: shell::command(
            record.path(),
            about_log,
            &options,
            &question.without,
            fitted.taken_out().is_some(),
        ),
        added,
        coefficients: coefficients(fitted, unit),
        widened: words::widened(&fitted.fit),
        judged: judged.collect(),
        frames: frames
            .iter()
            .map(|frame| drawn_frame::frame(unit, frame))
            .collect(),
        records,
        models,
    }
}

fn drawn(figures: Vec<Figure>, frames: &[Frame]) -> Vec<(DrawnRecord, DrawnModel)> {
    let pairs = figures.into_iter().zip(frames);
    pairs
        .map(|(figure, frame)| figure::drawn(figure, frame))
        .collect()
}

fn verdict(comparison: &Comparison<OCTAVES, BINS>) -> GoodnessOfFit {
    GoodnessOfFit {
        chi2: comparison.chi_squared,
        dof: comparison.degrees_of_freedom,
        p: shown_p(comparison.p_value),
        p_value: comparison.p_value,
        rms_percent: comparison.rms_percent,
        words: disagreement(comparison),
    }
}

fn added(fitted: &Fitted, question: &Question) -> Vec<Added> {
    let fit = &fitted.fit;
    let added = question.added(&fitted.model).into_iter();
    added
        .map(|(place, term)| {
            let parameters = term.effect.parameters().iter();
            let interval = |name: &str| {
                let mut shape = fit.shape.iter();
                let estimate = shape.find(|one| one.term == place && one.name == name)?;
                Some([estimate.lower, estimate.upper])
            };
            let own = own::find(term.effect);
            Added {
                with: with(term),
                formula: own.map(own::FormulaEffect::formula),
                own: own.map(|own| listed_as(own, own.explanation(), fitted.records)),
                effect: term.effect.name(),
                fitted: term.fitted,
                intervals: parameters.clone().map(|one| interval(one.name)).collect(),
                parameters: parameters
                    .zip(term.parameters)
                    .map(|(_, value)| value)
                    .collect(),
            }
        })
        .collect()
}

fn coefficients(fitted: &Fitted, unit: Unit) -> Vec<Shown> {
    let terms = fitted.model.terms().iter();
    terms
        .zip(&fitted.fit.coefficients)
        .map(|(term, one)| {
            let half = one.half_seconds;
            let customary = units::customary(unit, half);
            let customary = customary.map(|(factor, name)| (factor, name.to_owned()));
            let names = std::iter::once((1.0, units::unit(unit, half))).chain(customary);
            Shown {
                effect: term.effect.name(),
                name: words::of_sensor(term.effect.name(), unit),
                symbol: one.symbol,
                state: match one.state {
                    State::Measured => "measured",
                    State::UpperBound => "upper_bound",
                    State::NotObservable { .. } => "not_observable",
                },
                words: state(one),
                value: one.value,
                upper: one.upper,
                units: names
                    .map(|(factor, name)| shown(one, factor, name))
                    .collect(),
            }
        })
        .collect()
}

/// The value of a coefficient times a factor, its interval, and the name of its unit.
fn shown(one: &Coefficient, factor: f64, name: String) -> [String; 3] {
    let [value, lower, upper] =
        [one.value, one.lower, one.upper].map(|value| number(factor * value));
    match one.state {
        State::Measured => [value, format!("{lower} … {upper}"), name],
        State::UpperBound => [format!("< {upper}"), "interval includes 0".into(), name],
        State::NotObservable { .. } => ["–".into(), state(one), name],
    }
}
