//! The limits of all effects of a list, in pieces.

use super::{
    expected::{Derivatives, Ground, at_least_zero},
    limit::{Limit, is_of_shape},
    trial::{Progress as Sought, Trial},
};
use crate::{
    curve::Curve,
    diagnosis::{Options, Step, cost, place},
    effect::{Effect, Span},
    error::Error,
    fit::{Columns, Problem, Weights, derivative},
    limits::MAX_PARAMETERS,
    list::numbered,
    model::{Model, Term},
    nnls::Vector,
    observed::Observed,
    profile::Grid,
    real::{Real, real},
    spectrum::Spectrum,
};

/// The number of values of the first shape parameter for each factor of two. Between them, the limit of a
/// sinusoid changes by up to 10 %, because an octave grid sees some frequencies better than others.
const STEPS_AN_OCTAVE: Real = 4.0;

/// The limits of detection, in progress: the size of each effect that a record would have shown.
///
/// [`run`](Self::run) goes through all effects and shapes, and [`advance`](Self::advance) does one piece of the
/// work, so that a main loop can do something else in between. A piece is a row of the curve's covariance, the
/// choice of a shape, or one fit to an expected curve. Nothing is computed unless it is asked for, and a program
/// that does not name this type holds none of its code.
///
/// # Example
///
/// ```
/// use allanite::{Accumulator, Model, Scale};
/// use allanite::detection::{Detection, Ranges};
/// use allanite::diagnosis::{Diagnosis, Evidence, Options};
/// use allanite::effect::CATALOGUE;
///
/// let mut gyro = Accumulator::<12>::new();
/// let mut random = 1_u32;
/// for _ in 0..10_000 {
///     random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     gyro.push((random >> 24) as i32);
/// }
/// let curve = gyro.curve(Scale::new(0.01, 100.0)?);
/// let (model, options) = (Model::ieee_952(), Options::default());
/// let mut last = None;
/// Diagnosis::new(curve.clone(), Evidence::NONE, &model, &CATALOGUE, options)
///     .run(|step| last = Some(step.clone()))?;
/// let Some(step) = last else { return Ok(()) };
///
/// let mut ranges = Ranges::default();
/// Detection::new(curve, &step, &CATALOGUE, options).run(|limit| ranges.push(&limit))?;
/// let mut ranges = ranges.as_slice().iter();
/// let sinusoid = ranges.find(|range| range.effect.name() == "sinusoid");
/// // The samples have a standard deviation of 0.74 °/s.
/// assert!(sinusoid.is_some_and(|range| range.size < 0.74));
/// # Ok::<(), allanite::Error>(())
/// ```
pub struct Detection<'a, const K: usize, const B: usize = 0> {
    curve: Curve<K>,
    spectrum: Spectrum<B>,
    span: Span,
    model: Model,
    squares: Vector,
    columns: Columns<K, B>,
    weights: Weights<K, B>,
    derivatives: Derivatives<K, B>,
    effects: &'a [&'static dyn Effect],
    options: Options,
    /// The effect that comes next, and the next steps of its grids.
    effect: usize,
    at: [u32; MAX_PARAMETERS],
    /// The largest limit of the present value of the first shape parameter, for the values of the second one so
    /// far.
    worst: Option<Limit>,
    stage: Stage,
    /// The limit that is handed out next.
    limit: Option<Limit>,
}

enum Stage {
    Beginning,
    /// The covariance of the curve is being computed.
    Weighting,
    /// The next shape is chosen.
    Choosing,
    Searching(Trial),
    Finished(Result<(), Error>),
}

/// The result of one piece of work.
#[derive(Clone, Copy, Debug)]
pub enum Progress {
    /// There is more to do.
    Working,
    /// The limit of one more shape is known.
    Limit(Limit),
    /// All effects have been gone through.
    Finished,
}

impl<'a, const K: usize> Detection<'a, K> {
    /// The limits beside the model of a step, which is the last one of a diagnosis. `curve` is the curve on which
    /// the step was judged, without what follows a covariate. `effects` and `options` are those of the
    /// diagnosis.
    ///
    /// There are no limits if the model is not adequate.
    // Inlined, so that some kilobytes are built where they stay and not moved there.
    #[inline(always)]
    pub fn new(
        curve: Curve<K>,
        step: &Step<K>,
        effects: &'a [&'static dyn Effect],
        options: Options,
    ) -> Self {
        Self::with_spectrum(curve, Spectrum::EMPTY, step, effects, options)
    }
}

