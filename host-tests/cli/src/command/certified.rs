//! The certificate of a log or of a curve file: a diagnosis of every axis, in the form in which a device stores it.

use crate::command::{
    input::record::{self, CovariateArguments, LogArguments},
    output::{places, progress},
};
use allanite::{
    Curve, Error, Model, Record, Scale,
    course::analyse_without,
    detection::{Detection, Ranges},
    diagnosis::{Options, Step, Verdict},
    effect::CATALOGUE,
    spectrum::Spectrum,
    storage::{
        AxisCertificate, Certificate, CertifiedLimit, Conditions, MAX_AXES, MAX_DEVICE_BYTES,
        RateUnit,
    },
};
use allanite_host::{
    curve_file::{AxisCurve, CurveFile},
    dependence::candidates::Candidates,
    diagnosis::{diagnose, go_on},
};
use allanite_log::{
    BINS, Evidence, OCTAVES,
    failure::{Failure, Place, one_line, report},
    unit::Unit,
};
use std::path::Path;

/// The names of the axes of a certificate, which stores their order only.
const AXES: [&str; MAX_AXES] = ["x", "y", "z"];

/// How much a certificate tells.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Content {
    /// Everything, with the limits of detection.
    All,
    /// What a lot is judged by, which costs a small part of the time.
    Judged,
}

/// What is known of a gyro besides its record.
#[derive(Clone, Debug, Default)]
pub(crate) struct Identity {
    /// The device, in at most 16 bytes.
    pub(crate) device: String,
    /// The version of its firmware.
    pub(crate) firmware: [u16; 3],
    /// The lowest and the highest temperature in °C, if they are known.
    pub(crate) temperature_c: Option<(f32, f32)>,
}

/// The name of a device whose record is in this file: that of the file, without its extension.
pub(crate) fn device_of(path: &Path) -> String {
    one_line(&places::stem(path).to_string_lossy())
}

/// The certificate of the record in a file. The options about logs are for logs alone, so that curve files may stand beside
/// them.
///
/// # Errors
/// When the record cannot be read or fitted, or has what a certificate cannot tell.
pub(crate) fn certificate(
    path: &Path,
    (about_log, covariates): (&LogArguments, &CovariateArguments),
    identity: &Identity,
    content: Content,
) -> Result<Certificate, Failure> {
    let axes = if record::is_curve(path) {
        allanite_host::record::of_curves(CurveFile::read(path)?.axes)
    } else {
        record::read_with_evidence(path, about_log, covariates)?
    };
    note_names(path, &axes);
    let mut certificate = empty(path, &axes, identity)?;
    for (axis, evidence) in axes {
        let name = axis.axis.clone();
        let certified = of_axis(&axis, evidence, content)
            .map_err(|error| record::library_failure(path, &name, error))?;
        // `empty` has refused more axes than there is room for.
        let _ = certificate.axes.push(certified);
    }
    Ok(certificate)
}

/// A certificate of these axes without their results.
fn empty(
    path: &Path,
    axes: &[(AxisCurve, Evidence)],
    identity: &Identity,
) -> Result<Certificate, Failure> {
    let refused = |what: String, remedy: &str| Err(Place::file(path).failure(what, remedy));
    let Some((first, _)) = axes.first() else {
        return refused("there is no axis".into(), "give a record of a gyro");
    };
    if axes.len() > MAX_AXES {
        let what = format!(
            "a certificate has up to {MAX_AXES} axes, and there are {}",
            axes.len()
        );
        return refused(what, "choose the axes of the gyro with --columns");
    }
    let mut others = axes.iter().map(|(axis, _)| axis);
    let is_other = |other: &&AxisCurve| other.unit != first.unit || other.rate_hz != first.rate_hz;
    if let Some(other) = others.find(is_other) {
        let what = format!(
            "axis {} has another unit or another rate than {}",
            other.axis, first.axis
        );
        return refused(what, "certify records of one gyro");
    }
    let unit = match first.unit {
        Unit::DegreesPerSecond => RateUnit::DegreesPerSecond,
        Unit::RadiansPerSecond => RateUnit::RadiansPerSecond,
        Unit::MetresPerSecondSquared | Unit::StandardGravity => {
            let what = format!(
                "a certificate is that of a gyro, and the unit is {}",
                first.unit
            );
            return refused(
                what,
                "give a record of a gyro, or judge this one by `fit --limit`",
            );
        }
    };
    let samples = axes.iter().map(|(axis, _)| axis.samples).min();
    let gaps = axes.iter().map(|(axis, _)| axis.gaps).max();
    let samples = samples.unwrap_or(first.samples);
    let conditions = Conditions {
        temperature_c: identity.temperature_c,
        duration_s: samples as f64 / first.rate_hz,
        rate_hz: first.rate_hz,
        samples,
        gaps: gaps.unwrap_or(first.gaps),
    };
    let device = identity.device.as_bytes();
    Certificate::new(device, identity.firmware, conditions, unit).or_else(|_| {
        let what = format!(
            "the name of the device, {}, is longer than {MAX_DEVICE_BYTES} bytes",
            identity.device
        );
        refused(what, "give a shorter one with --device")
    })
}

