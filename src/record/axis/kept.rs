//! The sums of a record, which receive the samples that pass the gate.

use super::{
    courses::{CoursePart, CourseSums},
    gate::Missing,
    moments::{MomentPart, MomentSums},
    sample::Sample,
    spectra::{SpectrumPart, SpectrumSums, Waits},
};
use crate::record::{
    cross_sums::CrossSums,
    integrity::{Integrity, InvalidLimit, Limits},
    octave::{Accumulator, MagnitudeObserver, Observer, bridge::Filling},
    reads::Reads,
};

/// The sums of all axes and covariates. They all receive the same samples and gaps, so that all results
/// describe the same record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct AxesSums<
    const OCTAVES: usize,
    const COVARIATES: usize,
    M,
    const AXES: usize,
    S,
    T,
> where
    M: MomentPart,
    S: SpectrumPart,
    T: CoursePart,
{
    pub(crate) axes: [AxisSums<OCTAVES, COVARIATES, M, S, T>; AXES],
    /// One accumulator for each covariate, shared by all axes.
    pub(crate) covariates: [Accumulator<OCTAVES>; COVARIATES],
    /// The products of each covariate with the one before it. Those of the first one stay zero.
    pub(crate) between: [CrossSums<OCTAVES>; COVARIATES],
    /// What a reader made of the samples.
    pub(crate) reads: Reads<AXES>,
}

/// The sums of one axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct AxisSums<const OCTAVES: usize, const COVARIATES: usize, M, S, T>
where
    M: MomentPart,
    S: SpectrumPart,
    T: CoursePart,
{
    pub(crate) accumulator: Accumulator<OCTAVES>,
    pub(crate) integrity: Integrity,
    pub(crate) moments: M::Sums<OCTAVES>,
    pub(crate) cross: [CrossSums<OCTAVES>; COVARIATES],
    pub(crate) spectrum: S::Sums,
    pub(crate) course: T::Sums<COVARIATES>,
}

/// The differences of a covariate that one sample completes: those of octaves 0, 1 and 2, and at most one
/// of a higher octave.
#[derive(Clone, Copy)]
struct Completed([i64; 4]);

impl Completed {
    /// The difference of an octave.
    #[inline(always)]
    fn of(&self, octave: usize) -> i64 {
        self.0[octave.min(3)]
    }
}

impl Observer for Completed {
    #[inline(always)]
    fn observe(&mut self, octave: usize, difference: i64) {
        self.0[octave.min(3)] = difference;
    }
}

/// What is updated together with the accumulator of a covariate: its differences, and their products with those of the covariate
/// before it.
struct Neighbours<'a, const OCTAVES: usize> {
    completed: &'a mut Completed,
    before: &'a Completed,
    between: &'a mut CrossSums<OCTAVES>,
}

impl<const OCTAVES: usize> Observer for Neighbours<'_, OCTAVES> {
    #[inline(always)]
    fn observe(&mut self, octave: usize, difference: i64) {
        self.completed.observe(octave, difference);
        self.between.add(octave, self.before.of(octave), difference);
    }
}

/// The sums that are updated together with the accumulator of an axis when it takes a sample.
struct DifferenceSums<'a, S, const OCTAVES: usize, const COVARIATES: usize> {
    moments: &'a mut S,
    cross: &'a mut [CrossSums<OCTAVES>; COVARIATES],
    completed: &'a [Completed; COVARIATES],
}

impl<S, const OCTAVES: usize, const COVARIATES: usize> Observer
    for DifferenceSums<'_, S, OCTAVES, COVARIATES>
where
    S: MomentSums<OCTAVES>,
{
    #[inline(always)]
    fn observe(&mut self, octave: usize, difference: i64) {
        self.moments.add(octave, difference);
        for (cross, completed) in self.cross.iter_mut().zip(self.completed) {
            cross.add(octave, difference, completed.of(octave));
        }
    }
}

/// The fourth moments that are updated together with the accumulator of an axis without covariates when it takes many samples.
struct Fourths<'a, S, const OCTAVES: usize>(&'a mut S);

impl<S: MomentSums<OCTAVES>, const OCTAVES: usize> Observer for Fourths<'_, S, OCTAVES> {
    #[inline(always)]
    fn observe(&mut self, octave: usize, difference: i64) {
        self.0.add(octave, difference);
    }
}

impl<S: MomentSums<OCTAVES>, const OCTAVES: usize> MagnitudeObserver for Fourths<'_, S, OCTAVES> {
    #[inline(always)]
    fn observe_magnitudes(&mut self, octave: usize, magnitudes: &[u32]) {
        self.0.add_magnitudes(octave, magnitudes);
    }
}