impl<'a, const K: usize, const B: usize> Detection<'a, K, B> {
    /// The limits beside the model of a step that was judged on a curve and on a spectrum.
    // Inlined, so that some kilobytes are built where they stay and not moved there.
    #[inline(always)]
    pub fn with_spectrum(
        curve: Curve<K>,
        spectrum: Spectrum<B>,
        step: &Step<K, B>,
        effects: &'a [&'static dyn Effect],
        options: Options,
    ) -> Self {
        let model = step.model.clone();
        let columns = Columns::EMPTY;
        let problem = Problem::new(Observed::new(&curve, &spectrum), &model, &columns);
        let squares = at_least_zero(&problem.squares_of(&step.fit));
        let stage = if step.fit.is_adequate() == Some(true) {
            Stage::Beginning
        } else {
            Stage::Finished(Ok(()))
        };
        Self {
            span: curve.span(),
            curve,
            spectrum,
            model,
            squares,
            columns,
            weights: Weights::EMPTY,
            derivatives: Derivatives::new(),
            effects,
            options,
            effect: 0,
            at: [0; MAX_PARAMETERS],
            worst: None,
            stage,
            limit: None,
        }
    }

    /// Calls `each` for every limit.
    ///
    /// # Errors
    /// The same as those of [`advance`](Self::advance).
    pub fn run(&mut self, mut each: impl FnMut(Limit)) -> Result<(), Error> {
        loop {
            match self.advance()? {
                Progress::Working => {}
                Progress::Limit(limit) => each(limit),
                Progress::Finished => return Ok(()),
            }
        }
    }

    /// The limit of one shape, in one go. The first parameter of a filter is replaced by its limit. `None` if the
    /// effect hides in the model, if it has no shape, or if the model is not adequate.
    ///
    /// # Errors
    /// The same as those of [`advance`](Self::advance).
    pub fn limit_of(&mut self, term: Term) -> Result<Option<Limit>, Error> {
        while matches!(self.stage, Stage::Beginning | Stage::Weighting) {
            self.advance()?;
        }
        let range = term.effect.search_range(0, &self.span);
        let Some(range) = range.filter(|_| matches!(self.stage, Stage::Choosing)) else {
            return Ok(None);
        };
        let observed = Observed::new(&self.curve, &self.spectrum);
        let problem = Problem::new(observed, &self.model, &self.columns);
        let ground = Ground {
            problem: &problem,
            weights: &self.weights,
            derivatives: &self.derivatives,
        };
        let mut trial = Trial::new(&ground, term, (range.low, range.high));
        let gain = gain(&self.options, term.effect);
        loop {
            match trial.advance(&ground, &self.squares, gain) {
                Sought::Searching => {}
                Sought::Hidden => return Ok(None),
                Sought::Found(limit) => return Ok(Some(limit)),
            }
        }
    }

    /// Does one piece of work.
    ///
    /// # Errors
    /// [`Error::Singular`] if the covariance of the curve cannot be made positive definite. An error ends the
    /// work.
    pub fn advance(&mut self) -> Result<Progress, Error> {
        if let Err(error) = self.work() {
            self.stage = Stage::Finished(Err(error));
        }
        match (&self.stage, self.limit.take()) {
            (_, Some(limit)) => Ok(Progress::Limit(limit)),
            (Stage::Finished(result), None) => result.map(|()| Progress::Finished),
            _ => Ok(Progress::Working),
        }
    }

    #[inline(never)]
    fn work(&mut self) -> Result<(), Error> {
        match &mut self.stage {
            Stage::Beginning => self.begin(),
            Stage::Weighting => {
                let observed = Observed::new(&self.curve, &self.spectrum);
                let problem = Problem::new(observed, &self.model, &self.columns);
                if self.weights.advance(&problem, &self.squares)? {
                    self.stage = Stage::Choosing;
                }
                Ok(())
            }
            Stage::Choosing => {
                self.choose();
                Ok(())
            }
            Stage::Searching(trial) => {
                let observed = Observed::new(&self.curve, &self.spectrum);
                let problem = Problem::new(observed, &self.model, &self.columns);
                let ground = Ground {
                    problem: &problem,
                    weights: &self.weights,
                    derivatives: &self.derivatives,
                };
                let gain = gain(&self.options, trial.effect());
                match trial.advance(&ground, &self.squares, gain) {
                    Sought::Searching => return Ok(()),
                    Sought::Hidden => self.skip(),
                    Sought::Found(limit) => self.keep(limit),
                }
                self.stage = Stage::Choosing;
                Ok(())
            }
            Stage::Finished(_) => Ok(()),
        }
    }

    #[inline(never)]
    fn begin(&mut self) -> Result<(), Error> {
        let observed = Observed::new(&self.curve, &self.spectrum);
        self.columns.set(observed, &self.model);
        let problem = Problem::new(observed, &self.model, &self.columns);
        for (i, term) in numbered(self.model.terms().iter()) {
            for j in term.fitted_parameters().filter(|_| self.squares[i] > 0.0) {
                let change = derivative(&problem, *term, j, self.squares[i]);
                // A model has no more shapes than there are places.
                let _ = self.derivatives.push(change);
            }
        }
        self.weights
            .begin(&problem, &self.squares, self.options.tolerance)?;
        self.stage = Stage::Weighting;
        Ok(())
    }

    /// Leaves out the present value of the first shape parameter, because the effect hides with one value of
    /// the second.
    fn skip(&mut self) {
        if self.at[1] > 0 {
            self.at = [self.at[0].saturating_add(1), 0];
        }
        self.worst = None;
    }

    /// Keeps the larger limit of the present value of the first shape parameter, and hands it out after the last
    /// value of the second.
    fn keep(&mut self, limit: Limit) {
        if self.worst.is_none_or(|worst| worst.size() < limit.size()) {
            self.worst = Some(limit);
        }
        if self.at[1] == 0 {
            self.limit = self.worst.take();
        }
    }

    /// Chooses the next shape.
    #[inline(never)]
    fn choose(&mut self) {
        let Some(&effect) = self.effects.get(self.effect) else {
            self.stage = Stage::Finished(Ok(()));
            return;
        };
        let observed = Observed::new(&self.curve, &self.spectrum);
        let problem = Problem::new(observed, &self.model, &self.columns);
        let is_missing = self.model.position(effect.name()).is_none();
        let is_candidate = is_missing && has_limit(effect) && place(&problem, effect).is_some();
        let [first, second]: [Grid; MAX_PARAMETERS] =
            core::array::from_fn(|j| Grid::coarse(effect, j, &self.span, STEPS_AN_OCTAVE));
        let firsts = if is_of_shape(effect) { 1 } else { first.steps };
        if !is_candidate || self.at[0] >= firsts {
            self.effect = self.effect.saturating_add(1);
            self.at = [0; MAX_PARAMETERS];
            return;
        }
        let mut term = Term::fitted(effect);
        term.parameters = [first.at(self.at[0]), second.at(self.at[1])];
        self.at[1] = self.at[1].saturating_add(1);
        if self.at[1] >= second.steps {
            self.at = [self.at[0].saturating_add(1), 0];
        }
        let ground = Ground {
            problem: &problem,
            weights: &self.weights,
            derivatives: &self.derivatives,
        };
        self.stage = Stage::Searching(Trial::new(&ground, term, (first.low, first.high)));
    }
}

/// Whether there is a size from which on an effect shows. That of a filter is its length, which a filter around a
/// frequency does not have.
fn has_limit(effect: &dyn Effect) -> bool {
    let first = effect.parameters().first();
    !(is_of_shape(effect) && first.is_some_and(|first| first.unit == "Hz"))
}

/// The least fall of the score with which an effect of the right shape is added. A diagnosis asks for the threshold
/// and the costs of the effect, and its search fits the shape to the noise of the record, too, which makes χ² fall by
/// one more for each parameter.
fn gain(options: &Options, effect: &'static dyn Effect) -> Real {
    let continuous = effect.parameters().iter().filter(|one| !one.is_whole);
    let fitted = continuous.skip(usize::from(is_of_shape(effect))).count();
    options.threshold + 2.0 * cost(effect) - real(fitted)
}
