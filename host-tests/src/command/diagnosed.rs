//! A record and the way of its diagnosis: what `diagnose` prints, `report` shows and `plot` draws.

use super::{
    input::{self, LogArguments},
    words,
};
use crate::{
    curve_file::AxisCurve,
    failure::Failure,
    log::{CovariateChoice, Evidence, OCTAVES},
};
use allanite::{
    Addition, Candidate, CrossCurve, Diagnosis, Error, Follows, Model, Step, Term, Verdict,
    covariate, effect::CATALOGUE,
};
use clap::Args;
use std::path::{Path, PathBuf};

/// What to diagnose, and how.
#[derive(Debug, Args)]
pub(super) struct DiagnosisArguments {
    /// A log (.csv, .csv.gz, .npy, .mcap, .ulg), or a curve file (.json) that `measure` wrote
    pub(super) input: PathBuf,
    #[command(flatten)]
    settings: DiagnosisSettings,
}

impl DiagnosisArguments {
    /// Diagnoses every axis.
    pub(super) fn diagnosed(&self) -> Result<Vec<Diagnosed>, Failure> {
        self.settings.diagnosed(&self.input)
    }
}

/// How to diagnose.
#[derive(Debug, Args)]
pub(super) struct DiagnosisSettings {
    /// Most effects to add [default: 3]
    #[arg(long, value_name = "N")]
    max_effects: Option<usize>,
    /// Columns of the log that the rate may follow, or their rates of change, such as
    /// `temp_C,rate(temp_C)`
    #[arg(long, value_delimiter = ',', value_name = "COLUMN,…")]
    covariates: Vec<CovariateChoice>,
    #[command(flatten)]
    about_log: LogArguments,
}

impl DiagnosisSettings {
    /// Diagnoses every axis of a record.
    pub(super) fn diagnosed(&self, path: &Path) -> Result<Vec<Diagnosed>, Failure> {
        let diagnose = |(axis, evidence): (AxisCurve, Evidence)| {
            let name = axis.axis.clone();
            Diagnosed::new(axis, evidence, self.max_effects)
                .map_err(|error| input::library_failure(path, &name, error))
        };
        let axes = input::read_with_evidence(path, &self.about_log, &self.covariates)?;
        axes.into_iter().map(diagnose).collect()
    }
}

/// One axis, and the way from the five terms to what explains it.
pub(super) struct Diagnosed {
    pub(super) axis: AxisCurve,
    /// At least one: the last is the model that the diagnosis ends with.
    pub(super) steps: Vec<Step<OCTAVES>>,
    pub(super) verdict: Verdict,
    /// How effects were looked for.
    pub(super) diagnosis: Diagnosis,
    /// Names of the covariates, and what the axis shares with each.
    covariates: Vec<String>,
    cross: Vec<CrossCurve<OCTAVES>>,
}

impl Diagnosed {
    fn new(axis: AxisCurve, evidence: Evidence, max_effects: Option<usize>) -> Result<Self, Error> {
        let default = Diagnosis::default();
        let diagnosis = Diagnosis {
            max_effects: max_effects.unwrap_or(default.max_effects),
            ..default
        };
        let (covariates, cross): (Vec<_>, Vec<_>) = evidence.covariates.into_iter().unzip();
        let evidence = allanite::Evidence {
            kurtosis: Some(&evidence.kurtosis),
            covariates: &cross,
            invalid: evidence.invalid,
        };
        let mut steps = Vec::new();
        let curve = axis.curve()?;
        let model = Model::ieee_952();
        let verdict = diagnosis.run(&curve, &evidence, &model, &CATALOGUE, |step| {
            steps.push(step.clone());
        })?;
        Ok(Self {
            axis,
            steps,
            verdict,
            diagnosis,
            covariates,
            cross,
        })
    }

    /// The model that was asked about, and the one that the diagnosis ends with.
    pub(super) fn ends(&self) -> Option<(&Step<OCTAVES>, &Step<OCTAVES>)> {
        self.steps.first().zip(self.steps.last())
    }

