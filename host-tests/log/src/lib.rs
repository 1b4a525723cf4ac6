//! Reads recorded logs as a stream. A log of any length needs the same few megabytes of memory.
//!
//! A log is a table of numbers in which each row is a sample. The first bytes of a file tell its format, or else its
//! extension does:
//!
//! * Text, also compressed with gzip: values are separated by commas, semicolons, tabs or blanks, and the decimals may
//!   be written with commas. What stands above the rows is optional: names, a row of units below them, and a preamble
//!   of other lines. Comment lines begin with `#`; those at the top may contain `rate_hz=…`, `scale=…` (rate units per
//!   count) and `unit=…` (`deg/s`, `rad/s`, `m/s^2` or `g`). Options win over comments. A comment among the rows tells
//!   how many samples are lost there, as in `# lost 500 samples`, or it is refused.
//! * `.npy`: an array of one or two dimensions whose rows are samples. Its elements are integers of
//!   1 to 8 bytes or floats of 4 or 8 bytes, in either byte order and either memory order. A file beside it with
//!   `.txt` behind its name may contain the same comments.
//! * Bags of ROS 2 (MCAP, SQLite, or a folder of them) and of ROS 1, with a topic of `sensor_msgs/msg/Imu`.
//!   The stamps are those of the messages' headers. One chunk is in memory at a time.
//! * Parquet and Arrow, whose numbers are read as they are; and workbooks, arrays of MATLAB and HDF5, and flight logs of ArduPilot
//!   and Betaflight, which are rewritten as text first. In a file with several tables, the longest one is taken, or that of
//!   [`Options::topic`].
//! * `.ulg`: a log of PX4 with `sensor_gyro`, `sensor_accel`, `sensor_combined` or `vehicle_imu`.
//!
//! # Which columns are axes
//!
//! If [`Options::columns`] is given, it names the axes. Otherwise, in a log with a header, the axes
//! are the columns that are named like the axes of a gyro (`gx`, `gyro_y`, `angular_velocity.z`,
//! `w_RS_S_x [rad s^-1]`). If there are none, or if [`Options::sensor`] asks for an accelerometer,
//! they are the columns that are named like its axes (`ax`, `accel_y`, `linear_acceleration.z`). If
//! no column is named like an axis, the axes are all columns of numbers except times, indices and
//! temperatures. Those are recognised by their names, or because they rise from row to row. A note
//! lists the columns that were taken and left out, unless every column was an axis by its name.
//!
//! # Rate and gaps
//!
//! If options or comments give a rate, it is used, and time stamps are read only if
//! [`Options::time`] names their column. A rate that the first stamps contradict is refused if the unit
//! of the stamps is told. Otherwise the rate is the mean rate of the time stamps.
//! They are in the first column that is named like a time, or in two such columns for the seconds
//! and nanoseconds of ROS. Without such a name, they are in the only column without a name that
//! rises by steps other than one.
//!
//! Dates and times of ISO 8601 and times of day are stamps too.
//!
//! The unit of the stamps is the one in the column's name. Without one, it is the unit in which the
//! stamps are times since 1970, or else the only unit that gives a rate between 1 Hz (in seconds, 0.1
//! Hz) and 33 kHz. If several do, the log is refused.
//!
//! If nearly all steps between stamps are multiples of one step, a longer step is a gap. Otherwise it
//! is a gap if it exceeds 1.5 usual steps and lies far beyond their scatter.
//! No difference of the Allan variance spans a gap. A row that repeats the stamp of the row before
//! is left out. A note counts both. Stamps that go back are refused, and so are two rates in one
//! log and stamps that jump or repeat in more than 5 % of the rows.
//!
//! # Repeats
//!
//! A reader that is faster than the sensor repeats samples. If all axes repeat at once, and hardly any sample of the
//! sensor does so by chance, the repeats are left out, the rate is that of the sensor, and a note says so. Where chance
//! repeats are too many, the curve is not valid, and the reason tells the rate of the sensor.
//!
//! Rows that a program interpolated linearly between two samples, to a faster rate or to the times of another sensor, are
//! left out likewise. Of two or three axes, they lie the same share of the way from the row before to the row behind,
//! except for rounding.
//!
//! # Temperatures
//!
//! [`read_with_evidence`] takes the first two columns that are named like a temperature (`temp_C`,
//! `gyro.temperature`, `t [°C]`) as covariates, and their rates of change, unless it is given others. Their values
//! never stop the reading: a column with a value that is no number is left out with a note.
//!
//! # Units
//!
//! The unit comes from [`Options::unit`], from the comments, or from the columns' names, in this
//! order. Without any, it is the one that the program always uses whose names the columns have, which a note says, or
//! else deg/s or m/s². A unit that the names tell and that is not known is
//! refused, and so is one that contradicts the option or the comment, unless a scale is given too. If neighbouring samples scatter by more than 100 deg/s
//! or 20 m/s², a note calls the scale and unit unlikely. If they scatter by more than 100 000 deg/s
//! or m/s², the log is refused.
//!
//! # Counts
//!
//! Whole numbers within `i32` are taken as counts without a change, whether they are written `17`
//! or `17.0`. Larger whole numbers become counts after an origin is subtracted from them as integers. An
//! axis with any other number is rounded to counts. The size of a count is a power of
//! two between 2^-30 and 2^-29 of the axis' range, and a constant offset is subtracted. This takes
//! one more pass for the range. A row with a value that is not a finite number is a lost sample, which a note
//! counts. If more than a tenth of the rows are so, the log is refused, and so it is where columns lie one behind
//! the other.

