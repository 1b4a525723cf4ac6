//! A record and the steps of its diagnosis, which `diagnose` prints, `report` shows and `plot` draws.

use super::{
    given_filter::Better,
    lines::{self, Line, comb_notes, half_rate_notes},
    scope::Scope,
};
use crate::{
    comb::Comb,
    curve_file::AxisCurve,
    dependence::candidates::{Candidate as Series, Candidates},
    diagnosis::{diagnose, go_on},
    disturbance::invalid,
    freeform::{Freeform, alternative as alternative_filter},
    known_filter::{self, known_filter},
    rounding,
    stationarity::Stationarity,
    tried::{TriedCovariate, tried},
    verdict, words,
};
use allanite::{
    Curve, Error, Model, Record, Scale, Term,
    course::Course,
    covariate::{self, Slope},
    detection::{Detection, Limit, Ranges},
    diagnosis::{Addition, Candidate, FollowedCovariate, Step, Verdict, alternative},
    spectrum::Spectrum,
};
use allanite_log::{BINS, Disturbance, Evidence, OCTAVES};

/// What a p-value is worth after an effect was chosen.
const SELECTED: &str = "the last p-value takes the added effects for known: they were the best of many, so it is too high";

/// One axis, and the steps from the five terms to the last model.
pub struct Diagnosed {
    /// The curve.
    pub axis: AxisCurve,
    /// The steps, at least one; the last one has the model that the diagnosis ends with.
    pub steps: Vec<Step<OCTAVES, BINS>>,
    /// The verdict on the curve and the spectrum.
    pub verdict: Verdict,
    /// What fits better than the filter that was given; `None` if that fits or none was given.
    pub better: Option<Better>,
    /// A low pass of another form that explains the record without some of the effects; `None` if there is none.
    pub freeform: Option<Freeform>,
    /// The sizes of effects that the record would have shown. Empty unless the last model is adequate.
    pub limits: Vec<Limit>,
    /// What happened during the record.
    pub stationarity: Stationarity,
    /// The sinusoids of the last model, and those of them that are harmonics of one fundamental.
    pub lines: Vec<Line>,
    /// The harmonics.
    pub combs: Vec<Comb>,
    /// The course of the record. A curve file has none.
    pub course: Option<Course>,
    /// The columns that were recorded beside the axis, with their means in the blocks of the course.
    pub columns: Vec<(String, Vec<f64>)>,
    /// The motion or the spikes that make the record not valid, if there are any.
    pub disturbance: Option<Disturbance>,
    /// The covariates that were tried, with what was found of each. Empty for a record that is not valid.
    pub tried: Vec<TriedCovariate>,
    /// The effects that were tried, and the options of the search.
    pub scope: Scope,
    /// The covariates, with what the axis has in common with each of them.
    candidates: Candidates,
}

impl Diagnosed {
    /// Diagnoses an axis, from this model on, and finds out which effects the record would have shown, and whether a low pass of any
    /// form explains it better.
    pub fn new(
        axis: AxisCurve,
        evidence: Evidence,
        model: &Model,
        scope: &Scope,
    ) -> Result<Self, Error> {
        let mut diagnosed = Self::without_limits(axis, evidence, model, scope)?;
        diagnosed.limits = diagnosed.detection_limits()?;
        diagnosed.freeform = diagnosed.freeform()?;
        Ok(diagnosed)
    }

