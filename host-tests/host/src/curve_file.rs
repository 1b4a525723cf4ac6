//! The curve file, which `measure` writes and `fit` reads: one Allan curve for each axis of a log.
//!
//! The format is JSON. It is exact, because the sums of squares are integers, from which the variances
//! follow. The whole file is checked before any number of it is used.

mod check;
mod coarse;
mod course;
mod levels;
mod merge;
mod pieces;

pub use course::CourseDensities;
use levels::TOLERANCE;
pub use levels::{SpectrumLevel, SpectrumLevels};

use allanite::{
    Curve, Scale, course::CosineTransform, integrity::Reason, octave::Bridged, spectrum::Spectrum,
};
use allanite_log::{
    self as log, BINS, OCTAVES,
    failure::{Failure, Place, one_line, quoted},
    pieces::Pieces,
    regular_file,
    unit::Unit,
};
use serde::{Deserialize, Serialize};
use std::{io::Read, path::Path};

/// The name of the format, as it is written in the file.
pub const FORMAT: &str = "allanite-curve";

/// The version of the format that is written. Versions from 1 on are read; version 1 has no spectrum, version 2 no short
/// octaves, version 3 neither a course nor levels of the spectrum with fewer than 16 segments, version 4 no pieces, and version 5
/// neither the mean rate nor whether the record is valid.
pub const VERSION: u32 = 6;

/// The first version that says whether a record is valid. Of earlier ones, the octaves show whether the noise is too small.
const JUDGED_VERSION: u32 = 6;

/// Largest size of a curve file, in bytes. A curve takes a few kilobytes for each axis. Chosen by hand.
const LARGEST: u64 = 1 << 24;

/// Largest number of axes.
const MOST_AXES: usize = log::MOST_AXES;

/// Longest name of an axis, in bytes.
const LONGEST_NAME: usize = 1 << 12;

/// The curves of a log's axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CurveFile {
    format: String,
    version: u32,
    /// One curve an axis.
    pub axes: Vec<AxisCurve>,
}

/// The curve of one axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxisCurve {
    /// Name of the axis.
    pub axis: String,
    /// Samples per second.
    pub rate_hz: f64,
    /// The unit of the rate.
    pub unit: Unit,
    /// Rate units per count, or per quantum if the log has floating-point numbers.
    pub rate_per_count: f64,
    /// Number of samples of the record.
    pub samples: u64,
    /// The number of the first sample in the record that this is a part of.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub first_sample: u64,
    /// Number of gaps, each of which ends a contiguous stretch of the record.
    pub gaps: u64,
    /// The gaps that were filled, and the samples that were lost in them.
    #[serde(default, skip_serializing_if = "Bridged::is_empty")]
    pub bridged: Bridged,
    /// Where the record comes from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// The record's licence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub licence: Option<String>,
    /// The octaves, shortest averaging time first.
    pub octaves: Vec<Octave>,
    /// The octaves behind them, which have too few differences for a variance. Files that are merged need them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub short: Vec<ShortOctave>,
    /// The spectrum. Files of version 1 and records that are too short have none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spectrum: Option<SpectrumLevels>,
    /// The course. Files before version 4, records that are too short and merged records have none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub course: Option<CourseDensities>,
    /// What rejoins this part of a record with its neighbours. Files before version 5, and records that are measured as a whole,
    /// have none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pieces: Option<Pieces>,
    /// The mean rate, in rate units. Files before version 6 have none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_rate: Option<f64>,
    /// Why the record is not one of a gyro at rest, if it is not. Files before version 6 do not say it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub invalid: Option<Reason>,
}

fn is_zero(number: &u64) -> bool {
    *number == 0
}

/// One octave of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Octave {
    /// Averaging factor, a power of two.
    pub m: u32,
    /// Averaging time, in seconds.
    pub tau_s: f64,
    /// Number of quarter-overlapping differences of adjacent clusters.
    pub differences: u64,
    /// The exact sum of their squares, in counts².
    pub sum: u128,
    /// Allan variance, in rate units squared.
    pub variance: f64,
}

/// An octave with fewer than [`Curve::MIN_DIFFERENCES`] differences.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShortOctave {
    /// Averaging factor, a power of two.
    pub m: u32,
    /// Number of quarter-overlapping differences of adjacent clusters.
    pub differences: u64,
    /// The exact sum of their squares, in counts².
    pub sum: u128,
}

impl CurveFile {
    /// A file of these curves.
    pub fn new(axes: Vec<AxisCurve>) -> Self {
        Self {
            format: FORMAT.into(),
            version: VERSION,
            axes,
        }
    }

