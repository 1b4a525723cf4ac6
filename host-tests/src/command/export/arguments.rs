//! What `export` is told.

use crate::command::{examples, input::record::LogArguments};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Write the noise of a gyro as Kalibr, OpenVINS, PX4, ArduPilot, MATLAB or C take it
#[derive(Debug, Args)]
#[command(after_help = examples::EXPORT)]
pub(in crate::command) struct Arguments {
    /// A log (.csv, .csv.gz, .npy, .mcap, .ulg), or a curve file (.json) that `measure` wrote
    pub(super) input: PathBuf,
    /// What to write
    #[arg(long, short)]
    pub(super) format: Format,
    /// The file to write [default: standard output]
    #[arg(long, short, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,
    /// Give the conservative overbound to the filter, and the best fit in comments
    #[arg(long)]
    pub(super) overbound: bool,
    /// What the gyro is called: the part's name for MATLAB, the prefix of C names
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
    #[command(flatten)]
    pub(super) about_log: LogArguments,
}

/// What other programs read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
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
