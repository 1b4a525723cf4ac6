//! A diagnosis: it tests a model, searches for the effects that it lacks, and reports the steps to the model that explains
//! the record.

use super::{
    assessment::{Assessment, assess},
    covariate_regression::followed,
    extended::with,
    options::Options,
    search::{Found, Limits, Observation, Search},
    step::{Addition, Step},
    story::Story,
    verdict::Verdict,
};
use crate::{
    curve::Curve,
    error::Error,
    evidence::{observed::Observed, record::Record},
    fit::{Start, Tolerance, Work, check},
    numerics::{math, nnls::Vector, real::Real},
    pause::{Pause, Stop, call},
    spectrum::Spectrum,
    theory::{effect::Effect, model::Model},
};
use core::ops::ControlFlow;

/// The fall of half of −2 ln L that an effect needs in addition to the usual price where the rate follows a covariate: an error of the
/// slope or of a lag leaves something of the covariate, which is noise of a few hundred seconds. `cargo xtask study thermal
/// --drawn` named an effect in addition to the covariate in 20 of 960 records without it, and in 7 with it.
const COVARIATE_DOUBT: Real = 6.0;

/// A diagnosis in progress, which finds out which effects are missing.
///
/// It judges a model, looks whether the rate follows a covariate, and then looks for what is missing among a list of effects
/// such as [`CATALOGUE`](crate::effect::CATALOGUE). It always looks, because no single test of the whole model sees every
/// effect. The steps from the first model to the last one are reported in the order in which the error falls most.
///
/// [`run`](Self::run) does all of it. [`advance`](Self::advance) leads to the next step. In both, a *pause* is called between
/// two pieces of work, so that a main loop can feed its watchdog and take its samples. A piece takes at most 2 million
/// instructions on a Cortex-M4F in single precision (`cargo xtask bench` measures it). If the pause returns
/// [`ControlFlow::Break`], what is in progress is given up, and the next call begins it anew.
///
/// # Example
///
/// ```
/// use allanite::{Accumulator, Model, Scale};
/// use allanite::diagnosis::{Diagnosis, Options, Verdict};
/// use allanite::effect::CATALOGUE;
/// use core::ops::ControlFlow;
///
/// let mut gyro = Accumulator::<12>::new();
/// let mut random = 1_u32;
/// for _ in 0..10_000 {
///     random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     gyro.push((random >> 24) as i32);
/// }
/// let curve = gyro.curve(Scale::new(0.01, 100.0)?);
/// let (model, options) = (Model::ieee_952(), Options::default());
/// let mut diagnosis = Diagnosis::new(&curve, &model, &CATALOGUE, options);
/// let mut pause = || ControlFlow::Continue(()); // feed the watchdog, take the next samples
/// let verdict = diagnosis.run(|step| assert!(step.fit.p_value > 0.01), &mut pause)?;
/// assert_eq!(verdict, Some(Verdict::Adequate));
/// # Ok::<(), allanite::Error>(())
/// ```
pub struct Diagnosis<'a, const K: usize, const B: usize = 0> {
    record: Record<'a, K, B>,
    /// The curve and the spectrum, without what follows a covariate.
    curve: Curve<K>,
    spectrum: Spectrum<B>,
    /// The model that was asked about.
    model: Model,
    effects: &'a [&'static dyn Effect],
    options: Options,
    /// The present model, and what is reported about it.
    step: Step<K, B>,
    assessment: Assessment,
    /// The result of the search; `None` before it.
    story: Option<Story>,
    next: Next,
}

/// What comes next.
#[derive(Clone, Copy)]
enum Next {
    /// The model that was asked about is judged, and covariates are tried.
    Judging,
    /// The model is judged again, without what follows the covariate.
    JudgingAgain,
    /// Effects are searched for, and the step is reported.
    Searching,
    /// The next step is reported.
    Telling,
    Finished(Result<Verdict, Error>),
}

