//! The values of a shape parameter that explain a curve nearly as well as the best one.

use super::{
    EVALUATIONS_A_CALL,
    grid::Grid,
    likelihood::{Evaluation, Found},
    search::GridSearch,
};
use crate::{
    effect::Span,
    limits::{CHI_SQUARED_95, MAX_PARAMETERS},
    math,
    model::Term,
    real::Real,
};

/// By how much χ² rises to the ends of a 95 % interval.
const RISE: Real = CHI_SQUARED_95 as Real;
/// The first step of the logarithm away from the best value; steps double until they lead outside.
const FIRST_STEP: Real = 0.005;
/// How often the last step is halved then.
const HALVINGS: u8 = 6;

/// One end of an interval: the way to where χ² has risen by [`RISE`].
struct End {
    /// 1 upwards, −1 downwards.
    direction: Real,
    /// Distances of the logarithm that are known to lie inside, and that is tried next beyond.
    inside: Real,
    step: Real,
    /// Halvings so far, once the way has led outside.
    halvings: Option<u8>,
}

impl End {
    const fn new(direction: Real) -> Self {
        Self {
            direction,
            inside: 0.0,
            step: FIRST_STEP,
            halvings: None,
        }
    }

    /// Does one evaluation; returns the end when it is found.
    fn advance<const K: usize>(
        &mut self,
        best: &Found,
        j: usize,
        grid: &Grid,
        evaluation: &mut Evaluation<'_, K>,
    ) -> Option<Real> {
        let value = best.term.parameter(j);
        let at = |distance: Real| value * math::exp(self.direction * distance);
        if self.halvings.is_none() && !(grid.low..=grid.high).contains(&at(self.inside + self.step))
        {
            return Some(if self.direction < 0.0 {
                grid.low.min(value)
            } else {
                grid.high.max(value)
            });
        }
        let mut halvings = self.halvings;
        if let Some(halvings) = &mut halvings {
            if *halvings >= HALVINGS {
                return Some(at(self.inside));
            }
            *halvings = halvings.saturating_add(1);
            self.step *= 0.5;
        }
        let mut term = best.term;
        term.set_parameter(
            j,
            value * math::exp(self.direction * (self.inside + self.step)),
        );
        let rise = evaluation.found(term).chi_squared - best.chi_squared;
        // NaN counts as outside.
        let is_inside = rise <= RISE;
        if is_inside {
            self.inside += self.step;
        }
        self.halvings = match (halvings, is_inside) {
            (None, true) => {
                self.step *= 2.0;
                None
            }
            (None, false) => Some(0),
            (some, _) => some,
        };
        None
    }
}

/// The interval of a fitted parameter in which χ² stays within that of 95 % of the least, all
/// coefficients free, also where another effect could take the shape's place. It is joined with the
/// intervals at the other values of a whole-numbered parameter that explain the curve as well.
pub(crate) struct JointInterval {
    /// The parameter.
    j: usize,
    grid: Grid,
    known: Found,
    /// The best shape of the whole numbers that are bounded now.
    best: Found,
    ends: [End; 2],
    lower: Real,
    upper: Real,
    /// The whole-numbered parameter and the step of its grid that come next.
    whole: usize,
    step: u32,
    stage: Stage,
}

enum Stage {
    /// One end of the interval is looked for.
    Bounding { upper: bool },
    /// Other whole numbers come next.
    Choosing,
    /// Their best shape is looked for.
    Searching(GridSearch),
}

impl JointInterval {
    /// Begins with the interval of a parameter around a known shape.
    pub(crate) fn new<const K: usize>(
        evaluation: &mut Evaluation<'_, K>,
        term: Term,
        j: usize,
        span: &Span,
    ) -> Self {
        let known = evaluation.found(term);
        let value = term.parameter(j);
        Self {
            j,
            grid: Grid::of(term.effect, j, span),
            known,
            best: known,
            ends: [End::new(-1.0), End::new(1.0)],
            lower: value,
            upper: value,
            whole: 0,
            step: 0,
            stage: Stage::Bounding { upper: false },
        }
    }

    /// Does some evaluations; returns the interval when no more are to do.
    #[inline(never)]
    pub(crate) fn advance<const K: usize>(
        &mut self,
        evaluation: &mut Evaluation<'_, K>,
        span: &Span,
    ) -> Option<(Real, Real)> {
        for _ in 0..EVALUATIONS_A_CALL {
            match &mut self.stage {
                Stage::Bounding { upper } => {
                    let [lower_end, upper_end] = &mut self.ends;
                    let end = if *upper { upper_end } else { lower_end };
                    let reached = end.advance(&self.best, self.j, &self.grid, evaluation);
                    match (reached, *upper) {
                        (None, _) => {}
                        (Some(reached), false) => {
                            self.lower = self.lower.min(reached);
                            *upper = true;
                        }
                        (Some(reached), true) => {
                            self.upper = self.upper.max(reached);
                            self.stage = Stage::Choosing;
                        }
                    }
                }
                Stage::Choosing => {
                    let Some((j, value)) = self.next_whole(span) else {
                        return Some((self.lower, self.upper));
                    };
                    let effect = self.known.term.effect;
                    self.stage = Stage::Searching(GridSearch::with(effect, j, value, span));
                }
                Stage::Searching(search) => {
                    if let Some(found) = search.advance(evaluation) {
                        self.best = found;
                        self.ends = [End::new(-1.0), End::new(1.0)];
                        let as_good = found.chi_squared < self.known.chi_squared + RISE;
                        self.stage = if as_good {
                            Stage::Bounding { upper: false }
                        } else {
                            Stage::Choosing
                        };
                    }
                    // A search has done as many evaluations as a call may.
                    return None;
                }
            }
        }
        None
    }

    /// The next value of a whole-numbered parameter, and which one it is of.
    fn next_whole(&mut self, span: &Span) -> Option<(usize, Real)> {
        let effect = self.known.term.effect;
        let count = effect.parameters().len().min(MAX_PARAMETERS);
        while self.whole < count {
            let grid = Grid::of(effect, self.whole, span);
            if effect.is_whole(self.whole) && self.step < grid.steps {
                let value = grid.at(self.step);
                self.step = self.step.saturating_add(1);
                return Some((self.whole, value));
            }
            self.whole = self.whole.saturating_add(1);
            self.step = 0;
        }
        None
    }
}
