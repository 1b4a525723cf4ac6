//! χ² as a function of the shape of one effect, with all coefficients fitted anew.

use crate::{
    error::Error,
    fit::{Problem, Weights, Whitened},
    limits::MAX_EFFECTS,
    numerics::{
        nnls::{NormalEquations, PassiveSet, Vector},
        real::{Real, real},
    },
    theory::model::Term,
};

/// The fit of a curve with one effect of any shape, beside other effects of known shapes. It is
/// computed in units in which octaves are independent.
pub(crate) struct Profile<const K: usize, const B: usize = 0> {
    whitened: Whitened<K, B>,
    /// The equations of the other effects, and of the effect with the shape that was tried last.
    equations: NormalEquations,
    /// The effect's place in the model.
    place: usize,
    free: PassiveSet,
    pinned: PassiveSet,
}

impl<const K: usize, const B: usize> Profile<K, B> {
    /// A profile of no effect yet.
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const EMPTY: Self = Self {
        whitened: Whitened::EMPTY,
        equations: NormalEquations::EMPTY,
        place: 0,
        free: PassiveSet::NONE,
        pinned: PassiveSet::NONE,
    };

    /// Begins with a problem and its weights.
    #[inline(never)]
    pub(crate) fn begin(&mut self, problem: &Problem<'_, K, B>, weights: &Weights<K, B>) {
        weights.whiten_into(problem, &mut self.whitened);
    }

    /// Chooses an effect by its `place`, which is that of the effect that it replaces, or the first one
    /// behind the others. The first guess is that the effects above zero are those with positive
    /// `squares`.
    ///
    /// # Errors
    /// [`Error::TooManyEffects`] if there is no such place, [`Error::Singular`] if a column is zero or
    /// not finite.
    #[inline(never)]
    pub(crate) fn choose(
        &mut self,
        problem: &Problem<'_, K, B>,
        place: usize,
        squares: &Vector,
    ) -> Result<(), Error> {
        if place >= MAX_EFFECTS {
            return Err(Error::TooManyEffects {
                capacity: MAX_EFFECTS,
            });
        }
        let Whitened { columns, curve } = &self.whitened;
        let own = |i: usize| columns.get(i);
        self.equations
            .set(columns.len().max(place.saturating_add(1)), &|i, row| {
                for j in 0..=i {
                    let element = match (i == place || j == place, own(i).zip(own(j))) {
                        (false, Some((one, other))) => one.dot(other),
                        _ => real(u8::from(i == j)),
                    };
                    row.put(j, element);
                }
                own(i).map_or(0.0, |column| column.dot(curve))
            })?;
        self.place = place;
        self.pinned = problem.pinned();
        self.pinned.drop(place);
        let pinned = self.pinned;
        let above = |i: usize| i < MAX_EFFECTS && squares[i] > 0.0;
        self.free = PassiveSet::of(|i| i == place || (above(i) && !pinned.has(i)));
        Ok(())
    }

    /// Frees also the effects that are held at zero.
    pub(crate) fn release(&mut self) {
        self.pinned = PassiveSet::default();
    }
}

/// A profile, with the problem and the weights for which it is evaluated.
pub(crate) struct Evaluation<'a, const K: usize, const B: usize = 0> {
    profile: &'a mut Profile<K, B>,
    problem: &'a Problem<'a, K, B>,
    weights: &'a Weights<K, B>,
}

impl<'a, const K: usize, const B: usize> Evaluation<'a, K, B> {
    pub(crate) const fn new(
        profile: &'a mut Profile<K, B>,
        problem: &'a Problem<'a, K, B>,
        weights: &'a Weights<K, B>,
    ) -> Self {
        Self {
            profile,
            problem,
            weights,
        }
    }

    /// The best fit with the effect in this shape, or in the [distinct](crate::effect::Effect::distinct) one that is as
    /// good. Its χ² is infinite if there is no fit.
    #[inline(never)]
    pub(crate) fn found(&mut self, term: Term) -> Found {
        let Self {
            profile,
            problem,
            weights,
        } = self;
        let mut term = term;
        term.make_distinct(problem.interval_s);
        let unit = problem.column(&term);
        let (column, size) = weights.whiten_trial(problem, &|k| unit[k]);
        let column = column.map(|x| real(x) * size);
        let (others, curve) = (&profile.whitened.columns, &profile.whitened.curve);
        let exchanged = profile.equations.exchange(
            profile.place,
            &|i| match others.get(i) {
                Some(other) if i != profile.place => other.dot(&column),
                _ => column.norm_squared(),
            },
            column.dot(curve),
        );
        if exchanged.is_err() {
            return Found::none(term);
        }
        let equations = &profile.equations;
        let (squares, _) = equations.solve_non_negative_near(&profile.free, &profile.pinned);
        Found {
            term,
            chi_squared: curve.norm_squared() - equations.explained(&squares),
        }
    }
}

/// A shape of an effect, and the best fit with it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    pub(crate) term: Term,
    pub(crate) chi_squared: Real,
}

impl Found {
    /// The shape without a fit.
    pub(crate) const fn none(term: Term) -> Self {
        Self {
            term,
            chi_squared: Real::INFINITY,
        }
    }

    /// Replaces this shape by the other one if that explains the curve better, and returns whether it
    /// does.
    pub(crate) fn improve(&mut self, other: Self) -> bool {
        let better = other.chi_squared < self.chi_squared;
        if better {
            *self = other;
        }
        better
    }
}
