//! What an effect of a given size would add to a record that a model explains, and whether a diagnosis would see it.

use super::limit::Limit;
use crate::{
    diagnosis::search::{Observation, Values, Workspace},
    limits::{MAX_EFFECTS, ONE_SIDED_95},
    list::{count, numbered},
    numerics::{
        math,
        nnls::Vector,
        real::{Real, real, single},
    },
    theory::{
        effect::Distribution,
        model::{Model, Term},
    },
};

/// An effect is tried up to this multiple of the model in the row where it shows most.
const MOST: Real = 100.0;

/// The share of the fall of `−2 ln L` that is expected of noise without a frequency. Flicker noise and random walk imitate it
/// together, each record in its own way. By the study `detection`.
const SHOWN: Real = 0.65;

/// What is left of a model where an effect takes away from it, at least.
const LEAST: Real = 1e-3;

/// A record as a model explains it, and an additional effect.
pub(super) struct Excess<'o, 'a, const B: usize> {
    observation: &'o Observation<'a, B>,
    work: Workspace<B>,
    model: &'o Model,
    /// The squares of the model's columns, and of its coefficients.
    squares: Vector,
    coefficients: [Real; MAX_EFFECTS],
    /// The effect, and its column with a largest share of the model of one.
    term: Option<Term>,
    column: Values<B>,
    /// The squared coefficient for which the column is.
    square: Real,
}

impl<'o, 'a, const B: usize> Excess<'o, 'a, B> {
    /// A record as this model with these squared coefficients explains it. `None` if it explains a row with nothing.
    #[inline(never)]
    pub(super) fn new(
        observation: &'o Observation<'a, B>,
        model: &'o Model,
        squares: &[Real; MAX_EFFECTS],
    ) -> Option<Self> {
        let mut excess = Self {
            observation,
            work: Workspace::NEW,
            model,
            squares: Vector::ZEROS,
            coefficients: *squares,
            term: None,
            column: Values::NONE,
            square: 0.0,
        };
        excess.work.set_shape(observation);
        for (i, (term, square)) in numbered(model.terms().iter().zip(squares)) {
            excess.work.add_own(observation, term);
            let factor = excess.work.factor(i);
            excess
                .squares
                .put(i, square.max(0.0) / factor.max(Real::MIN_POSITIVE));
        }
        excess.work.pass_own(observation, model);
        excess.work.set_model(&excess.squares);
        excess
            .work
            .set_slopes(observation, model.terms(), &excess.squares);
        Some(excess)
    }

    /// Chooses the effect.
    #[inline(never)]
    pub(super) fn set(&mut self, term: &Term) {
        let factor = self.observation.column(term, None, &mut self.column);
        let mut largest: Real = 0.0;
        for row in self.observation.rows() {
            largest = largest.max(real(self.column[row]) / real(self.work.model()[row]));
        }
        let scale = if largest > 0.0 { 1.0 / largest } else { 0.0 };
        let column = self.column;
        self.column
            .change_by(&column, |value, _| value * single(scale));
        // The column is `factor` times what a coefficient of one adds.
        self.square = factor * scale;
        self.term = Some(*term);
    }

    /// The number of times in the record.
    pub(super) fn times(&self, time_s: Real) -> Real {
        self.observation.duration_s / time_s
    }

    /// The number of periods of a frequency in the record.
    pub(super) fn periods(&self, frequency_hz: Real) -> Real {
        frequency_hz * self.observation.duration_s
    }

    /// What every effect costs more on this record.
    pub(super) const fn surcharge(&self) -> Real {
        self.observation.surcharge()
    }

    /// Whether there are bins.
    pub(super) const fn has_bins(&self) -> bool {
        self.observation.has_bins()
    }

    /// The largest size that is tried.
    pub(super) const fn most(&self) -> Real {
        MOST
    }

    /// The limit of a size that shows with a probability of 95 %; `None` if it does not.
    #[inline(never)]
    pub(super) fn of_size(&mut self, size: Real, needed: Real) -> Option<Limit> {
        let term = self.term?;
        if self.square == 0.0 {
            return None;
        }
        let is_line = term.effect.description().distribution == Distribution::Deterministic;
        let mut with = *self.work.model();
        for row in self.observation.rows() {
            with.put(row, with[row] + single(size) * self.column[row]);
        }
        let own = |excess: &Self, row: usize| size * real(excess.column[row]);
        let squares = self.shows(&with, &term, needed, |excess, row| {
            if is_line { own(excess, row) } else { 0.0 }
        })?;
        Some(Limit {
            term,
            coefficient: math::sqrt(size * self.square),
            beside: squares.map(math::sqrt),
        })
    }

