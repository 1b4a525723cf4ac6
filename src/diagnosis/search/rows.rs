//! What a search compares with its hypotheses: the densities of all bins and, below them, the course or the octaves.

use super::values::{LOW, Values};
use crate::{
    curve::{Point, clusters},
    evidence::{course::CosineTransform, observed::Observed},
    fit::Rows,
    list::numbered,
    numerics::real::{Real, real, single},
    spectrum::{Spectrum, WHITE_DENSITY, levels_of},
    theory::{
        effect::{Effect, Span},
        model::Term,
    },
};

/// Neighbouring bins of Hann's window scatter together: `1 + 2 (4/9 + 1/36)` of them count as one.
const BINS_AS_ONE: Real = 1.944;

/// The degrees of freedom of an octave for each of its clusters. Chosen by hand, between those of white noise, 1.4, and of
/// random walks.
const PER_CLUSTER: Real = 1.2;

/// Neighbouring octaves scatter together: `1 + 2 (0.6 + 0.2)` of them count as one, for noise between white and flicker.
const OCTAVES_TOGETHER: Real = 2.6;

/// The surcharge of octaves alone: with it, an effect is reported in one of 200 clean records.
const OCTAVES_ALONE: Real = 4.0;

/// The share of a density by which no model is believed to be true, which is added to its relative error. Chosen by hand:
/// a third of the tolerance of a fit.
const TOLERANCE: Real = 0.003;

/// Cosine coefficients are taken up to this share of the lowest bin's frequency: to where Hann's window begins to see.
const BELOW: Real = 0.625;

/// A row with fewer degrees of freedom is smoothed before a solution starts from it.
const SPARSE: Real = 10.0;

/// What lies below the bins.
enum Low<'a> {
    Course(&'a CosineTransform),
    Octaves(&'a [Point]),
}

/// A record as a search sees it: rows that are nearly independent, each with the gamma distribution.
pub(crate) struct Observation<'a, const B: usize> {
    spectrum: Option<&'a Spectrum<B>>,
    low: Low<'a>,
    lows: usize,
    bins: usize,
    pub(super) interval_s: Real,
    pub(super) span: Span,
    /// The length of the record in seconds.
    pub(crate) duration_s: Real,
    /// The shape of each row's gamma distribution: half of its degrees of freedom.
    pub(super) shape: Values<B>,
    /// Where a solution starts: the measurement, smoothed where it is sparse, relative to itself.
    pub(super) start: Values<B>,
    /// The reciprocal of what was measured.
    per_measured: Values<B>,
}

impl<'a, const B: usize> Observation<'a, B> {
    /// The rows of a record.
    #[inline(never)]
    pub(crate) fn new<const K: usize>(
        observed: Observed<'a, K, B>,
        course: Option<&'a CosineTransform>,
    ) -> Self {
        let spectrum = observed.spectrum();
        let all = spectrum.map_or(&[][..], |spectrum| spectrum.all());
        let points = observed.curve().points();
        let (low, lows) = match (course, all.last()) {
            (Some(course), Some(last)) => {
                let lowest = levels_of(all).last().and_then(|level| level.first());
                let below = BELOW * lowest.unwrap_or(last).frequency_hz;
                let places = 0..course.densities().len().min(LOW);
                let count = places.filter(|&place| course.frequency_hz(place) < below);
                (Low::Course(course), crate::list::count(count))
            }
            (_, last) => {
                let from = last.map_or(0, |last| last.block.saturating_mul(8));
                let first = points.partition_point(|point| point.m < from);
                let points = points.get(first..).unwrap_or_default();
                (Low::Octaves(points), points.len().min(LOW))
            }
        };
        let longest = points.first().map_or(0.0, clusters);
        let mut observation = Self {
            spectrum,
            low,
            lows,
            bins: all.len(),
            interval_s: observed.interval_s(),
            span: observed.span(),
            duration_s: longest * observed.interval_s(),
            shape: Values::zeros(lows),
            // Bins that there are not weigh nothing, and divide by one.
            start: Values::constant(lows, 1.0),
            per_measured: Values::zeros(lows),
        };
        observation.measure(all, &|bin| observed.effective_segments(bin));
        observation
    }

