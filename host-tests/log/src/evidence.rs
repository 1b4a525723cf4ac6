//! What a log tells beside the curves of its axes, in units.

use super::{
    Axis, CovariateChoice, Disturbance, Evidence, OCTAVES,
    accumulate::{CovariateColumn, Measured},
    disturbed::Extremes,
    watched::{SharedSums, WatchedAxis},
};
use crate::{
    block_means::{BlockMeans, BlockSums},
    failure::{Failure, Place},
};
use allanite::{Scale, course::Course, covariate::Pair, integrity::Reason};
use std::{path::Path, sync::Arc};

/// A covariate that has been read: its name and the size of its counts, or `None` if it is left out.
type Named = Option<(String, f64)>;

/// The covariates that were recorded beside the axes.
pub(super) struct Recorded {
    rate_hz: f64,
    named: Vec<Named>,
    pairs: Vec<Pair<OCTAVES>>,
    /// The columns, with their means in the blocks of the course.
    columns: Vec<(String, Vec<f64>)>,
    /// The columns, with their means in many short blocks.
    short: Arc<[(String, Arc<[f64]>)]>,
    broken: Arc<[bool]>,
}

impl Recorded {
    /// The covariates of a log in their units.
    pub(super) fn new(
        path: &Path,
        choices: &[CovariateChoice],
        measured: &Measured,
        rate_hz: f64,
    ) -> Result<Self, Failure> {
        let named = named(choices, &measured.covariates, rate_hz);
        Ok(Self {
            rate_hz,
            pairs: shared(path, &measured.pairs, &named, rate_hz)?,
            columns: block_means(choices, &measured.covariates),
            short: short_means(choices, measured).into(),
            broken: measured.blocks.broken().into(),
            named,
        })
    }

    /// The means of an axis and of the columns in many short blocks. `place` is that of the axis among the blocks.
    pub(super) fn means(
        &self,
        blocks: &BlockSums,
        place: usize,
        rate_per_count: f64,
    ) -> Option<BlockMeans> {
        let mean = |counts: f64| counts * rate_per_count;
        (!self.short.is_empty()).then(|| BlockMeans {
            samples: blocks.samples(),
            block_s: f64::from(blocks.samples()) / self.rate_hz,
            broken: self.broken.clone(),
            rate: blocks.means(place).map(mean).collect(),
            columns: self.short.clone(),
        })
    }

    /// The evidence of an axis, without its course and its block means. `fault` is what the logger did to its samples, and
    /// `coarse` is why its numbers are too coarse, if they are. Counts may be pulses of an angle.
    pub(super) fn evidence(
        &self,
        path: &Path,
        axis: &Axis,
        watched: &dyn WatchedAxis,
        ([fault, coarse], has_pulses): ([Option<Reason>; 2], bool),
    ) -> Result<Evidence, Failure> {
        let fail = |error: allanite::Error| {
            Place::file(path).failure(format!("axis {}: {error}", axis.name), "check the scale")
        };
        let scale = Scale::new(axis.rate_per_count, self.rate_hz).map_err(fail)?;
        let unit = |named: &Named| named.as_ref().map_or(1.0, |(_, unit)| *unit);
        let units: Vec<f64> = self.named.iter().map(unit).collect();
        let told = watched.evidence(scale, &units).map_err(fail)?;
        // The order of the reasons is that of counts, where coarse numbers come before the jumps that they seem to make.
        let carries = || has_pulses || watched.accumulator().carries_rounding();
        let is_told = |reason: &Reason| !(matches!(reason, Reason::Coarse { .. }) && carries());
        let (own, coarse) = (told.invalid.filter(is_told), coarse.filter(is_told));
        let invalid = match own {
            _ if matches!(fault, Some(Reason::Unanswered { .. })) => fault,
            Some(Reason::Railed { .. } | Reason::Misread { .. }) => own,
            Some(Reason::Repeated { .. } | Reason::Stuck { .. }) => fault.or(own),
            // Motion without a place is judged from the curves of all axes together, by whoever has them.
            Some(Reason::Moved { motions: 0, .. }) => fault.or(coarse),
            other => fault.or(coarse).or(other),
        };
        let named = self.named.iter().zip(told.covariates);
        let named = named.filter_map(|(named, cross)| Some((named.as_ref()?.0.clone(), cross)));
        Ok(Evidence {
            kurtosis: told.kurtosis,
            covariates: named.collect(),
            pairs: self.pairs.clone(),
            invalid,
            course: None,
            columns: self.columns.clone(),
            means: None,
            disturbance: None,
            spectrogram: None,
            pieces: None,
        })
    }

    /// What disturbed an axis that is not valid for this reason: motion, which first showed at a sample of time, or spikes.
    pub(super) fn disturbance(
        &self,
        axis: &str,
        reason: Option<Reason>,
        moved_at: Option<u64>,
        extremes: &Extremes,
    ) -> Option<Disturbance> {
        let is_motion = match reason? {
            // What never stops has no place.
            Reason::Moved { motions: 0, .. } => return None,
            Reason::Moved { .. } => true,
            Reason::Spiked { .. } => false,
            _ => return None,
        };
        let time_s = |samples: u64| samples as f64 / self.rate_hz;
        let stretches = extremes.disturbed(self.rate_hz).into_iter();
        let stretches_s: Vec<_> = stretches
            .map(|(from, to)| (time_s(from), time_s(to)))
            .collect();
        let found = stretches_s.first().map(|(from_s, _)| *from_s);
        Some(Disturbance {
            axis: axis.to_owned(),
            is_motion,
            at_s: found.or(moved_at.map(time_s))?,
            stretches_s,
            end_s: time_s(extremes.time()),
        })
    }
}