mod accumulate;
mod arrays;
mod assembly;
mod axes;
mod axis_names;
#[cfg(feature = "bags")]
mod bag;
#[cfg(feature = "bags")]
mod bag_database;
#[cfg(feature = "bags")]
mod bag_folder;
#[cfg(feature = "bags")]
mod bag_mcap;
#[cfg(feature = "bags")]
mod bag_ros1;
#[cfg(feature = "bags")]
mod bag_sqlite;
mod between;
pub mod block_means;
#[cfg(not(target_family = "wasm"))]
mod cached;
#[cfg(feature = "bags")]
mod channel;
mod clock;
mod columns;
mod convention;
#[cfg(any(feature = "bags", feature = "tables"))]
mod converted;
mod covariate;
mod csv;
mod curve;
mod cuts;
mod date_time;
mod dialect;
mod disturbed;
mod edit;
mod evidence;
pub mod failure;
mod faults;
mod few;
mod field;
mod file;
mod filled;
mod foreign;
mod glue;
mod grid;
mod gyroflow;
mod hands;
#[cfg(feature = "bags")]
mod imu_message;
mod lines;
#[cfg(feature = "bags")]
mod message_definition;
#[cfg(feature = "bags")]
mod message_layout;
mod metadata;
mod names;
mod npy;
mod npy_block;
pub mod npy_header;
mod octaves;
mod pace;
mod part;
mod part_names;
mod parts;
pub mod pieces;
mod places;
mod preamble;
mod quantities;
mod quantum;
mod reading;
mod records;
pub mod regular_file;
mod rounding;
mod row_choice;
mod rows;
mod runs;
mod scaling;
pub mod sizes;
mod source;
mod source_marks;
mod sources;
mod spectrogram;
mod sums;
mod table;
#[cfg(feature = "tables")]
mod tables;
mod time_column;
mod tried;
#[cfg(feature = "tables")]
mod typed;
mod ulog;
mod ulog_format;
mod ulog_messages;
mod ulog_topics;
pub mod unit;
mod unit_names;
#[cfg(not(target_family = "wasm"))]
mod values;
pub mod visible;
mod watched;
mod worker;
mod wrap;

use crate::{
    block_means::BlockMeans,
    pieces::Pieces,
    unit::{Sensor, Unit},
};
use allanite::{
    Accumulator,
    course::Course,
    covariate::{CrossCurve, Pair},
    integrity::Reason,
    kurtosis::Kurtosis,
    spectrum::SpectrumAccumulator,
};
pub use arrays::{Arrays, Column, Fill, Numbers, read_arrays};
pub use covariate::{CovariateChoice, Covariates};
pub use cuts::{Cuts, Moment, TimeRange};
pub use faults::{rate_of, said as repeats_said};
pub use file::{read, read_for_page, read_in_two, read_part, read_with_evidence};
pub use names::TimeUnit;
pub use names::{is_degrees_column, is_temperature};
pub use octaves::accumulate;
pub use places::Places;
pub use row_choice::RowChoice;
use serde::{Deserialize, Serialize};
pub use spectrogram::Spectrogram;
#[cfg(feature = "tables")]
pub use tables::apart::answer as answer_about_table;

pub use crate::sizes::{BINS, LEVELS, OCTAVES, SEGMENT};

/// The spectrum of an axis as the host accumulates it.
pub type SpectrumSums = SpectrumAccumulator<SEGMENT, LEVELS>;

