//! The options of `export`.

use crate::command::{
    compare::model::ModelArguments,
    examples,
    input::record::{CovariateArguments, LogArguments},
};
use allanite_log::failure::Failure;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Write the model of a gyro's noise for a filter: Kalibr, OpenVINS, VINS-Fusion, ORB-SLAM3, LIO-SAM, FAST-LIO, GTSAM,
/// KF-GINS, ROS, PX4, ArduPilot, MATLAB, Gazebo, C or JSON
#[derive(Debug, Args)]
#[command(after_help = examples::EXPORT)]
pub(in crate::command) struct Arguments {
    /// A log (text, .npy, .ulg, or a bag of ROS), or a curve file (.json) that `measure` wrote
    pub(super) input: PathBuf,
    /// Format of the file
    #[arg(long, short)]
    pub(super) format: Format,
    /// The model [default: what the diagnosis finds, or with --with or --without the five terms so changed]
    #[arg(long, value_name = "MODEL")]
    model: Option<ModelName>,
    /// The file to write [default: standard output]
    #[arg(long, short, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,
    /// Give the conservative overbound to the filter and put the best fit into comments
    #[arg(long)]
    pub(super) overbound: bool,
    /// Name of the gyro, which is the name of the part for MATLAB and the prefix of names in C
    #[arg(long, default_value = "gyro")]
    pub(super) name: String,
    /// The topic of the IMU, for Kalibr, OpenVINS, VINS-Fusion, LIO-SAM and FAST-LIO
    #[arg(long, default_value = "/imu0", value_name = "TOPIC")]
    pub(super) rostopic: String,
    /// Take white noise and random walk of the accelerometer from the same log, for formats that have them
    #[arg(long)]
    pub(super) accelerometer: bool,
    /// White noise of the accelerometer, in m/s²/√Hz, for formats that have it
    #[arg(long, value_name = "DENSITY", allow_negative_numbers = true)]
    pub(super) accelerometer_noise_density: Option<f64>,
    /// Random walk of the accelerometer's bias, in m/s³/√Hz, for formats that have it
    #[arg(long, value_name = "DENSITY", allow_negative_numbers = true)]
    pub(super) accelerometer_random_walk: Option<f64>,
    /// Prediction interval of the autopilot's filter, in seconds [default: 0.01 for PX4, 0.012 for
    /// ArduPilot]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub(super) prediction_interval: Option<f64>,
    /// Export a record that is not valid, such as one in which the gyro was moved
    #[arg(long)]
    pub(super) despite_invalid: bool,
    /// Export what the diagnosis cannot explain in full
    #[arg(long)]
    pub(super) despite_unexplained: bool,
    #[command(flatten)]
    pub(super) covariates: CovariateArguments,
    #[command(flatten)]
    pub(super) effects: ModelArguments,
    #[command(flatten)]
    pub(super) about_log: LogArguments,
}

impl Arguments {
    /// The model that is exported.
    pub(super) fn choice(&self) -> ModelName {
        let named = if self.effects.changes() {
            ModelName::Asked
        } else {
            ModelName::Diagnosed
        };
        self.model.unwrap_or(named)
    }

    /// Refuses options that contradict each other or cannot be.
    ///
    /// # Errors
    /// When an option is impossible, or --model names another model than --with and --without make.
    pub(super) fn check(&self) -> Result<(), Failure> {
        let positive = [
            (
                "--accelerometer-noise-density",
                self.accelerometer_noise_density,
            ),
            (
                "--accelerometer-random-walk",
                self.accelerometer_random_walk,
            ),
            ("--prediction-interval", self.prediction_interval),
        ];
        for (option, value) in positive {
            if value.is_some_and(|value| !(value.is_finite() && value > 0.0)) {
                return Err(Failure::option(
                    format!("{option} is impossible"),
                    "give a positive, finite number",
                ));
            }
        }
        if self.effects.changes() && self.model.is_some_and(|model| model != ModelName::Asked) {
            return Err(Failure::option(
                "--model names another model than --with and --without",
                "drop --model, or the others",
            ));
        }
        Ok(())
    }
}

/// The models that can be exported.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum ModelName {
    /// What `diagnose` finds, temperature included
    Diagnosed,
    /// The five terms of IEEE Std 952, or those behind --filter
    FiveTerms,
    /// The five terms with and without what --with and --without name
    Asked,
}

/// The formats of other programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// Kalibr's imu.yaml
    Kalibr,
    /// OpenVINS' kalibr_imu_chain.yaml
    #[value(alias = "vins")]
    Openvins,
    /// The lines of VINS-Fusion's configuration
    #[value(alias = "vins-mono")]
    VinsFusion,
    /// The lines of ORB-SLAM3's settings
    OrbSlam3,
    /// The lines of LIO-SAM's params.yaml
    LioSam,
    /// The lines of FAST-LIO's configuration
    FastLio,
    /// A function in Python that sets GTSAM's preintegration parameters
    Gtsam,
    /// The noise part of KF-GINS' configuration
    KfGins,
    /// The angular_velocity_covariance of ROS messages sensor_msgs/Imu, as YAML
    Ros,
    /// A parameter file for PX4's EKF2, which QGroundControl loads
    Px4,
    /// A parameter file for ArduPilot's EKF3, which Mission Planner and MAVProxy load
    Ardupilot,
    /// JSON for loadparams of MATLAB's imuSensor
    Matlab,
    /// A model of SDFormat with an IMU, for Gazebo
    #[value(alias = "gazebo")]
    Sdf,
    /// A C header
    C,
    /// Everything the model has, with intervals, for a filter of your own
    Json,
    /// A table of the curve with its limits and models; --output FILE.csv also writes FILE.spectrum.csv and, of a
    /// log, FILE.course.csv
    Csv,
}
