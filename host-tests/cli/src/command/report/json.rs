//! The data of a report's page: the diagnosis as `diagnose --json` prints it, and the figures and words
//! of every step and of every candidate.

use crate::command::output::drawn_frame::{self, DrawnFrame};
use allanite::diagnosis::{Addition, Candidate as Tried, Step};
use allanite_host::{
    diagnose::{
        self,
        diagnosed::Diagnosed,
        found::Found,
        pictures::Pictures,
        words::{Finding, candidate_name, disagreement, shown_p},
    },
    fit, model_json, units,
};
use allanite_log::{BINS, OCTAVES, unit::Unit};
use allanite_plot::{CourseFigure, Frame, Line, Measured, Share};
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
    /// The frames of the figures, which all steps share.
    frames: Vec<AxisFrame>,
    /// The record over time, if it is known.
    course: Option<CourseFigure>,
    /// The customary unit of a coefficient, by the unit that follows from the log's.
    customary: BTreeMap<String, Customary>,
    steps: Vec<View>,
}

/// The frame of a figure.
#[derive(Serialize)]
struct AxisFrame {
    #[serde(flatten)]
    frame: DrawnFrame,
    /// The panel of residuals reaches from −z to z standard errors.
    z: f64,
    /// What the first step shows as measured.
    measured: Option<Measured>,
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
    /// A figure for each frame.
    figures: Vec<StepFigure>,
    /// Index of the figure in which the error fell most in this step, or is largest in the first step.
    front: usize,
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
struct StepFigure {
    /// What is measured, if it differs from the first step.
    measured: Option<Measured>,
    z: Vec<f32>,
    /// What the model predicts at each of the points.
    expected: Vec<f32>,
    /// The positions of the residuals in their panel.
    up: Vec<f32>,
    /// Index of the largest residual.
    worst: usize,
    #[serde(flatten)]
    lines: Lines,
}

#[derive(Serialize)]
struct Lines {
    model: Line,
    shares: Vec<Share>,
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
    let pictures = Pictures::of(diagnosed);
    let frames = pictures.frames();
    let shared = Shared {
        diagnosed,
        pictures: &pictures,
        first: frames
            .iter()
            .map(|frame| pictures.figure(&diagnosed.steps[0], frame).measured)
            .collect(),
        frames: &frames,
    };
    let steps = 0..diagnosed.steps.len();
    Axis {
        customary: customary(unit),
        steps: steps.map(|at| shared.step(at)).collect(),
        course: pictures.course(),
        frames: frames
            .iter()
            .zip(&shared.first)
            .map(|(frame, measured)| axis_frame(unit, frame, measured))
            .collect(),
    }
}

fn axis_frame(unit: Unit, frame: &Frame, measured: &Measured) -> AxisFrame {
    AxisFrame {
        frame: drawn_frame::frame(unit, frame),
        z: frame.z,
        measured: Some(measured.clone()),
    }
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

/// What all views of an axis share.
struct Shared<'a> {
    diagnosed: &'a Diagnosed,
    pictures: &'a Pictures<'a>,
    frames: &'a [Frame],
    /// What the first step shows as measured, in each frame.
    first: Vec<Measured>,
}

impl Shared<'_> {
    fn step(&self, at: usize) -> View {
        let diagnosed = self.diagnosed;
        let step = &diagnosed.steps[at];
        let before = at.checked_sub(1).map(|before| &diagnosed.steps[before]);
        let finding = before.and_then(|before| Finding::new(diagnosed, before, step));
        let candidates = step.candidates.iter().enumerate();
        let candidates = candidates.map(|(place, tried)| {
            let added = place == 0 && matches!(step.added, Some(Addition::Effect(_)));
            Candidate {
                name: candidate_name(tried),
                added,
                fitted: (!added).then(|| self.fitted(at, tried)).flatten(),
            }
        });
        View {
            found: finding.map(Found::from),
            candidates: candidates.collect(),
            ..self.view(diagnosed.model_name(at), before, step)
        }
    }

    /// The complete fit of a candidate that was not added; `None` if it cannot be fitted in full.
    fn fitted(&self, at: usize, tried: &Tried) -> Option<Fitted> {
        let step = self.diagnosed.alternative(at, tried).ok()?;
        let name = candidate_name(tried);
        let model = format!("{} + {name}", self.diagnosed.model_name(at));
        Some(Fitted {
            chi2: step.fit.chi_squared,
            dof: step.fit.degrees_of_freedom,
            p_value: step.fit.p_value,
            birge_ratio: step.fit.birge_ratio,
            rms_percent: step.comparison.rms_percent,
            coefficients: model_json::coefficients(&step.fit, self.diagnosed.axis.unit),
            view: self.view(model, Some(&self.diagnosed.steps[at]), &step),
        })
    }

    /// The view of a model that was fitted after that of the step before.
    fn view(
        &self,
        model: String,
        before: Option<&Step<OCTAVES, BINS>>,
        step: &Step<OCTAVES, BINS>,
    ) -> View {
        let figures = self.frames.iter().zip(&self.first).map(|(frame, first)| {
            let figure = self.pictures.figure(step, frame);
            StepFigure {
                worst: figure.worst(),
                up: figure.z.iter().map(|z| place(frame, *z)).collect(),
                measured: (figure.measured != *first).then_some(figure.measured),
                z: figure.z,
                expected: figure.expected,
                lines: Lines {
                    model: figure.model,
                    shares: figure.shares,
                },
            }
        });
        let falls = self.frames.iter().map(|frame| {
            let error = |of: &Step<OCTAVES, BINS>| {
                let quantity = frame.quantity;
                quantity.squared_error(&of.comparison, &step.comparison)
            };
            before.map_or(0.0, error) - error(step)
        });
        let largest = falls.map(f64::abs).enumerate();
        let largest = largest.max_by(|(_, one), (_, other)| one.total_cmp(other));
        View {
            model,
            front: largest.map_or(0, |(at, _)| at),
            figures: figures.collect(),
            words: disagreement(&step.comparison),
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
}

/// The position of a residual in its panel, with three digits.
fn place(frame: &Frame, z: f32) -> f32 {
    let up = frame.up(f64::from(z)).clamp(0.0, 1.0);
    ((1e4 * up).round() / 1e4) as f32
}
