//! The gamma likelihood of a record, and the squared coefficients that make it largest.
//!
//! A density of `n` segments, an octave or a cosine coefficient is a mean of squares, with the gamma distribution of shape
//! ν, half its degrees of freedom. With the model's value `m` relative to the measurement,
//!
//! ```text
//! −2 ln L = 2 Σ ν (1/m − 1 + ln m)
//! ```
//!
//! up to a constant (McCullagh & Nelder 1989, ch. 8). A row that a model puts 20 times too high adds 2ν (ln 20 − 0.95), four
//! times what it adds to χ² at the model's own covariance: deficits are seen as well as excesses.

mod passing;

use super::{rows::Observation, values::Values};
use crate::{
    limits::{MAX_EFFECTS, MAX_SHAPE},
    list::numbered,
    numerics::{
        math,
        nnls::{NormalEquations, PassiveSet, Vector},
        real::{Real, real, single},
    },
    theory::{effect::Effect, model::Term},
};
use heapless::Vec;

/// A row of the model is at least this share of the measurement, so that its logarithm stays near.
const LEAST: f32 = 1e-4;

/// The rounds in which coefficients are fitted to expected values.
const REFITS: u8 = 4;

/// How far the logarithm of a shape may follow an effect that is added.
const FOLLOWS: Real = 1.0;

/// A round of scoring that gains less is the last one.
const SETTLED: Real = 0.02;

/// The columns that a step of the shapes may change.
const CHANGED: usize = 4;

/// The memory in which hypotheses are solved.
pub(crate) struct Workspace<const B: usize> {
    /// The columns of the terms that every hypothesis has, then the own ones, those of the white noise and of what was added.
    columns: Vec<Values<B>, MAX_EFFECTS>,
    /// The number of the columns that every hypothesis has, their effects and factors.
    common: usize,
    effects: Vec<(&'static dyn Effect, Real), MAX_EFFECTS>,
    /// The filter among them that all noise passes, and its place. It is a list because an empty one is all zero.
    known: Vec<(usize, Term), 1>,
    /// Whether the common columns are those behind a filter of all noise.
    is_passed: bool,
    /// The factors of the own columns.
    factors: Vec<Real, MAX_EFFECTS>,
    /// What a step of the shapes replaced: places among the own columns, columns and factors.
    replaced: Vec<(usize, Values<B>, Real), CHANGED>,
    /// The columns of the shapes: the change of the model with the logarithm of each.
    pub(super) slopes: Vec<Values<B>, MAX_SHAPE>,
    /// The model relative to the measurement.
    pub(super) model: Values<B>,
    /// The shape of each row's distribution; zero for a row that is left out.
    pub(super) shape: Values<B>,
    pub(super) equations: NormalEquations,
    /// The squared coefficients in units of their columns.
    pub(super) squares: Vector,
    /// Those above zero in the last solution, with which the next one begins.
    pub(super) free: PassiveSet,
}

impl<const B: usize> Workspace<B> {
    /// No columns yet.
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const NEW: Self = Self {
        columns: Vec::new(),
        common: 0,
        effects: Vec::new(),
        known: Vec::new(),
        is_passed: false,
        factors: Vec::new(),
        replaced: Vec::new(),
        slopes: Vec::new(),
        model: Values::NONE,
        shape: Values::NONE,
        equations: NormalEquations::EMPTY,
        squares: Vector::ZEROS,
        free: PassiveSet::NONE,
    };

    /// The number of columns, slopes left out.
    pub(super) fn count(&self) -> usize {
        self.columns.len()
    }

    /// The number of the columns that every hypothesis has.
    pub(super) const fn common(&self) -> usize {
        self.common
    }

    /// The number of the own columns.
    pub(super) fn own(&self) -> usize {
        self.factors.len()
    }

    /// A column: the common ones first, then the own ones, then the slopes.
    pub(super) fn column(&self, i: usize) -> Option<&Values<B>> {
        match i.checked_sub(self.columns.len()) {
            None => self.columns.get(i),
            Some(slope) => self.slopes.get(slope),
        }
    }

    /// Sets the columns of the terms that every hypothesis has.
    pub(super) fn set_common<'t>(
        &mut self,
        observation: &Observation<'_, B>,
        terms: impl Iterator<Item = &'t Term>,
    ) {
        self.columns.clear();
        self.factors.clear();
        self.effects.clear();
        self.known.clear();
        self.is_passed = false;
        for term in terms {
            if let Some(factor) = self.push_column(observation, term) {
                if term.effect.passes_all() {
                    let _ = self.known.push((self.effects.len(), *term));
                }
                let _ = self.effects.push((term.effect, factor));
            }
        }
        self.common = self.columns.len();
    }

    /// Adds a column and returns its factor.
    fn push_column(&mut self, observation: &Observation<'_, B>, term: &Term) -> Option<Real> {
        self.columns.push(Values::NONE).ok()?;
        let values = self.columns.last_mut()?;
        Some(observation.column(term, None, values))
    }

