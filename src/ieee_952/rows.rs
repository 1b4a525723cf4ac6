//! The octaves of a curve, and the factor of their covariance.

use super::{
    covariance::{SHARE_BITS, covariance},
    factor::Factor,
    row::Row,
    tableau::Tableau,
    terms::{TERMS, Units, WALK, WHITE, is_positive, power, sqrt, truncated},
};
use crate::numerics::deviance::deviance_residual;

/// A number of the factor is in units of 2^-30: the covariance is scaled to a diagonal of one.
const FACTOR_BITS: u32 = 30;
const ONE: i32 = 1 << FACTOR_BITS;

/// The reciprocals of its diagonal are in units of 2^-24, and the square of a diagonal element is this at least.
const RECIPROCAL_BITS: u32 = 22;
const LEAST_PIVOT: f32 = 1e-5;

/// A whitened column is in units of 2^-22 of its largest element before it was whitened.
const WHITE_BITS: u32 = 22;

/// Products of whitened columns lose these bits, so that no sum of thirty overflows.
const PRODUCT_BITS: u32 = 8;

/// Half of a model, as a share of it.
const HALF: u16 = 1 << 14;

/// The octaves of a curve, and the factor of their covariance.
pub(super) struct Rows<'a, const K: usize> {
    pub(super) rows: &'a mut [Row],
    factor: Factor<'a>,
    pub(super) units: Units,
    /// The square of the tolerance: the relative variance that each octave has beside its scatter.
    pub(super) tolerance: f32,
    /// A term, and the square that is held of its coefficient, where the equations ask for what it differs from that.
    pub(super) held: (usize, f32),
    /// The units of the whitened columns.
    scales: [f32; TERMS + 1],
}

/// One over the number of places at which a shorter difference is taken to start beside a longer one: more than it has, if
/// its octave leaves out those across filled gaps.
fn per_place(shorter: &Row, longer: &Row, j: usize, k: usize) -> f32 {
    // Differences start a quarter of a cluster apart, and one sample at least.
    let bits = j.max(2).wrapping_sub(k.max(2)) as i32;
    let beside = longer.per_difference * power(bits);
    if beside < shorter.per_difference {
        beside
    } else {
        shorter.per_difference
    }
}