    /// The model of a step in words: `five terms + sinusoid`.
    pub(super) fn model_name(&self, step: usize) -> String {
        let Some(step) = self.steps.get(step) else {
            return String::new();
        };
        let channel = step.follows.as_ref().map(|follows| self.covariate(follows));
        let added = self
            .added_in(step)
            .map(|term| words::plain(term.effect.name()));
        let parts = std::iter::once("five terms".to_owned());
        let parts = parts.chain(channel.map(str::to_owned)).chain(added);
        parts.collect::<Vec<_>>().join(" + ")
    }

    /// The step that would have followed a step's candidate, had it been added.
    pub(super) fn alternative(
        &self,
        step: usize,
        candidate: &Candidate,
    ) -> Result<Step<OCTAVES>, Error> {
        let mut curve = self.axis.curve()?;
        let before = step
            .checked_sub(1)
            .and_then(|before| self.steps.get(before));
        let step = &self.steps[step];
        if let Some(follows) = &step.follows {
            self.cross[follows.covariate].correct(&mut curve, &follows.slope);
        }
        self.diagnosis.alternative(&curve, step, before, candidate)
    }

    /// The effects that were added and kept, without covariates, as the last model has them.
    fn added(&self) -> impl Iterator<Item = &Term> {
        self.steps
            .last()
            .into_iter()
            .flat_map(|last| self.added_in(last))
    }

    /// The effects of a step that the model that was asked about has not.
    fn added_in<'a>(&'a self, step: &'a Step<OCTAVES>) -> impl Iterator<Item = &'a Term> {
        let asked = self.steps.first();
        step.model.terms().iter().filter(move |term| {
            let asked = asked.map(|asked| asked.model.position(term.effect.name()));
            asked.flatten().is_none()
        })
    }

    /// Names of all that was added and kept.
    pub(super) fn missing(&self) -> impl Iterator<Item = &'static str> {
        let follows = self.steps.last().and_then(|last| last.follows);
        let covariate = follows.map(|_| covariate::NAME);
        covariate
            .into_iter()
            .chain(self.added().map(|term| term.effect.name()))
    }

    /// What every step added, with the effects that explain its curve about as well: without steps whose
    /// addition was dropped later.
    pub(super) fn ambiguous(&self) -> impl Iterator<Item = (&'static str, &[&'static str])> {
        let swaps = self.steps.iter().skip(1).map(|next| next.swap().is_some());
        let kept = self
            .steps
            .iter()
            .zip(swaps)
            .filter(|&(_, dropped)| !dropped);
        kept.filter_map(|(step, _)| {
            let others = step.ambiguous.as_slice();
            let added = step.added.as_ref().filter(|_| !others.is_empty())?;
            Some((added_name(added), others))
        })
    }

    /// The covariate that the rate follows, by name.
    pub(super) fn covariate(&self, follows: &Follows) -> &str {
        &self.covariates[follows.covariate]
    }

    /// What is worth knowing beside the figures, one line each.
    pub(super) fn notes(&self) -> Vec<String> {
        let Some((first, last)) = self.ends() else {
            return Vec::new();
        };
        let mut notes = Vec::new();
        if !first.fit.p_value.is_finite() {
            notes.push("there are too few octaves to judge the model: record longer".into());
        }
        if let Verdict::Invalid(reason) = self.verdict {
            notes.push(reason.to_string());
        }
        for (added, others) in self.ambiguous() {
            notes.push(format!(
                "{} is ambiguous: {} explains this curve as well",
                words::plain(added),
                words::list(others.iter().copied())
            ));
        }
        if self.missing().count() > 0 {
            notes.extend(words::damage(first, last, self.axis.unit));
        }
        let aliases = self
            .added()
            .filter_map(|term| words::alias(term, self.axis.rate_hz));
        notes.extend(aliases);
        notes
    }
}

/// What was added, by its name in files.
pub(super) fn added_name(added: &Addition) -> &'static str {
    match added {
        Addition::Effect(term) => term.effect.name(),
        Addition::Covariate(_) => covariate::NAME,
    }
}
