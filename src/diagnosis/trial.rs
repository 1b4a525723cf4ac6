//! A model with one more effect, fitted in full.

use super::{Candidate, span};
use crate::{
    curve::Curve,
    effect::Span,
    error::Error,
    fit::{
        Problem,
        generalized::{Rounds, Solution},
    },
    model::{MAX_EFFECTS, Model},
    nnls::Vector,
    search::{Found, Search},
};

/// Rounds of fitting and polishing the shapes of a candidate.
const ROUNDS: usize = 10;
/// A change of `−2 ln L` that ends the rounds.
const SETTLED: f64 = 0.3;
/// A lag of `−2 ln L` behind the best candidate that ends them too …
const HOPELESS: f64 = 60.0;
/// … where a round makes up for less than this share of it.
const CATCHING_UP: f64 = 0.1;

/// A model with one more effect, and its squared coefficients.
#[derive(Clone, Debug)]
pub(super) struct Better {
    pub(super) model: Model,
    pub(super) squares: Vector,
}

impl Better {
    /// With an effect as a scan found it: at the place of what it replaces, or behind the others.
    pub(super) fn new(model: &Model, found: &Found) -> Result<Self, Error> {
        let replaced = found.term.effect.replaces().map(|effect| effect.name());
        let place = replaced.and_then(|name| model.position(name));
        let mut better = Self {
            model: model.without(replaced.unwrap_or("")),
            squares: Vector::zeros(),
        };
        for (i, term) in better.model.terms().iter().enumerate() {
            let at = model.position(term.effect.name()).unwrap_or(i);
            better.squares[i] = found.squares[at];
        }
        let last = better.model.terms().len();
        better.model.add(found.term)?;
        better.squares[last] = found.squares[place.unwrap_or(last)];
        Ok(better)
    }

    /// Fits the model with its own covariance, polishing the shapes in turn, until its score settles
    /// or lags behind the `best` so far without catching up. `None` where a
    /// coefficient has to be held at zero in every round.
    #[inline(never)]
    pub(super) fn fit<const K: usize>(
        &mut self,
        curve: &Curve<K>,
        tolerance: f64,
        best: f64,
    ) -> Result<Option<(f64, Candidate)>, Error> {
        let span = span(curve);
        let mut last: Option<(f64, Candidate)> = None;
        for _ in 0..ROUNDS {
            let rounds = if last.is_none() {
                Rounds::All
            } else {
                Rounds::One
            };
            let Some(now) = self.round(curve, tolerance, &span, rounds)? else {
                continue;
            };
            let before = last.map_or(f64::INFINITY, |(score, _)| score);
            let (gain, lag) = (before - now.0, now.0 - best);
            last = Some(now);
            let settled = gain < SETTLED && gain > -SETTLED;
            if settled || (lag > HOPELESS && gain < CATCHING_UP * lag) {
                break;
            }
        }
        Ok(last)
    }

    /// One round: the score, and the candidate without its improvement. `None` if a coefficient has to
    /// be held at zero first.
    #[inline(never)]
    fn round<const K: usize>(
        &mut self,
        curve: &Curve<K>,
        tolerance: f64,
        span: &Span,
        rounds: Rounds,
    ) -> Result<Option<(f64, Candidate)>, Error> {
        let model = self.model.clone();
        let problem = Problem::new(curve, &model);
        let mut solution = Solution::new(&problem);
        solution.converge(self.squares, tolerance, rounds)?;
        self.squares = solution.squares;
        let confused = solution.confused();
        if let Some(confused) = confused {
            self.model.terms_mut()[confused].held = true;
            self.squares[confused] = 0.0;
        }
        polish(&mut self.model, &problem, &solution, &self.squares, span)?;
        if confused.is_some() {
            return Ok(None);
        }
        let at = model.terms().len() - 1;
        let candidate = Candidate {
            term: model.terms()[at],
            coefficient: solution.coefficient_of(at),
            chi_squared: solution.chi_squared,
            improvement: 0.0,
        };
        Ok(Some((solution.minus_two_log_likelihood(), candidate)))
    }
}

/// The best shape of every fitted effect, each with the others as they were fitted.
#[inline(never)]
fn polish<const K: usize>(
    model: &mut Model,
    problem: &Problem<'_, K>,
    solution: &Solution<'_, '_, K>,
    squares: &Vector,
    span: &Span,
) -> Result<(), Error> {
    let mut search = Search::new(problem, &solution.weights, false);
    for at in 0..MAX_EFFECTS.min(model.terms().len()) {
        let term = model.terms()[at];
        if !term.fitted || squares[at] <= 0.0 {
            continue;
        }
        search.at(at, squares)?;
        model.terms_mut()[at] = search.refine_known(term, span).term;
    }
    Ok(())
}
