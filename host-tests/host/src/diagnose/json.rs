//! The JSON document of a diagnosis.

use super::{
    diagnosed::{Diagnosed, added_name},
    lines::{Line, comb_words},
};
use crate::{
    comb::Comb,
    event_json::{Event, event, motion},
    fit,
    known_filter::Shape,
    model_json::{self, Effect, Worst},
    schema::{Numbers, ReasonName, VerdictName},
    tried::{self, TriedCovariate},
};
use allanite::{
    Term,
    comparison::ComparedBin,
    detection::Range,
    diagnosis::{Candidate as Tried, Step as Taken},
};
use allanite_log::{BINS, OCTAVES, unit::Unit};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};

/// The diagnoses of one file.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "axes")]
pub struct Document<'a> {
    /// The axes, in their order in the record.
    pub axes: Vec<Axis<'a>>,
}

/// The diagnosis of an axis.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "axis")]
pub struct Axis<'a> {
    /// The name of the axis.
    axis: &'a str,
    /// The filter that was given, and whether it fits.
    #[serde(skip_serializing_if = "Option::is_none")]
    filter: Option<Filter>,
    /// From the five terms to the last model, which explains the record if one does.
    #[schemars(length(min = 1))]
    steps: Vec<Step>,
    /// The spectrum beside the last model.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    spectrum: Vec<Bin>,
    /// What happened during the record.
    events: Vec<Event>,
    /// The sinusoids of the last model.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    lines: Vec<SpectralLine>,
    /// The sinusoids that are harmonics of one fundamental.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    combs: Vec<Harmonics>,
    /// The covariates that were tried.
    covariates: Vec<tried::Document>,
    /// The verdict, as it is written in files.
    #[schemars(with = "VerdictName")]
    pub verdict: &'static str,
    /// Why the record is not valid; `null` if it is.
    invalid: Option<String>,
    /// The same in a word.
    #[schemars(with = "Option<ReasonName>")]
    reason: Option<&'static str>,
    /// The effects that the five terms lack, and a covariate if the rate follows one.
    pub missing: Vec<&'static str>,
    /// Effects that would explain the record as well.
    ambiguous: Vec<&'static str>,
    /// The sizes of effects that the record would have shown with a probability of 95 %, over ranges of shapes.
    detection_limits: Vec<DetectionLimit>,
    /// Notes, a sentence each.
    notes: Vec<String>,
}

#[derive(Serialize, JsonSchema)]
#[schemars(rename = "line")]
struct SpectralLine {
    frequency_hz: f64,
    #[schemars(with = "Option<f64>")]
    lower_hz: f64,
    #[schemars(with = "Option<f64>")]
    upper_hz: f64,
    /// In rate units.
    #[schemars(with = "Option<f64>")]
    amplitude: f64,
    /// The width in hertz that is excluded with a probability of 95 %, as that of a resonance.
    narrower_than_hz: Option<f64>,
}

#[derive(Serialize, JsonSchema)]
#[schemars(rename = "comb")]
struct Harmonics {
    fundamental_hz: f64,
    /// The nominal frequency of the mains, if the fundamental agrees with it.
    mains_hz: Option<f64>,
    /// The places of the lines in `lines`, and their orders.
    lines: Vec<usize>,
    orders: Vec<u32>,
    words: String,
}

#[derive(Serialize, JsonSchema)]
#[schemars(rename = "filter")]
struct Filter {
    #[serde(flatten)]
    given: Shape,
    /// Whether the filter that was given fits.
    fits: bool,
    /// The filter that fits better; `null` if the given one fits, or no filter does.
    better: Option<Shape>,
}

#[derive(Serialize, JsonSchema)]
#[schemars(rename = "detection_limit")]
struct DetectionLimit {
    #[serde(flatten)]
    range: model_json::DetectionRange,
    /// The limit of every shape of the range that was computed.
    #[schemars(with = "Vec<Numbers>")]
    shapes: Vec<Map<String, Value>>,
}

#[derive(Serialize, JsonSchema)]
#[schemars(rename = "step")]
struct Step {
    /// The model.
    effects: Vec<Effect>,
    coefficients: Vec<fit::json::Term>,
    /// χ² of the fit.
    #[schemars(with = "Option<f64>")]
    chi2: f64,
    /// `chi2`, and what the rate follows of a covariate as long as that is not subtracted: it falls from step to step.
    #[schemars(with = "Option<f64>")]
    error: f64,
    /// The degrees of freedom.
    dof: usize,
    /// The deviance of the fit, as that of `fit`.
    #[schemars(with = "Option<f64>")]
    deviance: f64,
    #[schemars(with = "Option<f64>")]
    p_value: f64,
    /// The factor by which intervals and bounds are widened.
    #[schemars(with = "Option<f64>")]
    birge_ratio: f64,
    /// The rms difference of the Allan variances from the model, in percent.
    #[schemars(with = "Option<f64>")]
    rms_percent: f64,
    /// The octave that differs most.
    worst: Option<Worst>,
    /// The effects that were tried, the best one first.
    candidates: Vec<Candidate>,
    /// What the next step adds; `null` in the last step.
    added: Option<&'static str>,
}

/// A bin of the spectrum.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "bin")]
struct Bin {
    frequency_hz: f64,
    /// The number of samples in a block.
    block: u32,
    /// The one-sided density, in rate units squared per hertz.
    density: f64,
    /// The density that the model has there.
    expected: f64,
    /// Standard errors between them.
    #[schemars(with = "Option<f64>")]
    z: f64,
}

