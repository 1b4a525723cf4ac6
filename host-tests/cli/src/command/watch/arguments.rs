//! The options of `watch`.

use crate::command::examples;
use allanite_log::unit::Unit;
use clap::Args;
use std::path::PathBuf;

/// Watch a gyro: curve, coefficients, verdict and missing effects while counts arrive
///
/// Each line is one sample: one whole number for each axis, or with --decimals one rate, separated by commas,
/// semicolons, tabs or blanks. Lines that begin with # are comments. Any other line is counted as invalid
/// and leaves a gap, which no difference spans.
#[derive(Debug, Args)]
#[command(after_help = examples::WATCH)]
pub(in crate::command) struct Arguments {
    /// Samples per second
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    pub(super) rate: f64,
    /// Rate units per count [default: 1]
    #[arg(long, value_name = "RATE_PER_COUNT", allow_negative_numbers = true)]
    pub(super) scale: Option<f64>,
    /// The numbers are rates, which may have decimals, and are rounded to the rate of one count
    #[arg(long, requires = "scale")]
    pub(super) decimals: bool,
    /// Unit of the rates
    #[arg(long, default_value = "deg/s")]
    pub(super) unit: Unit,
    /// Names of the axes, one for each number in a line [default: x,y,z, as many as the first line has
    /// numbers]
    #[arg(long, value_delimiter = ',', value_name = "NAME,…")]
    pub(super) axes: Option<Vec<String>>,
    /// Serial port to read, such as /dev/ttyACM0 [default: standard input]
    #[arg(long, value_name = "DEVICE")]
    pub(super) port: Option<String>,
    /// Bits per second of the serial port
    #[arg(long, default_value_t = 115_200, requires = "port")]
    pub(super) baud: u32,
    /// The curve file (.json) to write at the end, on an interruption and at intervals
    #[arg(long, short, value_name = "CURVE.json")]
    pub(super) output: Option<PathBuf>,
    /// Seconds from one saving of the curve to the next, which is what a power cut can lose
    #[arg(long, value_name = "SECONDS", default_value_t = 0.5)]
    pub(super) save_every: f64,
    /// Seconds from one diagnosis to the next
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    pub(super) diagnose_every: f64,
    /// Seconds from one line to the next, if standard output is not a terminal
    #[arg(long, value_name = "SECONDS", default_value_t = 10.0)]
    pub(super) print_every: f64,
}