    /// As [`new`](Self::new), without the limits of detection and the low pass of any form, which take longer than the rest.
    pub fn without_limits(
        axis: AxisCurve,
        mut evidence: Evidence,
        model: &Model,
        scope: &Scope,
    ) -> Result<Self, Error> {
        let options = scope.options;
        let (course, columns) = (
            evidence.course.take(),
            std::mem::take(&mut evidence.columns),
        );
        let disturbance = evidence.disturbance.take();
        let (curve, spectrum, densities) = (axis.curve()?, axis.spectrum()?, axis.course()?);
        let candidates = Candidates::new(&curve, &spectrum, model, &evidence)?;
        let record = Record {
            course: densities.as_ref(),
            kurtosis: Some(&evidence.kurtosis),
            invalid: evidence.invalid,
            ..candidates.record(&curve, &spectrum)
        };
        let diagnose = |model: &Model, options| {
            let mut steps = Vec::new();
            let verdict = diagnose(record, model, &scope.effects, options, |step| {
                steps.push(step.clone());
            })?;
            Ok((steps, verdict))
        };
        let (mut steps, mut verdict) = diagnose(model, options)?;
        let five = |options| diagnose(&Model::ieee_952(), options);
        let better = match verdict {
            Verdict::Invalid(_) => None,
            _ => Better::than_given(&steps, options, five)?,
        };
        if better.is_some() {
            Better::keep_what_is_sure(&mut steps);
            verdict = match steps.len() {
                1 => Verdict::Unexplained,
                _ => Verdict::Incomplete,
            };
        }
        let mut diagnosed = Self {
            axis,
            steps,
            verdict,
            better,
            freeform: None,
            limits: Vec::new(),
            stationarity: Stationarity::default(),
            lines: Vec::new(),
            combs: Vec::new(),
            course: None,
            columns,
            disturbance,
            tried: Vec::new(),
            scope: scope.clone(),
            candidates,
        };
        diagnosed.lines = diagnosed.lines()?;
        diagnosed.combs = lines::combs(&diagnosed.lines, diagnosed.axis.rate_hz);
        diagnosed.tried = diagnosed.tried_in_last()?;
        if let Some(course) = course {
            diagnosed.stationarity = diagnosed.stationarity_in(&course)?;
            diagnosed.course = Some(course);
        }
        Ok(diagnosed)
    }

    /// What happened during the record, beside the noise of the last model.
    fn stationarity_in(&self, course: &Course) -> Result<Stationarity, Error> {
        let valid = !matches!(self.verdict, Verdict::Invalid(_) | Verdict::TooShort);
        let Some(last) = self.steps.last().filter(|_| valid) else {
            return Ok(Stationarity::default());
        };
        let scale = Scale::new(self.axis.rate_per_count, self.axis.rate_hz)?;
        let (curve, _) = self.observed_in(last)?;
        let followed = last.covariate.as_ref().map_or(Vec::new(), |followed| {
            self.candidates.followed(followed, course.block_length())
        });
        Stationarity::of(course, scale, &curve, &last.model, &followed)
    }

    /// What the last step tells of every covariate.
    fn tried_in_last(&self) -> Result<Vec<TriedCovariate>, Error> {
        let valid = !matches!(self.verdict, Verdict::Invalid(_));
        let Some(last) = self.steps.last().filter(|_| valid) else {
            return Ok(Vec::new());
        };
        let curve = self.axis.curve()?;
        Ok(tried(&curve, &self.candidates, last))
    }

    /// The sizes of effects that the record would have shown.
    fn detection_limits(&self) -> Result<Vec<Limit>, Error> {
        let mut limits = Vec::new();
        let adequate = matches!(self.verdict, Verdict::Adequate | Verdict::Improved);
        if let Some(last) = self.steps.last().filter(|_| adequate) {
            let (curve, spectrum) = self.observed_in(last)?;
            let course = self.axis.course()?;
            let record = Record {
                course: course.as_ref(),
                ..Record::new(&curve, &spectrum)
            };
            Detection::new(record, last, &self.scope.effects, self.scope.options)
                .run(|limit| limits.push(limit), &mut go_on);
        }
        Ok(limits)
    }

    /// The low pass of another form that explains the record with fewer effects, or better.
    fn freeform(&self) -> Result<Option<Freeform>, Error> {
        let Some((first, last)) = self.ends().filter(|_| self.better.is_none()) else {
            return Ok(None);
        };
        let (curve, spectrum, course) = (
            self.axis.curve()?,
            self.axis.spectrum()?,
            self.axis.course()?,
        );
        let record = Record {
            course: course.as_ref(),
            ..Record::new(&curve, &spectrum)
        };
        let found = alternative_filter(
            record,
            &first.model,
            (last, self.verdict),
            &self.scope.effects,
            self.scope.options,
        )?;
        let steps = found.as_ref().and_then(|(steps, _)| steps.last());
        Ok(steps.and_then(|with| Freeform::of(with, last)))
    }

    /// The sinusoids of the last model.
    fn lines(&self) -> Result<Vec<Line>, Error> {
        let Some(last) = self.steps.last() else {
            return Ok(Vec::new());
        };
        let (curve, spectrum) = self.observed_in(last)?;
        lines::lines(Record::new(&curve, &spectrum), last)
    }

