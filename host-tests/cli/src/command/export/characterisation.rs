//! The characterisation of a gyro, from which every format is written.

use super::{
    accelerometer::Accelerometer,
    arguments::Arguments,
    axis_noise::AxisNoise,
    explained::explained,
    given::{Given, Pair},
};
use allanite_log::{
    failure::{Failure, Place},
    unit::Sensor,
};

/// The characterisation of a gyro, in radians and seconds.
pub(super) struct Characterisation {
    pub(super) axes: Vec<AxisNoise>,
    pub(super) rate_hz: f64,
    pub(super) accelerometer: Accelerometer,
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
            noise_density: self.common(AxisNoise::white),
            random_walk: self.common(AxisNoise::walk),
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

/// The best fit or the overbound, with its name.
pub(super) struct Choice {
    pub(super) name: &'static str,
    pub(super) pair: Pair,
}

/// Reads the input, explains every axis and bounds it.
///
/// # Errors
/// As of [`explained`], and when an axis has no finite limits or the axes have different rates.
pub(super) fn characterise(arguments: &Arguments) -> Result<Characterisation, Failure> {
    let path = &arguments.input;
    let mut axes = Vec::new();
    for explained in explained(arguments, Sensor::Gyro)? {
        let noise = AxisNoise::of(&explained).ok_or_else(|| {
            let what = format!(
                "axis {}: its curve has no finite confidence limits",
                explained.axis.axis
            );
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
    Ok(Characterisation {
        axes,
        rate_hz,
        accelerometer: Accelerometer::of(arguments)?,
    })
}