impl<const OCTAVES: usize, M, S, T> AxisSums<OCTAVES, 0, M, S, T>
where
    M: MomentPart,
    S: SpectrumPart,
    T: CoursePart,
{
    /// Adds counts to the sums of octaves.
    pub(crate) fn push_slice(&mut self, counts: &[i32]) {
        self.accumulator
            .push_slice_observed(counts, &mut Fourths(&mut self.moments));
    }
}

impl<const OCTAVES: usize, const COVARIATES: usize, M, S, T> AxisSums<OCTAVES, COVARIATES, M, S, T>
where
    M: MomentPart,
    S: SpectrumPart,
    T: CoursePart,
{
    const NEW: Self = Self {
        accumulator: Accumulator::new(),
        integrity: Integrity::new(),
        moments: M::Sums::NEW,
        cross: [const { CrossSums::NEW }; COVARIATES],
        spectrum: S::Sums::NEW,
        course: T::Sums::NEW,
    };

    #[inline(always)]
    fn push(&mut self, count: i32, completed: &[Completed; COVARIATES]) {
        let Self {
            accumulator,
            moments,
            cross,
            ..
        } = self;
        let mut beside = DifferenceSums {
            moments,
            cross,
            completed,
        };
        accumulator.push_observed(count, &mut beside);
    }

    /// Adds the pending differences of the first octaves, which the accumulators no longer hand out after a loss.
    fn add_pending(&mut self, octaves: usize, covariates: &[Accumulator<OCTAVES>; COVARIATES]) {
        for octave in 0..octaves {
            let Some(difference) = self.accumulator.pending_difference(octave) else {
                continue;
            };
            self.moments.add(octave, difference);
            for (cross, covariate) in self.cross.iter_mut().zip(covariates) {
                if let Some(other) = covariate.pending_difference(octave) {
                    cross.add(octave, difference, other);
                }
            }
        }
    }
}

impl<const OCTAVES: usize, const COVARIATES: usize, M, const AXES: usize, S, T>
    AxesSums<OCTAVES, COVARIATES, M, AXES, S, T>
