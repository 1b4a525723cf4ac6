//! The search for the limit of one shape.

use super::{
    expected::{Ground, Standing},
    limit::{Limit, is_of_shape},
};
use crate::{
    covariance::covariance_row,
    effect::Effect,
    fit::Rows,
    math,
    model::{Model, Term},
    nnls::Vector,
    real::Real,
};

/// The largest number of steps towards the limit.
const STEPS: u8 = 14;
/// The steps end when root and needed root agree to this share, so that the limit of a coefficient is known
/// to half of it.
const AGREES: Real = 0.004;
/// The effect with which the search begins is at most this share of the curve in every octave.
const FIRST: Real = 0.1;
/// How far a coefficient is tried beyond the largest one that is informative. A larger limit is none.
const BEYOND: Real = 1.5;

/// The search for the limit of one shape, in progress. One step takes a fit to an expected curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial {
    term: Term,
    /// The logarithms of sizes that are known to be too small and large enough.
    low: Real,
    high: Real,
    /// The logarithm of the size that is tried next.
    next: Real,
    step: u8,
    /// By how much the effect's own power scatters beyond the octaves.
    surplus: Real,
    /// Whether a size that is large enough has been seen.
    is_bounded: bool,
}

/// What a step of the search found.
pub(super) enum Progress {
    Searching,
    /// There is no limit: the effect hides in the model at any size that the curve allows.
    Hidden,
    Found(Limit),
}

impl Trial {
    /// Begins with a shape. `range` is the range of the first shape parameter.
    pub(super) fn new<const K: usize, const B: usize>(
        ground: &Ground<'_, K, B>,
        term: Term,
        range: (Real, Real),
    ) -> Self {
        let (low, high, next) = if is_of_shape(term.effect) {
            let (low, high) = (math::log(range.0), math::log(range.1));
            (low, high, high)
        } else {
            let most = math::log(informative(ground, &term));
            (
                most - 30.0,
                most + math::log(BEYOND),
                most + math::log(FIRST),
            )
        };
        Self {
            term,
            low,
            high,
            next,
            step: 0,
            surplus: surplus(ground, &term),
            is_bounded: false,
        }
    }

    /// The effect whose limit is looked for.
    pub(super) const fn effect(&self) -> &'static dyn Effect {
        self.term.effect
    }

    /// Does one step.
    #[inline(never)]
    pub(super) fn advance<const K: usize, const B: usize>(
        &mut self,
        ground: &Ground<'_, K, B>,
        squares: &Vector,
        gain: Real,
    ) -> Progress {
        let size = math::exp(self.next);
        if is_of_shape(self.term.effect) {
            self.term.set_parameter(0, size);
        }
        self.step = self.step.saturating_add(1);
        let standing = self.standing(ground, squares, size, gain);
        if is_of_shape(self.term.effect) {
            return self.advance_shape(ground, squares, standing);
        }
        let Some(standing) = standing else {
            return Progress::Hidden;
        };
        if standing.root >= standing.needed {
            self.high = self.next;
            self.is_bounded = true;
        } else {
            self.low = self.next;
        }
        let distance = math::log(standing.needed / standing.root);
        let agrees = distance.abs() < AGREES;
        if agrees {
            return self.found(ground, squares);
        }
        if self.step >= STEPS {
            return Progress::Hidden;
        }
        // The root is nearly proportional to the square of the coefficient.
        let guess = self.next + distance;
        if !self.is_bounded && guess >= self.high {
            if self.next >= self.high {
                return Progress::Hidden;
            }
            self.next = self.high;
        } else if self.low < guess && guess < self.high {
            self.next = guess;
        } else {
            self.next = 0.5 * (self.low + self.high);
        }
        Progress::Searching
    }

    /// Goes on from the standing of a shape. A filter that is so wide that the model has no fit to it shows, but a
    /// limit is a filter that has one.
    fn advance_shape<const K: usize, const B: usize>(
        &mut self,
        ground: &Ground<'_, K, B>,
        squares: &Vector,
        standing: Option<Standing>,
    ) -> Progress {
        match standing {
            Some(Standing { root, needed }) if root < needed => self.low = self.next,
            standing => {
                self.high = self.next;
                self.is_bounded = standing.is_some();
            }
        }
        // Without a filter that is wide enough, the range has become empty at its upper end.
        if self.step >= STEPS || self.high - self.low < AGREES {
            return if self.is_bounded {
                self.found(ground, squares)
            } else {
                Progress::Hidden
            };
        }
        self.next = 0.5 * (self.low + self.high);
        Progress::Searching
    }

    /// The standing of the effect: of a coefficient with the square `size`, or of its present shape with the
    /// coefficient of the effect that it replaces.
    #[inline(never)]
    fn standing<const K: usize, const B: usize>(
        &self,
        ground: &Ground<'_, K, B>,
        squares: &Vector,
        size: Real,
        gain: Real,
    ) -> Option<Standing> {
        let (problem, term) = (ground.problem, &self.term);
        let column = problem.column(term);
        let beside = Beside::new(ground, squares, term, &column, size)?;
        let own = |k: usize| beside.own * column[k];
        let expected = |k: usize| beside.rest[k] + own(k);
        // A deterministic effect g scatters a curve only where random effects c beat against it: the
        // covariance is that of (c + g)² − g².
        let shape = term.sampled_shape(problem.interval_s);
        let is_random = term.effect.response(1.0, &shape).is_none();
        let scatter = |k: usize| {
            if is_random {
                expected(k)
            } else {
                math::sqrt(beside.rest[k] * (beside.rest[k] + 2.0 * own(k)))
            }
        };
        let positive = problem
            .rows()
            .all(|k| expected(k) > 0.0 && scatter(k) > 0.0);
        positive
            .then(|| ground.standing(&expected, &scatter, self.surplus, gain))
            .flatten()
    }

    #[inline(never)]
    fn found<const K: usize, const B: usize>(
        &self,
        ground: &Ground<'_, K, B>,
        squares: &Vector,
    ) -> Progress {
        let mut term = self.term;
        let size = if is_of_shape(term.effect) {
            term.set_parameter(0, math::exp(self.high));
            0.0
        } else {
            math::exp(self.next)
        };
        if size >= informative(ground, &term) {
            return Progress::Hidden;
        }
        let column = ground.problem.column(&term);
        let Some(beside) = Beside::new(ground, squares, &term, &column, size) else {
            return Progress::Hidden;
        };
        let root = |square: Real| math::sqrt(square * ground.problem.variance_unit);
        Progress::Found(Limit {
            term,
            coefficient: root(beside.own),
            beside: core::array::from_fn(|i| root(beside.squares[i])),
        })
    }
}

