//! Recorded logs, read as a stream: any length in the same few megabytes.
//!
//! A log is a table of numbers, one row a sample, by its extension:
//!
//! * `.csv`, `.csv.gz`: commas, semicolons or tabs; a header of names or none; comment lines begin
//!   with `#`, and those at the top may say `rate_hz=…`, `scale=…` (rate units per count) and
//!   `unit=deg/s`, `rad/s`, `m/s^2` or `g`. Options win over comments.
//! * `.npy`: one- or two-dimensional, rows are samples; integers of 1 to 8 bytes, floats of 4 or 8,
//!   either byte order, either memory order.
//!
//! * `.mcap`: bags of ROS 2, or of ROS 1 converted, with a topic of `sensor_msgs/msg/Imu`;
//!   stamps are those of the messages' headers. One chunk is in memory at a time.
//! * `.ulg`: logs of PX4 with `sensor_gyro`, `sensor_accel`, `sensor_combined` or `vehicle_imu`.
//!
//! # Which columns are axes
//!
//! Those that [`Options::columns`] names. Otherwise, with a header, those named like the axes of a
//! gyro (`gx`, `gyro_y`, `angular_velocity.z`, `w_RS_S_x [rad s^-1]`) or, where there are none or
//! [`Options::sensor`] asks for them, of an accelerometer (`ax`, `accel_y`,
//! `linear_acceleration.z`). Where no name says so, all columns of numbers, but for those that by
//! their name or by rising from row to row are times, indices or temperatures. Unless every column
//! was an axis by name, a note tells what was taken and what was left out.
//!
//! # Rate and gaps
//!
//! A rate that options or comments tell is the rate, and time stamps are not looked at unless
//! [`Options::time`] names their column. Otherwise the rate is the mean of the stamps of the first
//! column that is named like a time (of two for the seconds and nanoseconds of ROS), or of the only
//! one without a name that rises by other steps than one. Their unit is that of the name, else that of the time since 1970, else the one that
//! gives a rate between 10 Hz and 10 kHz.
//!
//! A step between stamps of more than 1.5 usual ones, and far beyond how they scatter, is a gap,
//! which no difference will span. A row with the stamp of the row before is left out. Both are
//! counted in a note. Stamps that go back, two rates in one log, and stamps that leap or repeat in
//! more than 5 % of the rows are refused.
//!
//! # Units
//!
//! The unit is that of [`Options::unit`], else of the comments, else of the columns' names, else
//! deg/s or m/s². Neighbouring samples that scatter by more than 100 deg/s or 20 m/s² get a note
//! that scale and unit are unlikely; by more than 100 000 deg/s or m/s² they are refused.
//!
//! # Counts
//!
//! Whole numbers within `i32` are counts as they are, whether written `17` or `17.0`. An axis with
//! any other number becomes counts of a power of two, between 2^-30 and 2^-29 of its range, less a
//! constant offset; this takes one more pass for the range. Nothing is skipped: a value that is not
//! a finite number ends the reading with its row.

mod accumulate;
#[cfg(feature = "bags")]
mod bag;
mod clock;
mod columns;
mod covariate;
mod csv;
mod field;
mod file;
#[cfg(feature = "bags")]
mod imu_message;
mod lines;
mod metadata;
mod names;
mod npy;
pub mod npy_header;
mod quantum;
mod reading;
mod records;
mod scaling;
mod source;
mod table;
mod time_column;
mod ulog;
mod ulog_format;
mod ulog_messages;
mod watched;
mod worker;

use crate::unit::{Sensor, Unit};
use allanite::{Accumulator, covariate::CrossCurve, integrity::Reason, kurtosis::Kurtosis};
pub use covariate::CovariateChoice;
pub use file::{read, read_in_two, read_with_evidence};
pub use names::TimeUnit;

/// Octaves that the host accumulates: all that cannot overflow, for records of years.
pub const OCTAVES: usize = 30;

/// What a user may say about a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Samples per second; time stamps are not needed then.
    pub rate_hz: Option<f64>,
    /// Rate units per count.
    pub scale: Option<f64>,
    /// The unit that the scaled counts have.
    pub unit: Option<Unit>,
    /// The axes, in this order; without, see [which columns are axes](self#which-columns-are-axes).
    pub columns: Option<Vec<ColumnChoice>>,
    /// Of which sensor axes are to be found.
    pub sensor: Option<Sensor>,
    /// The column of time stamps; without, see [rate and gaps](self#rate-and-gaps).
    pub time: Option<String>,
    /// The unit of the time stamps.
    pub time_unit: Option<TimeUnit>,
    /// Of a log of several topics the one to read.
    pub topic: Option<String>,
}

/// A column to take: `column` or `axis=column`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColumnChoice {
    /// What the axis is to be called, if not what the column is.
    pub axis: Option<String>,
    /// The column's name in the header, or its number from 1.
    pub column: String,
}

impl std::str::FromStr for ColumnChoice {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (axis, column) = match text.split_once('=') {
            Some((axis, column)) => (Some(axis.trim().to_owned()), column.trim()),
            None => (None, text.trim()),
        };
        if column.is_empty() || axis.as_deref() == Some("") {
            return Err("write COLUMN or AXIS=COLUMN");
        }
        Ok(Self {
            axis,
            column: column.to_owned(),
        })
    }
}

/// A log, read to its end.
#[derive(Clone, Debug)]
pub struct Log {
    /// Samples per second.
    pub rate_hz: f64,
    /// The unit of the rates.
    pub unit: Unit,
    /// The axes, in the order asked for, else in that of the columns.
    pub axes: Vec<Axis>,
    /// What was decided without being asked, one line each.
    pub notes: Vec<String>,
}

/// One axis of a log.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Its name.
    pub name: String,
    /// Rate units per count of the accumulator.
    pub rate_per_count: f64,
    /// All its samples.
    pub accumulator: Accumulator<OCTAVES>,
    /// What was watched beside them, if it was asked for.
    pub evidence: Option<Evidence>,
}

/// What a log tells of an axis beside its curve.
#[derive(Clone, Debug, Default)]
pub struct Evidence {
    /// Whether differences are Gaussian.
    pub kurtosis: Kurtosis<OCTAVES>,
    /// Names of the covariates, and what the axis shares with each.
    pub covariates: Vec<(String, CrossCurve<OCTAVES>)>,
    /// Why the curve cannot mean what it says.
    pub invalid: Option<Reason>,
}
