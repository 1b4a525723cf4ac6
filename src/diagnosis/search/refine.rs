//! The shapes of a hypothesis, refined together with its coefficients (Levenberg 1944, Marquardt 1963).

use super::{
    hypothesis::{Hypothesis, MAX_ADDED},
    kind::is_line,
    likelihood::{Workspace, kept},
    limits::Limits,
    rows::Observation,
    values::Values,
};
use crate::{
    limits::{MAX_PARAMETERS, MAX_SHAPE},
    list::{self, numbered},
    numerics::{
        math,
        nnls::{PassiveSet, Vector},
        real::{Real, real, single},
    },
    pause::Pause,
    theory::model::{Model, Term},
};
use core::ops::ControlFlow;
use heapless::Vec;

/// The largest step of a shape's logarithm.
const STRIDE: Real = 0.5;
/// The step of a numerical derivative.
const STEP: Real = 3e-3;
/// The largest step of a line's frequency, in bins of the finest level that shows the line, and that of its derivative.
const LINE_STRIDE: Real = 0.5;
const LINE_STEP: Real = 0.01;
/// A line shows in a bin if it adds this much to it, relative to the measurement.
const SHOWS: f32 = 0.2;
/// The damping at first, the factors by which it falls and rises, and where it gives up.
const DAMPING: Real = 1e-3;
const FALLS: Real = 6.0;
const RISES: Real = 12.0;
const HOPELESS: Real = 1e3;
/// A round that gains less is small, and two of these are the last ones; one that gains even less is the last one.
const SMALL: Real = 0.3;
const SETTLED: Real = 0.05;
/// A hypothesis is given up if this multiple of what the last round gained would not lift it over the bar.
const HOPE: Real = 4.0;

/// A shape of a hypothesis: the place of its term among the own columns, and its parameter.
#[derive(Clone, Copy)]
pub(super) struct Shape {
    term: usize,
    parameter: usize,
    /// The largest step of its logarithm.
    stride: Real,
}

/// The largest number of variants of filters.
pub(super) const MAX_VARIANTS: usize = 24;

type Shapes = Vec<Shape, MAX_SHAPE>;
type Terms = Vec<Term, 4>;

/// A solver of hypotheses for one record.
pub(crate) struct Solver<'s, 'a, 'p, const B: usize> {
    pub(super) observation: &'s Observation<'a, B>,
    pub(super) work: &'s mut Workspace<B>,
    /// The white noise as the model has it; `None` if the model has none that a filter could replace.
    pub(super) white: Option<Term>,
    /// The model that something is missing from.
    pub(super) model: &'s Model,
    pub(super) limits: Limits,
    /// The best shape of every filter in the continuum.
    pub(super) shapes: &'s mut Vec<Term, MAX_VARIANTS>,
    /// The scores that hypotheses of no effect, of one effect and so on have to beat.
    pub(super) bars: Bars,
    pub(super) pause: &'s mut Pause<'p>,
}

/// A score for each number of effects.
pub(super) type Bars = [Real; MAX_ADDED + 2];

/// No hypothesis fails at these.
pub(super) const NO_BARS: Bars = [Real::INFINITY; MAX_ADDED + 2];