/// The largest square with which an effect does not exceed the model in any octave.
fn informative<const K: usize, const B: usize>(ground: &Ground<'_, K, B>, term: &Term) -> Real {
    let column = ground.problem.column(term);
    let rows = ground.problem.rows();
    rows.map(|k| ground.weights.model[k] / column[k])
        .fold(Real::INFINITY, Real::min)
}

/// The place of the effect that this one replaces.
fn replaced<const K: usize, const B: usize>(
    ground: &Ground<'_, K, B>,
    effect: &dyn Effect,
) -> Option<usize> {
    ground.problem.model.position(effect.replaces()?.name())
}

/// A gyro with an effect that has a given size, and whose other coefficients are such that the model's fit to
/// its curve comes as near as possible to the fit of the record.
///
/// Where an effect adds to octaves that a coefficient dominates, that coefficient would have been smaller
/// than it was found to be, and larger where the effect takes away from them. What the coefficients can
/// make up for does not show, and a record does not exclude it.
struct Beside<const K: usize, const B: usize> {
    /// The squared coefficients of the model's terms.
    squares: Vector,
    /// The squared coefficient of the effect.
    own: Real,
    /// The variances of octaves without the effect.
    rest: Rows<K, B>,
}

impl<const K: usize, const B: usize> Beside<K, B> {
    #[inline(never)]
    fn new(
        ground: &Ground<'_, K, B>,
        squares: &Vector,
        term: &Term,
        column: &Rows<K, B>,
        size: Real,
    ) -> Option<Self> {
        let problem = ground.problem;
        let place = replaced(ground, term.effect);
        let kept = place.filter(|_| is_of_shape(term.effect));
        let own = kept.map_or(size, |place| squares[place]);
        let taken = |k: usize| kept.map_or(0.0, |place| problem.unit(place, k) * squares[place]);
        let change = ground.followed(squares, &|k| own * column[k] - taken(k))?;
        let own = kept.map_or(own, |place| (squares[place] - change[place]).max(0.0));
        let squares = Vector::from_fn(|i| {
            if place == Some(i) || i >= problem.count() {
                0.0
            } else {
                (squares[i] - change[i]).max(0.0)
            }
        });
        let rest = |k: usize| problem.variance(k, &squares) - ground.change(k, &change);
        Some(Self {
            squares,
            own,
            rest: Rows::of(problem.rows(), rest),
        })
    }
}

/// The relative variance of an effect's power in the octave where it shows most, as far as it exceeds that of the
/// octave. A narrow resonance makes only a few independent swings in a record, so that all octaves that show
/// it rise and fall together.
#[inline(never)]
fn surplus<const K: usize, const B: usize>(ground: &Ground<'_, K, B>, term: &Term) -> Real {
    let problem = ground.problem;
    let shape = term.sampled_shape(problem.interval_s);
    if is_of_shape(term.effect) || term.effect.response(1.0, &shape).is_some() {
        return 0.0;
    }
    let column = problem.column(term);
    let share = |k: usize| column[k] / ground.weights.model[k];
    let octaves = 0..problem.points.len().min(K);
    let Some(most) = octaves.max_by(|&i, &j| share(i).total_cmp(&share(j))) else {
        return 0.0;
    };
    let mut alone = Model::default();
    // There is a place for a single effect.
    let _ = alone.add(*term);
    let mut variance = 0.0;
    let points = problem.points.get(..=most).unwrap_or_default();
    covariance_row(
        points,
        &alone,
        &[1.0],
        problem.interval_s,
        (most, most),
        &mut |_, value| variance = value,
    );
    let error = ground.weights.relative_error(most);
    (variance / (column[most] * column[most]) - error * error).max(0.0)
}