/// A column of the equations.
#[derive(Clone, Copy)]
pub(super) enum Column<'a> {
    /// The variance of a term with a coefficient of one.
    Term(usize),
    /// The curve, less what is held.
    Measured,
    /// The curve, less the model of these squared coefficients.
    Residual(&'a [f32; TERMS]),
    /// The deviance residuals beside that model.
    Deviance(&'a [f32; TERMS]),
}

impl<'a, const K: usize> Rows<'a, K> {
    pub(super) fn new(rows: &'a mut [Row], factor: &'a mut [[u16; K]; K]) -> Self {
        Self {
            units: Units::new(rows.len()),
            rows,
            factor: Factor::new(factor),
            tolerance: 0.0,
            held: (0, 0.0),
            scales: [0.0; TERMS + 1],
        }
    }

    /// Sets the models of these squared coefficients, and the terms' shares of them.
    #[inline(never)]
    pub(super) fn set_models(&mut self, squares: &[f32; TERMS]) {
        let units = self.units;
        for (octave, row) in (0..K).zip(self.rows.iter_mut()) {
            let mut parts = [0.0; TERMS];
            for (term, (part, &square)) in (0..TERMS).zip(parts.iter_mut().zip(squares)) {
                *part = square * units.variance(term, octave);
            }
            row.model = parts.iter().sum();
            let leak = squares[WALK] * units.leak(octave);
            parts[WHITE] += leak;
            parts[WALK] -= leak;
            let per_model = power(-SHARE_BITS) / row.model;
            for (share, part) in row.shares.iter_mut().zip(parts) {
                // Not negative, and at most 2^15.
                *share = truncated(part * per_model + 0.5) as u16;
            }
        }
    }

    /// Takes the octaves for independent, with the scatter of as many clusters as they have: the weights with which the
    /// rounds begin.
    #[inline(never)]
    pub(super) fn weigh_independent(&mut self) {
        for (octave, row) in (0..K).zip(self.rows.iter_mut()) {
            let quarter = match octave {
                0 => 1.0,
                1 => 0.5,
                _ => 0.25,
            };
            let clusters = (1.0 / row.per_difference - 1.0) * quarter + 1.0;
            row.certainty = sqrt(2.0 * clusters);
            row.reciprocal = 1 << RECIPROCAL_BITS;
        }
        self.factor.clear();
    }

    /// Factors the covariance at the present models. `false` if it cannot be made positive definite.
    #[inline(never)]
    pub(super) fn weigh(&mut self) -> bool {
        /// The shares of the correlations that are kept, one after the other.
        const KEPT: [f32; 5] = [1.0, 0.97, 0.9, 0.7, 0.0];
        KEPT.iter().any(|&kept| self.factor(kept))
    }

    fn factor(&mut self, kept: f32) -> bool {
        for k in 0..self.rows.len() {
            let (before, rest) = self.rows.split_at_mut(k);
            let Some(row) = rest.first_mut() else {
                return false;
            };
            let variance = 0.5 * covariance(row, row, k, 0) * row.per_difference + self.tolerance;
            let is_positive = f32::MIN_POSITIVE < variance;
            if !is_positive {
                return false;
            }
            row.certainty = 1.0 / sqrt(variance);
            let per_row = kept * power(FACTOR_BITS as i32 - 1) * row.certainty;
            let mut pivot = i64::from(ONE) << FACTOR_BITS;
            for (j, shorter) in (0..K).zip(before.iter()) {
                let common =
                    covariance(shorter, row, j, k.wrapping_sub(j)) * per_place(shorter, row, j, k);
                let correlation = common * per_row * shorter.certainty;
                let common = i64::from(truncated(correlation)) << FACTOR_BITS;
                let left = self.factor.left(common, k, self.factor.row(j));
                let left = left >> FACTOR_BITS;
                let element = left.wrapping_mul(shorter.reciprocal.into()) >> RECIPROCAL_BITS;
                // `clamp` would check its limits, and link the words of that panic.
                let element = element.max((-ONE).into()).min(ONE.into()) as i32;
                self.factor.put(k, j, element);
                pivot = pivot.wrapping_sub(i64::from(element).wrapping_mul(element.into()));
            }
            let pivot = pivot as f32 * power(-2 * FACTOR_BITS as i32);
            let is_positive = LEAST_PIVOT < pivot;
            if !is_positive {
                return false;
            }
            row.reciprocal = truncated(power(RECIPROCAL_BITS as i32) / sqrt(pivot));
        }
        true
    }

    /// Sets what whitens an octave: one over the scatter that it has by the factored covariance, for models that are larger
    /// by `more` of a term.
    #[inline(never)]
    fn set_weights(&mut self, more: Option<(usize, f32)>) {
        let units = self.units;
        for (octave, row) in (0..K).zip(self.rows.iter_mut()) {
            let more = more.map_or(0.0, |(term, square)| square * units.variance(term, octave));
            row.weight = row.certainty / (row.model + more);
        }
    }

    /// Whitens a column, and keeps it as column `place`.
    #[inline(never)]
    fn whiten(&mut self, place: usize, column: Column<'_>) {
        let (units, held) = (self.units, self.held);
        let value = |octave: usize, row: &Row| {
            let own = match column {
                Column::Term(term) => units.variance(term, octave),
                Column::Measured => row.measured - held.1 * units.variance(held.0, octave),
                Column::Residual(squares) => row.measured - units.model(squares, octave),
                Column::Deviance(squares) => {
                    // A ramp is no variance with degrees of freedom.
                    let [.., ramp] = row.shares;
                    if ramp > HALF {
                        return (row.measured - units.model(squares, octave)) * row.weight;
                    }
                    let ratio = row.measured / units.model(squares, octave);
                    return deviance_residual(ratio, 1.0 / row.certainty);
                }
            };
            own * row.weight
        };
        // Sizes of floats compare as their bits do, without a call on a core that has no unit for floats.
        let mut largest = f32::MIN_POSITIVE.to_bits();
        for (octave, row) in (0..K).zip(self.rows.iter_mut()) {
            let value = value(octave, row);
            largest = largest.max(value.abs().to_bits());
            // The column keeps its floats until it is whitened.
            if let Some(white) = row.white.get_mut(place) {
                *white = value.to_bits() as i32;
            }
        }
        let largest = f32::from_bits(largest);
        let per_scale = power(WHITE_BITS as i32) / largest;
        for k in 0..self.rows.len() {
            let (before, rest) = self.rows.split_at_mut(k);
            let own = rest
                .first_mut()
                .map(|row| (row.reciprocal, row.white.get_mut(place)));
            let Some((reciprocal, Some(white))) = own else {
                continue;
            };
            let value = f32::from_bits(*white as u32);
            let column = before
                .iter()
                .map(|row| row.white.get(place).copied().unwrap_or(0));
            let number = i64::from(truncated(value * per_scale)) << FACTOR_BITS;
            let left = self.factor.left(number, k, column);
            let element = (left >> FACTOR_BITS).wrapping_mul(reciprocal.into());
            let limit = i64::from(i32::MAX);
            *white = (element >> RECIPROCAL_BITS).max(-limit).min(limit) as i32;
        }
        if let Some(scale) = self.scales.get_mut(place) {
            *scale = largest;
        }
    }

    /// The product of two whitened columns.
    fn product(&self, a: usize, b: usize) -> f32 {
        let mut sum = 0_i64;
        for row in self.rows.iter() {
            let element = |place: usize| i64::from(row.white.get(place).copied().unwrap_or(0));
            sum = sum.wrapping_add(element(a).wrapping_mul(element(b)) >> PRODUCT_BITS);
        }
        let scale = |place: usize| self.scales.get(place).copied().unwrap_or(0.0);
        let bits = PRODUCT_BITS as i32 - 2 * WHITE_BITS as i32;
        sum as f32 * power(bits) * scale(a) * scale(b)
    }

    /// The sum of squares of the whitened curve.
    pub(super) fn squared(&self) -> f32 {
        self.product(TERMS, TERMS)
    }

    /// Whitens the columns of all terms and of the curve, and sets the normal equations.
    #[inline(never)]
    pub(super) fn set_equations(&mut self, more: Option<(usize, f32)>, tableau: &mut Tableau) {
        self.set_weights(more);
        for term in 0..TERMS {
            self.whiten(term, Column::Term(term));
        }
        self.whiten(TERMS, Column::Measured);
        tableau.set(|a, b| self.product(a, b));
    }

    /// The gradient of the squared residuals with the residual as the last column, by the tableau's scales, and their sum.
    #[inline(never)]
    pub(super) fn residuals(&mut self, squares: &[f32; TERMS]) -> ([f32; TERMS], f32) {
        self.whiten(TERMS, Column::Residual(squares));
        let mut gradient = [0.0; TERMS];
        for (term, gradient) in (0..TERMS).zip(&mut gradient) {
            *gradient = self.product(term, TERMS);
        }
        (gradient, self.product(TERMS, TERMS))
    }

    /// The sum of squares of the deviance residuals, in units of their correlation.
    #[inline(never)]
    pub(super) fn deviance(&mut self, squares: &[f32; TERMS]) -> f32 {
        self.whiten(TERMS, Column::Deviance(squares));
        self.product(TERMS, TERMS)
    }

    /// By how much the relative residuals exceed zero, twice: what χ² gains because its covariance follows the measurement
    /// (see [`chi_squared`](super::Fit::chi_squared)).
    pub(super) fn excess(&self, squares: &[f32; TERMS]) -> f32 {
        let mut sum = 0.0;
        for (octave, row) in (0..K).zip(self.rows.iter()) {
            let excess = (row.measured - self.units.model(squares, octave)) / row.model;
            sum += excess * (1.0 - self.tolerance * row.certainty * row.certainty);
        }
        2.0 * sum
    }

    /// The square from which on a term alone is this many times the curve in every octave.
    pub(super) fn beyond(&self, term: usize, times: f32) -> f32 {
        let mut most = 0.0;
        for (octave, row) in (0..K).zip(self.rows.iter()) {
            let square = times * row.measured / self.units.variance(term, octave);
            most = if most < square { square } else { most };
        }
        most
    }

    /// Whether the model is above a term with this squared coefficient, in every octave.
    pub(super) fn all_above(&self, term: usize, square: f32) -> bool {
        let mut rows = (0..K).zip(self.rows.iter());
        rows.all(|(octave, row)| square * self.units.variance(term, octave) < row.model)
    }

    /// Notes the relative change from the models of the weights to those of these squared coefficients. Returns the largest
    /// one, and the ratio of the change to that of the round before.
    #[inline(never)]
    pub(super) fn change(&mut self, squares: &[f32; TERMS]) -> (f32, f32) {
        let (mut largest, mut product, mut square) = (0, 0.0, 0.0);
        for (octave, row) in (0..K).zip(self.rows.iter_mut()) {
            let change = self.units.model(squares, octave) / row.model - 1.0;
            product += change * row.change;
            square += row.change * row.change;
            largest = largest.max(change.abs().to_bits());
            row.change = change;
        }
        let largest = f32::from_bits(largest);
        (
            largest,
            if is_positive(square) {
                product / square
            } else {
                0.0
            },
        )
    }
}