/// The covariates by their names. A rate of change is counted in quanta per sample.
fn named(choices: &[CovariateChoice], columns: &[CovariateColumn], rate_hz: f64) -> Vec<Named> {
    let named = choices.iter().zip(columns).map(|(choice, column)| {
        let unit = column.quantum.step() * if choice.rate { rate_hz } else { 1.0 };
        (!column.flawed).then(|| (choice.to_string(), unit))
    });
    named.collect()
}

/// A note on every column that is left out because of its values.
pub(super) fn left_out(
    choices: &[CovariateChoice],
    measured: &Measured,
) -> impl Iterator<Item = String> {
    let columns = choices.iter().zip(&measured.covariates);
    let left_out = columns.filter(|(choice, column)| column.flawed && !choice.rate);
    left_out.map(|(choice, _)| {
        format!(
            "{} is not tried as a covariate: not all of its values are numbers of its usual size",
            choice.column
        )
    })
}

/// What covariates share that may act together, in their units.
fn shared(
    path: &Path,
    pairs: &[([usize; 2], SharedSums)],
    named: &[Named],
    rate_hz: f64,
) -> Result<Vec<Pair<OCTAVES>>, Failure> {
    let one = |(covariates, sums): &([usize; 2], SharedSums)| {
        let [Some((name, unit)), Some((_, other_unit))] = covariates.map(|at| &named[at]) else {
            return Ok(None);
        };
        let scale = Scale::new(*unit, rate_hz);
        let told = scale.and_then(|scale| sums.record_so_far(0, (scale, [*other_unit])));
        let told = told.map_err(|error| {
            let what = format!("covariate {name}: {error}");
            Place::file(path).failure(what, "check the values of its column")
        })?;
        let shared = told.covariates.into_iter().next().unwrap_or_default();
        // Places among the covariates that are not left out.
        let place = |at: usize| named[..at].iter().flatten().count();
        Ok(Some(Pair {
            covariates: covariates.map(place),
            shared,
        }))
    };
    pairs
        .iter()
        .filter_map(|pair| one(pair).transpose())
        .collect()
}

/// The columns of the covariates that are not left out, with their means in the blocks of the course.
fn block_means(
    choices: &[CovariateChoice],
    covariates: &[CovariateColumn],
) -> Vec<(String, Vec<f64>)> {
    // A scale of one leaves the means in counts; the times of the blocks are not used.
    let Ok(counts) = Scale::new(1.0, 1.0) else {
        return Vec::new();
    };
    let mut columns: Vec<(String, Vec<f64>)> = Vec::new();
    let sound = choices.iter().zip(covariates);
    for (choice, column) in sound.filter(|(_, column)| !column.flawed) {
        // A column and its rate of change may both be covariates.
        if columns.iter().all(|(name, _)| *name != choice.column) {
            let blocks = column.course.blocks(counts);
            let means = blocks.map(|block| column.quantum.value(block.mean));
            columns.push((choice.column.clone(), means.collect()));
        }
    }
    columns
}

/// The columns of the covariates that are not left out, with their means in many short blocks.
fn short_means(choices: &[CovariateChoice], measured: &Measured) -> Vec<(String, Arc<[f64]>)> {
    let mut columns: Vec<(String, Arc<[f64]>)> = Vec::new();
    let all = choices.iter().zip(&measured.covariates);
    for (place, (choice, column)) in all.enumerate() {
        let is_new = columns.iter().all(|(name, _)| *name != choice.column);
        if is_new && !column.flawed {
            let counts = measured.blocks.means(measured.axes.len() + place);
            let means = counts.map(|mean| column.quantum.value(mean));
            columns.push((choice.column.clone(), means.collect()));
        }
    }
    columns
}

/// Motion of one axis makes the curves of all axes invalid, because a gyro that turns about one axis is not at rest
/// about the others. What is to be left out of a log is to be left out of all axes.
pub(super) fn spread_motion(axes: &mut [Axis]) {
    let mut evidence: Vec<&mut Evidence> = axes
        .iter_mut()
        .filter_map(|axis| axis.evidence.as_mut())
        .collect();
    let all = evidence.iter().filter_map(|one| one.disturbance.as_ref());
    let stretches_s = union(
        all.flat_map(|one| one.stretches_s.iter().copied())
            .collect(),
    );
    for one in evidence
        .iter_mut()
        .filter_map(|one| one.disturbance.as_mut())
    {
        one.stretches_s.clone_from(&stretches_s);
    }
    let is_moved = |one: &&mut Evidence| matches!(one.invalid, Some(Reason::Moved { .. }));
    let moved = evidence.iter().filter(|one| is_moved(one));
    let first = moved.min_by(|one, other| {
        let at = |one: &Evidence| one.disturbance.as_ref().map_or(0.0, |motion| motion.at_s);
        at(one).total_cmp(&at(other))
    });
    let Some((reason, motion)) = first.map(|first| (first.invalid, first.disturbance.clone()))
    else {
        return;
    };
    for one in evidence {
        // A change of the noise of this axis explains what another one shows.
        if one.invalid.is_none() {
            let changed = one.course.as_ref().and_then(Course::change);
            one.invalid = changed.or(reason);
        }
        if one.disturbance.is_none() {
            one.disturbance.clone_from(&motion);
        }
    }
}

/// Stretches without overlaps, the earliest first.
fn union(mut stretches: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    stretches.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut union: Vec<(f64, f64)> = Vec::new();
    for (from, to) in stretches {
        match union.last_mut() {
            Some(last) if from <= last.1 => last.1 = last.1.max(to),
            _ => union.push((from, to)),
        }
    }
    union
}