/// The result of one piece of a diagnosis.
#[derive(Debug)]
pub enum Progress<'s, const K: usize, const B: usize = 0> {
    /// The pause ended the work before the next step.
    Paused,
    /// A model has been judged, and it is known what to add.
    Step(&'s Step<K, B>),
    /// The diagnosis is complete.
    Finished(Verdict),
}

impl<'a, const K: usize, const B: usize> Diagnosis<'a, K, B> {
    /// A diagnosis of a record that looks for what a model lacks. It does not begin before it is run.
    // Inlined, so that some kilobytes are built where they stay and not moved there.
    #[inline(always)]
    pub fn new(
        record: impl Into<Record<'a, K, B>>,
        model: &Model,
        effects: &'a [&'static dyn Effect],
        options: Options,
    ) -> Self {
        let record = record.into();
        Self {
            curve: record.curve.clone(),
            spectrum: record.spectrum.cloned().unwrap_or(Spectrum::EMPTY),
            record,
            model: model.clone(),
            effects,
            options,
            step: Step::of(model),
            assessment: Assessment::none(),
            story: None,
            next: Next::Judging,
        }
    }

    /// Does the whole diagnosis. Calls `report` for every step, including the last one, and `pause` between two pieces of
    /// work. Returns `None` if the pause ended it.
    ///
    /// # Errors
    /// As of [`fit`](crate::fit::fit()).
    pub fn run(
        &mut self,
        mut report: impl FnMut(&Step<K, B>),
        pause: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Result<Option<Verdict>, Error> {
        loop {
            match self.advance(pause)? {
                Progress::Paused => return Ok(None),
                Progress::Step(step) => report(step),
                Progress::Finished(verdict) => return Ok(Some(verdict)),
            }
        }
    }

    /// Works until the next step, or until the pause ends the work.
    ///
    /// # Errors
    /// The same as those of [`fit`](crate::fit::fit()). An error ends the diagnosis.
    pub fn advance(
        &mut self,
        pause: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Result<Progress<'_, K, B>, Error> {
        loop {
            if let Next::Finished(verdict) = self.next {
                return verdict.map(Progress::Finished);
            }
            match self.work(pause) {
                Ok(true) => return Ok(Progress::Step(&self.step)),
                Ok(false) => {}
                Err(Stop::Paused) => return Ok(Progress::Paused),
                Err(Stop::Failed(error)) => self.next = Next::Finished(Err(error)),
            }
        }
    }

    /// Does what comes next. Returns whether it led to a step.
    fn work(&mut self, pause: &mut Pause<'_>) -> Result<bool, Stop> {
        match self.next {
            Next::Judging => {
                check(self.curve.points(), 2)?;
                let tolerance = Tolerance::IfNeeded(self.options.tolerance);
                self.assess(Start::Independent, tolerance, pause)?;
                self.step.begin_report();
                if self.has_room() && !self.record.covariates.is_empty() {
                    let (model, judged) = (self.model.clone(), self.assessment);
                    self.follow(&model, judged.squares, pause)?;
                }
                self.next = Next::Searching;
                if self.step.added.is_some() {
                    self.next = Next::JudgingAgain;
                    return Ok(true);
                }
            }
            Next::JudgingAgain => {
                self.correct();
                let tolerance = Tolerance::IfNeeded(self.options.tolerance);
                self.assess(Start::From(self.assessment.squares), tolerance, pause)?;
                self.step.begin_report();
                self.next = Next::Searching;
            }
            Next::Searching => {
                self.search(pause)?;
                self.keep_what_lowers_the_error();
                if self.follow_beside_story(pause)? {
                    self.story = None;
                    self.next = Next::JudgingAgain;
                    return Ok(true);
                }
                return self.tell(pause);
            }
            Next::Telling => {
                self.judge_next(pause)?;
                return self.tell(pause);
            }
            Next::Finished(_) => {}
        }
        Ok(false)
    }

    /// Judges the step's model.
    #[inline(never)]
    fn assess(
        &mut self,
        start: Start,
        tolerance: Tolerance,
        pause: &mut Pause<'_>,
    ) -> Result<(), Stop> {
        let observed = Observed::new(&self.curve, &self.spectrum);
        let mut work = Work::<K, B>::NEW;
        self.assessment = assess(observed, start, tolerance, &mut work, &mut self.step, pause)?;
        Ok(())
    }

    /// Tests the covariates again in the noise of what was found, if they were not detected in that of the first model,
    /// which takes strong noise of another kind for that of the rate where it follows. Returns whether one is followed.
    fn follow_beside_story(&mut self, pause: &mut Pause<'_>) -> Result<bool, Stop> {
        let Some(story) = self.story.as_ref().filter(|story| !story.is_empty()) else {
            return Ok(false);
        };
        if self.step.covariate.is_some() || self.record.covariates.is_empty() {
            return Ok(false);
        }
        let model = story.whole(&self.model)?;
        let squares = self.solve(&model, pause)?;
        self.follow(&model, squares, pause)?;
        Ok(self.step.added.is_some())
    }

    /// The squared coefficients of a model.
    #[inline(never)]
    fn solve(&self, model: &Model, pause: &mut Pause<'_>) -> Result<Vector, Stop> {
        let observed = Observed::new(&self.curve, &self.spectrum);
        let mut work = Work::<K, B>::NEW;
        let tolerance = Tolerance::Fixed(self.assessment.tolerance);
        work.solve(observed, model, Start::Independent, tolerance, pause)?;
        Ok(work.solver.squares)
    }

    /// Tests whether the rate follows the covariates, in the noise of a model.
    #[inline(never)]
    fn follow(
        &mut self,
        model: &Model,
        squares: Vector,
        pause: &mut Pause<'_>,
    ) -> Result<(), Stop> {
        let observed = Observed::new(&self.curve, &self.spectrum);
        let (tolerance, least_z) = (self.assessment.tolerance, self.options.covariate_z);
        let noise = (model, squares);
        let followed = followed(observed, &self.record, noise, tolerance, least_z, pause)?;
        self.step.added = followed.map(Addition::Covariate);
        Ok(())
    }

    /// Takes what follows the covariate from the curve and the spectrum.
    fn correct(&mut self) {
        if let Some(Addition::Covariate(followed)) = self.step.added {
            self.step.covariate = Some(followed);
            followed.correct(&self.record, &mut self.curve, &mut self.spectrum);
        }
    }

    /// Whether something may be added to the model.
    fn has_room(&self) -> bool {
        self.left() > 0 && self.record.invalid.is_none()
    }

    /// The number of effects that may be added.
    fn left(&self) -> usize {
        let followed = usize::from(self.step.covariate.is_some());
        self.options.max_effects.saturating_sub(followed)
    }

    /// How much more an effect has to explain in a record with a covariate.
    fn doubt(&self) -> Real {
        self.step.covariate.map_or(0.0, |_| COVARIATE_DOUBT)
    }

    /// Looks for what the model lacks.
    #[inline(never)]
    fn search(&mut self, pause: &mut Pause<'_>) -> Result<(), Stop> {
        if !self.has_room() {
            self.story = Some(Story::NOTHING);
            return Ok(());
        }
        let observed = Observed::new(&self.curve, &self.spectrum);
        // The course is the one of the record with what follows a covariate.
        let course = self.record.course.filter(|_| self.step.covariate.is_none());
        let observation = Observation::new(observed, course);
        let limits = Limits {
            effects: self.left(),
            threshold: self.options.threshold + self.doubt(),
            ambiguity: self.options.ambiguity,
        };
        let found = look(&observation, &self.model, self.effects, limits, pause);
        let ControlFlow::Continue(found) = found else {
            return Err(Stop::Paused);
        };
        let told = Story::new(
            &observation,
            observed,
            &self.model,
            self.record.kurtosis,
            self.effects,
            found,
            (self.step.fit.chi_squared, self.step.fit.tolerance),
            pause,
        )?;
        self.story = Some(told);
        Ok(())
    }

    /// Gives up what was found if the fit with it has no smaller χ² than the fit without. The search compares
    /// likelihoods of octaves and bins that it takes for independent; the fit has their covariance.
    fn keep_what_lowers_the_error(&mut self) {
        let without = self.step.fit.chi_squared;
        self.story = match self.story.take() {
            Some(story) if story.chi_squared() >= without => Some(Story::NOTHING),
            story => story,
        };
    }

    /// Judges the model of the story's next step.
    fn judge_next(&mut self, pause: &mut Pause<'_>) -> Result<(), Stop> {
        let covariate = self.step.covariate;
        let Some(story) = &self.story else {
            return Ok(());
        };
        let (model, last) = (story.model(&self.model)?, story.chi_squared());
        let is_last = story.is_told_to_the_end();
        let mut tolerance = Tolerance::IfNeeded(self.options.tolerance);
        loop {
            self.step = Step::of(&model);
            self.step.covariate = covariate;
            self.assess(Start::Independent, tolerance, pause)?;
            // A model that needs a tolerance would be shown with a smaller error than the last one, which needs none.
            let needs_more = self.step.fit.tolerance > 0.0 && self.step.fit.chi_squared < last;
            if is_last || !needs_more {
                break;
            }
            tolerance = Tolerance::Fixed(0.0);
        }
        self.step.begin_report();
        Ok(())
    }

    /// Says what the step adds, and what comes next.
    fn tell(&mut self, pause: &mut Pause<'_>) -> Result<bool, Stop> {
        let told = self
            .story
            .as_ref()
            .is_some_and(|story| story.tell(&mut self.step));
        self.measure_candidates(pause)?;
        if let Some(story) = &mut self.story {
            story.go_on();
        }
        self.next = if told {
            Next::Telling
        } else {
            Next::Finished(Ok(self.verdict()))
        };
        Ok(true)
    }

    /// Fits the step's model with each of its candidates, for the candidate's coefficient and χ².
    #[inline(never)]
    fn measure_candidates(&mut self, pause: &mut Pause<'_>) -> Result<(), Stop> {
        let observed = Observed::new(&self.curve, &self.spectrum);
        let unit = self.curve.variance_unit();
        let mut work = Work::<K, B>::NEW;
        for candidate in &mut self.step.candidates {
            call(pause)?;
            let model = with(&self.step.model, &[candidate.term])?;
            let tolerance = Tolerance::Fixed(self.assessment.tolerance);
            match work.solve(observed, &model, Start::Independent, tolerance, pause) {
                Ok(()) => {
                    let place = model.terms().len().saturating_sub(1);
                    let square = work.solver.squares[place].max(0.0);
                    candidate.coefficient = math::sqrt(square * unit);
                    candidate.chi_squared = work.solver.chi_squared;
                }
                // A candidate that cannot be fitted keeps an unknown χ².
                Err(Stop::Failed(_)) => {}
                Err(Stop::Paused) => return Err(Stop::Paused),
            }
        }
        Ok(())
    }

    fn verdict(&self) -> Verdict {
        let has_story = self.story.as_ref().is_some_and(|story| !story.is_empty());
        let has_added = has_story || self.step.covariate.is_some();
        match (self.record.invalid, has_added, self.assessment.adequate) {
            (Some(reason), ..) => Verdict::Invalid(reason),
            (_, false, Some(true)) => Verdict::Adequate,
            (_, false, Some(false)) => Verdict::Unexplained,
            (_, false, None) => Verdict::TooShort,
            (_, true, Some(true)) => Verdict::Improved,
            _ => Verdict::Incomplete,
        }
    }
}

/// Runs a search in memory that is free again afterwards.
#[inline(never)]
fn look<const B: usize>(
    observation: &Observation<'_, B>,
    model: &Model,
    effects: &[&'static dyn Effect],
    limits: Limits,
    pause: &mut Pause<'_>,
) -> ControlFlow<(), Found> {
    let mut search = Search::<B>::NEW;
    search.run(observation, model, effects, limits, pause)
}
