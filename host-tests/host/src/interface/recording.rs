//! A record that grows while samples arrive.

use super::{options::Sensor, record::Record};
use allanite::{Accumulator, course::Course, integrity::Integrity};
use allanite_log::{
    Axis, Evidence, Log, OCTAVES, SpectrumSums,
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
    axes: Vec<Live>,
}

#[derive(Clone)]
struct Live {
    name: String,
    accumulator: Accumulator<OCTAVES>,
    spectrum: SpectrumSums,
    course: Course,
    integrity: Integrity,
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
        let axes = axes.into_iter().map(|name| Live {
            name,
            accumulator: Accumulator::new(),
            spectrum: SpectrumSums::new(),
            course: Course::new(),
            integrity: Integrity::new(),
        });
        Ok(Self {
            rate_hz: rate,
            rate_per_count: scale,
            unit,
            axes: axes.collect(),
        })
    }

    /// The number of axes.
    pub fn axes(&self) -> usize {
        self.axes.len()
    }

    /// The rate of a count.
    pub const fn rate_per_count(&self) -> f64 {
        self.rate_per_count
    }

    /// Samples of each axis so far.
    pub fn samples(&self) -> u64 {
        self.axes
            .first()
            .map_or(0, |axis| axis.accumulator.samples())
    }

    /// Adds counts of an axis. All axes have to get equally many before anything else is done.
    pub fn push(&mut self, axis: usize, counts: &[i32]) {
        if let Some(axis) = self.axes.get_mut(axis) {
            axis.accumulator.push_slice(counts);
            axis.spectrum.push_slice(counts);
            axis.course.push_slice(counts);
            axis.integrity.push_slice(counts);
        }
    }

    /// Tells that samples are missing here, an unknown number of them.
    pub fn gap(&mut self) {
        for axis in &mut self.axes {
            axis.accumulator.gap();
            axis.spectrum.gap();
            axis.course.gap();
            axis.integrity.gap();
        }
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
        let axes = self.axes.iter().map(|axis| Axis {
            name: axis.name.clone(),
            rate_per_count: self.rate_per_count,
            accumulator: axis.accumulator.clone(),
            spectrum: axis.spectrum.clone(),
            evidence: Some(Evidence {
                course: Some(axis.course.clone()),
                invalid: axis.integrity.verdict(),
                ..Evidence::default()
            }),
        });
        let log = Log {
            rate_hz: self.rate_hz,
            unit: self.unit,
            has_scale: true,
            axes: axes.collect(),
            notes: Vec::new(),
        };
        Record::of_log(path, log)
    }
}
