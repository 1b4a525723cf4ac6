//! The encoding of certificates as bytes.

use super::{
    AxisCertificate, Certificate, CertifiedBand, CertifiedEvent, CertifiedLimit, CertifiedShape,
    CertifiedSlope, CertifiedState, CertifiedTerm, CertifiedWhat, Conditions, Doubt, EffectCode,
    Findings, MAX_AXES, MAX_COVARIATES, MAX_DEVICE_BYTES, MAX_DOUBTS, RateUnit,
    verdict::WireVerdict,
};
use crate::{
    comparison::MAX_BANDS,
    course::MAX_EVENTS,
    detection::MAX_RANGES,
    fit::Correlations,
    limits::{MAX_EFFECTS, MAX_PARAMETERS, PAIRS},
    storage::Error,
    storage::envelope::{self, Kind, OVERHEAD, Writer, take},
};
use heapless::Vec;
use serde::{Deserialize, Serialize};

/// The version with findings, the one with limits of detection only, and the one without both.
const VERSION: u8 = 3;
const WITHOUT_FINDINGS: u8 = 2;
const WITHOUT_LIMITS: u8 = 1;

#[derive(Serialize, Deserialize)]
struct WireHead<'a> {
    device: &'a [u8],
    firmware: [u16; 3],
    temperature_c: Option<(f32, f32)>,
    duration_s: f64,
    rate_hz: f64,
    samples: u64,
    gaps: u64,
    unit: u8,
    axes: u8,
}

#[derive(Serialize, Deserialize)]
struct WireAxis {
    chi_squared: f64,
    p_value: f64,
    degrees_of_freedom: u16,
    tolerance: f32,
    verdict: WireVerdict,
    terms: u8,
}

#[derive(Serialize, Deserialize)]
struct WireTerm {
    effect: u8,
    value: f32,
    lower: f32,
    upper: f32,
    square_error: f32,
    state: WireState,
    shapes: u8,
}

#[derive(Serialize, Deserialize)]
enum WireState {
    Measured,
    UpperBound,
    NotObservable(Option<f32>),
}

/// The value, the lower end and the upper end of a shape parameter's interval.
type WireShape = (f32, f32, f32);

/// The effect, the limit, and the lowest and highest value of the first shape parameter.
type WireLimit = (u8, f32, f32, f32);

/// The place of a covariate, its slope, and the standard error of the slope.
type WireSlope = (u8, f32, f32);

/// The lowest and the highest frequency of a band, and its standard errors.
type WireBand = (f32, f32, f32);

#[derive(Serialize, Deserialize)]
struct WireEvent {
    what: WireWhat,
    at_s: f32,
    size: f32,
    lower: f32,
    upper: f32,
    z: f32,
}

#[derive(Serialize, Deserialize)]
enum WireWhat {
    NoiseChange,
    Bursts(u8),
    Step,
    WarmUp(f32),
}

// The sizes are in bytes, with every varint at its longest.
const HEAD_BYTES: usize = 1 + MAX_DEVICE_BYTES + 9 + 9 + 16 + 20 + 2;
const AXIS_BYTES: usize = 16 + 3 + 4 + 27 + 1 + 4 * PAIRS;
const TERM_BYTES: usize = 1 + 16 + 6 + 1 + 12 * MAX_PARAMETERS;
const LIMIT_BYTES: usize = 13;
const EVENT_BYTES: usize = 5 + 20;
const FINDINGS_BYTES: usize =
    1 + MAX_COVARIATES * 9 + 1 + MAX_DOUBTS * 2 + 1 + MAX_BANDS * 12 + 2 + MAX_EVENTS * EVENT_BYTES;
const PAYLOAD_BYTES: usize = HEAD_BYTES
    + MAX_AXES
        * (AXIS_BYTES + MAX_EFFECTS * TERM_BYTES + 1 + MAX_RANGES * LIMIT_BYTES + FINDINGS_BYTES);

impl Certificate {
    /// The size in bytes of a buffer that holds any certificate; three axes of five terms take 600, each limit of
    /// detection takes 13 more, and what else was found some tens.
    pub const MAX_BYTES: usize = PAYLOAD_BYTES + OVERHEAD;