impl<const B: usize> Solver<'_, '_, '_, B> {
    /// The terms of a hypothesis that are not common: the white noise or its filter, then what was added.
    pub(super) fn own_terms(&self, hypothesis: &Hypothesis) -> Terms {
        let white = hypothesis.filter.or(self.white);
        list::fill(white.into_iter().chain(hypothesis.added.iter().copied()))
    }

    /// Sets the columns of a hypothesis, and the model at its squares, or at the measurement if it has none yet.
    #[inline(never)]
    pub(super) fn load(&mut self, hypothesis: &Hypothesis) -> ControlFlow<()> {
        let terms = self.own_terms(hypothesis);
        self.work.set_own(self.observation, terms.iter());
        (self.pause)()?;
        self.work.pass(self.observation, hypothesis.filter.as_ref());
        let mut squares = Vector::ZEROS;
        for (i, square) in numbered(hypothesis.squares) {
            squares.put(i, real(square));
        }
        self.work.squares = squares;
        self.work.model = if hypothesis.squares.iter().all(|&square| square == 0.0) {
            self.observation.start
        } else {
            self.work.model_of(&squares)
        };
        ControlFlow::Continue(())
    }

    /// `−2 ln L` of a hypothesis whose shapes stay.
    pub(super) fn deviance(&mut self, hypothesis: &Hypothesis) -> ControlFlow<(), Real> {
        (self.pause)()?;
        self.load(hypothesis)?;
        (self.pause)()?;
        ControlFlow::Continue(self.work.solve(10))
    }

    /// The score that a hypothesis has to beat.
    fn bar(&self, hypothesis: &Hypothesis) -> Real {
        let bar = self.bars.get(list::count(hypothesis.terms()));
        bar.copied().unwrap_or(Real::INFINITY)
    }

    /// Sets the score that hypotheses of as many effects have to beat.
    pub(super) fn raise(&mut self, hypothesis: &Hypothesis, bar: Real) {
        if let Some(own) = self.bars.get_mut(list::count(hypothesis.terms())) {
            *own = bar;
        }
    }

    /// Refines all shapes of a hypothesis together with its coefficients, in at most this number of rounds. One that will
    /// not beat its bar is given up early.
    #[inline(never)]
    pub(super) fn refine(
        &mut self,
        hypothesis: Hypothesis,
        rounds: u8,
    ) -> ControlFlow<(), Hypothesis> {
        let bar = self.bar(&hypothesis) - 2.0 * hypothesis.parameters();
        let mut hypothesis = hypothesis;
        self.load(&hypothesis)?;
        (self.pause)()?;
        let mut deviance = self.work.solve(10);
        let mut terms = self.own_terms(&hypothesis);
        let mut damping = DAMPING;
        let mut small = 0_u8;
        let mut shapes: Option<Shapes> = None;
        let has_shapes = hypothesis
            .terms()
            .any(|term| term.fitted_parameters().next().is_some());
        for _ in 0..if has_shapes { rounds } else { 0 } {
            (self.pause)()?;
            if shapes.is_none() {
                shapes = Some(self.work.set_shapes(self.observation, &terms, self.pause)?);
                (self.pause)()?;
            }
            let Some(known) = &shapes else { break };
            let Some(steps) = self.step(known, damping) else {
                break;
            };
            let mut changed = terms.clone();
            for (shape, &step) in known.iter().zip(&steps) {
                if let Some(term) = changed.get_mut(shape.term) {
                    self.change(term, shape.parameter, step);
                }
            }
            let (before, model) = (self.work.squares, self.work.model);
            self.work.exchange_own(self.observation, &terms, &changed);
            (self.pause)()?;
            self.work.pass(self.observation, changed.first());
            (self.pause)()?;
            let now = self.work.solve(3);
            if now < deviance {
                let gain = deviance - now;
                small = if gain < SMALL {
                    small.saturating_add(1)
                } else {
                    0
                };
                (terms, deviance) = (changed, now);
                shapes = None;
                damping = (damping / FALLS).max(1e-6);
                if small > 1 || gain < SETTLED || deviance - HOPE * gain > bar {
                    break;
                }
            } else {
                damping *= RISES;
                self.work.put_back();
                self.work.pass(self.observation, terms.first());
                (self.work.squares, self.work.model) = (before, model);
                if damping > HOPELESS {
                    break;
                }
            }
        }
        let mut own = terms.iter();
        if hypothesis.filter.is_some() {
            hypothesis.filter = own.next().copied();
        } else if self.white.is_some() {
            own.next();
        }
        for (added, term) in hypothesis.added.iter_mut().zip(own) {
            *added = *term;
        }
        hypothesis.squares = kept(&self.work.squares);
        hypothesis.judge(deviance, self.observation, self.limits.threshold);
        ControlFlow::Continue(hypothesis)
    }

    /// Changes the logarithm of a parameter within its range.
    fn change(&self, term: &mut Term, parameter: usize, step: Real) {
        let range = term.effect.search_range(parameter, &self.observation.span);
        let changed = term.parameter(parameter) * math::exp(step);
        let changed = match range {
            Some(range) => changed.max(range.low).min(range.high.max(range.low)),
            None => changed,
        };
        term.set_parameter(parameter, changed);
        term.make_distinct(self.observation.interval_s);
    }

    /// The steps of the shapes' logarithms that lead towards the largest likelihood. The coefficients cannot be negative,
    /// and neither can a step plus its largest size, so that one solver serves both.
    #[inline(never)]
    fn step(&mut self, shapes: &Shapes, damping: Real) -> Option<Vec<Real, MAX_SHAPE>> {
        let strides: Vec<Real, MAX_SHAPE> = list::fill(shapes.iter().map(|shape| shape.stride));
        let count = self.work.count();
        if !self.work.set_equations(None, &strides, damping) {
            return None;
        }
        let shapes_too = |i: usize| {
            self.work.free.has(i) || (count..count.saturating_add(shapes.len())).contains(&i)
        };
        let guess = PassiveSet::of(shapes_too);
        let (solution, _) = self
            .work
            .equations
            .solve_non_negative_near(&guess, &PassiveSet::NONE);
        let steps = numbered(strides.iter()).map(|(at, &stride)| {
            let shifted = solution[count.saturating_add(at)];
            (shifted - stride).min(stride)
        });
        Some(list::fill(steps))
    }
}

