//! One axis, or several axes that are recorded together: the parts that a record may have, and what is read from it.

#[doc(inline)]
pub use crate::{
    record::axis::{
        Axes, Axis, CoursePart, Courses, GatePart, Gated, MomentPart, Moments, Sample, SpectrumPart,
    },
    spectrum::{Spectral, SpectrumReading},
};

use super::{
    course::CosineTransform,
    covariate::{CrossCurve, Pair},
    kurtosis::Kurtosis,
    motion::{self, Slowness},
    record::Record,
};
use crate::{
    curve::{Curve, Scale},
    error::Error,
    list::numbered,
    numerics::real::Real,
    record::{
        axis::{
            courses::CourseSums as _,
            gate::{Gate, Passing as _},
            kept::AxisSums,
            moments::MomentSums as _,
        },
        integrity::{Reason, exceeds},
    },
    spectrum::Spectrum,
};
use heapless::Vec;

/// What is kept of a record of one axis: a [`Record`] that owns its parts. `D` is the type of its spectrum.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct AxisRecord<const OCTAVES: usize, const COVARIATES: usize = 0, D = Spectrum<0>> {
    /// The number of samples that are kept.
    pub samples: u64,
    /// The unit and the rate of the gyro, as they were passed.
    pub scale: Scale,
    /// The Allan curve.
    pub curve: Curve<OCTAVES>,
    /// The [mean rate](crate::Accumulator::mean_rate), in rate units.
    pub mean_rate: Option<Real>,
    /// The power spectral densities; without bins if no spectrum is kept.
    pub spectrum: D,
    /// The cosine transform of the course; `None` if no course is kept, or if it is too short.
    pub course: Option<CosineTransform>,
    /// The kurtosis of the differences, which shows whether they are Gaussian; `None` if fourth moments
    /// are not kept.
    pub kurtosis: Option<Kurtosis<OCTAVES>>,
    /// What the axis has in common with each covariate.
    pub covariates: Vec<CrossCurve<OCTAVES>, COVARIATES>,
    /// The pairs of neighbouring covariates, which may act together.
    pub pairs: Vec<Pair<OCTAVES>, COVARIATES>,
    /// The reason why the curve is not valid; `None` if it is valid.
    pub invalid: Option<Reason>,
}

impl<'a, const OCTAVES: usize, const COVARIATES: usize, const B: usize>
    From<&'a AxisRecord<OCTAVES, COVARIATES, Spectrum<B>>> for Record<'a, OCTAVES, B>
{
    fn from(record: &'a AxisRecord<OCTAVES, COVARIATES, Spectrum<B>>) -> Self {
        Self {
            curve: &record.curve,
            spectrum: Some(&record.spectrum),
            course: record.course.as_ref(),
            kurtosis: record.kurtosis.as_ref(),
            covariates: &record.covariates,
            pairs: &record.pairs,
            invalid: record.invalid,
        }
    }
}

/// The units of an axis and of its covariates: a [`Scale`], or, with covariates, a scale and the unit per count of each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units<const COVARIATES: usize = 0> {
    /// The unit and the rate of the gyro.
    pub scale: Scale,
    /// The unit per count of each covariate.
    pub per_count: [Real; COVARIATES],
}

impl From<Scale> for Units {
    fn from(scale: Scale) -> Self {
        Self {
            scale,
            per_count: [],
        }
    }
}

impl<const COVARIATES: usize> From<(Scale, [Real; COVARIATES])> for Units<COVARIATES> {
    fn from((scale, per_count): (Scale, [Real; COVARIATES])) -> Self {
        Self { scale, per_count }
    }
}

impl<const OCTAVES: usize, const COVARIATES: usize, G, M, const AXES: usize, S, T>
    Axes<OCTAVES, COVARIATES, G, M, AXES, S, T>
