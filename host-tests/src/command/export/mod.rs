//! `export`: coefficients as other programs take them.

mod autopilot;
mod axis_noise;
mod c_header;
mod curve_csv;
mod decimal;
mod given;
mod kalibr;
mod matlab;
mod summary;

use super::{
    examples,
    fit::{Fitted, MethodName},
    input::{self, LogArguments},
    output_file::OutputFile,
};
use crate::{
    failure::{Failure, Place},
    unit::Sensor,
};
use axis_noise::AxisNoise;
use clap::{Args, ValueEnum};
use given::Given;
use std::{io::Write, path::PathBuf};

/// Write the noise of a gyro as Kalibr, OpenVINS, PX4, ArduPilot, MATLAB or C take it
#[derive(Debug, Args)]
#[command(after_help = examples::EXPORT)]
pub(super) struct Arguments {
    /// A log (.csv, .csv.gz, .npy, .mcap, .ulg), or a curve file (.json) that `measure` wrote
    input: PathBuf,
    /// What to write
    #[arg(long, short)]
    format: Format,
    /// The file to write [default: standard output]
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Give the conservative overbound to the filter, and the best fit in comments
    #[arg(long)]
    overbound: bool,
    /// What the gyro is called: the part's name for MATLAB, the prefix of C names
    #[arg(long, default_value = "gyro")]
    name: String,
    /// The topic of the IMU, for Kalibr and OpenVINS
    #[arg(long, default_value = "/imu0", value_name = "TOPIC")]
    rostopic: String,
    /// White noise of the accelerometer, in m/s²/√Hz, for Kalibr and OpenVINS
    #[arg(long, value_name = "DENSITY", allow_negative_numbers = true)]
    accelerometer_noise_density: Option<f64>,
    /// Random walk of the accelerometer's bias, in m/s³/√Hz, for Kalibr and OpenVINS
    #[arg(long, value_name = "DENSITY", allow_negative_numbers = true)]
    accelerometer_random_walk: Option<f64>,
    /// Prediction interval of the autopilot's filter, in seconds [default: 0.01 for PX4, 0.012 for
    /// ArduPilot]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    prediction_interval: Option<f64>,
    #[command(flatten)]
    about_log: LogArguments,
}

/// What other programs read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Kalibr's imu.yaml
    Kalibr,
    /// OpenVINS' kalibr_imu_chain.yaml
    #[value(alias = "vins")]
    Openvins,
    /// A parameter file of PX4's EKF2, as QGroundControl loads it
    Px4,
    /// A parameter file of ArduPilot's EKF3, as Mission Planner and MAVProxy load it
    Ardupilot,
    /// JSON for loadparams of MATLAB's imuSensor
    Matlab,
    /// A C header
    C,
    /// The curve with its limits and models as a table
    Csv,
}

/// What is known of the gyro, in radians and seconds.
struct Characterisation {
    axes: Vec<AxisNoise>,
    rate_hz: f64,
}

impl Characterisation {
    /// What a format takes that has one number for all axes: the largest.
    fn common(&self, of_axis: impl Fn(&AxisNoise) -> Given) -> Given {
        Given::largest(
            self.axes
                .iter()
                .map(|axis| (axis.name.as_str(), of_axis(axis))),
        )
    }

    /// White noise and random walk as the best fit has them.
    fn best(&self) -> Pair {
        Pair {
            noise_density: self.common(|axis| axis.best("N")),
            random_walk: self.common(|axis| axis.best("K")),
        }
    }

    /// Those of the overbound.
    fn overbound(&self) -> Pair {
        Pair {
            noise_density: self.common(AxisNoise::overbound_density),
            random_walk: self.common(AxisNoise::overbound_walk),
        }
    }

    /// What the filter is to take, and what stands beside it in comments.
    fn chosen(&self, overbound: bool) -> (Choice, Choice) {
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

/// What most filters know of a gyro, continuous-time.
struct Pair {
    /// In rad/s/√Hz.
    noise_density: Given,
    /// In rad/s²/√Hz.
    random_walk: Given,
}

/// One of the two kinds of numbers.
struct Choice {
    name: &'static str,
    pair: Pair,
}

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let positive = [
        (
            "--accelerometer-noise-density",
            arguments.accelerometer_noise_density,
        ),
        (
            "--accelerometer-random-walk",
            arguments.accelerometer_random_walk,
        ),
        ("--prediction-interval", arguments.prediction_interval),
    ];
    for (option, value) in positive {
        if value.is_some_and(|value| !(value.is_finite() && value > 0.0)) {
            return Err(Failure::option(
                format!("{option} is impossible"),
                "give a positive, finite number",
            ));
        }
    }
    // First, so that a place that cannot be written to costs no fit.
    let file = arguments.output.as_deref().map(OutputFile::create);
    let file = file.transpose()?;
    let known = characterise(arguments)?;
    let text = match arguments.format {
        Format::Kalibr => kalibr::kalibr(&known, arguments),
        Format::Openvins => kalibr::openvins(&known, arguments),
        Format::Px4 => autopilot::px4(&known, arguments),
        Format::Ardupilot => autopilot::ardupilot(&known, arguments),
        Format::Matlab => matlab::json(&known, arguments),
        Format::C => c_header::header(&known, &arguments.name),
        Format::Csv => {
            curve_csv::table(&known).map_err(|error| Failure::standard_output(&error.into()))?
        }
    };
    let Some(mut file) = file else {
        let written = output.write_all(text.as_bytes());
        return written.map_err(|error| Failure::standard_output(&error));
    };
    let place = arguments
        .output
        .as_deref()
        .map_or_else(Place::default, Place::file);
    file.write_all(text.as_bytes())
        .map_err(|error| place.io(&error))?;
    file.commit()
}

/// Reads, fits and bounds every axis.
fn characterise(arguments: &Arguments) -> Result<Characterisation, Failure> {
    let path = &arguments.input;
    let mut axes = Vec::new();
    for axis in input::read(path, &arguments.about_log)? {
        if axis.unit.sensor() != Sensor::Gyro {
            let what = format!("axis {} is an accelerometer's, in {}", axis.axis, axis.unit);
            let remedy = "export a gyro; `fit` prints the coefficients of an accelerometer";
            return Err(Place::file(path).failure(what, remedy));
        }
        let fitted = Fitted::new(path, axis, MethodName::Covariance)?;
        let name = fitted.axis.axis.clone();
        let noise = AxisNoise::of(fitted).ok_or_else(|| {
            let what = format!("axis {name}: its curve has no finite confidence limits");
            Place::file(path).failure(what, "record longer")
        })?;
        axes.push(noise);
    }
    // Logs have one rate; a curve file could have several.
    let rate_hz = axes
        .first()
        .map_or(f64::NAN, |axis: &AxisNoise| axis.rate_hz);
    if let Some(other) = axes.iter().find(|axis| axis.rate_hz != rate_hz) {
        let what = format!("axes of {rate_hz} Hz and {} Hz", other.rate_hz);
        return Err(Place::file(path).failure(what, "export axes of one rate at a time"));
    }
    Ok(Characterisation { axes, rate_hz })
}
