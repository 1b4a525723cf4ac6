//! `diagnose`: which effects a curve has that the five terms lack.

use super::{
    diagnose_json, diagnose_text,
    input::{self, LogArguments},
    words,
};
use crate::{curve_file::AxisCurve, failure::Failure, log::OCTAVES};
use allanite::{Diagnosis, Model, Step, Term, Verdict, effect::CATALOGUE};
use clap::Args;
use std::{io::Write, path::PathBuf};

/// Find the physical effects that the five IEEE-952 terms lack, one after the other
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// A log (.csv, .csv.gz, .npy), or a curve file (.json) that `measure` wrote
    input: PathBuf,
    /// Most effects to add [default: 3]
    #[arg(long, value_name = "N")]
    max_effects: Option<usize>,
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
}

impl Diagnosed {
    fn new(axis: AxisCurve, max_effects: Option<usize>) -> Result<Self, allanite::Error> {
        let default = Diagnosis::default();
        let diagnosis = Diagnosis {
            max_effects: max_effects.unwrap_or(default.max_effects),
            ..default
        };
        let mut steps = Vec::new();
        let curve = axis.curve()?;
        let verdict = diagnosis.run(&curve, &Model::ieee_952(), &CATALOGUE, |step| {
            steps.push(step.clone());
        })?;
        Ok(Self {
            axis,
            steps,
            verdict,
            adequate_p: diagnosis.adequate_p,
        })
    }

    /// The model that was asked about, and the one that the diagnosis ends with.
    pub(super) fn ends(&self) -> Option<(&Step<OCTAVES>, &Step<OCTAVES>)> {
        self.steps.first().zip(self.steps.last())
    }

    /// The effects that were added.
    pub(super) fn added(&self) -> impl Iterator<Item = &Term> {
        self.steps.iter().filter_map(|step| step.added.as_ref())
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
        for step in &self.steps {
            let others = ambiguous(step);
            if let (Some(added), false) = (step.added, others.is_empty()) {
                notes.push(format!(
                    "{} is ambiguous: {} explains this curve as well",
                    words::plain(added.effect.name()),
                    words::list(others)
                ));
            }
        }
        if self.added().count() > 0 {
            notes.extend(words::damage(first, last, self.axis.unit));
        }
        // The shapes as the last model has them: earlier ones were polished since.
        let final_terms = self.added().filter_map(|added| {
            let at = last.model.position(added.effect.name())?;
            last.model.terms().get(at)
        });
        notes.extend(final_terms.filter_map(|term| words::alias(term, self.axis.rate_hz)));
        notes
    }
}

/// Effects that explain a step's curve about as well as the one that was added; with each of them
/// those of the same Allan variance, which no curve tells from it.
pub(super) fn ambiguous(step: &Step<OCTAVES>) -> Vec<&'static str> {
    let Some(added) = step.added else {
        return Vec::new();
    };
    let mut names: Vec<&'static str> = Vec::new();
    for name in step.ambiguous.iter().copied() {
        for other in [name].into_iter().chain(words::twins(name)) {
            if other != added.effect.name() && !names.contains(&other) {
                names.push(other);
            }
        }
    }
    names
}

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let diagnose = |axis: AxisCurve| {
        let name = axis.axis.clone();
        Diagnosed::new(axis, arguments.max_effects)
            .map_err(|error| input::library_failure(&arguments.input, &name, error))
    };
    let diagnosed = input::read(&arguments.input, &arguments.about_log)?
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
