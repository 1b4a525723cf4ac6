//! A diagnosis in memory.

use super::{
    comparison::Comparison,
    document::{json, no_axis, text},
    options::Search,
    own::Own,
};
use crate::{
    compare::model::ModelChoice,
    curve_file::AxisCurve,
    diagnose::{
        self, conclusion,
        diagnosed::Diagnosed,
        drawing::{self, Shown},
        scope::Scope,
    },
    effect_argument, known_filter,
    record::library_failure,
};
use allanite::Model;
use allanite_log::{Evidence, failure::Failure};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// The diagnoses of all axes of a record, with their pictures.
pub struct Diagnosis {
    path: PathBuf,
    diagnosed: Vec<Diagnosed>,
}

/// The last model of an axis in the options of `compare`.
#[derive(Serialize)]
struct Last {
    with: Vec<String>,
    without: Vec<&'static str>,
    /// The covariates that are subtracted before the model is fitted.
    covariates: Vec<String>,
    /// The model of each step in words.
    names: Vec<String>,
}

impl Diagnosis {
    /// Diagnoses axes. `goes_on` is asked before each of them, whose number it is told.
    pub(super) fn of(
        path: &Path,
        axes: Vec<(AxisCurve, Evidence)>,
        search: &Search,
        goes_on: &mut dyn FnMut(usize) -> bool,
    ) -> Result<Self, Failure> {
        let model = known_filter::model(search.filter.as_deref())?;
        let scope = Scope::new(search.max_effects, &search.own)?;
        let diagnose = |(number, (axis, evidence)): (usize, (AxisCurve, Evidence))| {
            if !goes_on(number) {
                return Err(Failure::interrupted());
            }
            let name = axis.axis.clone();
            Diagnosed::new(axis, evidence, &model, &scope)
                .map_err(|error| library_failure(path, &name, error))
        };
        let axes = axes.into_iter().enumerate();
        Ok(Self {
            path: path.to_owned(),
            diagnosed: axes.map(diagnose).collect::<Result<_, _>>()?,
        })
    }

    /// What was found, axis by axis, as `diagnose --json` prints it.
    pub fn document(&self) -> diagnose::json::Document<'_> {
        diagnose::json::document(&self.diagnosed)
    }

    /// The document that `diagnose --json` prints.
    ///
    /// # Errors
    /// None occurs, because all numbers can be written.
    pub fn json(&self) -> Result<String, Failure> {
        json(&self.document())
    }

    /// The text that `diagnose` prints.
    ///
    /// # Errors
    /// None occurs, because the text is in memory.
    pub fn text(&self) -> Result<String, Failure> {
        text(|output| diagnose::text::print(&self.diagnosed, output))
    }

    /// The first lines of that text: what the diagnosis of each axis ends with.
    pub fn conclusion(&self) -> Vec<String> {
        conclusion::lines(&self.diagnosed.iter().collect::<Vec<_>>())
    }

    /// The last model of every axis in the options of `compare`, as JSON.
    ///
    /// # Errors
    /// None occurs, because all numbers can be written.
    pub fn models(&self) -> Result<String, Failure> {
        json(&self.diagnosed.iter().map(last).collect::<Vec<_>>())
    }

    /// The picture that `plot` draws, as the text of an SVG file.
    ///
    /// # Errors
    /// When there is no such axis, or it has nothing of what is to be drawn.
    pub fn svg(&self, shown: &Shown) -> Result<String, Failure> {
        let chosen = drawing::chosen(&self.diagnosed, &self.path, shown)?;
        drawing::drawn(&chosen, &self.path, shown)
    }

    /// Fits another model to an axis, without what the diagnosis found to follow a covariate.
    ///
    /// # Errors
    /// As of [`Record::compare`](super::Record::compare).
    pub fn compare(
        &self,
        axis: &str,
        model: &ModelChoice,
        own: &[&'static Own],
    ) -> Result<Comparison, Failure> {
        let mut all = self.diagnosed.iter();
        let found = all.find(|one| one.axis.axis == axis);
        let diagnosed = found.ok_or_else(|| {
            let names = self.diagnosed.iter().map(|one| one.axis.axis.as_str());
            no_axis(&self.path, axis, names)
        })?;
        let observed = match diagnosed.steps.last() {
            Some(last) => diagnosed.observed_in(last),
            None => diagnosed.axis.curve().and_then(|curve| {
                let spectrum = diagnosed.axis.spectrum()?;
                Ok((curve, spectrum))
            }),
        };
        let observed = observed.map_err(|error| library_failure(&self.path, axis, error))?;
        Comparison::of(&self.path, &diagnosed.axis, observed, (model, own))
    }
}

fn last(diagnosed: &Diagnosed) -> Last {
    let five = Model::ieee_952();
    let model = diagnosed.steps.last().map_or(&five, |last| &last.model);
    let terms = model.terms().iter();
    let added = terms
        .clone()
        // A filter that was given is an option of its own.
        .filter(|term| term.fitted || !known_filter::is_filter(term.effect))
        .filter(|term| five.position(term.effect.name()).is_none());
    let is_replaced = |name: &str| {
        let mut replaced = terms.clone().filter_map(|term| term.effect.replaces());
        replaced.any(|replaced| replaced.name() == name)
    };
    let five = five.terms().iter().map(|term| term.effect.name());
    let gone = five.filter(|name| model.position(name).is_none() && !is_replaced(name));
    let covariates = diagnosed.steps.last().and_then(|last| {
        let names = diagnosed.covariate(last.covariate.as_ref()?);
        Some(names.into_iter().map(str::to_owned).collect())
    });
    Last {
        with: added.map(effect_argument::written).collect(),
        without: gone.collect(),
        covariates: covariates.unwrap_or_default(),
        names: (0..diagnosed.steps.len())
            .map(|step| diagnosed.model_name(step))
            .collect(),
    }
}
