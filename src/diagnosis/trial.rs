//! The trial of a model with one more effect: it is fitted with its own covariance, and its shapes are
//! polished.

use super::step::Candidate;
use crate::{
    effect::Span,
    error::Error,
    fit::{ADEQUATE_P, Problem, ShapeEquations, Start, Tolerance, Work},
    limits::MAX_SHAPE,
    math,
    model::Model,
    nnls::Vector,
    observed::Observed,
    profile::{Found, Neighbourhood},
    real::{Real, real, single},
};
use heapless::Vec;

/// The largest number of rounds of fitting a candidate and polishing its shapes. Chosen by hand.
/// `cargo xtask study hidden-effect` runs with this value and does not vary it.
const ROUNDS: u8 = 10;
/// The rounds end when `−2 ln L` changes by less than this. Chosen by hand, to save rounds: it is small
/// beside the improvement of 8 for which an effect is accepted.
const SETTLED: Real = 0.5;
/// The rounds end as well when `−2 ln L` lags behind that of the best candidate by more than this, and
/// a round makes up for less than the share [`CATCHING_UP`] of the lag. If that candidate explains the observed,
/// nothing can lead it by so much, and the trial ends with the round. Chosen by hand.
/// `cargo xtask study hidden-effect` runs with this value and does not vary it.
const HOPELESS: Real = 60.0;
/// The share of the lag behind the best candidate that a round must make up for; see [`HOPELESS`].
/// Chosen by hand, to save rounds. `cargo xtask study hidden-effect` runs with this value and does not
/// vary it.
const CATCHING_UP: Real = 0.25;
/// The largest step of a shape's logarithm. Chosen by hand: a round changes a shape by at most 22 %.
/// `cargo xtask study hidden-effect` runs with this value and does not vary it.
const STRIDE: Real = 0.2;
/// How often a step may be halved because it led too far. Chosen by hand: the last step is then a
/// sixteenth of the first. `cargo xtask study hidden-effect` runs with this value and does not vary it.
const HALVINGS: u8 = 4;

/// If the rounds do not explain the observed, they are repeated from a shape of the neighbourhood that lowers
/// χ² by this factor at least. Chosen by hand: a minimum that is no better is not worth the rounds.
const MUCH_BETTER: Real = 0.5;

/// Changes of the logarithms of fitted shapes, with the place of the effect and of the parameter.
type Steps = Vec<(u8, u8, f32), MAX_SHAPE>;

/// A model, and the squared coefficients at which its covariance is taken.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    pub(super) model: Model,
    pub(super) squares: Vector,
}

impl Fitted {
    /// A model of no effects.
    #[inline(always)]
    pub(super) fn empty() -> Self {
        Self {
            model: Model::default(),
            squares: Vector::zeros(),
        }
    }

    /// A model with one more effect, as a scan found it. The effect takes the place of the effect that
    /// it replaces, or the last place.
    ///
    /// # Errors
    /// [`Error::TooManyEffects`] if the model has no room.
    pub(super) fn with(model: &Model, found: &Found) -> Result<Self, Error> {
        let mut model = model.clone();
        let mut squares = found.squares;
        let replaced = found.term.effect.replaces();
        if let Some(place) = replaced.and_then(|effect| model.remove(effect.name())) {
            // The square of the effect moves to the end, as the effect does.
            for i in place..model.terms().len() {
                let (one, other) = (squares[i], squares[i.saturating_add(1)]);
                squares.put(i, other);
                squares.put(i.saturating_add(1), one);
            }
        }
        model.add(found.term)?;
        Ok(Self { model, squares })
    }

    /// A model without the effect at a place. What the effect replaced comes back with its square.
    ///
    /// # Errors
    /// [`Error::TooManyEffects`] never occurs, because one effect less leaves room for another.
    pub(super) fn without(model: &Model, squares: &Vector, place: usize) -> Result<Self, Error> {
        let mut rest = *squares;
        let mut shorter = model.clone();
        shorter.take(place);
        let count = shorter.terms().len();
        for i in place..count {
            rest.put(i, squares[i.saturating_add(1)]);
        }
        rest.put(count, 0.0);
        // What was held at zero because of the effect is free again.
        for term in shorter.terms_mut() {
            term.held = false;
        }
        let replaced = model
            .terms()
            .get(place)
            .and_then(|term| term.effect.replaces());
        if let Some(replaced) = replaced {
            let back = shorter.restore(replaced)?;
            for i in (back..count).rev() {
                let moved = rest[i];
                rest.put(i.saturating_add(1), moved);
            }
            rest.put(back, squares[place]);
        }
        Ok(Self {
            model: shorter,
            squares: rest,
        })
    }

    /// Changes the logarithms of shapes within their ranges.
    fn change(&mut self, steps: &Steps, sign: Real, span: &Span) {
        for &(i, j, step) in steps {
            let (j, step) = (usize::from(j), real(step));
            let Some(term) = self.model.terms_mut().get_mut(usize::from(i)) else {
                continue;
            };
            let Some(range) = term.effect.search_range(j, span) else {
                continue;
            };
            let changed = term.parameter(j) * math::exp(sign * step);
            let highest = range.high.max(range.low);
            term.set_parameter(j, changed.max(range.low).min(highest));
        }
    }
}

