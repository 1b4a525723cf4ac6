//! What is known of a record, and what each effect of a model would contribute to it.

use super::{result::Fit, rows::Rows};
use crate::{
    curve::{Point, clusters},
    error::Error,
    evidence::observed::Observed,
    limits::MAX_EFFECTS,
    list::{self, numbered},
    numerics::{
        math,
        nnls::{PassiveSet, Vector},
        real::{Real, real, single},
    },
    spectrum::{Bin, WHITE_DENSITY},
    theory::{
        effect::{Behind, Effect},
        model::{Model, Term, is_passed},
    },
};
use heapless::Vec;

/// Allan variances and densities of each effect of a model in the octaves and bins that are fitted, for
/// coefficients of one. The rounding of single precision is far below what any record can show.
#[derive(Clone, Debug)]
pub(crate) struct Columns<const K: usize, const B: usize = 0>(Vec<Rows<K, B, f32>, MAX_EFFECTS>);

impl<const K: usize, const B: usize> Columns<K, B> {
    /// Columns of no model yet.
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const EMPTY: Self = Self(Vec::new());

    /// The columns of a model.
    pub(crate) fn new(observed: Observed<'_, K, B>, model: &Model) -> Self {
        let mut columns = Self::EMPTY;
        columns.set(observed, model);
        columns
    }

    /// Computes the columns of a model in place.
    #[inline(never)]
    pub(crate) fn set(&mut self, observed: Observed<'_, K, B>, model: &Model) {
        let terms = model.terms().iter();
        self.0 = list::fill(terms.map(|term| column(observed, term).map(single)));
        if let Some((place, _)) = model.passing() {
            self.pass(observed, model, place);
        }
    }

    /// Lets all noise without a shape pass the filter at a place of the model.
    #[inline(never)]
    fn pass(&mut self, observed: Observed<'_, K, B>, model: &Model, place: usize) {
        let Some(filter) = self.0.get(place).copied() else {
            return;
        };
        let interval_s = observed.interval_s();
        for ((i, term), column) in numbered(model.terms()).zip(self.0.iter_mut()) {
            let Some(through) = model.filter_of(i) else {
                continue;
            };
            let shape = through.sampled_shape(interval_s);
            if let Some(behind) = Behind::new(term.effect, through.effect, &shape) {
                *column = column_of(observed, &behind, through).map(single);
                continue;
            }
            for (row, point) in numbered(observed.points()) {
                let passed = model.unit_variance(i, real(point.m), interval_s);
                column.put(row, single(passed.max(0.0)));
            }
            for b in 0..observed.bins().len().min(B) {
                let row = K.saturating_add(b);
                column.put(row, column[row] * filter[row] / WHITE_DENSITY);
            }
        }
    }
}

/// The Allan variances and densities of one effect, for a coefficient of one.
fn column<const K: usize, const B: usize>(observed: Observed<'_, K, B>, term: &Term) -> Rows<K, B> {
    column_of(observed, term.effect, term)
}

/// The same of an effect with the shape of a term.
fn column_of<const K: usize, const B: usize>(
    observed: Observed<'_, K, B>,
    effect: &dyn Effect,
    term: &Term,
) -> Rows<K, B> {
    let mut column = Rows::ZEROS;
    let mut row = 0_usize;
    let mut factors = observed.points().iter().map(|point| real(point.m));
    let shape = term.sampled_shape(observed.interval_s());
    effect.variances(&mut factors, &shape, &mut |variance| {
        // Where a shape lies far beyond what a record can tell, rounding may leave less than zero.
        column.put(row, variance.max(0.0));
        row = row.saturating_add(1);
    });
    if let Some(spectrum) = observed.spectrum() {
        let expected = spectrum.expected(effect, term.parameters);
        for (row, &expected) in (K..usize::MAX).zip(&expected) {
            column.put(row, expected.max(0.0));
        }
    }
    column
}

/// Octaves and bins, a model, and the columns of that model. This is what a fit works on. Each octave and each bin
/// is a row, with the same numbers as in [`Rows`].
///
/// Variances, densities and squared coefficients are counted in the curve's `variance_unit`, so that their squares
/// stay within the range of single precision.
#[derive(Clone, Copy)]
pub(crate) struct Problem<'a, const K: usize, const B: usize = 0> {
    pub(crate) observed: Observed<'a, K, B>,
    /// The octaves that are fitted.
    pub(crate) points: &'a [Point],
    pub(crate) bins: &'a [Bin],
    pub(crate) model: &'a Model,
    pub(crate) interval_s: Real,
    pub(crate) variance_unit: Real,
    per_unit: Real,
    columns: &'a Columns<K, B>,
}

impl<'a, const K: usize, const B: usize> Problem<'a, K, B> {
    /// The problem of a model whose columns are known.
    pub(crate) fn new(
        observed: Observed<'a, K, B>,
        model: &'a Model,
        columns: &'a Columns<K, B>,
    ) -> Self {
        let unit = observed.curve().variance_unit();
        Self {
            observed,
            points: observed.points(),
            bins: observed.bins(),
            model,
            interval_s: observed.interval_s(),
            variance_unit: unit,
            per_unit: 1.0 / unit,
            columns,
        }
    }

    /// The rows of all octaves and bins.
    pub(crate) fn rows(&self) -> impl Iterator<Item = usize> + Clone + use<K, B> {
        let bins = K..K.saturating_add(self.bins.len().min(B));
        (0..self.points.len().min(K)).chain(bins)
    }

    /// The number of rows.
    pub(crate) fn row_count(&self) -> usize {
        self.points.len().saturating_add(self.bins.len())
    }

    /// The contribution of one effect, for a coefficient of one.
    pub(crate) fn column(&self, term: &Term) -> Rows<K, B> {
        column(self.observed, term)
    }

