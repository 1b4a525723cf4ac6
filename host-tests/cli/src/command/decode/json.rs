//! Factory certificates and snapshots as a JSON document.

use super::decoded::{self, Decoded, Stored, StoredSnapshot};
use allanite::{
    diagnosis::Verdict,
    integrity::Reason,
    storage::{
        self, AxisCertificate, Certificate, CertifiedBand, CertifiedLimit, CertifiedSlope,
        CertifiedState, CertifiedTerm,
    },
};
use allanite_host::{
    event_json, model_json,
    schema::{self, Numbers, ReasonName, StateName, UnitName, VerdictName},
    stationarity::is_disturbed,
    units, verdict,
};
use allanite_log::unit::Unit;
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::{
    io::{self, Write},
    path::Path,
};

/// Certificates and snapshots. Programs that read it skip properties that they do not know.
#[derive(Serialize, JsonSchema)]
struct Document {
    /// The certificates.
    records: Vec<Device>,
    snapshots: Vec<Snapshot>,
}

#[derive(Serialize, JsonSchema)]
#[schemars(rename = "certificate")]
struct Device {
    file: String,
    /// The identity of the device.
    device: String,
    device_hex: String,
    firmware: String,
    #[schemars(with = "UnitName")]
    unit: Unit,
    /// The lowest and the highest temperature during the record.
    temperature_c: Option<(f32, f32)>,
    duration_s: f64,
    rate_hz: f64,
    samples: u64,
    gaps: u64,
    axes: Vec<Axis>,
}

/// One axis of a record.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "axis")]
struct Axis {
    axis: String,
    #[schemars(with = "Option<VerdictName>")]
    verdict: Option<&'static str>,
    /// Why the record is not valid, in a sentence and in a word.
    invalid: Option<String>,
    #[schemars(with = "Option<ReasonName>")]
    reason: Option<&'static str>,
    found: Vec<&'static str>,
    coefficients: Vec<Term>,
    /// Covariance of the squared coefficients, as a lower triangle.
    #[schemars(with = "Vec<Vec<Option<f64>>>")]
    covariance: Vec<Vec<f64>>,
    #[schemars(with = "Option<f64>")]
    chi2: f64,
    dof: u16,
    #[schemars(with = "Option<f64>")]
    p_value: f64,
    #[schemars(with = "Option<f64>")]
    tolerance: f32,
    /// The sizes of effects that the record would have shown with a probability of 95 %.
    detection_limits: Vec<model_json::DetectionRange>,
    /// The covariates that the rate follows.
    covariates: Vec<Slope>,
    /// Effects that explain the record about as well as those of the model.
    ambiguous: Vec<Doubt>,
    /// The bands in which the spectrum differs from the model.
    bands: Vec<Band>,
    /// Whether nothing happened during the record; `null` if its course was not kept.
    stationary: Option<bool>,
    events: Vec<event_json::Event>,
}

#[derive(Serialize, JsonSchema)]
struct Slope {
    covariate: u8,
    slope: f32,
    error: f32,
}

#[derive(Serialize, JsonSchema)]
struct Doubt {
    effect: &'static str,
    other: &'static str,
}

#[derive(Serialize, JsonSchema)]
struct Band {
    from_hz: f32,
    to_hz: f32,
    z: f32,
}

#[derive(Serialize, JsonSchema)]
#[schemars(rename = "coefficient")]
struct Term {
    effect: &'static str,
    symbol: Option<&'static str>,
    #[schemars(with = "Option<f64>")]
    value: f32,
    #[schemars(with = "Option<f64>")]
    lower: f32,
    #[schemars(with = "Option<f64>")]
    upper: f32,
    #[schemars(with = "Option<f64>")]
    square_error: f32,
    #[schemars(with = "StateName")]
    state: &'static str,
    after_s: Option<f32>,
    unit: Option<String>,
    #[schemars(with = "Numbers")]
    shape: Map<String, Value>,
}

#[derive(Serialize, JsonSchema)]
struct Snapshot {
    file: String,
    samples: u64,
    gaps: u64,
    octaves: Vec<Octave>,
}

#[derive(Serialize, JsonSchema)]
struct Octave {
    m: u32,
    differences: u64,
    /// The sum of squared differences, a whole number of up to 128 bits; `null` if it is larger.
    sum: Option<u128>,
}

/// The schema of what is printed.
pub(in crate::command) fn schema(title: &str) -> Schema {
    schema::of::<Document>(title)
}