    /// Sets what was measured.
    #[inline(never)]
    fn measure(
        &mut self,
        all: &[crate::spectrum::Bin],
        degrees: &dyn Fn(&crate::spectrum::Bin) -> Real,
    ) {
        for row in 0..self.lows {
            let (measured, shape) = match &self.low {
                Low::Course(course) => {
                    let density = course.densities().get(row);
                    (density.copied().unwrap_or(0.0), 0.5)
                }
                Low::Octaves(points) => points.get(row).map_or((0.0, 0.0), |point| {
                    let freedom = PER_CLUSTER * (clusters(point) - 1.0).max(0.5);
                    (point.variance, 0.5 * freedom)
                }),
            };
            self.put(row, measured, shape);
        }
        for (b, bin) in numbered(all) {
            let shape = degrees(bin) / BINS_AS_ONE;
            self.put(LOW.saturating_add(b), bin.density, shape);
        }
        self.smooth(all);
    }

    fn put(&mut self, row: usize, measured: Real, shape: Real) {
        // A row of zero has no logarithm. It weighs nothing.
        let is_sound = measured > Real::MIN_POSITIVE && measured.is_finite() && shape > 0.0;
        let (per_measured, shape) = if is_sound {
            (1.0 / measured, 1.0 / (1.0 / shape + TOLERANCE * TOLERANCE))
        } else {
            (0.0, 0.0)
        };
        self.per_measured.put(row, single(per_measured));
        self.shape.put(row, single(shape));
        self.start.put(row, 1.0);
    }

    /// Smooths the rows that are sparse, over up to three neighbours at either side.
    fn smooth(&mut self, all: &[crate::spectrum::Bin]) {
        let group = |row: usize| {
            let bin = row.checked_sub(LOW).and_then(|bin| all.get(bin));
            bin.map(|bin| bin.block)
        };
        let rows = self.rows();
        for row in rows.clone() {
            if real(self.shape[row]) >= SPARSE || self.per_measured[row] == 0.0 {
                continue;
            }
            let near = rows.clone().filter(|&other| {
                other.abs_diff(row) < 4
                    && group(other) == group(row)
                    && self.per_measured[other] > 0.0
            });
            let (mut sum, mut number) = (0.0, 0.0);
            for other in near {
                sum += 1.0 / real(self.per_measured[other]);
                number += 1.0;
            }
            let smooth = sum / number * real(self.per_measured[row]);
            self.start.put(row, single(smooth));
        }
    }

    /// The rows: those below the bins, then the bins.
    pub(crate) fn rows(&self) -> impl Iterator<Item = usize> + Clone + use<B> {
        (0..self.lows).chain(LOW..LOW.saturating_add(self.bins.min(B)))
    }