    /// The columns of the model.
    pub(crate) fn columns(&self) -> &'a [Rows<K, B, f32>] {
        &self.columns.0
    }

    /// The measured variance or density of a row.
    pub(crate) fn measured(&self, row: usize) -> Real {
        let measured = match row.checked_sub(K) {
            None => self.points.get(row).map_or(0.0, |point| point.variance),
            Some(bin) => self.bins.get(bin).map_or(0.0, |bin| bin.density),
        };
        measured * self.per_unit
    }

    /// The relative accuracy of a row whose measurement is independent of all others: that of the paper for an
    /// octave, and `1/√n` for a bin of `n` independent segments.
    pub(crate) fn relative_accuracy(&self, row: usize) -> Real {
        match row.checked_sub(K) {
            None => self.points.get(row).map_or(1.0, relative_accuracy),
            Some(bin) => self
                .bins
                .get(bin)
                .map_or(1.0, |bin| 1.0 / math::sqrt(self.effective_segments(bin))),
        }
    }

    /// The number of independent segments that would scatter as much as those of a bin. In a record with gaps, fewer
    /// segments overlap than [`Bin::effective_segments`] takes for granted: the first one of each stretch has none before
    /// it. As many stretches have segments as have differences that span a segment.
    pub(crate) fn effective_segments(&self, bin: &Bin) -> Real {
        self.observed.effective_segments(bin)
    }

    /// The squared coefficients of a fit.
    pub(crate) fn squares_of(&self, fit: &Fit) -> Vector {
        Vector::from_fn(|i| {
            let coefficient = fit.coefficients.get(i);
            coefficient.map_or(0.0, |coefficient| coefficient.square * self.per_unit)
        })
    }

    /// What effect `i` contributes to a row, for a coefficient of one.
    pub(crate) fn unit(&self, i: usize, row: usize) -> Real {
        let column = self.columns.0.get(i);
        column.map_or(0.0, |column| real(column[row]))
    }

    /// The share of effect `i` in the model's value of a row, from 0 to 1. It is 0 for an effect beyond the
    /// model.
    pub(crate) fn share(&self, row: usize, i: usize, squares: &Vector) -> Real {
        if i < self.count() {
            self.unit(i, row) * squares[i] / self.variance(row, squares)
        } else {
            0.0
        }
    }

    /// The choice of coefficients that are held at zero.
    pub(crate) fn pinned(&self) -> PassiveSet {
        PassiveSet::of(|i| self.model.terms().get(i).is_some_and(|term| term.pinned))
    }

    /// The number of coefficients.
    pub(crate) fn count(&self) -> usize {
        self.model.terms().len()
    }

    /// What passes the filter at a place of the model in a row, the white noise and all other noise, relative to the white
    /// noise alone. It is one for a filter that the white noise alone passes.
    pub(crate) fn passed(&self, place: usize, row: usize, squares: &Vector) -> Real {
        let own = self.unit(place, row) * squares[place];
        match self.model.passing() {
            Some((filter, _)) if filter == place && own > 0.0 => {
                let terms = numbered(self.model.terms().iter());
                let others = terms.filter(|(_, term)| is_passed(term));
                let others: Real = others.map(|(i, _)| self.unit(i, row) * squares[i]).sum();
                1.0 + others / own
            }
            _ => 1.0,
        }
    }

    /// The squared coefficients that give a model without the filter that all noise passes the variances that this model has
    /// at an averaging factor.
    pub(crate) fn squares_at(&self, m: Real, squares: &Vector) -> Vector {
        if self.model.passing().is_none() {
            return *squares;
        }
        let mut passed = *squares;
        for (i, term) in numbered(self.model.terms().iter()) {
            if is_passed(term) {
                let plain = term
                    .effect
                    .variance(m, &term.sampled_shape(self.interval_s));
                let behind = self.model.unit_variance(i, m, self.interval_s);
                passed.put(i, squares[i] * (behind / plain).max(0.0));
            }
        }
        passed
    }

    /// The deterministic effects.
    pub(crate) fn deterministic(&self) -> PassiveSet {
        let is_deterministic = |term: &Term| {
            let shape = term.sampled_shape(self.interval_s);
            term.effect.response(1.0, &shape).is_some()
        };
        PassiveSet::of(|i| self.model.terms().get(i).is_some_and(is_deterministic))
    }

    /// The share of these effects in the model's value of a row, from 0 to 1.
    pub(crate) fn share_of(&self, effects: &PassiveSet, row: usize, squares: &Vector) -> Real {
        let places = (0..self.count()).filter(|&i| effects.has(i));
        places.map(|i| self.share(row, i, squares)).sum()
    }

    /// The model's variance or density of a row.
    pub(crate) fn variance(&self, row: usize, squares: &Vector) -> Real {
        (0..self.count())
            .map(|i| self.unit(i, row) * squares[i])
            .sum()
    }
}

/// Checks that a curve can be fitted: it must have at least `needed` octaves, and noise in each.
pub(crate) fn check(points: &[Point], needed: usize) -> Result<(), Error> {
    if points.len() < needed {
        return Err(Error::TooFewOctaves {
            found: points.len(),
            needed,
        });
    }
    let is_silent = |point: &&Point| {
        let has_noise = 0.0 < point.variance;
        !has_noise
    };
    if let Some(point) = points.iter().find(is_silent) {
        return Err(Error::NoNoise { m: point.m });
    }
    Ok(())
}

/// The relative accuracy of an octave by Lv, Liu, Lai & Huang 2015: `δ = 1/√(2(N/m − 1))`.
pub(crate) fn relative_accuracy(point: &Point) -> Real {
    1.0 / math::sqrt(2.0 * (clusters(point) - 1.0))
}