/// The fit of a model with one more effect, in progress. Each round takes the covariance, fits the
/// coefficients, and changes the shapes by the method of Gauss and Newton. At last, the coefficients
/// are fitted with fixed shapes.
pub(super) struct Trial {
    present: Fitted,
    /// The best model so far, and its score.
    kept: Option<(Fitted, Real)>,
    before: Real,
    steps: Steps,
    halvings: u8,
    round: u8,
    stage: Stage,
    /// The search around the shape, once the rounds are over; `None` before it is needed.
    neighbourhood: Option<Neighbourhood>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    /// A round begins.
    Begin,
    /// The coefficients of a round are fitted.
    Round,
    /// The shapes are changed.
    Polishing,
    /// The neighbourhood is searched.
    Looking,
    /// The last fit begins.
    BeginLast,
    /// The best round is fitted again, with fixed shapes.
    Last,
}

/// The best of the other candidates.
#[derive(Clone, Copy)]
pub(super) struct Rival {
    /// Its `−2 ln L`, costs included.
    pub(super) score: Real,
    /// Whether its model is adequate.
    pub(super) explains: bool,
}

/// The fit of a candidate, the squares at which its covariance was taken, and its score.
pub(super) struct Completed {
    pub(super) fitted: Fitted,
    pub(super) score: Real,
    /// Whether the model is adequate.
    pub(super) explains: bool,
}

impl Trial {
    /// Begins with a model.
    pub(super) fn new(fitted: Fitted) -> Self {
        Self {
            present: fitted,
            kept: None,
            before: Real::INFINITY,
            steps: Steps::new(),
            halvings: 0,
            round: 0,
            stage: Stage::Begin,
            neighbourhood: None,
        }
    }

    /// Does one piece of work. When the fit is complete, returns it and writes its effect, coefficient
    /// and χ² to the candidate. The rounds end early if the score lags behind that of the `best` of the other
    /// candidates without catching up.
    ///
    /// # Errors
    /// An error means that the model cannot be fitted. The effect is then no candidate.
    #[inline(never)]
    pub(super) fn advance<const K: usize, const B: usize>(
        &mut self,
        observed: Observed<'_, K, B>,
        span: &Span,
        tolerance: Real,
        best: Option<Rival>,
        work: &mut Work<K, B>,
        candidate: &mut Candidate,
    ) -> Result<Option<Completed>, Error> {
        match self.stage {
            Stage::Begin => {
                let squares = self.present.squares;
                self.begin(
                    Stage::Round,
                    Start::Once(squares),
                    observed,
                    tolerance,
                    work,
                )?;
                return Ok(None);
            }
            Stage::BeginLast => {
                let (fitted, _) = self.kept.take().ok_or(Error::Singular)?;
                self.present = fitted;
                let squares = self.present.squares;
                self.begin(Stage::Last, Start::From(squares), observed, tolerance, work)?;
                return Ok(None);
            }
            _ => {}
        }
        let problem = Problem::new(observed, &self.present.model, &work.columns);
        match self.stage {
            Stage::Looking => {
                let looking = self.neighbourhood.as_mut();
                let seen =
                    looking.and_then(|looking| looking.advance(&problem, &work.solver, span));
                match seen {
                    None => {}
                    Some(seen)
                        if seen.chi_squared < MUCH_BETTER * work.solver.squared_residuals =>
                    {
                        self.begin_again(&seen);
                        self.stage = Stage::Begin;
                    }
                    Some(_) => self.stage = Stage::BeginLast,
                }
            }
            Stage::Polishing => {
                let squares = &work.solver.squares;
                if !work.derivatives.advance(&problem, squares) {
                    return Ok(None);
                }
                if self.end_round(observed, span, best, work) {
                    let problem = Problem::new(observed, &self.present.model, &work.columns);
                    return Ok(Some(self.complete(&problem, work, candidate)));
                }
            }
            _ => {
                if !work.solver.advance(&problem)? {
                    return Ok(None);
                }
                if self.stage == Stage::Last {
                    return Ok(Some(self.complete(&problem, work, candidate)));
                }
                work.derivatives.clear();
                self.stage = Stage::Polishing;
            }
        }
        Ok(None)
    }

