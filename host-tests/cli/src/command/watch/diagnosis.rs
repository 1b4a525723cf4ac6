//! The diagnosis of a recording, which a thread of its own repeats while counts arrive.

use allanite::Model;
use allanite_host::{
    curve_file::AxisCurve,
    diagnose::{
        diagnosed::Diagnosed,
        scope::Scope,
        words::{brief, verdict},
    },
};
use allanite_log::Evidence;
use std::{
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

/// What a diagnosis says about an axis.
#[derive(Clone)]
pub(super) struct Found {
    pub(super) axis: String,
    /// The number of samples of the record at that time.
    pub(super) samples: u64,
    /// What is missing, in a few words.
    pub(super) brief: String,
    /// The same in a sentence.
    pub(super) sentence: String,
    /// The averaging times, in seconds, and the Allan deviations of the last model at them, in rate units.
    pub(super) model: Vec<(f64, f64)>,
}

impl Found {
    /// Diagnoses an axis. `None` if it cannot be fitted.
    pub(super) fn of((axis, evidence): (AxisCurve, Evidence)) -> Option<Self> {
        let (name, samples) = (axis.axis.clone(), axis.samples);
        let model = Model::ieee_952();
        let diagnosed =
            Diagnosed::without_limits(axis, evidence, &model, &Scope::default()).ok()?;
        let (_, last) = diagnosed.ends()?;
        let octaves = last.comparison.octaves.iter();
        Some(Self {
            axis: name,
            samples,
            brief: brief(&diagnosed),
            sentence: verdict(&diagnosed),
            model: octaves
                .map(|octave| (octave.tau_s, octave.model.sqrt()))
                .collect(),
        })
    }
}

/// Diagnoses a recording now and then.
pub(super) struct Diagnoser {
    every: Duration,
    begun: Option<Instant>,
    running: Option<JoinHandle<Vec<Found>>>,
    found: Vec<Found>,
}

impl Diagnoser {
    /// Begins a diagnosis every so often. The first one begins as soon as there is a curve.
    pub(super) const fn new(every: Duration) -> Self {
        Self {
            every,
            begun: None,
            running: None,
            found: Vec::new(),
        }
    }

    /// What was found last of an axis.
    pub(super) fn found(&self, axis: &str) -> Option<&Found> {
        self.found.iter().find(|found| found.axis == axis)
    }

    /// Takes the results of a diagnosis that has ended, and begins another one if it is time to.
    pub(super) fn advance(&mut self, curves: impl FnOnce() -> Option<Vec<(AxisCurve, Evidence)>>) {
        if let Some(running) = self.running.take_if(|running| running.is_finished()) {
            // A thread that panicked has no results; the earlier ones stay.
            self.found = running.join().unwrap_or(std::mem::take(&mut self.found));
        }
        let waited = self.begun.is_none_or(|begun| begun.elapsed() >= self.every);
        if self.running.is_some() || !waited {
            return;
        }
        if let Some(curves) = curves() {
            self.begun = Some(Instant::now());
            let diagnose = move || curves.into_iter().filter_map(Found::of).collect();
            self.running = Some(thread::spawn(diagnose));
        }
    }
}
