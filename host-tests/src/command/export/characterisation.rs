//! The characterisation of a gyro, from which every format is written.

use super::{arguments::Arguments, axis_noise::AxisNoise, given::Given};
use crate::{
    command::{
        fit::fitted::{Fitted, MethodName},
        input::record,
        output::progress,
        tried::TriedCovariate,
    },
    failure::{Failure, Place, one_line, report},
    unit::Sensor,
};

/// The characterisation of a gyro, in radians and seconds.
pub(super) struct Characterisation {
    pub(super) axes: Vec<AxisNoise>,
    pub(super) rate_hz: f64,
}

impl Characterisation {
    /// The largest number of all axes, for a format with one number for all of them.
    pub(super) fn common(&self, of_axis: impl Fn(&AxisNoise) -> Given) -> Given {
        Given::largest(
            self.axes
                .iter()
                .map(|axis| (axis.name.as_str(), of_axis(axis))),
        )
    }

    /// White noise and random walk of the best fit.
    pub(super) fn best(&self) -> Pair {
        Pair {
            noise_density: self.common(|axis| axis.best("N")),
            random_walk: self.common(|axis| axis.best("K")),
        }
    }

    /// White noise and random walk of the overbound.
    pub(super) fn overbound(&self) -> Pair {
        Pair {
            noise_density: self.common(AxisNoise::overbound_density),
            random_walk: self.common(AxisNoise::overbound_walk),
        }
    }

    /// The pair for the filter, and the pair for the comments.
    pub(super) fn chosen(&self, overbound: bool) -> (Choice, Choice) {
        let best = Choice {
            name: "best fit",
            pair: self.best(),
        };
        let above = Choice {
            name: "overbound",
            pair: self.overbound(),
        };
        if overbound {
            (above, best)
        } else {
            (best, above)
        }
    }
}

/// The two continuous-time densities that most filters use.
pub(super) struct Pair {
    /// White noise, in rad/s/√Hz.
    pub(super) noise_density: Given,
    /// Random walk, in rad/s²/√Hz.
    pub(super) random_walk: Given,
}

/// The best fit or the overbound, with its name.
pub(super) struct Choice {
    pub(super) name: &'static str,
    pub(super) pair: Pair,
}

/// Reads the input, and fits and bounds every axis.
///
/// # Errors
/// When the input cannot be read or fitted, is of an accelerometer, or has axes of different rates.
pub(super) fn characterise(arguments: &Arguments) -> Result<Characterisation, Failure> {
    let path = &arguments.input;
    let model = arguments.filter.model()?;
    let mut axes = Vec::new();
    let (about_log, covariates) = (&arguments.about_log, &arguments.covariates);
    for (axis, mut evidence) in record::read_with_evidence(path, about_log, covariates)? {
        if axis.unit.sensor() != Sensor::Gyro {
            let what = format!(
                "axis {} is from an accelerometer, in {}",
                axis.axis, axis.unit
            );
            let remedy = "export a gyro; `fit` prints the coefficients of an accelerometer";
            return Err(Place::file(path).failure(what, remedy));
        }
        let course = evidence.course.take();
        let fitted = Fitted::with_evidence(path, axis, &model, MethodName::Covariance, evidence)?;
        let name = fitted.axis.axis.clone();
        let what = |text: &str| format!("axis {name}: {text}");
        let reason = fitted.invalid.as_deref().map(what);
        if let Some(reason) = reason.as_ref().filter(|_| !arguments.despite_invalid) {
            let remedy = "record again, or export all the same with --despite-invalid";
            return Err(Place::file(path).failure(reason, remedy));
        }
        if !progress::is_quiet() {
            let acts = fitted.tried.iter().any(TriedCovariate::acts);
            let notes = fitted.covariate_notes();
            let notes = notes.iter().filter(|_| acts).map(|note| what(note));
            for note in reason.into_iter().chain(notes) {
                report(format_args!("{}{}", Place::file(path), one_line(&note)));
            }
        }
        let noise = AxisNoise::of(fitted, course).ok_or_else(|| {
            let what = format!("axis {name}: its curve has no finite confidence limits");
            Place::file(path).failure(what, "record longer")
        })?;
        axes.push(noise);
    }
    // A log has one rate, but the axes of a curve file could have several.
    let rate_hz = axes
        .first()
        .map_or(f64::NAN, |axis: &AxisNoise| axis.rate_hz);
    if let Some(other) = axes.iter().find(|axis| axis.rate_hz != rate_hz) {
        let what = format!(
            "the axes have rates of {rate_hz} Hz and {} Hz",
            other.rate_hz
        );
        return Err(Place::file(path).failure(what, "export only axes with the same rate"));
    }
    Ok(Characterisation { axes, rate_hz })
}
