//! The values of a shape parameter that explain a curve nearly as well as the best one.

use super::{
    evaluations_a_call,
    grid::Grid,
    likelihood::{Evaluation, Found},
    search::GridSearch,
};
use crate::{
    limits::{CHI_SQUARED_95, MAX_PARAMETERS},
    numerics::{
        math,
        real::{Real, real},
    },
    theory::{effect::Span, model::Term},
};

/// The first step of the logarithm away from the best value. Steps double until they lead outside the
/// interval. Chosen by hand: it is about the smallest error of a shape in
/// `cargo xtask study hidden-effect`, 0.4 %.
const FIRST_STEP: Real = 0.005;
/// How often the last step is halved once a step has led to a place inside. Six halvings find an end to a 64th of that
/// step, which is at most 2 % of the interval's half-width.
const HALVINGS: u8 = 6;
/// The step from which on halvings count even if no step has led to a place inside. No record tells a shape as well.
const SMALLEST: Real = 1e-6;

/// The search for one end of an interval, where χ² has risen by so much.
struct End {
    /// The direction of the search: 1 upwards, −1 downwards.
    direction: Real,
    /// The distance of the logarithm that is known to lie inside, and the step beyond it that is tried
    /// next.
    inside: Real,
    step: Real,
    /// The number of halvings so far; `None` until a step has led outside.
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

    /// Does one evaluation. Returns the end when it is found.
    fn advance<const K: usize, const B: usize>(
        &mut self,
        best: &Found,
        j: usize,
        grid: &Grid,
        most: Real,
        evaluation: &mut Evaluation<'_, K, B>,
    ) -> Option<Real> {
        let value = best.term.parameter(j);
        let at = |distance: Real| value * math::exp(self.direction * distance);
        if self.halvings.is_none() {
            // The end of the range is tried before it is taken for the end of the interval.
            let last = if self.direction < 0.0 {
                grid.low.min(value)
            } else {
                grid.high.max(value)
            };
            let room = self.direction * math::log(last / value) - self.inside;
            if room >= SMALLEST {
                self.step = self.step.min(room);
            } else {
                return Some(last);
            }
        }
        let mut halvings = self.halvings;
        if let Some(halvings) = &mut halvings {
            if *halvings >= HALVINGS {
                return Some(at(self.inside));
            }
            if self.inside > 0.0 || self.step < SMALLEST {
                *halvings = halvings.saturating_add(1);
            }
            self.step *= 0.5;
        }
        let mut term = best.term;
        term.set_parameter(
            j,
            value * math::exp(self.direction * (self.inside + self.step)),
        );
        let rise = evaluation.found(term).chi_squared - best.chi_squared;
        // A NaN counts as outside.
        let is_inside = rise <= most;
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

/// The 95 % interval of a fitted parameter: the values at which χ² exceeds its minimum by no more than
/// the quantile of one degree of freedom. All coefficients are free, even where another effect could take the shape's place. The
/// interval is joined with the intervals at those values of a whole-numbered parameter that explain the
/// curve as well.
pub(crate) struct JointInterval {
    /// The parameter.
    j: usize,
    grid: Grid,
    /// The rise of χ² from the best value to the ends of the interval.
    rise: Real,
    known: Found,
    /// The best shape at the whole numbers whose interval is being computed.
    best: Found,
    ends: [End; 2],
    lower: Real,
    upper: Real,
    /// The whole-numbered parameter that comes next, and the step of its grid.
    whole: usize,
    step: u32,
    stage: Stage,
}

// Large variants share their memory with those of other stages.
#[allow(clippy::large_enum_variant)]
enum Stage {
    /// One end of the interval is being searched for.
    Bounding { upper: bool },
    /// The next value of a whole-numbered parameter is chosen.
    Choosing,
    /// Their best shape is looked for.
    Searching(GridSearch),
}

impl JointInterval {
    /// Begins with the interval of a parameter around a known shape. The errors are multiplied by
    /// `widened`.
    pub(crate) fn new<const K: usize, const B: usize>(
        evaluation: &mut Evaluation<'_, K, B>,
        term: Term,
        j: usize,
        span: &Span,
        widened: Real,
    ) -> Self {
        let known = evaluation.found(term);
        let value = term.parameter(j);
        Self {
            j,
            grid: Grid::of(term.effect, j, span),
            rise: real(CHI_SQUARED_95) * widened * widened,
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

    /// Does some evaluations. Returns the interval when there are no more to do.
    #[inline(never)]
    pub(crate) fn advance<const K: usize, const B: usize>(
        &mut self,
        evaluation: &mut Evaluation<'_, K, B>,
        span: &Span,
    ) -> Option<(Real, Real)> {
        for _ in 0..evaluations_a_call(B) {
            match &mut self.stage {
                Stage::Bounding { upper } => {
                    let [lower_end, upper_end] = &mut self.ends;
                    let end = if *upper { upper_end } else { lower_end };
                    let reached =
                        end.advance(&self.best, self.j, &self.grid, self.rise, evaluation);
                    match (reached, *upper) {
                        (None, _) => {}
                        (Some(reached), false) => {
                            self.lower = self.lower.min(reached);
                            *upper = true;
                        }
                        (Some(reached), true) => {
                            let is_end = reached >= self.grid.high;
                            let end = span.end_of(self.grid.high);
                            let reached = if is_end { reached.max(end) } else { reached };
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
                        let as_good = found.chi_squared < self.known.chi_squared + self.rise;
                        self.stage = if as_good {
                            Stage::Bounding { upper: false }
                        } else {
                            Stage::Choosing
                        };
                    }
                    // A refinement has done all the evaluations that a call may do.
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
