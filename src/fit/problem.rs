//! A curve, and what each effect of a model would contribute to it.

use super::result::Fit;
use crate::{
    algebra,
    curve::{Curve, Point, clusters},
    error::Error,
    limits::MAX_EFFECTS,
    list, math,
    model::{Model, Term},
    nnls::{Free, Vector},
    real::{Real, real, single},
};
use heapless::Vec;

/// Allan variances of each effect of a model at the averaging times of a curve, for coefficients of
/// one. The rounding of single precision is far below what any record can show.
#[derive(Clone, Debug)]
pub(crate) struct Columns<const K: usize>(Vec<algebra::Vector<K, f32>, MAX_EFFECTS>);

impl<const K: usize> Columns<K> {
    /// Columns of no model yet.
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const EMPTY: Self = Self(Vec::new());

    /// The columns of a model.
    pub(crate) fn new(curve: &Curve<K>, model: &Model) -> Self {
        let mut columns = Self::EMPTY;
        columns.set(curve, model);
        columns
    }

    /// Computes the columns of a model in place.
    #[inline(never)]
    pub(crate) fn set(&mut self, curve: &Curve<K>, model: &Model) {
        let terms = model.terms().iter();
        self.0 = list::fill(terms.map(|term| column(curve, term).map(single).into()));
    }
}

/// The Allan variances of one effect, for a coefficient of one.
fn column<const K: usize>(curve: &Curve<K>, term: &Term) -> algebra::Vector<K> {
    let mut column = algebra::Vector::<K>::zeros();
    let mut k = 0_usize;
    let mut factors = curve.points().iter().map(|point| real(point.m));
    let shape = term.sampled_shape(curve.interval_s());
    term.effect
        .variances(&mut factors, &shape, &mut |variance| {
            column.put(k, variance);
            k = k.saturating_add(1);
        });
    column
}

/// A curve, a model, and the columns of that model. This is what a fit works on.
///
/// Variances and squared coefficients are counted in the curve's `variance_unit`, so that their squares
/// stay within the range of single precision.
#[derive(Clone, Copy)]
pub(crate) struct Problem<'a, const K: usize> {
    pub(crate) curve: &'a Curve<K>,
    pub(crate) points: &'a [Point],
    pub(crate) model: &'a Model,
    pub(crate) interval_s: Real,
    pub(crate) variance_unit: Real,
    per_unit: Real,
    columns: &'a Columns<K>,
}

impl<'a, const K: usize> Problem<'a, K> {
    /// The problem of a model whose columns are known.
    pub(crate) fn new(curve: &'a Curve<K>, model: &'a Model, columns: &'a Columns<K>) -> Self {
        Self {
            curve,
            points: curve.points(),
            model,
            interval_s: curve.interval_s(),
            variance_unit: curve.variance_unit(),
            per_unit: 1.0 / curve.variance_unit(),
            columns,
        }
    }

    /// The Allan variances of one effect, for a coefficient of one.
    pub(crate) fn column(&self, term: &Term) -> algebra::Vector<K> {
        column(self.curve, term)
    }

    /// The columns of the model.
    pub(crate) fn columns(&self) -> &'a [algebra::Vector<K, f32>] {
        &self.columns.0
    }

    /// The measured variance of octave `k`.
    pub(crate) fn measured(&self, k: usize) -> Real {
        let point = self.points.get(k);
        point.map_or(0.0, |point| point.variance * self.per_unit)
    }

    /// The squared coefficients of a fit.
    pub(crate) fn squares_of(&self, fit: &Fit) -> Vector {
        Vector::from_fn(|i| {
            let coefficient = fit.coefficients.get(i);
            coefficient.map_or(0.0, |coefficient| coefficient.square * self.per_unit)
        })
    }

    /// The variance of effect `i` in octave `k`, for a coefficient of one.
    pub(crate) fn unit(&self, i: usize, k: usize) -> Real {
        let column = self.columns.0.get(i);
        column.map_or(0.0, |column| real(column[k]))
    }

    /// The share of effect `i` in the model's variance of octave `k`, from 0 to 1. It is 0 for an
    /// effect beyond the model.
    pub(crate) fn share(&self, k: usize, i: usize, squares: &Vector) -> Real {
        if i < self.count() {
            self.unit(i, k) * squares[i] / self.variance(k, squares)
        } else {
            0.0
        }
    }

    /// The choice of coefficients that are held at zero.
    pub(crate) fn held(&self) -> Free {
        Free::of(|i| self.model.terms().get(i).is_some_and(|term| term.held))
    }

    /// The number of coefficients.
    pub(crate) fn count(&self) -> usize {
        self.model.terms().len()
    }

    /// The model's variance in octave `k`.
    pub(crate) fn variance(&self, k: usize, squares: &Vector) -> Real {
        (0..self.count())
            .map(|i| self.unit(i, k) * squares[i])
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
    if let Some(point) = points.iter().find(|point| point.variance == 0.0) {
        return Err(Error::NoNoise { m: point.m });
    }
    Ok(())
}

/// The relative accuracy of an octave by Lv, Liu, Lai & Huang 2015: `δ = 1/√(2(N/m − 1))`.
pub(crate) fn relative_accuracy(point: &Point) -> Real {
    1.0 / math::sqrt(2.0 * (clusters(point) - 1.0))
}
