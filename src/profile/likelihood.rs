//! χ² as a function of the shape of one effect, all coefficients fitted anew.

use crate::{
    error::Error,
    fit::{Problem, Weights, Whitened},
    limits::MAX_EFFECTS,
    model::Term,
    nnls::{Free, NormalEquations, Vector},
    real::{Real, real},
};

/// The fit of a curve with one effect of any shape among others whose shapes are known, in units in
/// which octaves are independent.
pub(crate) struct Profile<const K: usize> {
    /// Standard errors of the octaves are those of the measured curve instead of the model's.
    to_measured: bool,
    whitened: Whitened<K>,
    /// The equations of the others, and of the shape that was tried last.
    equations: NormalEquations,
    /// The effect's place among the others.
    place: usize,
    free: Free,
    held: Free,
}

impl<const K: usize> Profile<K> {
    /// A profile of no effect yet.
    #[inline(always)]
    pub(crate) fn empty() -> Self {
        Self {
            to_measured: false,
            whitened: Whitened::empty(),
            equations: NormalEquations::empty(),
            place: 0,
            free: Free::default(),
            held: Free::default(),
        }
    }

    /// Begins with a solved problem. With `to_measured`, the covariance is rescaled to the measured
    /// curve: before an effect is found, the model is too far off to say how much the octaves that it
    /// dominates scatter.
    #[inline(never)]
    pub(crate) fn begin(
        &mut self,
        problem: &Problem<'_, K>,
        weights: &Weights<K>,
        to_measured: bool,
    ) {
        self.to_measured = to_measured;
        let scatter = |k| scatter(problem, weights, to_measured, k);
        weights.whiten_into(problem, &scatter, &mut self.whitened);
    }

    /// Chooses an effect by its `place`: that of the effect that it replaces, or the first behind the
    /// others. The effects above zero are guessed to be those for which `squares` are.
    ///
    /// # Errors
    /// [`Error::TooManyEffects`] without such a place, [`Error::Singular`].
    #[inline(never)]
    pub(crate) fn choose(
        &mut self,
        problem: &Problem<'_, K>,
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
        self.held = problem.held();
        self.held.drop(place);
        let held = self.held;
        let above = |i: usize| i < MAX_EFFECTS && squares[i] > 0.0;
        self.free = Free::of(|i| i == place || (above(i) && !held.has(i)));
        Ok(())
    }

    /// Frees the effects that are held at zero as well.
    pub(crate) fn release(&mut self) {
        self.held = Free::default();
    }
}

/// A profile with what it is evaluated on.
pub(crate) struct Evaluation<'a, const K: usize> {
    profile: &'a mut Profile<K>,
    problem: &'a Problem<'a, K>,
    weights: &'a Weights<K>,
}

impl<'a, const K: usize> Evaluation<'a, K> {
    pub(crate) const fn new(
        profile: &'a mut Profile<K>,
        problem: &'a Problem<'a, K>,
        weights: &'a Weights<K>,
    ) -> Self {
        Self {
            profile,
            problem,
            weights,
        }
    }

    /// The best fit with the effect in this shape; χ² is infinite where there is none.
    #[inline(never)]
    pub(crate) fn found(&mut self, term: Term) -> Found {
        let Self {
            profile,
            problem,
            weights,
        } = self;
        let unit = problem.column(&term);
        let scatter = |k| scatter(problem, weights, profile.to_measured, k);
        let (column, size) = weights.whiten_trial(problem, &scatter, &|k| unit[k]);
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
        let (squares, _) = equations.solve_non_negative_near(&profile.free, &profile.held);
        Found {
            term,
            chi_squared: curve.norm_squared() - equations.explained(&squares),
            squares,
        }
    }
}

/// How much more than the model says octave `k` scatters.
fn scatter<const K: usize>(
    problem: &Problem<'_, K>,
    weights: &Weights<K>,
    to_measured: bool,
    k: usize,
) -> Real {
    match problem.points.get(k) {
        Some(_) if to_measured => problem.measured(k) / weights.model[k],
        _ => 1.0,
    }
}

/// A shape of an effect, and the best fit with it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    pub(crate) term: Term,
    pub(crate) chi_squared: Real,
    /// The squared coefficients, the effect's own at its place in the profile.
    pub(crate) squares: Vector,
}

impl Found {
    /// No fit with this shape.
    pub(crate) fn none(term: Term) -> Self {
        Self {
            term,
            chi_squared: Real::INFINITY,
            squares: Vector::zeros(),
        }
    }

    /// Becomes the other one if that explains the curve better, and returns whether it does.
    pub(crate) fn improve(&mut self, other: Self) -> bool {
        let better = other.chi_squared < self.chi_squared;
        if better {
            *self = other;
        }
        better
    }
}
