//! A record that grows while samples arrive.

use super::{options::Sensor, record::Record};
use crate::live::Live;
use allanite_log::{
    Log,
    failure::{Failure, Place},
    unit::Unit,
};
use std::path::Path;

/// Accumulators of the axes of a sensor, which take samples in pieces of any length and keep none.
#[derive(Clone)]
pub struct Recording {
    rate_hz: f64,
    rate_per_count: f64,
    unit: Unit,
    names: Vec<String>,
    axes: Live,
}

impl Recording {
    /// No samples yet.
    ///
    /// # Errors
    /// When the rate or the scale is impossible, or a name is empty or repeated.
    pub fn new(sensor: Sensor) -> Result<Self, Failure> {
        let Sensor {
            rate_hz: rate,
            rate_per_count: scale,
            unit,
            axes,
        } = sensor;
        for (option, value) in [("--rate", rate), ("--scale", scale)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(Failure::option(
                    format!("{option} {value} is impossible"),
                    "give a positive, finite number",
                ));
            }
        }
        let twice = |(i, name): (usize, &String)| axes[..i].contains(name);
        if axes.iter().any(String::is_empty) || axes.iter().enumerate().any(twice) {
            return Err(Failure::option(
                "--axes: a name is empty or repeated",
                "give each axis a name of its own",
            ));
        }
        Ok(Self {
            rate_hz: rate,
            rate_per_count: scale,
            unit,
            axes: Live::new(axes.len()),
            names: axes,
        })
    }

    /// The number of axes.
    pub const fn axes(&self) -> usize {
        self.axes.width()
    }

    /// The rate of a count.
    pub const fn rate_per_count(&self) -> f64 {
        self.rate_per_count
    }

    /// Samples of each axis so far.
    pub fn samples(&self) -> u64 {
        self.axes.samples()
    }

    /// Adds counts of every axis, all of one length.
    pub fn push(&mut self, columns: &[&[i32]]) {
        self.axes.push(columns);
    }

    /// Tells that samples are missing here, an unknown number of them.
    pub fn gap(&mut self) {
        self.axes.gap();
    }

    /// The record so far.
    ///
    /// # Errors
    /// When there are too few samples, or the sums of an axis are too large for a curve.
    pub fn record(&self) -> Result<Record, Failure> {
        const LEAST: u64 = 9;
        let path = Path::new("accumulator");
        if self.samples() < LEAST {
            let what = format!("{} samples are too few", self.samples());
            return Err(Place::file(path).failure(what, format!("push at least {LEAST}")));
        }
        let log = Log {
            rate_hz: self.rate_hz,
            unit: self.unit,
            has_scale: true,
            axes: self.axes.axes(&self.names, self.rate_per_count),
            notes: Vec::new(),
        };
        Record::of_log(path, log)
    }
}