    /// The text of the file.
    ///
    /// # Errors
    /// When a number cannot be written as JSON.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        Ok(text)
    }

    /// Reads a file and checks every number in it.
    ///
    /// # Errors
    /// When the file cannot be read or a number is impossible. The failure names the file, the axis, the
    /// octave and the remedy.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let (file, _) = regular_file::open(path)?;
        let mut text = Vec::new();
        file.take(LARGEST + 1)
            .read_to_end(&mut text)
            .map_err(|error| Place::file(path).io(&error))?;
        if text.len() as u64 > LARGEST {
            return Err(Place::file(path).failure(
                format!("a curve file is smaller than {} MiB", LARGEST >> 20),
                "give the file that measure wrote",
            ));
        }
        Self::parse(path, &text)
    }

    /// Reads the text of a file as [`read`](Self::read) does. `path` stands for the file in messages.
    ///
    /// # Errors
    /// As of [`read`](Self::read), except those of the file itself.
    pub fn parse(path: &Path, text: &[u8]) -> Result<Self, Failure> {
        /// The fields that every version of the format has.
        #[derive(Deserialize)]
        struct Head {
            format: String,
            version: u32,
        }
        let head: Head = serde_json::from_slice(text).map_err(|error| syntax(path, &error))?;
        if head.format != FORMAT {
            return Err(Place::file(path).failure(
                format!(
                    "the format is {}, not {FORMAT}",
                    quoted(head.format.as_bytes())
                ),
                "give the file that measure wrote",
            ));
        }
        if !(1..=VERSION).contains(&head.version) {
            return Err(Place::file(path).failure(
                format!(
                    "the format has version {}, but this program reads versions 1 to {VERSION}",
                    head.version
                ),
                "measure the log again",
            ));
        }
        let mut file: Self = serde_json::from_slice(text).map_err(|error| syntax(path, &error))?;
        let is_judged = file.version >= JUDGED_VERSION;
        file.version = VERSION;
        for axis in &mut file.axes {
            if !is_judged {
                axis.invalid = axis.coarse();
            }
            // Names are printed, and control characters would reach the terminal.
            axis.axis = one_line(&axis.axis);
        }
        file.check().map_err(|what| {
            Place::file(path).failure(what, "restore the file or measure the log again")
        })?;
        Ok(file)
    }

    fn check(&self) -> Result<(), String> {
        if self.axes.is_empty() {
            return Err("the file has no axes".into());
        }
        if self.axes.len() > MOST_AXES {
            return Err(format!(
                "the file has {} axes, more than {MOST_AXES}",
                self.axes.len()
            ));
        }
        for (i, axis) in self.axes.iter().enumerate() {
            let name = quoted(axis.axis.as_bytes());
            if axis.axis.is_empty() {
                return Err(format!("axis {} has no name", i + 1));
            }
            if axis.axis.len() > LONGEST_NAME {
                return Err(format!("axis {}: the name {name} is not valid", i + 1));
            }
            if self.axes[..i].iter().any(|other| other.axis == axis.axis) {
                return Err(format!("two axes are named {name}"));
            }
            axis.check()
                .map_err(|what| format!("axis {name}: {what}"))?;
        }
        Ok(())
    }
}

impl AxisCurve {
    /// The curve of one axis of a log.
    ///
    /// # Errors
    /// When a sum exceeds 128 bits, which takes days of full-scale input.
    pub fn of(axis: &log::Axis, rate_hz: f64, unit: Unit) -> Result<Self, Failure> {
        let fail = |what: String| {
            Place::default().axis_failure(&axis.name, what, "check the scale and the sensor")
        };
        let scale =
            Scale::new(axis.rate_per_count, rate_hz).map_err(|error| fail(error.to_string()))?;
        // The curve has the first octaves of the accumulator, because the number of differences falls
        // from octave to octave.
        let curve = axis.accumulator.curve(scale);
        let sums = axis.accumulator.octaves();
        let sums = sums.take_while(|octave| octave.differences > 0);
        let sums = sums.map(|octave| {
            let too_large = || fail(format!("octave m = {}: the sum exceeds 128 bits", octave.m));
            Ok(ShortOctave {
                m: octave.m,
                differences: octave.differences,
                sum: octave.sum.to_u128().ok_or_else(too_large)?,
            })
        });
        let mut sums: Vec<ShortOctave> = sums.collect::<Result<_, Failure>>()?;
        let short = sums.split_off(curve.points().len());
        let evidence = axis.evidence.as_ref();
        let course =
            evidence.and_then(|evidence| evidence.course.as_ref()?.cosine_transform(scale));
        let (bridged, samples) = (axis.accumulator.bridged(), axis.accumulator.samples());
        let spectrum = axis.spectrum.spectrum(scale);
        let spectrum = spectrum.without_bridges(bridged, samples);
        let octaves = sums.iter().zip(curve.points());
        let octaves = octaves.map(|(sum, point)| Octave {
            m: sum.m,
            tau_s: point.tau_s,
            differences: sum.differences,
            sum: sum.sum,
            variance: point.variance,
        });
        Ok(Self {
            axis: axis.name.clone(),
            rate_hz,
            unit,
            rate_per_count: axis.rate_per_count,
            samples: axis.accumulator.samples(),
            first_sample: 0,
            mean_rate: axis
                .accumulator
                .mean_rate(scale)
                .map(|mean| axis.zero + mean),
            gaps: axis.accumulator.gaps(),
            bridged: *axis.accumulator.bridged(),
            source: None,
            licence: None,
            octaves: octaves.collect(),
            short,
            spectrum: Some(SpectrumLevels::of(&spectrum))
                .filter(|spectrum| !spectrum.levels.is_empty()),
            course: course.as_ref().map(CourseDensities::of),
            pieces: None,
            invalid: None,
        })
    }