#[derive(Serialize, JsonSchema)]
#[schemars(rename = "candidate")]
struct Candidate {
    effect: &'static str,
    #[schemars(with = "Numbers")]
    parameters: Map<String, Value>,
    #[schemars(with = "Option<f64>")]
    chi2: f64,
    /// By how much χ² falls, scaled.
    #[schemars(with = "Option<f64>")]
    improvement: f64,
}

/// Puts the diagnoses of all axes into one document.
pub fn document(diagnosed: &[Diagnosed]) -> Document<'_> {
    Document {
        axes: diagnosed.iter().map(axis).collect(),
    }
}

fn axis(diagnosed: &Diagnosed) -> Axis<'_> {
    let unit = diagnosed.axis.unit;
    let mut names: Vec<&'static str> = diagnosed
        .ambiguous()
        .flat_map(|(_, others)| others.iter().copied())
        .collect();
    names.sort_unstable();
    names.dedup();
    Axis {
        axis: &diagnosed.axis.axis,
        filter: diagnosed.filter().map(|given| filter(given, diagnosed)),
        steps: diagnosed
            .steps
            .iter()
            .enumerate()
            .map(|(at, one)| step(at, one, diagnosed, unit))
            .collect(),
        spectrum: diagnosed.ends().map_or(Vec::new(), |(_, last)| {
            let bins = last.comparison.bins.iter();
            bins.map(bin).collect()
        }),
        events: diagnosed
            .motion()
            .map(motion)
            .chain(diagnosed.stationarity.events.iter().map(event))
            .collect(),
        lines: diagnosed.lines.iter().map(line).collect(),
        combs: diagnosed.combs.iter().map(harmonics).collect(),
        covariates: diagnosed
            .tried
            .iter()
            .map(TriedCovariate::document)
            .collect(),
        verdict: diagnosed.verdict_name(),
        missing: diagnosed.missing().collect(),
        invalid: diagnosed.invalid(),
        reason: match diagnosed.verdict {
            allanite::diagnosis::Verdict::Invalid(reason) => Some(reason.name()),
            _ => None,
        },
        ambiguous: names,
        detection_limits: limits(diagnosed),
        notes: diagnosed.notes(),
    }
}

fn line(line: &Line) -> SpectralLine {
    SpectralLine {
        frequency_hz: line.frequency_hz,
        lower_hz: line.lower_hz,
        upper_hz: line.upper_hz,
        amplitude: line.amplitude,
        narrower_than_hz: line.narrower_than_hz,
    }
}

fn harmonics(comb: &Comb) -> Harmonics {
    let (lines, orders) = comb.members.iter().copied().unzip();
    Harmonics {
        fundamental_hz: comb.fundamental_hz,
        mains_hz: comb.mains_hz,
        lines,
        orders,
        words: comb_words(comb),
    }
}

fn filter(given: &Term, diagnosed: &Diagnosed) -> Filter {
    let better = diagnosed.better.as_ref();
    Filter {
        given: Shape::of(given),
        fits: better.is_none(),
        better: better
            .and_then(|better| better.filter.as_ref())
            .map(Shape::of),
    }
}

fn limits(diagnosed: &Diagnosed) -> Vec<DetectionLimit> {
    let ranges = diagnosed.ranges();
    let with_shapes = |range: &Range| DetectionLimit {
        range: model_json::detection_range(range, diagnosed.axis.unit),
        shapes: diagnosed
            .limits
            .iter()
            .filter(|limit| range.has(limit))
            .map(|limit| model_json::parameters(&limit.term, limit.coefficient))
            .collect(),
    };
    ranges.as_slice().iter().map(with_shapes).collect()
}

fn step(at: usize, step: &Taken<OCTAVES, BINS>, diagnosed: &Diagnosed, unit: Unit) -> Step {
    let covariates = step.covariate.iter().flat_map(|followed| {
        let slopes = diagnosed.slopes(followed).into_iter();
        slopes.map(|(slope, series)| model_json::covariate(&slope, series))
    });
    Step {
        effects: covariates
            .chain(model_json::effects(&step.model, &step.fit))
            .collect(),
        coefficients: model_json::coefficients(&step.fit, unit),
        chi2: step.fit.chi_squared,
        error: diagnosed.chi_squared(at),
        dof: step.fit.degrees_of_freedom,
        deviance: step.fit.deviance,
        p_value: step.fit.p_value,
        birge_ratio: step.fit.birge_ratio,
        rms_percent: step.comparison.rms_percent,
        worst: model_json::worst(&step.comparison),
        candidates: step.candidates.iter().map(candidate).collect(),
        added: step.added.as_ref().map(added_name),
    }
}

fn bin(compared: &ComparedBin) -> Bin {
    Bin {
        frequency_hz: compared.bin.frequency_hz,
        block: compared.bin.block,
        density: compared.bin.density,
        expected: compared.model,
        z: compared.z,
    }
}

fn candidate(tried: &Tried) -> Candidate {
    Candidate {
        effect: tried.term.effect.name(),
        parameters: model_json::parameters(&tried.term, tried.coefficient),
        chi2: tried.chi_squared,
        improvement: tried.improvement,
    }
}
