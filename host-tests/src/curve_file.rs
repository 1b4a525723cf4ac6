//! The curve file, which `measure` writes and `fit` reads: one Allan curve for each axis of a log.
//!
//! The format is JSON. It is exact, because the sums of squares are integers, from which the variances
//! follow. The whole file is checked before any number of it is used.

use crate::{
    failure::{Failure, Place, brief, one_line, quoted},
    log::{self, BINS, OCTAVES},
    regular_file,
    unit::Unit,
};
use allanite::{
    Curve, Scale,
    spectrum::{Bin, Spectrum},
};
use serde::{Deserialize, Serialize};
use std::{io::Read, path::Path};

/// The name of the format, as it is written in the file.
pub const FORMAT: &str = "allanite-curve";

/// The version of the format that is written. Versions from 1 on are read; version 1 has no spectrum.
pub const VERSION: u32 = 2;

/// Largest size of a curve file, in bytes. A curve takes a few kilobytes for each axis. Chosen by hand.
const LARGEST: u64 = 1 << 24;

/// Largest number of axes.
const MOST_AXES: usize = log::MOST_AXES;

/// Longest name of an axis, in bytes.
const LONGEST_NAME: usize = 1 << 12;

/// Largest number of samples: a thousand years at 33 kHz.
const MOST_SAMPLES: u64 = 1 << 50;

/// Largest relative error of a number that follows from other numbers of the file. Chosen by hand:
/// numbers are written with all their digits, so that only rounding remains, some 1e-15.
const TOLERANCE: f64 = 1e-9;

/// The most power of a level, in Allan variances of one of its blocks. An octave's response to the frequencies of the
/// level is 0.075 at least, so that a record without gaps has 14 at most. Chosen by hand: gaps leave out segments, so
/// that a record with many of them may have more.
const MOST_POWER: f64 = 1e6;

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
    /// Number of gaps, each of which ends a contiguous stretch of the record.
    pub gaps: u64,
    /// Where the record comes from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// The record's licence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub licence: Option<String>,
    /// The octaves, shortest averaging time first.
    pub octaves: Vec<Octave>,
    /// The spectrum. Files of version 1 and records that are too short have none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spectrum: Option<SpectrumLevels>,
}

/// The spectrum of one axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpectrumLevels {
    /// Number of blocks in a segment.
    pub segment: u32,
    /// The levels, shortest blocks first.
    pub levels: Vec<SpectrumLevel>,
}

/// One level of a spectrum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpectrumLevel {
    /// Number of samples in a block, a power of 8.
    pub block: u32,
    /// Number of segments that overlap by half.
    pub segments: u32,
    /// One-sided densities in rate units squared per hertz, from the bin `segment/16` to the bin before `segment/2`.
    pub density: Vec<f64>,
    /// Spectral kurtosis of each bin.
    pub kurtosis: Vec<f64>,
}

impl SpectrumLevels {
    fn of(spectrum: &Spectrum<BINS>) -> Self {
        let levels = spectrum.levels().map(|level| SpectrumLevel {
            block: level.first().map_or(0, |bin| bin.block),
            segments: level.first().map_or(0, |bin| bin.segments),
            density: level.iter().map(|bin| bin.density).collect(),
            kurtosis: level.iter().map(|bin| bin.spectral_kurtosis).collect(),
        });
        Self {
            segment: spectrum.segment(),
            levels: levels.collect(),
        }
    }

    fn spectrum(&self, rate_hz: f64) -> Result<Spectrum<BINS>, allanite::Error> {
        let bins = self.levels.iter().flat_map(|level| {
            let measured = level.density.iter().zip(&level.kurtosis);
            let indices = self.segment / 16..;
            measured
                .zip(indices)
                .map(|((density, kurtosis), index)| Bin {
                    block: level.block,
                    index,
                    frequency_hz: 0.0,
                    density: *density,
                    segments: level.segments,
                    spectral_kurtosis: *kurtosis,
                })
        });
        Spectrum::new(rate_hz, self.segment, bins)
    }

    /// Checks the numbers of the levels against each other and against the axis.
    fn check(&self, axis: &AxisCurve) -> Result<(), String> {
        let blocks = (0..10).map(|level| 1_u32 << (3 * level));
        let right = self.levels.iter().zip(blocks);
        if self.levels.len() > 10 || right.clone().any(|(level, block)| level.block != block) {
            return Err("spectrum: the blocks of the levels are not 1, 8, 64, …".into());
        }
        for level in &self.levels {
            let here = |what: &str| Err(format!("spectrum, block {}: {what}", level.block));
            let bins = (self.segment / 2 - self.segment / 16) as usize;
            if level.density.len() != bins || level.kurtosis.len() != bins {
                return here("the number of bins is impossible");
            }
            let half = u64::from(level.block) * u64::from(self.segment / 2);
            let most = (axis.samples / half.max(1)).saturating_sub(1);
            if u64::from(level.segments) > most {
                return here("there are more segments than samples for them");
            }
            if level.segments < Spectrum::<BINS>::MIN_SEGMENTS {
                return here("there are too few segments");
            }
            // By Cauchy and Schwarz, n ΣP² is at least (ΣP)² and at most n (ΣP)².
            let most = f64::from(level.segments) + 1.0;
            if level
                .kurtosis
                .iter()
                .any(|&kurtosis| kurtosis > most * (1.0 + TOLERANCE))
            {
                return here("a spectral kurtosis is impossible");
            }
            let mut octaves = axis.octaves.iter();
            let Some(octave) = octaves.find(|octave| octave.m == level.block) else {
                return here("there is no octave of this length");
            };
            let bin_hz = axis.rate_hz / (f64::from(level.block) * f64::from(self.segment));
            let power = bin_hz * level.density.iter().sum::<f64>();
            if power > MOST_POWER * octave.variance {
                return here("the densities contradict the octaves");
            }
        }
        let spectrum = self.spectrum(axis.rate_hz);
        spectrum
            .map(|_| ())
            .map_err(|error| format!("spectrum: {error}"))
    }
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