    /// Writes the certificate to a buffer and returns the part of it that was used.
    ///
    /// # Errors
    /// [`Error::Impossible`] if the conditions are impossible; [`Error::BufferTooSmall`], which never occurs
    /// with [`MAX_BYTES`](Self::MAX_BYTES).
    pub fn encode<'b>(&self, buffer: &'b mut [u8]) -> Result<&'b [u8], Error> {
        let conditions = &self.conditions;
        if !conditions.are_possible() {
            return Err(Error::Impossible);
        }
        let version = if self.axes.iter().any(|axis| !axis.findings.is_empty()) {
            VERSION
        } else if self.axes.iter().any(|axis| !axis.limits.is_empty()) {
            WITHOUT_FINDINGS
        } else {
            WITHOUT_LIMITS
        };
        let mut writer = Writer::new(buffer, Kind::Certificate, version, PAYLOAD_BYTES)?;
        writer.push(&WireHead {
            device: &self.device,
            firmware: self.firmware,
            temperature_c: conditions.temperature_c,
            duration_s: conditions.duration_s,
            rate_hz: conditions.rate_hz,
            samples: conditions.samples,
            gaps: conditions.gaps,
            unit: match self.unit {
                RateUnit::DegreesPerSecond => 0,
                RateUnit::RadiansPerSecond => 1,
            },
            axes: self.axes.len() as u8,
        })?;
        for axis in &self.axes {
            encode_axis(axis, &mut writer)?;
            if version >= WITHOUT_FINDINGS {
                encode_limits(axis, &mut writer)?;
            }
            if version == VERSION {
                encode_findings(&axis.findings, &mut writer)?;
            }
        }
        writer.finish()
    }

    /// Reads the bytes that [`encode`](Self::encode) wrote, and checks all of them.
    ///
    /// # Errors
    /// [`Error::UnknownMagic`], [`Error::WrongLength`], [`Error::Corrupt`], [`Error::WrongKind`],
    /// [`Error::UnknownVersion`]; [`Error::Impossible`] if no fit has such numbers.
    pub fn decode(bytes: &[u8]) -> Result<Self, Error> {
        let (version, mut rest) = envelope::open_any(bytes, Kind::Certificate)?;
        if !(WITHOUT_LIMITS..=VERSION).contains(&version) {
            return Err(Error::UnknownVersion {
                found: version,
                known: VERSION,
            });
        }
        let record = decode_payload(&mut rest, version).ok_or(Error::Impossible)?;
        rest.is_empty().then_some(record).ok_or(Error::Impossible)
    }
}

fn encode_axis(axis: &AxisCertificate, writer: &mut Writer<'_>) -> Result<(), Error> {
    writer.push(&WireAxis {
        chi_squared: axis.chi_squared,
        p_value: axis.p_value,
        degrees_of_freedom: axis.degrees_of_freedom,
        tolerance: axis.tolerance,
        verdict: axis.verdict.into(),
        terms: axis.terms.len() as u8,
    })?;
    for term in &axis.terms {
        writer.push(&WireTerm {
            effect: term.effect.number(),
            value: term.value,
            lower: term.lower,
            upper: term.upper,
            square_error: term.square_error,
            state: match term.state {
                CertifiedState::Measured => WireState::Measured,
                CertifiedState::UpperBound => WireState::UpperBound,
                CertifiedState::NotObservable { after_s } => WireState::NotObservable(after_s),
            },
            shapes: term.shape.len() as u8,
        })?;
        for shape in &term.shape {
            writer.push(&(shape.value, shape.lower, shape.upper))?;
        }
    }
    for correlation in axis.correlations.triangle(axis.terms.len()) {
        writer.push(correlation)?;
    }
    Ok(())
}

fn encode_limits(axis: &AxisCertificate, writer: &mut Writer<'_>) -> Result<(), Error> {
    writer.push(&(axis.limits.len() as u8))?;
    for limit in &axis.limits {
        writer.push(&(limit.effect.number(), limit.size, limit.low, limit.high))?;
    }
    Ok(())
}

fn encode_findings(findings: &Findings, writer: &mut Writer<'_>) -> Result<(), Error> {
    writer.push(&(findings.covariates.len() as u8))?;
    for slope in &findings.covariates {
        writer.push(&(slope.covariate, slope.value, slope.error))?;
    }
    writer.push(&(findings.doubts.len() as u8))?;
    for doubt in &findings.doubts {
        writer.push(&(doubt.effect.number(), doubt.other.number()))?;
    }
    writer.push(&(findings.bands.len() as u8))?;
    for band in &findings.bands {
        writer.push(&(band.from_hz, band.to_hz, band.z))?;
    }
    let Some(events) = &findings.events else {
        return writer.push(&0_u8);
    };
    writer.push(&(1_u8, events.len() as u8))?;
    for event in events {
        writer.push(&WireEvent {
            what: match event.what {
                CertifiedWhat::NoiseChange => WireWhat::NoiseChange,
                CertifiedWhat::Bursts { blocks } => WireWhat::Bursts(blocks),
                CertifiedWhat::Step => WireWhat::Step,
                CertifiedWhat::WarmUp { time_constant_s } => WireWhat::WarmUp(time_constant_s),
            },
            at_s: event.at_s,
            size: event.size,
            lower: event.lower,
            upper: event.upper,
            z: event.z,
        })?;
    }
    Ok(())
}

