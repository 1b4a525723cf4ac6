//! The JSON document of a comparison.

use super::compared::Compared;
use crate::{
    fit,
    model_json::{self, Effect, Worst},
    schema::{Numbers, UnitName},
};
use allanite::{
    Model,
    comparison::{self, ComparedOctave},
};
use allanite_log::unit::Unit;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};

/// The comparisons of one file.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "axes")]
pub struct Document<'a> {
    axes: Vec<Axis<'a>>,
}

#[derive(Serialize, JsonSchema)]
#[schemars(rename = "axis")]
struct Axis<'a> {
    /// The name of the axis.
    axis: &'a str,
    /// Samples per second.
    rate_hz: f64,
    /// The unit of the rate.
    #[schemars(with = "UnitName")]
    unit: Unit,
    /// The model.
    effects: Vec<Effect>,
    coefficients: Vec<fit::json::Term>,
    octaves: Vec<Octave>,
    /// χ² of the comparison.
    #[schemars(with = "Option<f64>")]
    chi2: f64,
    /// The degrees of freedom.
    dof: usize,
    #[schemars(with = "Option<f64>")]
    p_value: f64,
    /// The rms difference of the Allan variances from the model, in percent.
    #[schemars(with = "Option<f64>")]
    rms_percent: f64,
    /// The octave that differs most.
    worst: Option<Worst>,
    /// Averaging times between which the curve lies on one side of the model.
    stretches: Vec<Stretch>,
    /// The comparison in words.
    words: String,
    held_out: Option<HeldOut>,
}

/// An octave: deviations in the log's unit, and the difference of the variances in percent.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "octave")]
struct Octave {
    /// The averaging factor.
    m: u32,
    /// The averaging time in seconds.
    tau_s: f64,
    measured: f64,
    model: f64,
    #[schemars(with = "Option<f64>")]
    percent: f64,
    /// Standard errors from the model.
    #[schemars(with = "Option<f64>")]
    z: f64,
    /// The share of each effect in the variance of the model, by its name.
    #[schemars(with = "Numbers")]
    shares: Map<String, Value>,
}

#[derive(Serialize, JsonSchema)]
#[schemars(rename = "stretch")]
struct Stretch {
    side: &'static str,
    from_s: f64,
    to_s: f64,
}

/// The number of held-out samples, with which the model was compared, and how well it fits the others.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "held_out")]
struct HeldOut {
    samples: u64,
    fitted: Fitted,
}

#[derive(Serialize, JsonSchema)]
#[schemars(rename = "fitted")]
struct Fitted {
    samples: u64,
    #[schemars(with = "Option<f64>")]
    chi2: f64,
    dof: usize,
    #[schemars(with = "Option<f64>")]
    p_value: f64,
    #[schemars(with = "Option<f64>")]
    rms_percent: f64,
}

/// The document of the axes of one file.
pub fn document(compared: &[Compared]) -> Document<'_> {
    Document {
        axes: compared.iter().map(axis).collect(),
    }
}

fn axis(compared: &Compared) -> Axis<'_> {
    let Compared {
        axis,
        model,
        fit,
        comparison,
        held_out,
        ..
    } = compared;
    let held_out = held_out.as_ref().map(|held_out| HeldOut {
        samples: held_out.axis.samples,
        fitted: Fitted {
            samples: axis.samples,
            chi2: fit.chi_squared,
            dof: fit.degrees_of_freedom,
            p_value: fit.p_value,
            rms_percent: held_out.fitted_rms_percent,
        },
    });
    Axis {
        axis: &axis.axis,
        rate_hz: axis.rate_hz,
        unit: axis.unit,
        effects: model_json::effects(model, fit),
        coefficients: model_json::coefficients(fit, axis.unit),
        octaves: comparison
            .octaves
            .iter()
            .map(|one| octave(one, model))
            .collect(),
        chi2: comparison.chi_squared,
        dof: comparison.degrees_of_freedom,
        p_value: comparison.p_value,
        rms_percent: comparison.rms_percent,
        worst: model_json::worst(comparison),
        stretches: comparison.stretches().map(stretch).collect(),
        words: comparison.to_string(),
        held_out,
    }
}

/// Adds a share by the name of its effect. Those of two effects with the same name are added up.
fn add(mut shares: Map<String, Value>, (name, share): (&str, f32)) -> Map<String, Value> {
    let before = shares.get(name).and_then(Value::as_f64).unwrap_or(0.0);
    shares.insert(name.to_owned(), (before + f64::from(share)).into());
    shares
}

fn octave(octave: &ComparedOctave, model: &Model) -> Octave {
    let names = model.terms().iter().map(|term| term.effect.name());
    Octave {
        m: octave.m,
        tau_s: octave.tau_s,
        measured: octave.measured.sqrt(),
        model: octave.model.sqrt(),
        percent: octave.percent(),
        z: octave.z,
        shares: names.zip(octave.shares).fold(Map::new(), add),
    }
}

fn stretch(one: comparison::Stretch) -> Stretch {
    Stretch {
        side: if one.above { "above" } else { "below" },
        from_s: one.from_s,
        to_s: one.to_s,
    }
}
