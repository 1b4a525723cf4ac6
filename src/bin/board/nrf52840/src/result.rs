//! What the record says: the five terms of each axis, and a certificate of them.

use crate::{Gyro, record::SENSOR};
use allanite::{
    Error, Model, Real, Scale,
    fit::{Fit, Options, State, fit},
    storage::{self, AxisCertificate, Certificate, Conditions, RateUnit},
};
use defmt::{Format, info, warn};

/// The reason why there is no certificate.
#[derive(Format)]
pub enum Failure {
    /// An axis cannot be fitted.
    Fit(Error),
    /// The certificate has no room for what it should say.
    Certificate(storage::Error),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Fit(error)
    }
}

impl From<storage::Error> for Failure {
    fn from(error: storage::Error) -> Self {
        Self::Certificate(error)
    }
}

/// Fits the five terms of IEEE Std 952 to every axis of a record with so many samples per second, and logs and certifies them.
///
/// # Errors
/// [`Failure`].
pub fn certify(gyro: &mut Gyro, rate_hz: Real) -> Result<Certificate, Failure> {
    let scale = Scale::new(SENSOR.scale_dps, rate_hz)?;
    let [x, ..] = gyro.accumulators();
    let conditions = Conditions {
        temperature_c: None,
        duration_s: x.samples() as f64 / f64::from(rate_hz),
        rate_hz: rate_hz.into(),
        samples: x.samples(),
        gaps: x.gaps(),
    };
    // Write the serial number and the version of your product here.
    let device = b"SN-0001";
    let mut certificate =
        Certificate::new(device, [0, 1, 0], conditions, RateUnit::DegreesPerSecond)?;
    let model = Model::ieee_952();
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let record = gyro.record(axis, scale)?;
        if let Some(reason) = record.invalid {
            warn!(
                "{=str} was not a gyro at rest, and its fit means nothing: {}",
                name, reason
            );
        }
        let fit = fit(&record, &model, Options::default())?;
        log(name, &fit);
        let certified = AxisCertificate::new(&record, &model, &fit)?;
        // There is room for three axes.
        certificate.axes.push(certified).ok();
    }
    Ok(certificate)
}

/// Logs the coefficients of an axis, in °/s and seconds.
fn log(axis: &str, fit: &Fit) {
    for found in &fit.coefficients {
        let (name, value, lower, upper) = (found.name, found.value, found.lower, found.upper);
        match found.state {
            State::Measured => {
                info!(
                    "{=str} {=str} {=f32}, 95 % interval {=f32} to {=f32}",
                    axis, name, value, lower, upper
                );
            }
            State::UpperBound => info!("{=str} {=str} below {=f32}", axis, name, upper),
            State::NotObservable { .. } => {
                info!(
                    "{=str} {=str} is not told by a record of this length",
                    axis, name
                );
            }
        }
    }
    match fit.is_adequate() {
        Some(true) => info!("{=str}: the five terms explain the record", axis),
        Some(false) => warn!(
            "{=str}: the five terms do not explain the record (p = {=f32})",
            axis, fit.p_value
        ),
        None => warn!(
            "{=str}: the record is too short to judge the five terms",
            axis
        ),
    }
}
