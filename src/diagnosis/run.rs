//! A diagnosis, in one go or in pieces: one stage follows the other until the model is adequate or
//! nothing helps.

use super::{
    chosen::choose,
    dropped::Dropping,
    evidence::Evidence,
    followed::Following,
    judged::{Judged, Judging},
    mirrored::tell_from_mirror,
    options::Options,
    scanned::Scanning,
    step::{Addition, Step},
    swapped::{Preferred, Swapping},
    trial::Fitted,
    tried::{Base, Contest, Trying},
    verdict::Verdict,
};
use crate::{
    curve::Curve,
    effect::{Effect, Span},
    error::Error,
    fit::{Problem, Start, Tolerance, Work, check},
    list,
    model::Model,
    observed::Observed,
    spectrum::Spectrum,
};

/// A diagnosis in progress, which finds out which effect is missing.
///
/// It looks for what a model lacks in a list of effects such as
/// [`CATALOGUE`](crate::effect::CATALOGUE). It fits the model, compares it with the curve, tries every
/// effect, adds the best one, and starts again, until the model is adequate or nothing helps.
/// Covariates are tried first, because they carry their own evidence.
///
/// [`run`](Self::run) does all of it. [`advance`](Self::advance) does one piece and returns, so that a
/// main loop can feed its watchdog and take its samples in between. One piece takes at most 2 million
/// instructions on a Cortex-M4F in single precision, with a spectrum or without, of some 300 million for a
/// whole diagnosis of 20 octaves (`cargo xtask bench` measures both). To abort a diagnosis, drop it.
///
/// # Example
///
/// ```
/// use allanite::{Accumulator, Model, Scale};
/// use allanite::diagnosis::{Diagnosis, Evidence, Options, Progress, Verdict};
/// use allanite::effect::CATALOGUE;
///
/// let mut gyro = Accumulator::<12>::new();
/// let mut random = 1_u32;
/// for _ in 0..10_000 {
///     random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     gyro.push((random >> 24) as i32);
/// }
/// let curve = gyro.curve(Scale::new(0.01, 100.0)?);
/// let model = Model::ieee_952();
/// let (evidence, options) = (Evidence::NONE, Options::default());
/// let mut diagnosis = Diagnosis::new(curve, evidence, &model, &CATALOGUE, options);
/// let verdict = loop {
///     match diagnosis.advance()? {
///         Progress::Working => {} // feed the watchdog, take the next samples
///         Progress::Step(step) => assert!(step.fit.p_value > 0.01),
///         Progress::Finished(verdict) => break verdict,
///     }
/// };
/// assert_eq!(verdict, Verdict::Adequate);
/// # Ok::<(), allanite::Error>(())
/// ```
pub struct Diagnosis<'a, const K: usize, const B: usize = 0> {
    /// The curve, without what follows a covariate.
    curve: Curve<K>,
    spectrum: Spectrum<B>,
    span: Span,
    evidence: Evidence<'a, K>,
    effects: &'a [&'static dyn Effect],
    options: Options,
    /// The present model, and what is reported about it.
    step: Step<K, B>,
    judged: Judged,
    /// The model with the first of the step's candidates.
    best: Fitted,
    /// Effects and covariates added so far.
    additions: usize,
    /// The number of fitted effects in the model that the diagnosis began with.
    given: usize,
    /// The effect that was added last, and the effects to which it was preferred.
    preferred: Option<Preferred>,
    work: Work<K, B>,
    stage: Stage<K, B>,
}

/// The stage that is in progress.
// The large variants share their memory. A diagnosis is stored once and never copied.
#[allow(clippy::large_enum_variant)]
enum Stage<const K: usize, const B: usize> {
    /// Nothing has been done yet.
    Beginning,
    /// The step's model is fitted and compared.
    Judging(Judging<K, B>),
    /// The model is tried without each of its earlier additions.
    Dropping(Dropping),
    /// The covariates are tested for whether the rate follows them.
    Following(Following<K, B>),
    /// The step's model is solved again, because the solver has worked on other models or on
    /// covariates. The covariates come next, unless they have been tested.
    Resolving { followed: bool },
    /// The effects are scanned for their best shapes.
    Scanning(Scanning<K, B>),
    /// The best shapes are fitted in full.
    Trying(Trying),
    /// Pairs of effects are tried in the place of the effect that was added last.
    Swapping(Swapping<K, B>),
    /// The step is reported. What it adds comes next.
    Reported,
    /// There is nothing left to do.
    Finished(Result<Verdict, Error>),
}

