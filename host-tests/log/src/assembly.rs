//! Makes a log of what was measured of its axes.

use super::{
    Axis, Evidence, Log, OCTAVES,
    accumulate::Measured,
    evidence::{Recorded, spread_motion},
    faults, few, part,
    quantum::Quantum,
    scaling::{Origin, Scaling},
    sums::Sums,
};
use crate::failure::{Failure, Place};
use allanite::Accumulator;
use std::path::Path;

/// What the axes of a log have in common.
pub(super) struct Assembly<'a> {
    pub(super) path: &'a Path,
    /// Whether the rows behind the first ones were summed apart.
    pub(super) is_in_two: bool,
    pub(super) scaling: Scaling,
    pub(super) rate_hz: f64,
    /// Whether the logger repeated samples.
    pub(super) repeats: bool,
    pub(super) recorded: Recorded,
    /// What was measured, without the axes.
    pub(super) measured: Measured,
}

/// The sums of the axes with their names and quanta.
type Named = Vec<(String, (Sums, Quantum))>;

impl Assembly<'_> {
    /// The log with these notes, and the axes of the rows behind the first ones.
    pub(super) fn log(
        self,
        named: Named,
        mut notes: Vec<String>,
    ) -> Result<(Log, Vec<Axis>), Failure> {
        let (mut axes, mut rest) = (Vec::new(), Vec::new());
        let some_change = named.iter().any(|(_, (sums, _))| !self.is_constant(sums));
        let quanta = named.iter().map(|(_, (_, quantum))| quantum);
        let has_scale = self
            .scaling
            .has_scale(quanta.clone().any(Quantum::is_whole));
        let mut least = 0.0_f64;
        for (place, (name, (mut sums, quantum))) in named.into_iter().enumerate() {
            if some_change && self.is_constant(&sums) {
                notes.push(format!("axis {name} never changes its value: left out"));
                continue;
            }
            let mut axis = Axis {
                name,
                rate_per_count: self.scaling.scale * quantum.step(),
                zero: self.scaling.scale * quantum.value(0.0),
                accumulator: sums.accumulator().clone(),
                spectrum: sums.spectrum().clone(),
                evidence: None,
            };
            if let (true, Sums::InTwo { rest: behind, .. }) = (self.is_in_two, &sums) {
                let behind = Axis {
                    accumulator: behind.accumulator.clone(),
                    spectrum: behind.spectrum.clone(),
                    ..axis.clone()
                };
                check_axis(self.path, &behind)?;
                rest.push(behind);
            }
            check_axis(self.path, &axis)?;
            if let Some(evidence) = self.evidence(place, &axis, &mut sums, quantum)? {
                if evidence.invalid.is_none() {
                    least = least.max(self.measured.faults.least(place));
                }
                axis.evidence = Some(evidence);
            }
            if quantum.is_whole() && !self.scaling.scale_is_told {
                notes.push(format!(
                    "axis {}: whole numbers and no scale given: 1 per count assumed (change it with --scale)",
                    axis.name
                ));
            }
            notes.extend(self.scaling.check(self.path, &axis)?);
            axes.push(axis);
        }
        notes.extend(faults::bound(least));
        spread_motion(&mut axes);
        if self.scaling.origin == Origin::Assumed {
            notes.push(format!(
                "no unit given: {} assumed (change it with --unit)",
                self.scaling.unit
            ));
        }
        let log = Log {
            rate_hz: self.rate_hz,
            unit: self.scaling.unit,
            has_scale,
            axes,
            notes,
        };
        Ok((log, rest))
    }

    /// Whether the values of an axis never change, before or behind the first rows.
    fn is_constant(&self, sums: &Sums) -> bool {
        is_constant(sums.accumulator())
            || matches!(sums, Sums::InTwo { rest, .. } if self.is_in_two && is_constant(&rest.accumulator))
    }

    /// What was recorded beside the curve of an axis, if it was watched.
    fn evidence(
        &self,
        place: usize,
        axis: &Axis,
        sums: &mut Sums,
        quantum: Quantum,
    ) -> Result<Option<Evidence>, Failure> {
        let Sums::Watched(watched, beside) = sums else {
            return Ok(None);
        };
        let (path, rate_hz, measured) = (self.path, self.rate_hz, &self.measured);
        let part = beside.take_part();
        let part = part.map(|part| match (self.repeats, quantum == Quantum::WHOLE) {
            (_, false) => Err(part::refused(
                path,
                "its values are no whole numbers of 32 bits",
            )),
            (true, _) => Err(part::refused(path, "the logger repeated samples")),
            _ => part.finish(path, rate_hz, axis.rate_per_count),
        });
        let coarse = measured.coarse.get(place).copied().flatten();
        let coarse = coarse.or_else(|| few::coarse(watched.accumulator(), &beside.extremes));
        let fault = measured.faults.verdict(place);
        let recorded = &self.recorded;
        let has_pulses = measured.faults.has_pulses(place);
        let evidence = recorded.evidence(path, axis, &**watched, ([fault, coarse], has_pulses))?;
        let moved_at = watched.moved_at();
        Ok(Some(Evidence {
            disturbance: recorded.disturbance(
                &axis.name,
                evidence.invalid,
                moved_at,
                &beside.extremes,
            ),
            course: Some(*beside.course.clone()),
            means: recorded.means(&measured.blocks, place, axis.rate_per_count),
            spectrogram: beside.spectrogram(rate_hz, axis.rate_per_count),
            pieces: part.transpose()?,
            ..evidence
        }))
    }
}

/// Whether no value of an axis differs from the one before.
fn is_constant(accumulator: &Accumulator<OCTAVES>) -> bool {
    let octave = accumulator.octave(0);
    octave.is_none_or(|octave| octave.sum.to_real() == 0.0)
}

/// Checks that an axis is long enough and that its values change.
fn check_axis(path: &Path, axis: &Axis) -> Result<(), Failure> {
    let fail = |what: String, remedy: &str| Err(Place::file(path).failure(what, remedy));
    let Axis {
        name,
        rate_per_count,
        accumulator,
        ..
    } = axis;
    // Nine samples give two octaves of at least six differences each.
    const LEAST: u64 = 9;
    if accumulator.samples() < LEAST {
        return fail(
            match accumulator.samples() {
                1 => format!("1 sample is too few: two octaves need {LEAST}"),
                samples => format!("{samples} samples are too few: two octaves need {LEAST}"),
            },
            "record longer",
        );
    }
    if is_constant(accumulator) {
        return fail(
            format!("axis {name} never changes its value"),
            "check the sensor, or choose other columns with --columns",
        );
    }
    if !(rate_per_count.is_finite() && *rate_per_count > 0.0) {
        return fail(
            format!(
                "axis {name}: a scale of {rate_per_count} per count is outside the range of floats"
            ),
            "give another --scale",
        );
    }
    Ok(())
}