where
    G: GatePart,
    M: MomentPart,
    S: SpectrumReading,
    T: CoursePart,
{
    /// The record of an axis at its end: [releases](Self::release) the samples that the gate still holds back. `units` is
    /// the [`Scale`], or, with covariates, `(scale, [unit per count of each])`.
    ///
    /// # Errors
    /// [`Error::InvalidScale`] if a unit is not positive and finite; [`Error::UnknownAxis`] if there is no
    /// such axis.
    pub fn record(
        &mut self,
        axis: usize,
        units: impl Into<Units<COVARIATES>>,
    ) -> Result<AxisRecord<OCTAVES, COVARIATES, S::Spectrum>, Error> {
        self.release();
        self.record_so_far(axis, units)
    }

    /// The record of an axis at this moment, which goes on: without the samples that the gate holds back. The spectrum
    /// also lacks up to `P` samples that wait for [`advance`](Self::advance).
    ///
    /// # Errors
    /// As of [`record`](Self::record).
    pub fn record_so_far(
        &self,
        axis: usize,
        units: impl Into<Units<COVARIATES>>,
    ) -> Result<AxisRecord<OCTAVES, COVARIATES, S::Spectrum>, Error> {
        let Units { scale, per_count } = units.into();
        let sums = self.kept.axes.get(axis);
        let sums = sums.ok_or(Error::UnknownAxis { axis, axes: AXES })?;
        let mut covariates = Vec::new();
        let all = self.kept.covariates.iter().zip(&sums.cross).zip(per_count);
        for ((covariate, products), per_count) in all {
            let gyro = &sums.accumulator;
            let cross = CrossCurve::new(gyro, covariate, products, scale, per_count)?;
            // The vector has room for every covariate.
            let _ = covariates.push(cross);
        }
        let pairs = self.pairs(scale, per_count)?;
        let moments = sums.moments.moments();
        Ok(AxisRecord {
            samples: sums.accumulator.samples(),
            scale,
            curve: sums.accumulator.curve(scale),
            mean_rate: sums.accumulator.mean_rate(scale),
            spectrum: S::spectrum(&sums.spectrum, &sums.accumulator, scale),
            course: sums
                .course
                .course()
                .and_then(|course| course.cosine_transform(scale)),
            kurtosis: moments.map(|moments| moments.kurtosis(&sums.accumulator)),
            covariates,
            pairs,
            invalid: self.verdict(axis).or_else(|| self.motion(scale)),
        })
    }

    /// What neighbouring covariates have in common.
    fn pairs(
        &self,
        scale: Scale,
        per_count: [Real; COVARIATES],
    ) -> Result<Vec<Pair<OCTAVES>, COVARIATES>, Error> {
        let mut pairs = Vec::new();
        let neighbours = self.kept.covariates.windows(2).zip(per_count.windows(2));
        let neighbours = neighbours.zip(self.kept.between.iter().skip(1));
        for (place, ((covariates, units), products)) in numbered(neighbours) {
            let ([one, other], &[unit, other_unit]) = (covariates, units) else {
                continue;
            };
            let own = Scale::new(unit, scale.rate_hz())?;
            let shared = CrossCurve::new(one, other, products, own, other_unit)?;
            // There is room for every covariate.
            let _ = pairs.push(Pair {
                covariates: [place, place.saturating_add(1)],
                shared,
            });
        }
        Ok(pairs)
    }

    /// Motion that never stopped, which the curves of all axes show together.
    #[inline(never)]
    fn motion(&self, scale: Scale) -> Option<Reason> {
        let axes = self.kept.axes.each_ref();
        let read = axes.map(|axis| Slowness::of(&axis.accumulator.curve(scale)));
        motion::judge_axes(&read, scale.per_degree())
    }

    /// The reason why the curve of an axis is not valid; `None` if it is valid.
    ///
    /// The verdict is that of [`Integrity`](crate::integrity::Integrity) on the record that is kept, of what a reader
    /// [made](crate::faults::Reads) of the samples, and of a change of the noise, if its [course](Courses) is kept. A [record](Self::record) also shows
    /// [motion](crate::motion) that never stopped, for which its scale is needed. Motion in one axis makes all axes
    /// invalid, because a gyro that turns about one axis is not at rest about the others. A record is also
    /// invalid if the gate left out a larger share of its samples than
    /// [`left_out_per_mille`](crate::integrity::Limits::left_out_per_mille) allows, which is one in four by default.
    pub fn verdict(&self, axis: usize) -> Option<Reason> {
        // The rounding of pulses of an angle is carried over to the next sample.
        let has_pulses = AXES == 3 && self.kept.reads.joint().is_alternating();
        let verdict = |axis: &AxisSums<_, _, _, _, _>| {
            let is_rounded = |reason: &Reason| {
                let is_coarse = matches!(reason, Reason::Coarse { .. });
                !is_coarse || !has_pulses && !axis.accumulator.carries_rounding()
            };
            axis.integrity.verdict().filter(is_rounded)
        };
        let own = self.kept.axes.get(axis);
        let all = self.kept.axes.iter();
        let moved = |reason: &Reason| matches!(reason, Reason::Moved { .. });
        let others = all.filter_map(verdict).find(moved);
        let left_out = self
            .gate
            .gate()
            .and_then(|gate| self.left_out_too_much(gate));
        let reads = self.kept.reads.verdict();
        let unanswered = reads.filter(|reason| matches!(reason, Reason::Unanswered { .. }));
        let first = unanswered.or_else(|| own.and_then(verdict)).or(others);
        let known = first.or(reads).or(left_out);
        // A change of the noise of this axis explains what only others show.
        let is_of_others = known.as_ref().is_some_and(moved)
            && own.is_some_and(|axis| axis.integrity.verdict().is_none());
        let course = own.and_then(|sums| sums.course.course());
        let own = known.filter(|_| !is_of_others);
        course
            .map_or(own, |course| course.or_changed(own))
            .or(known)
    }

    fn left_out_too_much(&self, gate: &Gate<AXES, COVARIATES>) -> Option<Reason> {
        let left_out = gate.left_out();
        let samples = self.samples().saturating_add(left_out);
        let most = self.limits().left_out_per_mille;
        exceeds(left_out.into(), samples.into(), most)
            .then_some(Reason::LeftOut { left_out, samples })
    }
}