/// Says which axis of the certificate is which, where their order does not.
fn note_names(path: &Path, axes: &[(AxisCurve, Evidence)]) {
    if progress::is_quiet() {
        return;
    }
    for ((axis, _), place) in axes.iter().zip(AXES) {
        let last = axis.axis.to_lowercase();
        let own = AXES.into_iter().find(|name| last.ends_with(name));
        if own.is_some_and(|own| own != place) {
            let note = format!(
                "axis {} is {place} in the certificate, which stores the order of its axes only",
                axis.axis
            );
            report(format_args!("{}{}", Place::file(path), one_line(&note)));
        }
    }
}

/// The curve and the spectrum on which a step was judged: without what follows a covariate.
fn observed(
    record: &Record<'_, OCTAVES, BINS>,
    (curve, spectrum): (&Curve<OCTAVES>, &Spectrum<BINS>),
    step: &Step<OCTAVES, BINS>,
) -> (Curve<OCTAVES>, Spectrum<BINS>) {
    let (mut curve, mut spectrum) = (curve.clone(), spectrum.clone());
    if let Some(followed) = &step.covariate {
        followed.correct(record, &mut curve, &mut spectrum);
    }
    (curve, spectrum)
}

/// What the certificate tells of an axis.
fn of_axis(
    axis: &AxisCurve,
    mut evidence: Evidence,
    content: Content,
) -> Result<AxisCertificate, Error> {
    let (model, options) = (Model::ieee_952(), Options::default());
    let (curve, spectrum, densities) = (axis.curve()?, axis.spectrum()?, axis.course()?);
    let course = evidence.course.take();
    let candidates = Candidates::new(&curve, &spectrum, &model, &evidence)?;
    let record = Record {
        course: densities.as_ref(),
        kurtosis: Some(&evidence.kurtosis),
        invalid: evidence.invalid,
        ..candidates.record(&curve, &spectrum)
    };
    let mut certified = AxisCertificate::empty();
    let (mut taken, mut last) = (Ok(()), None);
    let verdict = diagnose(record, &model, &CATALOGUE, options, |step| {
        let (curve, spectrum) = observed(&record, (&curve, &spectrum), step);
        let this = certified.take(Record::new(&curve, &spectrum), step);
        taken = taken.and(this);
        last = Some(step.clone());
    })?;
    taken?;
    certified.verdict = Some(verdict);
    let is_judged = !matches!(verdict, Verdict::Invalid(_) | Verdict::TooShort);
    let Some(last) = last.filter(|_| is_judged) else {
        return Ok(certified);
    };
    let (curve, spectrum) = observed(&record, (&curve, &spectrum), &last);
    let is_explained = matches!(verdict, Verdict::Adequate | Verdict::Improved);
    if is_explained && content == Content::All {
        let record = Record {
            course: densities.as_ref(),
            ..Record::new(&curve, &spectrum)
        };
        let mut ranges = Ranges::default();
        Detection::new(record, &last, &CATALOGUE, options)
            .run(|limit| ranges.push(&limit), &mut go_on);
        for range in ranges.as_slice() {
            let _ = certified.limits.push(CertifiedLimit::of(range));
        }
    }
    if let Some(course) = course {
        let scale = Scale::new(axis.rate_per_count, axis.rate_hz)?;
        let followed = last.covariate.as_ref().map_or(Vec::new(), |followed| {
            candidates.followed(followed, course.block_length())
        });
        let options = allanite::fit::Options::default();
        let analysis = analyse_without(&curve, &last.model, &course, scale, &followed, options)?;
        certified.findings.set_events(&analysis.events);
    }
    Ok(certified)
}