    fn parse(path: &Path, text: &[u8]) -> Result<Self, Failure> {
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
        file.version = VERSION;
        for axis in &mut file.axes {
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
            Failure::option(
                format!("axis {}: {what}", axis.name),
                "check the scale and the sensor",
            )
        };
        let scale =
            Scale::new(axis.rate_per_count, rate_hz).map_err(|error| fail(error.to_string()))?;
        let curve = axis.accumulator.curve(scale);
        // The curve has the first octaves of the accumulator, because the number of differences falls
        // from octave to octave.
        let octaves =
            curve
                .points()
                .iter()
                .zip(axis.accumulator.octaves())
                .map(|(point, octave)| {
                    let sum = octave.sum.to_u128();
                    Ok(Octave {
                        m: point.m,
                        tau_s: point.tau_s,
                        differences: point.differences,
                        sum: sum.ok_or_else(|| {
                            fail(format!("octave m = {}: the sum exceeds 128 bits", point.m))
                        })?,
                        variance: point.variance,
                    })
                });
        Ok(Self {
            axis: axis.name.clone(),
            rate_hz,
            unit,
            rate_per_count: axis.rate_per_count,
            samples: axis.accumulator.samples(),
            gaps: axis.accumulator.gaps(),
            source: None,
            licence: None,
            octaves: octaves.collect::<Result<_, Failure>>()?,
            spectrum: Some(SpectrumLevels::of(&axis.spectrum.spectrum(scale)))
                .filter(|spectrum| !spectrum.levels.is_empty()),
        })
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

    fn check(&self) -> Result<(), String> {
        let positive = |name: &str, value: f64| {
            let valid = value.is_finite() && value > 0.0;
            valid
                .then_some(())
                .ok_or_else(|| format!("{name} {} is impossible", brief(value)))
        };
        positive("rate_hz", self.rate_hz)?;
        if !(1e-6..=1e9).contains(&self.rate_hz) {
            return Err(format!("rate_hz {} is impossible", brief(self.rate_hz)));
        }
        positive("rate_per_count", self.rate_per_count)?;
        if self.samples > MOST_SAMPLES {
            return Err(format!("{} samples are impossible", self.samples));
        }
        if self.gaps > self.samples {
            let (gaps, samples) = (self.gaps, self.samples);
            return Err(format!("{gaps} gaps in {samples} samples are impossible"));
        }
        if self.octaves.len() < 2 {
            return Err(format!(
                "a fit needs two octaves, and the file has {}",
                self.octaves.len()
            ));
        }
        let mut last = 0;
        for octave in &self.octaves {
            let here = |what: String| format!("octave m = {}: {what}", octave.m);
            if octave.m <= last {
                return Err(here("averaging factors must ascend".into()));
            }
            last = octave.m;
            self.check_octave(octave).map_err(here)?;
        }
        if let Some(spectrum) = &self.spectrum {
            spectrum.check(self)?;
        }
        Ok(())
    }

    fn check_octave(&self, octave: &Octave) -> Result<(), String> {
        let m = f64::from(octave.m);
        if !octave.m.is_power_of_two() || octave.m.ilog2() >= OCTAVES as u32 {
            return Err("the averaging factor is not a power of two up to 2^29".into());
        }
        if !close(octave.tau_s, m / self.rate_hz) {
            return Err(format!("tau_s {} is not m / rate_hz", brief(octave.tau_s)));
        }
        let possible = differences(self.samples, octave.m);
        let least = Curve::<OCTAVES>::MIN_DIFFERENCES;
        let right = match self.gaps {
            0 => octave.differences == possible,
            _ => octave.differences <= possible,
        };
        if !right || octave.differences < least {
            return Err(format!(
                "{} differences of {} samples are impossible",
                octave.differences, self.samples
            ));
        }
        let count = octave.differences as f64;
        let sum = octave.sum as f64;
        // The sums of two clusters of m counts differ by less than 2^32 m.
        if sum > count * (m * 2f64.powi(32)).powi(2) {
            return Err(format!(
                "a sum of {} is too large for 32-bit counts",
                octave.sum
            ));
        }
        let variance = 0.5 * sum / count * (self.rate_per_count / m).powi(2);
        if !close(octave.variance, variance) {
            return Err(format!(
                "variance {} does not follow from the sum",
                brief(octave.variance)
            ));
        }
        Ok(())
    }
}

/// Number of quarter-overlapping differences in a record without gaps.
fn differences(samples: u64, m: u32) -> u64 {
    let (blocks, first) = match m {
        1 => (samples, 1),
        2 => (samples, 3),
        _ => (samples / u64::from(m / 4), 7),
    };
    blocks.saturating_sub(first)
}

fn close(value: f64, expected: f64) -> bool {
    expected.is_finite() && (value - expected).abs() <= TOLERANCE * expected
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