    /// Ends a round whose coefficients are fitted: changes the shapes and decides what comes next. Returns whether the
    /// trial is over.
    #[inline(never)]
    fn end_round<const K: usize, const B: usize>(
        &mut self,
        observed: Observed<'_, K, B>,
        span: &Span,
        best: Option<Rival>,
        work: &Work<K, B>,
    ) -> bool {
        let problem = Problem::new(observed, &self.present.model, &work.columns);
        let mut next = Steps::new();
        let confused = polish(&problem, work, &mut next);
        self.present.squares = work.solver.squares;
        let now = work.solver.minus_two_log_likelihood();
        let adequate = best.filter(|best| best.explains);
        if confused.is_none() && self.is_hopeless(now, adequate) {
            return true;
        }
        let goes_on = match confused {
            Some(confused) => {
                // This is another model, whose scores cannot be compared with the earlier ones.
                if let Some(term) = self.present.model.terms_mut().get_mut(confused) {
                    term.held = true;
                }
                self.present.squares.put(confused, 0.0);
                self.before = Real::INFINITY;
                true
            }
            None => self.step(now, best, next, span),
        };
        self.round = self.round.saturating_add(1);
        let last = self.present.model.terms().last().copied();
        self.stage = match last {
            _ if goes_on && self.round < ROUNDS => Stage::Begin,
            Some(term) if self.neighbourhood.is_none() && work.solver.p_value() < ADEQUATE_P => {
                self.neighbourhood = Some(Neighbourhood::new(term));
                Stage::Looking
            }
            _ => Stage::BeginLast,
        };
        false
    }

    /// Begins the rounds again, from a shape of the neighbourhood.
    fn begin_again(&mut self, seen: &Found) {
        if let Some(last) = self.present.model.terms_mut().last_mut() {
            last.parameters = seen.term.parameters;
        }
        self.present.squares = seen.squares;
        self.before = Real::INFINITY;
        self.halvings = 0;
        self.round = 0;
    }

    /// Begins the fit of a stage.
    fn begin<const K: usize, const B: usize>(
        &mut self,
        stage: Stage,
        start: Start,
        observed: Observed<'_, K, B>,
        tolerance: Real,
        work: &mut Work<K, B>,
    ) -> Result<(), Error> {
        self.stage = stage;
        let tolerance = Tolerance::Fixed(tolerance);
        work.begin_at(observed, &self.present.model, start, tolerance)
    }

    /// Keeps a round that is the best so far, and changes the shapes for the next round. Returns
    /// whether there is a next round.
    fn step(&mut self, now: Real, best: Option<Rival>, next: Steps, span: &Span) -> bool {
        let gain = self.before - now;
        let is_best = self.kept.as_ref().is_none_or(|(_, score)| now < *score);
        if is_best {
            self.kept = Some((self.present.clone(), now));
        }
        if gain > -SETTLED {
            if gain < SETTLED || self.is_hopeless(now, best) {
                if let Some((fitted, _)) = self.kept.as_mut().filter(|_| is_best) {
                    fitted.change(&next, 1.0, span);
                }
                return false;
            }
            self.before = now;
            self.steps = next;
            self.present.change(&self.steps, 1.0, span);
            return true;
        }
        // The step led too far, so half of it is taken back.
        self.halvings = self.halvings.saturating_add(1);
        if self.halvings > HALVINGS {
            return false;
        }
        for step in &mut self.steps {
            step.2 *= 0.5;
        }
        self.present.change(&self.steps, -1.0, span);
        true
    }

    /// Whether a round with this score lags far behind the best one, and catches up too little.
    /// A round that led too far tells nothing, unless half the step led too far as well.
    fn is_hopeless(&self, now: Real, best: Option<Rival>) -> bool {
        let gain = self.before - now;
        let tells = gain > -SETTLED || self.halvings > 0;
        best.is_some_and(|best| {
            let lag = now - best.score;
            tells && lag > HOPELESS && gain < CATCHING_UP * lag
        })
    }

    /// The complete fit, with fixed shapes.
    fn complete<const K: usize, const B: usize>(
        &self,
        problem: &Problem<'_, K, B>,
        work: &Work<K, B>,
        candidate: &mut Candidate,
    ) -> Completed {
        let solver = &work.solver;
        if let Some((last, others)) = problem.model.terms().split_last() {
            let square = solver.squares[others.len()].max(0.0);
            candidate.term = *last;
            candidate.coefficient = math::sqrt(square * problem.variance_unit);
        }
        candidate.chi_squared = solver.chi_squared;
        Completed {
            fitted: Fitted {
                model: self.present.model.clone(),
                squares: solver.assumed,
            },
            score: solver.minus_two_log_likelihood(),
            explains: solver.p_value() >= ADEQUATE_P,
        }
    }
}

/// Finds how the shapes should change. Returns the effect that must be held at zero before the shapes
/// are determined, if there is one.
#[inline(never)]
fn polish<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    work: &Work<K, B>,
    steps: &mut Steps,
) -> Option<usize> {
    let solver = &work.solver;
    let mut shape = ShapeEquations::EMPTY;
    if !shape.set(problem, &solver.weights, &solver.squares, &work.derivatives) {
        return None;
    }
    let confused = solver.confused(problem, &shape);
    if confused.is_none() {
        shape.steps(&solver.free, |i, j, step| {
            // There is a place for every fitted shape.
            let _ = steps.push((i as u8, j as u8, single(step.clamp(-STRIDE, STRIDE))));
        });
    }
    confused
}