/// The most axes that are read from a log.
pub const MOST_AXES: usize = 64;

/// What a user may specify about a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// The sampling rate, in Hz. Time stamps are not needed then.
    pub rate_hz: Option<f64>,
    /// The scale, in rate units per count.
    pub scale: Option<f64>,
    /// The unit of the scaled counts.
    pub unit: Option<Unit>,
    /// The axes, in this order. `None` selects them as in [which columns are
    /// axes](self#which-columns-are-axes).
    pub columns: Option<Vec<ColumnChoice>>,
    /// The sensor whose axes are read.
    pub sensor: Option<Sensor>,
    /// The column of time stamps. `None` selects it as in [rate and gaps](self#rate-and-gaps).
    pub time: Option<String>,
    /// The unit of the time stamps.
    pub time_unit: Option<TimeUnit>,
    /// The topic to read, in a log with several topics.
    pub topic: Option<String>,
    /// The rows to read, in a log with the rows of several sensors.
    pub rows: Option<RowChoice>,
    /// What to do with samples that the logger repeated or interpolated.
    pub repeats: Repeats,
    /// What is left out.
    pub cuts: Cuts,
}

/// What to do with samples that the logger repeated or interpolated, where it is certain that the sensor did not give them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Repeats {
    /// Leave them out, and take the rate of the sensor.
    #[default]
    Drop,
    /// Keep them. The curve is not valid then.
    Keep,
}

/// A column to read, written `column` or `axis=column`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColumnChoice {
    /// The name of the axis, if it differs from the name of the column.
    pub axis: Option<String>,
    /// The column's name in the header, or its number, counted from 1.
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

/// A log that has been read to its end.
#[derive(Clone, Debug)]
pub struct Log {
    /// The sampling rate, in Hz.
    pub rate_hz: f64,
    /// The unit of the rates.
    pub unit: Unit,
    /// Whether unit and scale are known rather than assumed.
    pub has_scale: bool,
    /// The axes, in the order of the request or else in that of the columns.
    pub axes: Vec<Axis>,
    /// What the reader decided without being asked, one line for each decision.
    pub notes: Vec<String>,
}

/// An axis of a log.
#[derive(Clone, Debug)]
pub struct Axis {
    /// The name of the axis.
    pub name: String,
    /// The scale, in rate units per count of the accumulator.
    pub rate_per_count: f64,
    /// The rate of count 0, in rate units: a reader of floats takes counts from the middle of their range.
    pub zero: f64,
    /// The accumulator with all samples of the axis.
    pub accumulator: Accumulator<OCTAVES>,
    /// The spectrum of the same samples.
    pub spectrum: SpectrumSums,
    /// The evidence beside the curve, if it was asked for.
    pub evidence: Option<Evidence>,
}

/// What a log shows of an axis beside its Allan variance.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Evidence {
    /// The kurtosis of the differences, which shows whether they are Gaussian.
    pub kurtosis: Kurtosis<OCTAVES>,
    /// The names of the covariates, and the covariance of the axis with each.
    pub covariates: Vec<(String, CrossCurve<OCTAVES>)>,
    /// The covariates that may act together.
    pub pairs: Vec<Pair<OCTAVES>>,
    /// The reason why the curve is not valid, if there is one.
    pub invalid: Option<Reason>,
    /// The course of the axis over time.
    pub course: Option<Course>,
    /// The columns of the covariates, with their means in the blocks of the course.
    pub columns: Vec<(String, Vec<f64>)>,
    /// The means of the axis and of the columns of the covariates in many short blocks; `None` without covariates.
    pub means: Option<BlockMeans>,
    /// The motion or the spikes that make the record not valid, if there are any.
    pub disturbance: Option<Disturbance>,
    /// The spectrogram, for a page that shows it, and nobody else keeps.
    #[serde(skip)]
    pub spectrogram: Option<Spectrogram>,
    /// What rejoins the axis with its neighbours, if the log is a part of a longer record.
    #[serde(skip)]
    pub pieces: Option<Pieces>,
}

/// Motion during a record, or its spikes. A gyro that turns about one axis is not at rest about the others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Disturbance {
    /// The axis that shows it.
    pub axis: String,
    /// Whether it is motion rather than spikes.
    pub is_motion: bool,
    /// When it began, in seconds from the first row of the log, missing samples included.
    pub at_s: f64,
    /// The stretches of the log that are disturbed, in seconds from its first row. Empty if they are not found.
    pub stretches_s: Vec<(f64, f64)>,
    /// When the log ends.
    pub end_s: f64,
}