fn decode_payload(rest: &mut &[u8], version: u8) -> Option<Certificate> {
    let head: WireHead = take(rest)?;
    let conditions = Conditions {
        temperature_c: head.temperature_c,
        duration_s: head.duration_s,
        rate_hz: head.rate_hz,
        samples: head.samples,
        gaps: head.gaps,
    };
    if !conditions.are_possible() {
        return None;
    }
    let mut axes = Vec::new();
    for _ in 0..head.axes {
        axes.push(decode_axis(rest, version, &conditions)?).ok()?;
    }
    Some(Certificate {
        device: Vec::from_slice(head.device).ok()?,
        firmware: head.firmware,
        conditions,
        unit: match head.unit {
            0 => RateUnit::DegreesPerSecond,
            1 => RateUnit::RadiansPerSecond,
            _ => return None,
        },
        axes,
    })
}

fn decode_axis(rest: &mut &[u8], version: u8, conditions: &Conditions) -> Option<AxisCertificate> {
    let axis: WireAxis = take(rest)?;
    let mut terms = Vec::new();
    for _ in 0..axis.terms {
        terms.push(decode_term(rest)?).ok()?;
    }
    let mut below = [f32::NAN; PAIRS];
    let pairs = terms.len() * terms.len().saturating_sub(1) / 2;
    for slot in below.iter_mut().take(pairs) {
        *slot = take(rest)?;
    }
    let mut limits = Vec::new();
    if version >= WITHOUT_FINDINGS {
        for _ in 0..take::<u8>(rest)? {
            limits.push(decode_limit(rest)?).ok()?;
        }
    }
    let findings = match version {
        VERSION => decode_findings(rest)?,
        _ => Findings::default(),
    };
    let axis = AxisCertificate {
        terms,
        correlations: Correlations::from_triangle(below),
        chi_squared: axis.chi_squared,
        degrees_of_freedom: axis.degrees_of_freedom,
        p_value: axis.p_value,
        tolerance: axis.tolerance,
        verdict: axis.verdict.into(),
        limits,
        findings,
    };
    axis.is_possible(conditions).then_some(axis)
}

fn decode_limit(rest: &mut &[u8]) -> Option<CertifiedLimit> {
    let (effect, size, low, high): WireLimit = take(rest)?;
    Some(CertifiedLimit {
        effect: EffectCode::from_number(effect)?,
        size,
        low,
        high,
    })
}

fn decode_findings(rest: &mut &[u8]) -> Option<Findings> {
    let mut findings = Findings::default();
    for _ in 0..take::<u8>(rest)? {
        let (covariate, value, error): WireSlope = take(rest)?;
        let slope = CertifiedSlope {
            covariate,
            value,
            error,
        };
        findings.covariates.push(slope).ok()?;
    }
    for _ in 0..take::<u8>(rest)? {
        let (effect, other): (u8, u8) = take(rest)?;
        let doubt = Doubt {
            effect: EffectCode::from_number(effect)?,
            other: EffectCode::from_number(other)?,
        };
        findings.doubts.push(doubt).ok()?;
    }
    for _ in 0..take::<u8>(rest)? {
        let (from_hz, to_hz, z): WireBand = take(rest)?;
        let band = CertifiedBand { from_hz, to_hz, z };
        findings.bands.push(band).ok()?;
    }
    findings.events = match take::<u8>(rest)? {
        0 => None,
        1 => {
            let mut events = Vec::new();
            for _ in 0..take::<u8>(rest)? {
                events.push(decode_event(rest)?).ok()?;
            }
            Some(events)
        }
        _ => return None,
    };
    Some(findings)
}

fn decode_event(rest: &mut &[u8]) -> Option<CertifiedEvent> {
    let event: WireEvent = take(rest)?;
    Some(CertifiedEvent {
        what: match event.what {
            WireWhat::NoiseChange => CertifiedWhat::NoiseChange,
            WireWhat::Bursts(blocks) => CertifiedWhat::Bursts { blocks },
            WireWhat::Step => CertifiedWhat::Step,
            WireWhat::WarmUp(time_constant_s) => CertifiedWhat::WarmUp { time_constant_s },
        },
        at_s: event.at_s,
        size: event.size,
        lower: event.lower,
        upper: event.upper,
        z: event.z,
    })
}

fn decode_term(rest: &mut &[u8]) -> Option<CertifiedTerm> {
    let term: WireTerm = take(rest)?;
    let mut shape = Vec::new();
    for _ in 0..term.shapes {
        let (value, lower, upper): WireShape = take(rest)?;
        let one = CertifiedShape {
            value,
            lower,
            upper,
        };
        shape.push(one).ok()?;
    }
    let state = match term.state {
        WireState::Measured => CertifiedState::Measured,
        WireState::UpperBound => CertifiedState::UpperBound,
        WireState::NotObservable(after_s) => CertifiedState::NotObservable { after_s },
    };
    Some(CertifiedTerm {
        effect: EffectCode::from_number(term.effect)?,
        value: term.value,
        lower: term.lower,
        upper: term.upper,
        square_error: term.square_error,
        state,
        shape,
    })
}