/// The result of one piece of a diagnosis.
#[derive(Debug)]
pub enum Progress<'s, const K: usize, const B: usize = 0> {
    /// There is more to do.
    Working,
    /// A model has been judged, and it has been decided what to add.
    Step(&'s Step<K, B>),
    /// The diagnosis is complete.
    Finished(Verdict),
}

impl<'a, const K: usize> Diagnosis<'a, K> {
    /// A diagnosis that looks for what a model lacks. It does not begin before it is advanced.
    // Inlined, so that some 7 KiB are built where they stay and not moved there.
    #[inline(always)]
    pub fn new(
        curve: Curve<K>,
        evidence: Evidence<'a, K>,
        model: &Model,
        effects: &'a [&'static dyn Effect],
        options: Options,
    ) -> Self {
        Self::with_spectrum(curve, Spectrum::EMPTY, evidence, model, effects, options)
    }
}

impl<'a, const K: usize, const B: usize> Diagnosis<'a, K, B> {
    /// A diagnosis of a curve and of the density of the same record.
    // Inlined, so that some 7 KiB are built where they stay and not moved there.
    #[inline(always)]
    pub fn with_spectrum(
        curve: Curve<K>,
        spectrum: Spectrum<B>,
        evidence: Evidence<'a, K>,
        model: &Model,
        effects: &'a [&'static dyn Effect],
        options: Options,
    ) -> Self {
        Self {
            span: curve.span(),
            curve,
            spectrum,
            evidence,
            effects,
            options,
            step: Step::of(model),
            judged: Judged::none(),
            best: Fitted::empty(),
            additions: 0,
            given: list::count(model.terms().iter().filter(|term| term.fitted)),
            preferred: None,
            work: Work::NEW,
            stage: Stage::Beginning,
        }
    }

    /// Does the whole diagnosis. Calls `report` for every step, including the last one.
    ///
    /// # Errors
    /// As of [`fit`](crate::fit::fit()).
    pub fn run(&mut self, mut report: impl FnMut(&Step<K, B>)) -> Result<Verdict, Error> {
        loop {
            match self.advance()? {
                Progress::Working => {}
                Progress::Step(step) => report(step),
                Progress::Finished(verdict) => return Ok(verdict),
            }
        }
    }

    /// Does one piece of work.
    ///
    /// # Errors
    /// The same as those of [`fit`](crate::fit::fit()). An error ends the diagnosis.
    pub fn advance(&mut self) -> Result<Progress<'_, K, B>, Error> {
        let advanced = match self.work() {
            Ok(false) => Ok(()),
            Ok(true) => self.go_on(),
            Err(error) => Err(error),
        };
        if let Err(error) = advanced {
            self.stage = Stage::Finished(Err(error));
        }
        match &self.stage {
            Stage::Finished(verdict) => verdict.map(Progress::Finished),
            Stage::Reported => Ok(Progress::Step(&self.step)),
            _ => Ok(Progress::Working),
        }
    }

    /// Does one piece of work on the present stage, and returns whether the stage is complete.
    // This is a function of its own, because the temporaries of what follows a stage would lie on the
    // stack below it.
    #[inline(never)]
    fn work(&mut self) -> Result<bool, Error> {
        let contest = self.contest();
        let Self {
            curve,
            spectrum,
            span,
            evidence,
            effects,
            options,
            step,
            judged,
            best,
            work,
            stage,
            ..
        } = self;
        let observed = Observed::new(curve, spectrum);
        match stage {
            Stage::Judging(judging) => {
                let complete = judging.advance(observed, span, work, step)?;
                if let Some(complete) = complete {
                    *judged = complete;
                }
                Ok(complete.is_some())
            }
            Stage::Dropping(dropping) => {
                Ok(dropping.advance(observed, &contest, &step.model, &judged.squares, work))
            }
            Stage::Following(following) => {
                let (model, least_z) = (&step.model, options.covariate_z);
                let complete =
                    following.advance(observed, evidence, model, judged, least_z, work)?;
                if let Some(followed) = complete {
                    step.added = followed.map(Addition::Covariate);
                }
                Ok(complete.is_some())
            }
            Stage::Resolving { .. } => {
                let problem = Problem::new(observed, &step.model, &work.columns);
                work.solver.advance(&problem)
            }
            Stage::Scanning(scanning) => {
                let problem = Problem::new(observed, &step.model, &work.columns);
                Ok(scanning.advance(&problem, &work.solver, effects, span))
            }
            Stage::Trying(trying) => {
                let base = Base {
                    model: &step.model,
                    swap: None,
                };
                Ok(trying.advance(observed, &contest, base, work, &mut step.candidates, best))
            }
            Stage::Swapping(swapping) => {
                Ok(swapping.advance(observed, effects, &contest, work, step, best))
            }
            Stage::Beginning | Stage::Reported | Stage::Finished(_) => Ok(true),
        }
    }

    /// Goes on to the stage that follows the present one, which is complete.
    #[inline(never)]
    fn go_on(&mut self) -> Result<(), Error> {
        match &mut self.stage {
            Stage::Beginning => {
                check(self.curve.points(), 2)?;
                let tolerance = Tolerance::IfNeeded(self.options.tolerance);
                self.judge(Start::Independent, tolerance)?;
            }
            Stage::Judging(_) => match Dropping::new(&self.step.model, self.given) {
                Some(dropping) => self.stage = Stage::Dropping(dropping),
                None => {
                    self.step.begin_report();
                    self.follow_or_scan();
                }
            },
            Stage::Dropping(_) => self.drop()?,
            Stage::Following(_) => {
                if self.step.added.is_some() || self.judged.adequate != Some(false) {
                    self.stage = Stage::Reported;
                } else {
                    self.resolve(true)?;
                }
            }
            Stage::Resolving { followed: true } => self.scan_or_report(),
            Stage::Resolving { followed: false } => self.follow_or_scan(),
            Stage::Scanning(_) => self.try_shapes(),
            Stage::Trying(_) if self.preferred.is_some() => self.swap(),
            Stage::Trying(_) | Stage::Swapping(_) => self.choose(),
            Stage::Reported => self.add()?,
            Stage::Finished(_) => {}
        }
        Ok(())
    }

    /// Begins to judge the step's model.
    fn judge(&mut self, start: Start, tolerance: Tolerance) -> Result<(), Error> {
        let observed = Observed::new(&self.curve, &self.spectrum);
        self.work
            .begin_at(observed, &self.step.model, start, tolerance)?;
        self.stage = Stage::Judging(Judging::new());
        Ok(())
    }

    /// Whether something may be added to the model.
    fn has_room(&self) -> bool {
        self.additions < self.options.max_effects && self.evidence.invalid.is_none()
    }

    /// Begins to scan the list of effects if the model is not adequate; otherwise reports the step.
    fn scan_or_report(&mut self) {
        if !self.has_room() || self.judged.adequate != Some(false) {
            self.stage = Stage::Reported;
            return;
        }
        self.stage = Stage::Scanning(Scanning::new());
        if let Stage::Scanning(scanning) = &mut self.stage {
            let observed = Observed::new(&self.curve, &self.spectrum);
            let problem = Problem::new(observed, &self.step.model, &self.work.columns);
            scanning.begin(&problem, &mut self.work.solver);
        }
    }

    /// Goes on with the covariates if there are any, and else with the list of effects.
    fn follow_or_scan(&mut self) {
        if self.has_room() && self.step.covariate.is_none() && !self.evidence.covariates.is_empty()
        {
            self.follow();
        } else {
            self.scan_or_report();
        }
    }

    /// Begins to solve the step's model again.
    fn resolve(&mut self, followed: bool) -> Result<(), Error> {
        let start = Start::Once(self.judged.assumed);
        let tolerance = Tolerance::Fixed(self.judged.tolerance);
        let model = &self.step.model;
        let observed = Observed::new(&self.curve, &self.spectrum);
        self.work.begin_at(observed, model, start, tolerance)?;
        self.stage = Stage::Resolving { followed };
        Ok(())
    }

    /// Drops the addition that the model needs least, if it does not need it, and begins to judge the
    /// model without it.
    #[inline(never)]
    fn drop(&mut self) -> Result<(), Error> {
        let Stage::Dropping(dropping) = &self.stage else {
            return Ok(());
        };
        match dropping.dropped(self.options.threshold) {
            Some((term, fitted)) => {
                // There is a place for every effect that a model can have.
                let _ = self.step.dropped.push(term.effect.name());
                self.step.model.clone_from(&fitted.model);
                let start = Start::Once(fitted.squares);
                self.judge(start, Tolerance::IfNeeded(self.options.tolerance))
            }
            None => {
                self.step.begin_report();
                self.resolve(false)
            }
        }
    }

    // Each stage begins in a function of its own. What is moved into place there does not lie on the
    // stack below the others.

    #[inline(never)]
    fn follow(&mut self) {
        let following = Following::new(&self.curve, self.judged.squares);
        self.stage = Stage::Following(following);
    }

    #[inline(never)]
    fn try_shapes(&mut self) {
        if let Stage::Scanning(scanning) = &self.stage {
            let shapes = scanning.shapes().clone();
            self.stage = Stage::Trying(Trying::new(shapes));
        }
    }

    #[inline(never)]
    fn swap(&mut self) {
        if let Some(preferred) = self.preferred.take() {
            self.stage = Stage::Swapping(Swapping::new(preferred));
        }
    }

    /// What the candidates are compared with.
    const fn contest(&self) -> Contest {
        Contest {
            score: self.judged.score,
            tolerance: self.judged.tolerance,
            span: self.span,
        }
    }

    /// Chooses from the step's candidates, and reports the step.
    fn choose(&mut self) {
        let Options {
            threshold,
            ambiguity,
            ..
        } = self.options;
        let (step, best) = (&mut self.step, &mut self.best);
        if let Some(chosen) = choose(&step.candidates, threshold, ambiguity) {
            step.ambiguous = chosen.ambiguous;
            step.added = step
                .candidates
                .first()
                .map(|first| Addition::Effect(first.term));
            tell_from_mirror(
                Observed::new(&self.curve, &self.spectrum),
                self.evidence.kurtosis,
                self.effects,
                &mut self.work.columns,
                best,
                step,
            );
        }
        self.stage = Stage::Reported;
    }

    /// Adds what the step adds, and begins to judge the model with it. If the step adds nothing, the
    /// diagnosis ends.
    fn add(&mut self) -> Result<(), Error> {
        match self.step.added {
            Some(Addition::Covariate(followed)) => {
                self.step.covariate = Some(followed);
                followed.correct(&self.evidence, &mut self.curve, &mut self.spectrum);
                self.additions = self.additions.saturating_add(1);
                // The curve is another one now, so the tolerance is decided anew.
                let tolerance = Tolerance::IfNeeded(self.options.tolerance);
                self.judge(Start::From(self.judged.squares), tolerance)
            }
            Some(Addition::Effect(_)) => {
                let (candidates, threshold) = (&self.step.candidates, self.options.threshold);
                self.preferred = Preferred::of(candidates, threshold);
                self.step.dropped.clear();
                self.step.model.clone_from(&self.best.model);
                self.additions = self.additions.saturating_add(1);
                // The model may explain the record without the tolerance that the one before needed.
                let tolerance = Tolerance::IfNeeded(self.judged.tolerance);
                self.judge(Start::Once(self.best.squares), tolerance)
            }
            None => {
                self.stage = Stage::Finished(Ok(self.verdict()));
                Ok(())
            }
        }
    }

    fn verdict(&self) -> Verdict {
        match (self.evidence.invalid, self.additions, self.judged.adequate) {
            (Some(reason), ..) => Verdict::Invalid(reason),
            (_, 0, Some(true)) => Verdict::Adequate,
            (_, 0, Some(false)) => Verdict::Unexplained,
            (_, 0, None) => Verdict::TooShort,
            (_, _, Some(true)) => Verdict::Improved,
            _ => Verdict::Incomplete,
        }
    }
}