    /// Keeps this number of own columns.
    pub(super) fn keep_own(&mut self, count: usize) {
        self.columns.truncate(self.common.saturating_add(count));
        self.factors.truncate(count);
    }

    /// Sets the columns of the white noise and of what was added.
    pub(super) fn set_own<'t>(
        &mut self,
        observation: &Observation<'_, B>,
        terms: impl Iterator<Item = &'t Term>,
    ) {
        self.keep_own(0);
        for term in terms {
            self.add_own(observation, term);
        }
    }

    /// Adds the column of one more term.
    pub(crate) fn add_own(&mut self, observation: &Observation<'_, B>, term: &Term) {
        if let Some(factor) = self.push_column(observation, term) {
            let _ = self.factors.push(factor);
        }
    }

    /// Sets an own column anew.
    pub(super) fn change_own(&mut self, observation: &Observation<'_, B>, i: usize, term: &Term) {
        let place = self.common.saturating_add(i);
        if let (Some(values), Some(factor)) = (self.columns.get_mut(place), self.factors.get_mut(i))
        {
            *factor = observation.column(term, None, values);
        }
    }

    /// Sets the own columns anew whose terms have changed. What was there is kept for [`put_back`](Self::put_back).
    #[inline(never)]
    pub(super) fn exchange_own(
        &mut self,
        observation: &Observation<'_, B>,
        before: &[Term],
        after: &[Term],
    ) {
        self.replaced.clear();
        for (i, (before, after)) in numbered(before.iter().zip(after)) {
            if before.parameters == after.parameters {
                continue;
            }
            if let (Some(column), Some(factor)) = (self.own_column(i), self.factors.get(i)) {
                let _ = self.replaced.push((i, *column, *factor));
            }
            self.change_own(observation, i, after);
        }
    }

    /// Takes the last exchange back.
    pub(super) fn put_back(&mut self) {
        for (i, column, factor) in &self.replaced {
            let place = self.common.saturating_add(*i);
            if let (Some(own), Some(own_factor)) =
                (self.columns.get_mut(place), self.factors.get_mut(*i))
            {
                (*own, *own_factor) = (*column, *factor);
            }
        }
    }

    /// Gives every row its weight.
    pub(crate) fn set_shape(&mut self, observation: &Observation<'_, B>) {
        self.shape = observation.shape;
    }

    /// Sets the model of these squared coefficients.
    pub(crate) fn set_model(&mut self, squares: &Vector) {
        self.squares = *squares;
        self.model = self.model_of(squares);
    }

    /// The model relative to the measurement.
    pub(crate) const fn model(&self) -> &Values<B> {
        &self.model
    }

    /// The shape of each row's distribution.
    pub(crate) const fn shape(&self) -> &Values<B> {
        &self.shape
    }

    /// The factor of an own column.
    pub(crate) fn factor(&self, i: usize) -> Real {
        self.factors.get(i).copied().unwrap_or(0.0)
    }

    /// An own column.
    pub(crate) fn own_column(&self, i: usize) -> Option<&Values<B>> {
        self.columns.get(self.common.saturating_add(i))
    }

    /// What the columns and the slopes follow of expected values: the squares of their best fit, and the rest. The weights
    /// are those of the present model. `None` if the columns cannot be distinguished.
    #[inline(never)]
    pub(crate) fn followed(&mut self, with: &Values<B>) -> Option<(Vector, Values<B>)> {
        let shift: Vec<Real, MAX_SHAPE> = crate::list::fill(self.slopes.iter().map(|_| FOLLOWS));
        if !self.set_equations(Some(with), &shift, 0.0) {
            return None;
        }
        let (squares, _) = self.equations.solve_non_negative(&PassiveSet::NONE);
        let mut rest = *with;
        for i in 0..self.count().saturating_add(shift.len()) {
            let slope = i >= self.count();
            let size = if slope {
                squares[i] - FOLLOWS
            } else {
                squares[i]
            };
            if let Some(column) = self.column(i) {
                rest.add_scaled(column, -single(size));
            }
        }
        Some((squares, rest))
    }

    /// `−2 ln L` of expected values at their best fit, less that of the values themselves: `2 Σ ν (x/m − 1 − ln x/m)`.
    #[inline(never)]
    pub(crate) fn refitted(&mut self, with: &Values<B>) -> Real {
        let (model, mut least) = (self.model, Real::INFINITY);
        for _ in 0..REFITS {
            if !self.set_equations(Some(with), &[], 0.0) {
                break;
            }
            let (squares, _) = self.equations.solve_non_negative(&PassiveSet::NONE);
            self.model = self.model_of(&squares);
            let mut sum = 0.0;
            with.each_with(&self.model, &self.shape, |with, model, shape| {
                if shape > 0.0 {
                    let ratio = real(with) / real(model);
                    sum += real(shape) * (ratio - 1.0 - math::log(ratio));
                }
            });
            least = least.min(2.0 * sum);
        }
        self.model = model;
        least
    }

    /// `−2 ln L` of a model.
    pub(super) fn deviance(&self, model: &Values<B>) -> Real {
        let mut sum = 0.0;
        model.each_with(&self.shape, model, |m, shape, _| {
            if shape > 0.0 {
                let m = real(m);
                sum += real(shape) * (1.0 / m - 1.0 + math::log(m));
            }
        });
        2.0 * sum
    }

    /// The model of these squared coefficients.
    pub(super) fn model_of(&self, squares: &Vector) -> Values<B> {
        let mut model = Values::zeros(self.shape.lows());
        for i in 0..self.count() {
            let square = single(squares[i]);
            if square > 0.0
                && let Some(column) = self.column(i)
            {
                model.add_scaled(column, square);
            }
        }
        model.change_by(&self.shape, |model, _| model.max(LEAST));
        model
    }

    /// Sets the normal equations of all columns at the present model, by Fisher's weights `ν/m²`. What they explain is
    /// `data`, or one in each row, what was measured, plus `shift` times each slope.
    pub(crate) fn set_equations(
        &mut self,
        data: Option<&Values<B>>,
        shift: &[Real],
        damping: Real,
    ) -> bool {
        let slopes = shift.len();
        let mut weighted = self.shape;
        weighted.change_by(&self.model, |shape, m| shape / (m * m));
        let count = self.count().saturating_add(slopes);
        let mut target = match data {
            Some(data) => *data,
            None => Values::constant(self.shape.lows(), 1.0),
        };
        for (slope, shift) in self.slopes.iter().take(slopes).zip(shift) {
            target.add_scaled(slope, single(*shift));
        }
        let first_slope = self.count();
        let mut equations = core::mem::replace(&mut self.equations, NormalEquations::EMPTY);
        let set = equations.set(count, &|i, own| {
            let Some(column) = self.column(i) else {
                return 0.0;
            };
            let mut product = *column;
            product.change_by(&weighted, |column, weight| column * weight);
            for j in 0..=i {
                own.put(
                    j,
                    self.column(j).map_or(0.0, |other| real(product.dot(other))),
                );
            }
            let mut right = real(product.dot(&target));
            if let Some(at) = i.checked_sub(first_slope) {
                let diagonal = own[i];
                own.put(i, diagonal * (1.0 + damping));
                right += damping * diagonal * shift.get(at).copied().unwrap_or(0.0);
            }
            right
        });
        self.equations = equations;
        set.is_ok()
    }

    /// Fits the squared coefficients by Fisher scoring from the present model on. Returns `−2 ln L` of the best round, whose
    /// model and squares are kept.
    #[inline(never)]
    pub(super) fn solve(&mut self, rounds: u8) -> Real {
        let mut best: Option<(Real, Values<B>, Vector)> = None;
        let mut last: Option<Real> = None;
        for _ in 0..rounds {
            if !self.set_equations(None, &[], 0.0) {
                break;
            }
            let (squares, free) = self
                .equations
                .solve_non_negative_near(&self.free, &PassiveSet::NONE);
            self.free = free;
            let model = self.model_of(&squares);
            let deviance = self.deviance(&model);
            self.model = model;
            if best.as_ref().is_none_or(|(least, ..)| deviance < *least) {
                best = Some((deviance, model, squares));
            }
            if last.is_some_and(|last| deviance > last - SETTLED) {
                break;
            }
            last = Some(deviance);
        }
        match best {
            Some((deviance, model, squares)) => {
                self.model = model;
                self.squares = squares;
                deviance
            }
            None => Real::INFINITY,
        }
    }

    /// By how much `−2 ln L` falls if a column is added at its best size, with all else fixed.
    #[inline(never)]
    pub(super) fn gain(&self, column: &Values<B>) -> Real {
        let mut square: f32 = 0.0;
        for _ in 0..7 {
            let (mut along, mut own) = (0.0, 0.0);
            column.each_with(&self.model, &self.shape, |c, m, shape| {
                let whole = m + square * c;
                let weight = shape * c / (whole * whole);
                along += weight * (1.0 - m);
                own += weight * c;
            });
            square = if own > 0.0 {
                (along / own).max(0.0)
            } else {
                0.0
            };
        }
        if square == 0.0 {
            return 0.0;
        }
        let mut sum = 0.0;
        column.each_with(&self.model, &self.shape, |c, m, shape| {
            if shape > 0.0 {
                let (m, whole) = (real(m), real(m + square * c));
                sum += real(shape) * (1.0 / m - 1.0 / whole - math::log(whole / m));
            }
        });
        2.0 * sum
    }
}

/// The squared coefficients as a hypothesis keeps them.
pub(super) fn kept(squares: &Vector) -> [f32; MAX_EFFECTS] {
    let mut kept = [0.0; MAX_EFFECTS];
    for (i, kept) in numbered(kept.iter_mut()) {
        *kept = single(squares[i]);
    }
    kept
}
