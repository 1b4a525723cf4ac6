//! The data of a report's page: the diagnosis as `diagnose --json` prints it, and the figures and words
//! of every step and of every candidate.

use crate::{
    command::{
        diagnose::{
            self,
            diagnosed::Diagnosed,
            words::{Finding, candidate_name, shown_p},
        },
        fit,
        output::{model_json, units},
    },
    log::{BINS, OCTAVES},
    plot::{Figure, Frame},
    unit::Unit,
};
use allanite::diagnosis::{Addition, Candidate as Tried, Step};
use serde::Serialize;
use std::collections::BTreeMap;

#[derive(Serialize)]
pub(super) struct Document<'a> {
    diagnosis: diagnose::json::Document<'a>,
    /// The axes, in the order of the diagnosis.
    axes: Vec<Axis>,
}

#[derive(Serialize)]
struct Axis {
    /// Units of the deviation: first the log's unit, then the customary one.
    units: Vec<DeviationUnit>,
    /// The customary unit of a coefficient, by the unit that follows from the log's.
    customary: BTreeMap<String, Customary>,
    /// Ends of the axis of averaging times, in seconds.
    tau_s: [f64; 2],
    /// Ends of the axis of deviations, in the log's unit.
    sigma: [f64; 2],
    times: Vec<(f64, String)>,
    steps: Vec<View>,
}

#[derive(Serialize)]
struct DeviationUnit {
    name: String,
    /// The factor from the log's unit to this unit.
    factor: f64,
    ticks: Vec<(f64, String)>,
}

#[derive(Serialize)]
struct Customary {
    factor: f64,
    unit: &'static str,
}

/// The view of one model beside the record.
#[derive(Serialize)]
struct View {
    model: String,
    figure: Figure,
    /// The panel of residuals reaches from −z to z standard errors.
    z: f64,
    /// The ticks of that panel.
    residuals: [(f64, String); 3],
    /// Index of the octave with the largest residual.
    worst: usize,
    /// The comparison of model and record in words.
    words: String,
    /// The p-value with its relation.
    p: String,
    /// The state of each coefficient in words.
    states: Vec<String>,
    /// The addition of the step before, which led to this step.
    found: Option<Found>,
    candidates: Vec<Candidate>,
}

#[derive(Serialize)]
struct Found {
    name: String,
    found: Option<String>,
    lines: Vec<(&'static str, String)>,
    ambiguous: Option<String>,
}

#[derive(Serialize)]
struct Candidate {
    name: String,
    /// Whether the candidate was added; then its fit is the next step.
    added: bool,
    /// The complete fit of a candidate that was not added; `None` if it cannot be fitted.
    fitted: Option<Fitted>,
}

#[derive(Serialize)]
struct Fitted {
    chi2: f64,
    dof: usize,
    p_value: f64,
    /// The factor by which intervals and bounds are widened.
    birge_ratio: f64,
    rms_percent: f64,
    coefficients: Vec<fit::json::Term>,
    view: View,
}

/// Puts the diagnoses of all axes into one document. Every candidate is fitted in full.
pub(super) fn document(diagnosed: &[Diagnosed]) -> Document<'_> {
    Document {
        diagnosis: diagnose::json::document(diagnosed),
        axes: diagnosed.iter().map(axis).collect(),
    }
}

fn axis(diagnosed: &Diagnosed) -> Axis {
    let unit = diagnosed.axis.unit;
    let frame = Frame::of(diagnosed.steps.iter().map(|step| &step.comparison));
    let steps = 0..diagnosed.steps.len();
    Axis {
        units: deviation_units(unit, &frame),
        customary: customary(unit),
        tau_s: [frame.tau_s.low, frame.tau_s.high],
        sigma: [frame.sigma.low, frame.sigma.high],
        times: frame.tau_s.times(),
        steps: steps.map(|at| step(diagnosed, at, &frame)).collect(),
    }
}

fn deviation_units(unit: Unit, frame: &Frame) -> Vec<DeviationUnit> {
    let customary = units::customary(unit, 0).map(|(factor, name)| (factor, name.to_owned()));
    let names = std::iter::once((1.0, units::unit(unit, 0))).chain(customary);
    let unit = |(factor, name)| DeviationUnit {
        name,
        factor,
        ticks: frame.sigma.scaled(factor).labelled(),
    };
    names.map(unit).collect()
}

fn customary(unit: Unit) -> BTreeMap<String, Customary> {
    let one = |half_seconds| {
        let (factor, customary) = units::customary(unit, half_seconds)?;
        let name = units::unit(unit, half_seconds);
        Some((
            name,
            Customary {
                factor,
                unit: customary,
            },
        ))
    };
    (-2..=2).filter_map(one).collect()
}

fn step(diagnosed: &Diagnosed, at: usize, frame: &Frame) -> View {
    let step = &diagnosed.steps[at];
    let before = at.checked_sub(1).map(|before| &diagnosed.steps[before]);
    let finding = before.and_then(|before| Finding::new(diagnosed, before, step));
    let candidates = step.candidates.iter().enumerate();
    let candidates = candidates.map(|(place, tried)| {
        let added = place == 0 && matches!(step.added, Some(Addition::Effect(_)));
        Candidate {
            name: candidate_name(tried),
            added,
            fitted: (!added)
                .then(|| fitted(diagnosed, at, tried, frame))
                .flatten(),
        }
    });
    View {
        found: finding.map(|finding| Found {
            lines: finding
                .lines()
                .into_iter()
                .map(|(label, text)| (label, text.to_owned()))
                .collect(),
            name: finding.name,
            found: finding.found,
            ambiguous: finding.ambiguous,
        }),
        candidates: candidates.collect(),
        ..view(diagnosed.model_name(at), step, frame)
    }
}

/// The complete fit of a candidate that was not added; `None` if it cannot be fitted in full.
fn fitted(diagnosed: &Diagnosed, at: usize, tried: &Tried, frame: &Frame) -> Option<Fitted> {
    let step = diagnosed.alternative(at, tried).ok()?;
    let name = candidate_name(tried);
    let model = format!("{} + {name}", diagnosed.model_name(at));
    Some(Fitted {
        chi2: step.fit.chi_squared,
        dof: step.fit.degrees_of_freedom,
        p_value: step.fit.p_value,
        birge_ratio: step.fit.birge_ratio,
        rms_percent: step.comparison.rms_percent,
        coefficients: model_json::coefficients(&step.fit, diagnosed.axis.unit),
        view: view(model, &step, frame),
    })
}

/// The view of a step. All steps share the frame of the deviations, but each has its own for the
/// residuals.
fn view(model: String, step: &Step<OCTAVES, BINS>, frame: &Frame) -> View {
    let own = Frame::of([&step.comparison]);
    let figure = Figure::new(&step.model, &step.comparison, frame);
    View {
        model,
        worst: figure.worst(),
        figure,
        z: own.z,
        residuals: own.residuals(),
        words: step.comparison.to_string(),
        p: shown_p(step.fit.p_value),
        states: step
            .fit
            .coefficients
            .iter()
            .map(fit::table::state)
            .collect(),
        found: None,
        candidates: Vec::new(),
    }
}