where
    M: MomentPart,
    S: SpectrumPart,
    T: CoursePart,
{
    pub(crate) const NEW: Self = Self {
        axes: [const { AxisSums::NEW }; AXES],
        covariates: [const { Accumulator::new() }; COVARIATES],
        between: [const { CrossSums::NEW }; COVARIATES],
        reads: Reads::new(),
    };

    pub(crate) fn set_limits(&mut self, limits: &'static Limits) -> Result<(), InvalidLimit> {
        let fresh = Integrity::with_limits(limits)?;
        for axis in &mut self.axes {
            axis.integrity = fresh.clone();
        }
        Ok(())
    }

    /// The accumulators of the axes, then those of the covariates.
    #[cfg(feature = "storage")]
    pub(crate) fn accumulators(&self) -> impl Iterator<Item = &Accumulator<OCTAVES>> {
        let axes = self.axes.iter().map(|axis| &axis.accumulator);
        axes.chain(&self.covariates)
    }

    /// The same, to be rebuilt.
    #[cfg(feature = "storage")]
    pub(crate) fn accumulators_mut(&mut self) -> impl Iterator<Item = &mut Accumulator<OCTAVES>> {
        let axes = self.axes.iter_mut().map(|axis| &mut axis.accumulator);
        axes.chain(&mut self.covariates)
    }

    #[inline(always)]
    pub(crate) fn push(&mut self, sample: &Sample<AXES, COVARIATES>) {
        self.sum(sample, true);
    }

    /// Adds a sample, or values that fill the place of a lost one.
    #[inline(never)]
    pub(crate) fn push_any(&mut self, sample: &Sample<AXES, COVARIATES>, is_measured: bool) {
        self.sum(sample, is_measured);
    }

    #[inline(always)]
    fn sum(&mut self, sample: &Sample<AXES, COVARIATES>, is_measured: bool) {
        if is_measured {
            self.reads.push(sample.counts);
        }
        for (axis, &count) in self.axes.iter_mut().zip(&sample.counts) {
            if is_measured {
                axis.integrity.push(count);
                axis.course.push(count, sample.covariates);
            }
            axis.spectrum.push(count);
        }
        let mut completed = [Completed([0; 4]); COVARIATES];
        if COVARIATES > 1 {
            completed = self.push_neighbours(sample.covariates);
        } else {
            let covariates = self.covariates.iter_mut().zip(&sample.covariates);
            for ((covariate, &count), completed) in covariates.zip(&mut completed) {
                covariate.push_observed(count, completed);
            }
        }
        for (axis, &count) in self.axes.iter_mut().zip(&sample.counts) {
            axis.push(count, &completed);
        }
        self.make_room();
    }

    /// Adds the counts of several covariates, and their products with their neighbours. A single covariate, or none, needs no more than its
    /// own sums.
    #[inline(never)]
    fn push_neighbours(&mut self, counts: [i32; COVARIATES]) -> [Completed; COVARIATES] {
        let mut completed = [Completed([0; 4]); COVARIATES];
        let sums = self.covariates.iter_mut().zip(&mut self.between);
        // What the first one adds to its sum of products is zero.
        let mut before = Completed([0; 4]);
        for ((covariate, between), (count, completed)) in
            sums.zip(counts.into_iter().zip(&mut completed))
        {
            let mut neighbours = Neighbours {
                completed: &mut *completed,
                before: &before,
                between,
            };
            covariate.push_observed(count, &mut neighbours);
            before = *completed;
        }
        completed
    }

    /// Transforms a segment of an axis of which half of the room for counts is taken. The axes take turns, so
    /// that one sample has to wait for one transform only. A segment is due every half of the room. So each of
    /// up to four axes gets its turn in time, even if segments of seven levels are due at once.
    #[inline(always)]
    fn make_room(&mut self) {
        let mut is_done = false;
        for axis in &mut self.axes {
            let is_due = match axis.spectrum.waits() {
                Waits::Little => false,
                Waits::Half => !is_done,
                Waits::Full => true,
            };
            if is_due {
                axis.spectrum.advance();
                is_done = true;
            }
        }
    }

    /// Does a part of the work of the spectra that waits, and tells whether there is more.
    pub(crate) fn advance(&mut self) -> bool {
        self.axes.iter_mut().any(|axis| axis.spectrum.advance())
    }

    /// Samples are missing at this place. If they are few, and their number is known, the sums of octaves and the spectrum go
    /// on with values that fill it.
    #[inline(never)]
    pub(crate) fn miss(&mut self, missing: Missing) {
        let known = if missing.has_more { 0 } else { missing.samples };
        // All accumulators take the same samples and gaps.
        let mut accumulators = self.axes.iter().map(|axis| &axis.accumulator);
        let touched = accumulators.next().and_then(|first| first.touched(known));
        let Some(touched) = touched else {
            return self.gap(missing.samples);
        };
        self.add_pending_between(touched);
        for axis in &mut self.axes {
            axis.add_pending(touched, &self.covariates);
            axis.integrity.gap();
            axis.course.gap(known);
        }
        self.reads.gap();
        let mut axes = self
            .axes
            .each_mut()
            .map(|axis| axis.accumulator.fill(known));
        let mut covariates = self
            .covariates
            .each_mut()
            .map(|covariate| covariate.fill(known));
        let next = |filling: &mut Option<Filling>| {
            let next = filling.as_mut().and_then(Iterator::next);
            next.unwrap_or(0)
        };
        for _ in 0..known {
            let sample = Sample {
                counts: axes.each_mut().map(next),
                covariates: covariates.each_mut().map(next),
            };
            self.push_any(&sample, false);
        }
    }

    /// No difference spans this place, where so many samples are missing, or an unknown number if it is 0.
    #[inline(never)]
    pub(crate) fn gap(&mut self, missing: u64) {
        self.add_pending_between(OCTAVES);
        for axis in &mut self.axes {
            axis.add_pending(OCTAVES, &self.covariates);
            axis.accumulator.gap();
            axis.integrity.gap();
            axis.spectrum.gap();
            axis.course.gap(missing);
        }
        self.covariates.iter_mut().for_each(Accumulator::gap);
        self.reads.gap();
    }

    /// As [`AxisSums::add_pending`], of the covariates among themselves.
    fn add_pending_between(&mut self, octaves: usize) {
        let pairs = self.covariates.windows(2);
        for (pair, between) in pairs.zip(self.between.iter_mut().skip(1)) {
            let [before, covariate] = pair else { continue };
            for octave in 0..octaves {
                let pending = before.pending_difference(octave);
                if let (Some(one), Some(other)) = (pending, covariate.pending_difference(octave)) {
                    between.add(octave, one, other);
                }
            }
        }
    }

    pub(crate) fn add_missing(&mut self, samples: u64) {
        for axis in &mut self.axes {
            axis.integrity.add_missing(samples);
        }
    }

    pub(crate) fn merge(&mut self, other: &Self) {
        self.gap(0);
        // The pending differences of the other record belong to its own sums.
        let mut other = other.clone();
        other.gap(0);
        for (own, other) in self.axes.iter_mut().zip(&other.axes) {
            own.accumulator.merge(&other.accumulator);
            own.integrity.merge(&other.integrity);
            own.moments.merge(&other.moments);
            own.spectrum.merge(&other.spectrum);
            for (own, other) in own.cross.iter_mut().zip(&other.cross) {
                own.merge(other);
            }
        }
        for (own, other) in self.covariates.iter_mut().zip(&other.covariates) {
            own.merge(other);
        }
        for (own, other) in self.between.iter_mut().zip(&other.between) {
            own.merge(other);
        }
        self.reads.merge(&other.reads);
    }
}
