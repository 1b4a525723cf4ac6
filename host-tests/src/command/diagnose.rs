//! `diagnose`: which effects a curve has that the five terms lack.

use super::{
    diagnose_json, diagnose_text,
    input::{self, LogArguments},
    words,
};
use crate::{
    curve_file::AxisCurve,
    failure::Failure,
    log::{CovariateChoice, Evidence, OCTAVES},
};
use allanite::{
    Addition, Diagnosis, Follows, Model, Step, Term, Verdict,
    effect::{CATALOGUE, covariate},
};
use clap::Args;
use std::{io::Write, path::PathBuf};

/// Find the physical effects that the five IEEE-952 terms lack, one after the other
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// A log (.csv, .csv.gz, .npy, .mcap, .ulg), or a curve file (.json) that `measure` wrote
    input: PathBuf,
    /// Most effects to add [default: 3]
    #[arg(long, value_name = "N")]
    max_effects: Option<usize>,
    /// Columns of the log that the rate may follow, or their rates of change, such as
    /// `temp_C,rate(temp_C)`
    #[arg(long, value_delimiter = ',', value_name = "COLUMN,…")]
    covariates: Vec<CovariateChoice>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    about_log: LogArguments,
}

/// One axis, and the way from the five terms to what explains it.
pub(super) struct Diagnosed {
    pub(super) axis: AxisCurve,
    /// At least one: the last is the model that the diagnosis ends with.
    pub(super) steps: Vec<Step<OCTAVES>>,
    pub(super) verdict: Verdict,
    /// Models of lower p-value are not adequate.
    pub(super) adequate_p: f64,
    /// Names of the covariates.
    covariates: Vec<String>,
}

impl Diagnosed {
    fn new(
        axis: AxisCurve,
        evidence: Evidence,
        max_effects: Option<usize>,
    ) -> Result<Self, allanite::Error> {
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
            adequate_p: diagnosis.adequate_p,
            covariates,
        })
    }

    /// The model that was asked about, and the one that the diagnosis ends with.
    pub(super) fn ends(&self) -> Option<(&Step<OCTAVES>, &Step<OCTAVES>)> {
        self.steps.first().zip(self.steps.last())
    }

    /// The effects that were added and kept, without covariates, as the last model has them.
    fn added(&self) -> impl Iterator<Item = &Term> {
        let (asked, last) = self.ends().unzip();
        let terms = last.map_or(&[][..], |last| last.model.terms());
        terms.iter().filter(move |term| {
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

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let diagnose = |(axis, evidence): (AxisCurve, Evidence)| {
        let name = axis.axis.clone();
        Diagnosed::new(axis, evidence, arguments.max_effects)
            .map_err(|error| input::library_failure(&arguments.input, &name, error))
    };
    let axes = input::read_with_evidence(
        &arguments.input,
        &arguments.about_log,
        &arguments.covariates,
    )?;
    let diagnosed = axes
        .into_iter()
        .map(diagnose)
        .collect::<Result<Vec<_>, _>>()?;
    let printed = if arguments.json {
        diagnose_json::print(&diagnosed, output)
    } else {
        diagnose_text::print(&diagnosed, output)
    };
    printed.map_err(|error| Failure::standard_output(&error))
}
