//! What a fit works on.

use crate::{
    curve::{Curve, Point},
    numerics::real::Real,
    spectrum::{Bin, Spectrum},
    theory::effect::Span,
};

/// A bin takes the place of the octaves that end below this share of the longest block's segment. The octaves
/// from there on hold what lies below the lowest bin.
const OCTAVES_FROM: u32 = 8;

/// What is known of a record: its curve, and its spectrum if there is one.
///
/// A fit to both uses all bins of the spectrum, and the octaves that reach below the lowest bin. The other octaves
/// say nothing that the bins do not say, so that they are compared with the model but not fitted. Only the coefficients
/// of a model without shapes that explains the record come from all octaves, which tell them better than bins do.
#[derive(Debug)]
pub(crate) struct Observed<'a, const K: usize, const B: usize = 0> {
    curve: &'a Curve<K>,
    spectrum: Option<&'a Spectrum<B>>,
}

impl<const K: usize, const B: usize> Clone for Observed<'_, K, B> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<const K: usize, const B: usize> Copy for Observed<'_, K, B> {}

impl<'a, const K: usize> From<&'a Curve<K>> for Observed<'a, K> {
    fn from(curve: &'a Curve<K>) -> Self {
        Self::of_curve(curve)
    }
}

impl<'a, const K: usize, const B: usize> Observed<'a, K, B> {
    /// A curve and the spectrum of the same record. A spectrum without bins changes nothing.
    pub(crate) const fn new(curve: &'a Curve<K>, spectrum: &'a Spectrum<B>) -> Self {
        Self {
            curve,
            spectrum: Some(spectrum),
        }
    }

    /// A curve without a spectrum.
    pub(crate) const fn of_curve(curve: &'a Curve<K>) -> Self {
        Self {
            curve,
            spectrum: None,
        }
    }

    /// The curve.
    pub(crate) const fn curve(&self) -> &'a Curve<K> {
        self.curve
    }

    /// The curve alone.
    pub(crate) const fn octaves(&self) -> Self {
        Self {
            spectrum: None,
            ..*self
        }
    }

    /// The spectrum, if there is one that has bins.
    pub(crate) fn spectrum(&self) -> Option<&'a Spectrum<B>> {
        if B == 0 {
            return None;
        }
        self.spectrum.filter(|spectrum| !spectrum.bins().is_empty())
    }

    /// The number of independent segments that would scatter as much as those of a bin. In a record with gaps, fewer
    /// segments overlap than [`Bin::effective_segments`] takes for granted: the first one of each stretch has none before
    /// it. As many stretches have segments as have differences that span a segment.
    pub(crate) fn effective_segments(&self, bin: &Bin) -> Real {
        let spectrum = self.spectrum();
        let segment = spectrum.map_or(0, |spectrum| spectrum.segment());
        let half = bin.block.saturating_mul(segment / 2);
        let points = self.curve.points();
        let as_long = points
            .iter()
            .find(|point| point.m >= half)
            .or(points.last());
        let stretches = as_long.map_or(1, |point| point.stretches);
        bin.effective_segments_of(stretches)
    }

    /// The bins of the spectrum.
    pub(crate) fn bins(&self) -> &'a [Bin] {
        // Known to the compiler, which leaves out what works on bins.
        if B == 0 {
            return &[];
        }
        self.spectrum.map_or(&[], |spectrum| spectrum.bins())
    }

    /// The octaves that are fitted.
    pub(crate) fn points(&self) -> &'a [Point] {
        let points = self.curve.points();
        let Some(last) = self.bins().last() else {
            return points;
        };
        let from = last.block.saturating_mul(OCTAVES_FROM);
        let first = points.partition_point(|point| point.m < from);
        points.get(first..).unwrap_or_default()
    }

    /// The number of octaves and bins that are fitted.
    pub(crate) fn rows(&self) -> usize {
        self.points().len().saturating_add(self.bins().len())
    }

    /// Sample interval, in seconds.
    pub(crate) fn interval_s(&self) -> Real {
        self.curve.interval_s()
    }

    /// The range of times that is covered.
    pub(crate) fn span(&self) -> Span {
        self.curve.span()
    }
}