    /// The levels of the spectrum, shortest blocks first: the first row of each, and its bins.
    pub(super) fn levels(
        &self,
    ) -> impl Iterator<Item = (usize, &'a [crate::spectrum::Bin])> + use<'a, B> {
        let all = self.spectrum.map_or(&[][..], |spectrum| spectrum.all());
        let mut row = LOW;
        levels_of(all).map(move |level| {
            let first = row;
            row = row.saturating_add(level.len());
            (first, level)
        })
    }

    /// About what `−2 ln L` of a true model is.
    pub(super) fn expected_deviance(&self) -> Real {
        // A row of shape ν adds 2ν (ln ν − ψ(ν)), which is near one, and 1.27 for one degree of freedom.
        let per_low = match &self.low {
            Low::Course(_) => 1.27,
            Low::Octaves(_) => 1.0,
        };
        real(self.bins as u32) / BINS_AS_ONE + per_low * real(self.lows as u32)
    }

    /// The frequency of a row and the distance of its neighbours, in Hz; `None` for an octave.
    pub(super) fn place(&self, row: usize) -> Option<(Real, Real)> {
        let Some(bin) = row.checked_sub(LOW) else {
            return match &self.low {
                Low::Course(course) => Some((course.frequency_hz(row), course.frequency_hz(0))),
                Low::Octaves(_) => None,
            };
        };
        let bin = self.spectrum?.all().get(bin)?;
        Some((bin.frequency_hz, bin.frequency_hz / real(bin.index)))
    }

    /// What a density would be in a row, relative to the measurement.
    pub(super) fn relative(&self, row: usize, density: Real) -> f32 {
        single(density * real(self.per_measured[row]))
    }

    /// A number relative to what was measured, as a share of what white noise with a coefficient of one would be there.
    pub(super) fn of_white(&self, row: usize, relative: f32) -> f32 {
        let per_measured = self.per_measured[row];
        let white = match &self.low {
            Low::Octaves(points) if row < LOW => {
                let m = points.get(row).map_or(1.0, |point| real(point.m));
                single(1.0 / (m * self.interval_s))
            }
            _ => WHITE_DENSITY,
        };
        if per_measured > 0.0 {
            relative / (per_measured * white)
        } else {
            1.0
        }
    }

    /// What every effect costs more where the rows are octaves, which scatter together more than they are taken to.
    pub(crate) const fn surcharge(&self) -> Real {
        if self.has_bins() { 0.0 } else { OCTAVES_ALONE }
    }

    /// The variance of a sum over rows near a row, relative to that of rows that are independent.
    pub(crate) fn overlap(&self, row: usize) -> Real {
        match &self.low {
            Low::Octaves(_) if row < LOW => OCTAVES_TOGETHER,
            _ => 1.0,
        }
    }

    /// Whether there are bins.
    pub(crate) const fn has_bins(&self) -> bool {
        self.bins > 0
    }

    /// What a term would add to each row, relative to the measurement, times a factor. Without a factor, the largest
    /// number is one. Returns the factor, or zero if the term adds nothing.
    pub(crate) fn column(&self, term: &Term, factor: Option<Real>, values: &mut Values<B>) -> Real {
        self.column_of(term.effect, term, factor, values)
    }

    /// The same of an effect with the shape of a term.
    #[inline(never)]
    pub(super) fn column_of(
        &self,
        effect: &dyn Effect,
        term: &Term,
        factor: Option<Real>,
        values: &mut Values<B>,
    ) -> Real {
        let shape = term.sampled_shape(self.interval_s);
        let mut largest: Real = 0.0;
        // The range of single precision holds no square of a ramp at the longest times, so that numbers are scaled first.
        let mut raw = Rows::<LOW, B, Real>::ZEROS;
        let mut row = 0_usize;
        let mut low = |value: Real| {
            let value = (value * real(self.per_measured[row])).max(0.0);
            largest = largest.max(value);
            raw.put(row, value);
            row = row.saturating_add(1);
        };
        match &self.low {
            Low::Course(course) => {
                course.each_expected(effect, term.parameters, self.lows, &mut low);
            }
            Low::Octaves(points) => {
                let mut factors = points.iter().take(self.lows).map(|point| real(point.m));
                effect.variances(&mut factors, &shape, &mut low);
            }
        }
        if let Some(spectrum) = self.spectrum {
            let mut row = LOW;
            spectrum.each_expected(effect, term.parameters, &mut |value| {
                let value = (value * real(self.per_measured[row])).max(0.0);
                largest = largest.max(value);
                raw.put(row, value);
                row = row.saturating_add(1);
            });
        }
        let factor = factor.unwrap_or(if largest > 0.0 && largest.is_finite() {
            1.0 / largest
        } else {
            0.0
        });
        *values = Values::zeros(self.lows);
        for row in self.rows() {
            values.put(row, single(raw[row] * factor));
        }
        factor
    }
}
