//! A model with one more effect, fitted in full.

use super::{Candidate, Standing, span};
use crate::{
    curve::Curve,
    effect::Span,
    error::Error,
    fit::{Problem, generalized::Solution},
    model::{MAX_EFFECTS, Model},
    nnls::Vector,
    search::{Found, Search},
};

/// Rounds of fitting and polishing the shapes of a candidate.
const POLISHES: usize = 4;
/// A gain of `−2 ln L` that ends the rounds.
const SETTLED: f64 = 0.05;

/// A model with one more effect, and its squared coefficients.
#[derive(Clone, Debug)]
pub(super) struct Better {
    pub(super) model: Model,
    pub(super) squares: Vector,
}

impl Better {
    /// With an effect as a scan found it.
    pub(super) fn new(model: &Model, standing: &Standing, found: &Found) -> Result<Self, Error> {
        let replaced = found.term.effect.replaces().map(|effect| effect.name());
        let mut extended = model.without(replaced.unwrap_or(""));
        extended.add(found.term)?;
        let mut squares = Vector::zeros();
        for (i, term) in extended.terms().iter().enumerate() {
            squares[i] = match model.position(term.effect.name()) {
                Some(at) if i + 1 < extended.terms().len() => standing.squares[at],
                _ => found.square,
            };
        }
        Ok(Self {
            model: extended,
            squares,
        })
    }

    /// Fits the model with its own covariance, and polishes the shapes, as long as that helps. `None`
    /// where it does not settle.
    #[inline(never)]
    pub(super) fn fit<const K: usize>(
        &mut self,
        curve: &Curve<K>,
        before: f64,
        tolerance: f64,
    ) -> Result<Option<Candidate>, Error> {
        let span = span(curve);
        let mut next = self.clone();
        let mut best: Option<(f64, Candidate)> = None;
        for _ in 0..POLISHES {
            let round = next.round(curve, tolerance, &span)?;
            let Some((now, mut candidate, fitted)) = round else {
                continue;
            };
            let score = best.map_or(f64::INFINITY, |(score, _)| score);
            if now >= score {
                break;
            }
            let parameters = 1 + candidate.term.fitted_parameters().count();
            candidate.improvement = before - now - 2.0 * parameters as f64;
            best = Some((now, candidate));
            *self = fitted;
            if score - now < SETTLED {
                break;
            }
        }
        Ok(best.map(|(_, candidate)| candidate))
    }

    /// One round: the score, the candidate and what was fitted, while `self` has the polished shapes
    /// for the next round. `None` if a coefficient had to be held at zero first.
    #[inline(never)]
    fn round<const K: usize>(
        &mut self,
        curve: &Curve<K>,
        tolerance: f64,
        span: &Span,
    ) -> Result<Option<(f64, Candidate, Self)>, Error> {
        let fitted_model = self.model.clone();
        let problem = Problem::new(curve, &fitted_model);
        let mut solution = Solution::new(&problem);
        solution.converge(self.squares, tolerance)?;
        self.squares = solution.squares;
        if let Some(confused) = solution.confused() {
            self.model.terms_mut()[confused].held = true;
            self.squares[confused] = 0.0;
            polish(&mut self.model, &problem, &solution, &self.squares, span)?;
            return Ok(None);
        }
        let at = fitted_model.terms().len() - 1;
        let candidate = Candidate {
            term: fitted_model.terms()[at],
            coefficient: solution.coefficient_of(at),
            chi_squared: solution.chi_squared,
            improvement: 0.0,
        };
        polish(&mut self.model, &problem, &solution, &self.squares, span)?;
        let fitted = Self {
            squares: solution.squares,
            model: fitted_model.clone(),
        };
        Ok(Some((
            solution.minus_two_log_likelihood(),
            candidate,
            fitted,
        )))
    }
}

/// The best shape of every fitted effect, each with the others as they were fitted.
fn polish<const K: usize>(
    model: &mut Model,
    problem: &Problem<'_, K>,
    solution: &Solution<'_, '_, K>,
    squares: &Vector,
    span: &Span,
) -> Result<(), Error> {
    for at in 0..MAX_EFFECTS.min(model.terms().len()) {
        let term = model.terms()[at];
        if !term.fitted || squares[at] <= 0.0 {
            continue;
        }
        let mut search = Search::new(problem, &solution.weights, squares, at, false)?;
        model.terms_mut()[at] = search.refine_known(term, span).term;
    }
    Ok(())
}