    /// The curve of an axis with these sums, of as many octaves as have differences, shortest first. The sensor has a rate in
    /// samples per second, a unit and a scale in rate units per count.
    pub(crate) fn of_sums(
        axis: &str,
        (samples, bridged): (u64, &Bridged),
        (rate_hz, unit, rate_per_count): (f64, Unit, f64),
        sums: &[ShortOctave],
    ) -> Self {
        let least = Curve::<OCTAVES>::MIN_DIFFERENCES;
        let (long, short): (Vec<ShortOctave>, Vec<ShortOctave>) =
            sums.iter().partition(|octave| octave.differences >= least);
        let raw = long.iter();
        let raw = raw.map(|octave| (octave.m, octave.differences, octave.sum));
        let variances = variances(raw, rate_per_count, bridged, samples);
        let octaves = long.iter().zip(variances);
        let octaves = octaves.map(|(octave, variance)| Octave {
            m: octave.m,
            tau_s: f64::from(octave.m) / rate_hz,
            differences: octave.differences,
            sum: octave.sum,
            variance,
        });
        Self {
            axis: axis.into(),
            rate_hz,
            unit,
            rate_per_count,
            samples,
            first_sample: 0,
            mean_rate: None,
            gaps: 0,
            bridged: *bridged,
            source: None,
            licence: None,
            octaves: octaves.collect(),
            short,
            spectrum: None,
            course: None,
            pieces: None,
            invalid: None,
        }
    }

    /// The spectrum as the library's type; without bins if the file has none.
    ///
    /// # Errors
    /// When the library refuses a number. [`CurveFile::read`] would have refused it too.
    pub fn spectrum(&self) -> Result<Spectrum<BINS>, allanite::Error> {
        let spectrum = self.spectrum.as_ref();
        spectrum.map_or(Ok(Spectrum::EMPTY), |spectrum| {
            spectrum.spectrum(self.rate_hz)
        })
    }

    /// The cosine transform of the course as the library's type.
    ///
    /// # Errors
    /// When the library refuses a number. [`CurveFile::read`] would have refused it too.
    pub fn course(&self) -> Result<Option<CosineTransform>, allanite::Error> {
        let course = self.course.as_ref();
        course
            .map(|course| course.transform(self.rate_hz))
            .transpose()
    }

    /// The curve as the library's type.
    ///
    /// # Errors
    /// When the library refuses a number. [`CurveFile::read`] would have refused it too.
    pub fn curve(&self) -> Result<Curve<OCTAVES>, allanite::Error> {
        let octaves = self.octaves.iter();
        Curve::new(
            self.rate_hz,
            octaves.map(|octave| (octave.m, octave.differences, octave.variance)),
        )
    }
}

/// The Allan variances, in rate units squared, computed as [`Curve`] does.
fn variances(
    octaves: impl Iterator<Item = (u32, u64, u128)> + Clone,
    rate_per_count: f64,
    bridged: &Bridged,
    samples: u64,
) -> Vec<f64> {
    let raw = octaves.map(|(m, differences, sum)| {
        let cluster_scale = rate_per_count / f64::from(m);
        let mean = sum as f64 / differences as f64;
        (m, differences, 0.5 * mean * cluster_scale * cluster_scale)
    });
    let plain = || raw.clone().map(|(.., variance)| variance).collect();
    if bridged.is_empty() {
        return plain();
    }
    // The rate does not matter. What the library refuses is refused elsewhere.
    let curve = Curve::<OCTAVES>::new(1.0, raw.clone());
    curve.map_or_else(
        |_| plain(),
        |curve| {
            let curve = curve.without_bridges(bridged, samples);
            curve.points().iter().map(|point| point.variance).collect()
        },
    )
}

/// The failure of a file that the JSON parser refuses, with the line.
fn syntax(path: &Path, error: &serde_json::Error) -> Failure {
    let text = error.to_string();
    let what = text
        .rsplit_once(" at line ")
        .map_or(text.as_str(), |(what, _)| what);
    Place::row(path, error.line() as u64).failure(
        format!("not a curve file: {what}"),
        "give the file that measure wrote",
    )
}
