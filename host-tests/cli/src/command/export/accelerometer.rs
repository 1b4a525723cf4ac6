//! White noise and random walk of the accelerometer, for programs that take those of a whole IMU: what options give, or
//! what the accelerometer beside the gyro shows.

use super::{
    arguments::Arguments,
    axis_noise::AxisNoise,
    explained::explained,
    given::{Given, Pair},
};
use allanite_log::{
    failure::{Failure, Place},
    unit::Sensor,
};

/// The options that give the numbers.
const DENSITY: &str = "--accelerometer-noise-density";
const WALK: &str = "--accelerometer-random-walk";

/// The accelerometer beside the gyro.
pub(super) struct Accelerometer {
    /// The numbers for the filter: white noise in m/s²/√Hz, and random walk in m/s³/√Hz.
    pub(super) pair: Pair,
    /// Its axes, if the log of the gyro was read for them.
    pub(super) axes: Vec<AxisNoise>,
}

impl Accelerometer {
    /// Takes the numbers from the options, and what they do not give from the log if that is asked for.
    ///
    /// # Errors
    /// When the log has no accelerometer, or its model cannot be exported.
    pub(super) fn of(arguments: &Arguments) -> Result<Self, Failure> {
        let axes = match arguments.accelerometer {
            true => of_log(arguments)?,
            false => Vec::new(),
        };
        let of_axes = |of: fn(&AxisNoise) -> Given, option: &str| match axes.is_empty() {
            true => Given::Missing {
                why: format!(
                    "not part of a gyro's record: fill it in, give it with {option}, or take it from the same log with \
                     --accelerometer"
                ),
            },
            false => Given::largest(axes.iter().map(|axis| (axis.name.as_str(), of(axis)))),
        };
        let noise_density = match arguments.overbound {
            true => of_axes(AxisNoise::overbound_density, DENSITY),
            false => of_axes(AxisNoise::white, DENSITY),
        };
        let random_walk = match arguments.overbound {
            true => of_axes(AxisNoise::overbound_walk, WALK),
            false => of_axes(AxisNoise::walk, WALK),
        };
        let given = |value: Option<f64>, otherwise: Given| value.map_or(otherwise, Given::plain);
        let pair = Pair {
            noise_density: given(arguments.accelerometer_noise_density, noise_density),
            random_walk: given(arguments.accelerometer_random_walk, random_walk),
        };
        Ok(Self { pair, axes })
    }
}

/// The noise of the accelerometer in the log.
fn of_log(arguments: &Arguments) -> Result<Vec<AxisNoise>, Failure> {
    let path = &arguments.input;
    let no_limits = |name: &str| {
        let what = format!("axis {name}: its curve has no finite confidence limits");
        Place::file(path).failure(what, "record longer")
    };
    let explained = explained(arguments, Sensor::Accelerometer)?;
    let noise = explained
        .iter()
        .map(|one| AxisNoise::of(one).ok_or_else(|| no_limits(&one.axis.axis)));
    noise.collect()
}