/// Prints all certificates and snapshots as one JSON document.
pub(super) fn print(decoded: &[Decoded], output: &mut impl Write) -> io::Result<()> {
    let mut document = Document {
        records: Vec::new(),
        snapshots: Vec::new(),
    };
    for one in decoded {
        match &one.stored {
            Stored::Certificate(record) => document.records.push(device(&one.file, record)),
            Stored::Snapshot(stored) => document.snapshots.push(snapshot(&one.file, stored)),
        }
    }
    serde_json::to_writer(&mut *output, &document)?;
    writeln!(output)
}

fn device(file: &Path, record: &Certificate) -> Device {
    let conditions = &record.conditions;
    let axes = record.axes.iter().enumerate();
    Device {
        file: file.to_string_lossy().into_owned(),
        device: decoded::device(record),
        device_hex: decoded::hex(record),
        firmware: decoded::firmware(record),
        unit: record.unit.into(),
        temperature_c: conditions.temperature_c,
        duration_s: conditions.duration_s,
        rate_hz: conditions.rate_hz,
        samples: conditions.samples,
        gaps: conditions.gaps,
        axes: axes
            .map(|(i, one)| axis(decoded::axis_name(i), one, record.unit.into()))
            .collect(),
    }
}

fn axis(name: String, axis: &AxisCertificate, unit: Unit) -> Axis {
    let (count, findings) = (axis.terms.len(), &axis.findings);
    let row = |i: usize| (0..=i).map(|j| axis.covariance(i, j)).collect();
    let reason = match axis.verdict {
        Some(Verdict::Invalid(reason)) => Some(reason),
        _ => None,
    };
    Axis {
        axis: name,
        verdict: (axis.verdict).map(|verdict| verdict::name(verdict, is_disturbed(axis))),
        invalid: reason.map(|reason| reason.to_string()),
        reason: reason.as_ref().map(Reason::name),
        found: axis.found().map(|term| term.effect.name()).collect(),
        coefficients: axis.terms.iter().map(|one| term(one, unit)).collect(),
        covariance: (0..count).map(row).collect(),
        chi2: axis.chi_squared,
        dof: axis.degrees_of_freedom,
        p_value: axis.p_value,
        tolerance: axis.tolerance,
        detection_limits: axis
            .limits
            .iter()
            .filter_map(CertifiedLimit::range)
            .map(|range| model_json::detection_range(&range, unit))
            .collect(),
        covariates: findings.covariates.iter().map(slope).collect(),
        ambiguous: findings.doubts.iter().map(doubt).collect(),
        bands: findings.bands.iter().map(band).collect(),
        stationary: findings.is_stationary(),
        events: findings
            .events
            .iter()
            .flatten()
            .map(|event| event_json::event(&event.event()))
            .collect(),
    }
}

fn slope(slope: &CertifiedSlope) -> Slope {
    Slope {
        covariate: slope.covariate,
        slope: slope.value,
        error: slope.error,
    }
}

fn doubt(doubt: &storage::Doubt) -> Doubt {
    Doubt {
        effect: doubt.effect.name(),
        other: doubt.other.name(),
    }
}

fn band(band: &CertifiedBand) -> Band {
    Band {
        from_hz: band.from_hz,
        to_hz: band.to_hz,
        z: band.z,
    }
}

fn term(term: &CertifiedTerm, unit: Unit) -> Term {
    let effect = term.effect.effect();
    let parameters = effect.map_or(&[][..], |effect| effect.parameters());
    let shape = parameters.iter().zip(&term.shape).map(|(parameter, one)| {
        let numbers = json!({ "value": one.value, "lower": one.lower, "upper": one.upper });
        (parameter.name.to_owned(), numbers)
    });
    let (state, after_s) = match term.state {
        CertifiedState::Measured => ("measured", None),
        CertifiedState::UpperBound => ("upper_bound", None),
        CertifiedState::NotObservable { after_s } => ("not_observable", after_s),
    };
    Term {
        effect: term.effect.name(),
        symbol: effect.map(|effect| effect.symbol()),
        value: term.value,
        lower: term.lower,
        upper: term.upper,
        square_error: term.square_error,
        state,
        after_s,
        unit: effect.map(|effect| units::unit(unit, effect.half_seconds())),
        shape: shape.collect(),
    }
}

fn snapshot(file: &Path, stored: &StoredSnapshot) -> Snapshot {
    let octaves = stored.octaves.iter().map(|octave| Octave {
        m: octave.m,
        differences: octave.differences,
        sum: octave.sum.to_u128(),
    });
    Snapshot {
        file: file.to_string_lossy().into_owned(),
        samples: stored.samples,
        gaps: stored.gaps,
        octaves: octaves.collect(),
    }
}