    /// The limit of the present filter if it shows with a probability of 95 %; `None` if it does not.
    #[inline(never)]
    pub(super) fn of_filter(&mut self, needed: Real) -> Option<Limit> {
        let term = self.term?;
        let place = self.model.position(term.effect.replaces()?.name())?;
        let square = self.coefficients.get(place).copied()?;
        if square <= 0.0 || self.square == 0.0 {
            return None;
        }
        let size = single(square / self.square);
        let white = single(self.squares[place]);
        let mut with = *self.work.model();
        let column = self.work.own_column(place)?;
        for row in self.observation.rows() {
            let change = size * self.column[row] - white * column[row];
            with.put(row, with[row] + change);
        }
        let squares = self.shows(&with, &term, needed, |_, _| 0.0)?;
        let mut beside = squares.map(math::sqrt);
        // The filter has the white noise that the model follows it with.
        let white = beside.get_mut(place).map(core::mem::take);
        Some(Limit {
            term,
            coefficient: white.unwrap_or_default(),
            beside,
        })
    }

    /// Whether a record that is expected to be `with` shows the effect: the fall of `−2 ln L` exceeds what is needed in 95 %
    /// of the records. The part that the model follows does not show: the true gyro is the one whose fit is the model.
    /// Returns its squared coefficients. `line` is the part that is deterministic, and scatters only as it beats with noise.
    ///
    /// The fall is that of a noncentral χ² with the noncentrality `λ = 2 Σ ν (x/m − 1 − ln x/m)`, and the variance of
    /// `4 Σ ν (x/m − 1)²` in addition to that of its degrees of freedom.
    #[inline(never)]
    fn shows(
        &mut self,
        with: &Values<B>,
        term: &Term,
        needed: Real,
        line: impl Fn(&Self, usize) -> Real,
    ) -> Option<[Real; MAX_EFFECTS]> {
        let (followed, rest) = self.work.followed(with)?;
        let (mut lambda, mut scatter) = (0.0, 0.0);
        let mut true_rows = rest;
        for row in self.observation.rows() {
            let m = self.work.model()[row];
            true_rows.put(row, (m + rest[row]).max(single(LEAST) * m));
        }
        let refitted = self.work.refitted(&true_rows);
        for row in self.observation.rows() {
            let m = real(self.work.model()[row]);
            let ratio = (1.0 + real(rest[row]) / m).max(LEAST);
            let shape = real(self.work.shape()[row]);
            lambda += 2.0 * shape * (ratio - 1.0 - math::log(ratio));
            let share = (line(self, row) / (m * ratio)).min(1.0);
            // A line of share s in a row beats with the noise beside it: its scatter is √(1 − s²) of that of noise.
            let noise = 1.0 - share * share;
            let together = self.observation.overlap(row);
            scatter += 4.0 * shape * (ratio - 1.0) * (ratio - 1.0) * noise * together;
        }
        // Where the effect is large, the coefficients follow it further than the weights of the model say.
        let lambda = lambda.min(refitted);
        let lambda = if is_noise(term) {
            SHOWN * lambda
        } else {
            lambda
        };
        let shapes = real(count(term.fitted_parameters()) as u32);
        let is_filter = term.effect.replaces().is_some();
        let freedom = if is_filter { shapes } else { shapes + 1.0 };
        let error = math::sqrt(2.0 * freedom + scatter);
        let least = freedom + lambda - real(ONE_SIDED_95) * error;
        (least > needed + 2.0 * freedom).then(|| {
            core::array::from_fn(|i| {
                let factor = self.work.factor(i);
                let own = 2.0 * self.squares[i] - followed[i];
                own.max(0.0) * factor
            })
        })
    }
}

/// Whether a term is noise without a frequency that adds to the noise of a model.
pub(super) fn is_noise(term: &Term) -> bool {
    let effect = term.effect;
    let first = effect.parameters().first();
    effect.replaces().is_none() && first.is_some_and(|first| first.unit == "s")
}