impl<const B: usize> Workspace<B> {
    /// The finest level that shows a term, by the width of its bins in Hz.
    fn resolution(&self, observation: &Observation<'_, B>, term: usize) -> Option<Real> {
        let column = self.own_column(term)?;
        let square = single(self.squares[self.common().saturating_add(term)]);
        let levels = observation.levels();
        let shown = levels.filter(|(first, bins)| {
            let rows = *first..first.saturating_add(bins.len());
            rows.into_iter().any(|row| column[row] * square > SHOWS)
        });
        let (_, finest) = shown.last()?;
        let bin = finest.first()?;
        Some(bin.frequency_hz / real(bin.index))
    }

    /// Sets the derivatives of the model by the logarithms of the shapes.
    #[inline(never)]
    pub(super) fn set_shapes(
        &mut self,
        observation: &Observation<'_, B>,
        terms: &[Term],
        pause: &mut Pause<'_>,
    ) -> ControlFlow<(), Shapes> {
        let mut shapes = Shapes::new();
        self.slopes.clear();
        for (i, term) in numbered(terms) {
            let place = self.common().saturating_add(i);
            let square = single(self.squares[place]);
            if square <= 0.0 {
                continue;
            }
            for j in term.fitted_parameters().take(MAX_PARAMETERS) {
                pause()?;
                let (stride, step) = match self
                    .resolution(observation, i)
                    .filter(|_| is_line(term.effect))
                {
                    Some(width_hz) if j == 0 => {
                        let relative = width_hz / term.parameter(0);
                        (
                            (LINE_STRIDE * relative).min(STRIDE),
                            (LINE_STEP * relative).min(STEP),
                        )
                    }
                    _ => (STRIDE, STEP),
                };
                let mut near = *term;
                // The derivative is taken to the side that has room.
                let top = term.effect.search_range(j, &observation.span);
                let step = match top {
                    Some(range) if near.parameter(j) * (1.0 + step) > range.high => -step,
                    _ => step,
                };
                near.scale_parameter(j, math::exp(step));
                let mut slope = Values::<B>::NONE;
                let factor = Some(self.factor(i));
                observation.column(&near, factor, &mut slope);
                let Some(column) = self.own_column(i) else {
                    continue;
                };
                let scale = square / single(step);
                let mut size = 0.0;
                slope.change_by(column, |near, own| (near - own) * scale);
                if i == 0 {
                    self.pass_slope(&mut slope);
                }
                slope.each_with(&self.shape, &slope, |change, shape, _| {
                    size += change * change * shape;
                });
                // A shape that changes nothing has no place in the equations.
                if size > 0.0 && size.is_finite() && self.slopes.push(slope).is_ok() {
                    let _ = shapes.push(Shape {
                        term: i,
                        parameter: j,
                        stride,
                    });
                }
            }
        }
        ControlFlow::Continue(shapes)
    }

    /// Sets the derivatives of the model by the logarithms of the shapes of its own terms.
    pub(crate) fn set_slopes(
        &mut self,
        observation: &Observation<'_, B>,
        terms: &[Term],
        squares: &Vector,
    ) {
        self.squares = *squares;
        let _ = self.set_shapes(observation, terms, &mut || ControlFlow::Continue(()));
    }
}