    /// The limits of detection as ranges of shapes.
    pub fn ranges(&self) -> Ranges {
        let mut ranges = Ranges::default();
        self.limits.iter().for_each(|limit| ranges.push(limit));
        ranges
    }

    /// The curve and the spectrum on which a step was judged: without what follows a covariate.
    pub fn observed_in(
        &self,
        step: &Step<OCTAVES, BINS>,
    ) -> Result<(Curve<OCTAVES>, Spectrum<BINS>), Error> {
        let (curve, spectrum) = (self.axis.curve()?, self.axis.spectrum()?);
        let (mut corrected, mut densities) = (curve.clone(), spectrum.clone());
        if let Some(followed) = &step.covariate {
            let record = self.candidates.record(&curve, &spectrum);
            followed.correct(&record, &mut corrected, &mut densities);
        }
        Ok((corrected, densities))
    }

    /// The verdict, as it is written in files.
    pub fn verdict_name(&self) -> &'static str {
        verdict::name(self.verdict, self.stationarity.is_disturbed())
    }

    /// The first step, which has the five terms, and the last one.
    pub fn ends(&self) -> Option<(&Step<OCTAVES, BINS>, &Step<OCTAVES, BINS>)> {
        self.steps.first().zip(self.steps.last())
    }

    /// Why the record is not valid, if it is not.
    pub fn invalid(&self) -> Option<String> {
        match self.verdict {
            Verdict::Invalid(reason) => Some(invalid(
                &reason,
                self.disturbance.as_ref(),
                (&self.axis.axis, self.axis.rate_hz, self.axis.unit),
            )),
            _ => None,
        }
    }

    /// The motion that makes the record not valid, if there is one.
    pub fn motion(&self) -> impl Iterator<Item = &Disturbance> {
        self.disturbance.iter().filter(|one| one.is_motion)
    }

    /// What the last model subtracts of what was recorded alongside, and how much of χ² that explains: the sum of the
    /// squares of its slopes in standard errors. `None` if the rate follows nothing.
    pub fn dependence(&self) -> Option<(String, f64)> {
        let followed = self.steps.last()?.covariate.as_ref()?;
        let squares = self.slopes(followed).into_iter();
        let squares = squares.map(|(slope, _)| slope.z().powi(2)).sum();
        Some((self.covariate(followed).join(" and "), squares))
    }

    /// The error of a step, which falls from step to step: χ² of the curve and the spectrum, and, as long as it is not
    /// subtracted, what the rate follows of a covariate. Twice a logarithm of a likelihood ratio is the sum of both.
    pub fn chi_squared(&self, at: usize) -> f64 {
        let step = &self.steps[at];
        let dependence = match step.covariate {
            Some(_) => 0.0,
            None => self.dependence().map_or(0.0, |(_, squares)| squares),
        };
        step.fit.chi_squared + dependence
    }

    /// The model of a step in words: `five terms + sinusoid`.
    pub fn model_name(&self, step: usize) -> String {
        let Some(step) = self.steps.get(step) else {
            return String::new();
        };
        let channel = step
            .covariate
            .as_ref()
            .map(|followed| self.covariate(followed).join(" + "));
        let added = self
            .added_in(step)
            .map(|term| words::plain(term.effect.name()));
        let asked = self.steps.first().map(|first| &first.model);
        let parts = asked.map(known_filter::terms).into_iter();
        let parts = parts.chain(channel).chain(added);
        parts.collect::<Vec<_>>().join(" + ")
    }

    /// The filter that was given.
    pub fn filter(&self) -> Option<&Term> {
        known_filter(&self.steps.first()?.model)
    }

    /// The step that would have followed if this candidate had been added.
    ///
    /// # Errors
    /// When the model with the candidate cannot be fitted in full.
    pub fn alternative(
        &self,
        step: usize,
        candidate: &Candidate,
    ) -> Result<Step<OCTAVES, BINS>, Error> {
        let step = &self.steps[step];
        let (curve, spectrum) = self.observed_in(step)?;
        alternative(Record::new(&curve, &spectrum), step, candidate)
    }

    /// The effects that were added, as in the last model. Covariates are not among them.
    pub fn added(&self) -> impl Iterator<Item = &Term> {
        self.steps
            .last()
            .into_iter()
            .flat_map(|last| self.added_in(last))
    }

    /// The effects of a step that are not in the model of the first step.
    fn added_in<'a>(&'a self, step: &'a Step<OCTAVES, BINS>) -> impl Iterator<Item = &'a Term> {
        let asked = self.steps.first();
        step.model.terms().iter().filter(move |term| {
            let is_behind = |model| words::is_behind_filter(term.effect, model);
            asked.is_none_or(|asked| {
                asked.model.position(term.effect.name()).is_none()
                    || (is_behind(&step.model) && !is_behind(&asked.model))
            })
        })
    }

    /// Names of the covariate and the effects that were added.
    pub fn missing(&self) -> impl Iterator<Item = &'static str> {
        let last = self.steps.last();
        let followed = last.and_then(|last| last.covariate);
        let covariate = followed.map(|_| covariate::NAME);
        let added = last.into_iter().flat_map(|last| {
            let added = self.added_in(last);
            added.map(|term| words::name_in(term.effect, &last.model))
        });
        covariate.into_iter().chain(added)
    }

    /// The addition of each step that has ambiguous alternatives, with the names of these alternatives:
    /// they explain the curve about as well.
    pub fn ambiguous(&self) -> impl Iterator<Item = (&'static str, &[&'static str])> {
        let last = self.steps.last();
        self.steps.iter().filter_map(move |step| {
            let others = step.ambiguous.as_slice();
            let added = step.added.as_ref().filter(|_| !others.is_empty())?;
            let name = match (added, last) {
                (Addition::Effect(term), Some(last)) => words::name_in(term.effect, &last.model),
                _ => added_name(added),
            };
            Some((name, others))
        })
    }

    /// The names of the covariates that the rate depends on.
    pub fn covariate(&self, followed: &FollowedCovariate) -> Vec<&str> {
        let slopes = self.slopes(followed).into_iter();
        slopes
            .map(|(_, candidate)| candidate.name.as_str())
            .collect()
    }

    /// The slopes with which the rate follows covariates.
    pub fn slopes(&self, followed: &FollowedCovariate) -> Vec<(Slope, &Series)> {
        self.candidates.slopes(followed)
    }

    /// Notes on the result, one line each.
    pub fn notes(&self) -> Vec<String> {
        let Some((first, last)) = self.ends() else {
            return Vec::new();
        };
        let mut notes = Vec::new();
        if self.verdict == Verdict::TooShort {
            notes.push(format!("{}: record longer", verdict::too_few("model")));
        }
        match self.invalid() {
            Some(reason) => notes.push(reason),
            None => notes.extend(rounding::note(&self.axis, &last.fit)),
        }
        notes.extend(self.stationarity.notes(self.axis.unit));
        let tried = self.tried.iter();
        notes.extend(tried.map(|tried| format!("tried {}", tried.words(self.axis.unit))));
        for (added, others) in self.ambiguous() {
            notes.push(format!(
                "{} is ambiguous: {} would explain this curve as well",
                words::in_sentence(added),
                words::alternatives(others.iter().copied())
            ));
        }
        if self.added().next().is_some() {
            notes.extend(words::open_white_noise(&last.fit, self.axis.unit));
            let octaves = last.comparison.octaves.len();
            let (rate_hz, unit) = (self.axis.rate_hz, self.axis.unit);
            notes.extend(words::shared_plateau(
                &last.model,
                &last.fit,
                rate_hz,
                octaves,
                unit,
            ));
        }
        notes.extend(self.freeform.iter().map(|one| one.words(self.axis.unit)));
        notes.extend(comb_notes(&self.lines, &self.combs));
        notes.extend(half_rate_notes(&self.lines, self.axis.rate_hz));
        if self.added().next().is_some() && self.verdict == Verdict::Improved {
            notes.push(SELECTED.into());
        }
        notes.extend(words::widened(&last.fit));
        if self.missing().count() > 0 {
            let [before, after] = [first, last].map(|step| (&step.model, &step.fit));
            notes.extend(words::damage(before, after, self.axis.unit));
        }
        let aliases = self
            .added()
            .filter_map(|term| words::alias(term, self.axis.rate_hz));
        notes.extend(aliases);
        notes
    }
}

/// The name of an addition as it is written in files.
pub fn added_name(added: &Addition) -> &'static str {
    match added {
        Addition::Effect(term) => term.effect.name(),
        _ => covariate::NAME,
    }
}
