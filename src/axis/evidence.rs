//! What a record tells of one axis: its curve, and all that a diagnosis takes beside it.

use super::{
    Axes,
    gate::{Gate, GatePart, Passing as _},
    moments::{MomentPart, MomentSums as _},
};
use crate::{
    covariate::CrossCurve,
    curve::{Curve, Scale},
    diagnosis::Evidence,
    error::Error,
    integrity::{Integrity, Reason, exceeds},
    kurtosis::Kurtosis,
    real::Real,
};
use heapless::Vec;

/// What a record tells of one axis.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct AxisEvidence<const OCTAVES: usize, const COVARIATES: usize = 0> {
    /// Samples that are kept.
    pub samples: u64,
    /// The Allan curve.
    pub curve: Curve<OCTAVES>,
    /// Whether the differences are Gaussian; `None` where fourth moments are not kept.
    pub kurtosis: Option<Kurtosis<OCTAVES>>,
    /// What the axis shares with every covariate.
    pub covariates: Vec<CrossCurve<OCTAVES>, COVARIATES>,
    /// Why the curve is not valid; `None` where it is.
    pub invalid: Option<Reason>,
}

impl<const OCTAVES: usize, const COVARIATES: usize> AxisEvidence<OCTAVES, COVARIATES> {
    /// What a diagnosis takes beside the curve.
    pub fn evidence(&self) -> Evidence<'_, OCTAVES> {
        Evidence {
            kurtosis: self.kurtosis.as_ref(),
            covariates: &self.covariates,
            invalid: self.invalid,
        }
    }
}

impl<const OCTAVES: usize, const COVARIATES: usize, G, M, const AXES: usize>
    Axes<OCTAVES, COVARIATES, G, M, AXES>
where
    G: GatePart,
    M: MomentPart,
{
    /// What the record tells of an axis as of now, without the samples that the gate holds back.
    /// `per_count` is the unit of every covariate per count.
    ///
    /// # Errors
    /// [`Error::InvalidScale`] unless every unit is positive and finite; [`Error::UnknownAxis`].
    pub fn evidence(
        &self,
        axis: usize,
        scale: Scale,
        per_count: [Real; COVARIATES],
    ) -> Result<AxisEvidence<OCTAVES, COVARIATES>, Error> {
        let sums = self.kept.axes.get(axis);
        let sums = sums.ok_or(Error::UnknownAxis { axis, axes: AXES })?;
        let mut covariates = Vec::new();
        let all = self.kept.covariates.iter().zip(&sums.cross).zip(per_count);
        for ((covariate, products), per_count) in all {
            let gyro = &sums.accumulator;
            let cross = CrossCurve::new(gyro, covariate, products, scale, per_count)?;
            // There are as many as there is room for.
            let _ = covariates.push(cross);
        }
        let moments = sums.moments.moments();
        Ok(AxisEvidence {
            samples: sums.accumulator.samples(),
            curve: sums.accumulator.curve(scale),
            kurtosis: moments.map(|moments| moments.kurtosis(&sums.accumulator)),
            covariates,
            invalid: self.verdict(axis),
        })
    }

    /// Why the curve of an axis is not valid; `None` where it is.
    ///
    /// The verdict is that of [`Integrity`] on the record that is kept. Motion in any axis makes all of them
    /// invalid, because a gyro that turns about one axis was not at rest about another. A record of which
    /// the gate left out more than [`left_out_per_mille`](crate::Limits::left_out_per_mille), one sample in
    /// four by default, is invalid too.
    pub fn verdict(&self, axis: usize) -> Option<Reason> {
        let verdict = |integrity: &Integrity| integrity.verdict();
        let own = self.kept.axes.get(axis).map(|axis| &axis.integrity);
        let all = self.kept.axes.iter().map(|axis| &axis.integrity);
        let moved = |reason: &Reason| matches!(reason, Reason::Moved { .. });
        let others = all.filter_map(verdict).find(moved);
        let left_out = self
            .gate
            .gate()
            .and_then(|gate| self.left_out_too_much(gate));
        own.and_then(verdict).or(others).or(left_out)
    }

    fn left_out_too_much(&self, gate: &Gate<AXES, COVARIATES>) -> Option<Reason> {
        let left_out = gate.left_out();
        let samples = self.samples().saturating_add(left_out);
        let most = self.limits().left_out_per_mille;
        exceeds(left_out.into(), samples.into(), most)
            .then_some(Reason::LeftOut { left_out, samples })
    }
}
