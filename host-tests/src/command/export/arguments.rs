//! The options of `export`.

use crate::command::{
    examples,
    input::record::{CovariateArguments, LogArguments},
    known_filter::KnownFilter,
};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Write the noise of a gyro in the format of Kalibr, OpenVINS, PX4, ArduPilot, MATLAB or C
#[derive(Debug, Args)]
#[command(after_help = examples::EXPORT)]
pub(in crate::command) struct Arguments {
    /// A log (text, .npy, .ulg, or a bag of ROS), or a curve file (.json) that `measure` wrote
    pub(super) input: PathBuf,
    /// Format of the file
    #[arg(long, short)]
    pub(super) format: Format,
    /// The file to write [default: standard output]
    #[arg(long, short, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,
    /// Give the conservative overbound to the filter and put the best fit into comments
    #[arg(long)]
    pub(super) overbound: bool,
    /// Name of the gyro, which is the name of the part for MATLAB and the prefix of names in C
    #[arg(long, default_value = "gyro")]
    pub(super) name: String,
    /// The topic of the IMU, for Kalibr and OpenVINS
    #[arg(long, default_value = "/imu0", value_name = "TOPIC")]
    pub(super) rostopic: String,
    /// White noise of the accelerometer, in m/s²/√Hz, for Kalibr and OpenVINS
    #[arg(long, value_name = "DENSITY", allow_negative_numbers = true)]
    pub(super) accelerometer_noise_density: Option<f64>,
    /// Random walk of the accelerometer's bias, in m/s³/√Hz, for Kalibr and OpenVINS
    #[arg(long, value_name = "DENSITY", allow_negative_numbers = true)]
    pub(super) accelerometer_random_walk: Option<f64>,
    /// Prediction interval of the autopilot's filter, in seconds [default: 0.01 for PX4, 0.012 for
    /// ArduPilot]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub(super) prediction_interval: Option<f64>,
    /// Export a record that is not valid, such as one in which the gyro was moved
    #[arg(long)]
    pub(super) despite_invalid: bool,
    #[command(flatten)]
    pub(super) covariates: CovariateArguments,
    #[command(flatten)]
    pub(super) filter: KnownFilter,
    #[command(flatten)]
    pub(super) about_log: LogArguments,
}

/// The formats of other programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// Kalibr's imu.yaml
    Kalibr,
    /// OpenVINS' kalibr_imu_chain.yaml
    #[value(alias = "vins")]
    Openvins,
    /// A parameter file for PX4's EKF2, which QGroundControl loads
    Px4,
    /// A parameter file for ArduPilot's EKF3, which Mission Planner and MAVProxy load
    Ardupilot,
    /// JSON for loadparams of MATLAB's imuSensor
    Matlab,
    /// A C header
    C,
    /// A table of the curve with its limits and models; --output FILE.csv also writes FILE.spectrum.csv and, of a
    /// log, FILE.course.csv
    Csv,
}
