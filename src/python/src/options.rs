//! The arguments of Python as types: `rate=100` and `unit="deg/s"` arrive as `--rate=100` and `--unit=deg/s`.

use allanite_host::{
    compare::model::ModelChoice,
    diagnose::drawing::Shown,
    fit::fitted::MethodName,
    interface::options::{Fitting, Reading, Search, Sensor},
    limit::LimitArgument,
};
use allanite_log::{
    Covariates, Cuts, Options as LogOptions,
    failure::{Failure, did_you_mean},
    unit::Unit,
};
use clap::ValueEnum;
use std::{fmt::Display, str::FromStr};

/// The arguments that have not been taken yet, by their names, in their order.
pub(crate) struct Options {
    given: Vec<(String, String)>,
    /// The names that were asked for.
    known: Vec<&'static str>,
}

impl Options {
    fn new(given: Vec<String>) -> Self {
        let split = |text: String| {
            let text = text.trim_start_matches('-');
            let (name, value) = text.split_once('=').unwrap_or((text, ""));
            (name.to_owned(), value.to_owned())
        };
        Self {
            given: given.into_iter().map(split).collect(),
            known: Vec::new(),
        }
    }

    /// The values of an argument that may be given several times.
    fn all(&mut self, name: &'static str) -> Vec<String> {
        self.known.push(name);
        let (found, rest) = std::mem::take(&mut self.given)
            .into_iter()
            .partition(|(other, _)| other == name);
        self.given = rest;
        found.into_iter().map(|(_, value)| value).collect()
    }

    fn text(&mut self, name: &'static str) -> Option<String> {
        self.all(name).pop()
    }

    fn one<T: FromStr<Err: Display>>(&mut self, name: &'static str) -> Result<Option<T>, Failure> {
        let text = self.text(name);
        text.map(|text| parsed(name, &text)).transpose()
    }

    /// Values between commas.
    fn list<T: FromStr<Err: Display>>(
        &mut self,
        name: &'static str,
    ) -> Result<Option<Vec<T>>, Failure> {
        let text = self.text(name);
        let list = |text: String| text.split(',').map(|text| parsed(name, text)).collect();
        text.map(list).transpose()
    }

    fn choice<T: ValueEnum>(&mut self, name: &'static str) -> Result<Option<T>, Failure> {
        let text = self.text(name);
        text.map(|text| chosen(name, &text)).transpose()
    }

    /// # Errors
    /// When an argument is left that nobody has asked for.
    fn finish(self) -> Result<(), Failure> {
        match self.given.first() {
            None => Ok(()),
            Some((name, _)) => {
                let hint = did_you_mean(name, self.known.iter().copied());
                let known = self.known.join(", ");
                Err(Failure::option(
                    format!("unexpected argument {name}"),
                    format!("{hint}choose from {known}"),
                ))
            }
        }
    }
}

/// A value as its type reads it.
fn parsed<T: FromStr<Err: Display>>(name: &str, text: &str) -> Result<T, Failure> {
    text.parse()
        .map_err(|why| Failure::option(format!("invalid value '{text}' for --{name}"), why))
}

/// One of several names.
fn chosen<T: ValueEnum>(name: &str, text: &str) -> Result<T, Failure> {
    T::from_str(text, false).map_err(|_| {
        let variants = T::value_variants().iter();
        let names = variants.filter_map(|one| Some(one.to_possible_value()?.get_name().to_owned()));
        Failure::option(
            format!("invalid value '{text}' for --{name}"),
            format!("choose from {}", names.collect::<Vec<_>>().join(", ")),
        )
    })
}

/// How a log is read.
///
/// # Errors
/// When an argument is unknown or its value is not valid; so it is below.
pub(crate) fn reading(given: Vec<String>) -> Result<Reading, Failure> {
    let mut options = Options::new(given);
    let none = !options.all("no-covariates").is_empty();
    let covariates = match options.list("covariates")? {
        Some(chosen) => Covariates::Chosen(chosen),
        None if none => Covariates::Chosen(Vec::new()),
        None => Covariates::Found,
    };
    let mut drop = Vec::new();
    for text in options.all("drop") {
        drop.push(parsed("drop", &text)?);
    }
    let log = LogOptions {
        rate_hz: options.one("rate")?,
        scale: options.one("scale")?,
        unit: options.choice("unit")?,
        columns: options.list("columns")?,
        sensor: options.choice("sensor")?,
        time: options.text("time"),
        time_unit: options.choice("time-unit")?,
        topic: options.text("topic"),
        repeats: options.choice("repeats")?.unwrap_or_default(),
        cuts: Cuts {
            from: options.one("from")?,
            to: options.one("to")?,
            drop,
        },
    };
    options.finish()?;
    Ok(Reading { log, covariates })
}

/// How axes are fitted.
pub(crate) fn fitting(given: Vec<String>) -> Result<Fitting, Failure> {
    let mut options = Options::new(given);
    let fitting = Fitting {
        method: options.choice("method")?.unwrap_or(MethodName::Covariance),
        limits: LimitArgument::all(&options.all("limit"))?,
        filter: options.text("filter"),
    };
    options.finish()?;
    Ok(fitting)
}

/// How effects are searched for.
pub(crate) fn search(given: Vec<String>) -> Result<Search, Failure> {
    let mut options = Options::new(given);
    let search = Search {
        max_effects: options.one("max-effects")?,
        filter: options.text("filter"),
    };
    options.finish()?;
    Ok(search)
}

/// The model that a record is compared with.
pub(crate) fn model(given: Vec<String>) -> Result<ModelChoice, Failure> {
    let mut options = Options::new(given);
    let choice = ModelChoice {
        with: options.all("with"),
        without: options.all("without"),
        filter: options.text("filter"),
    };
    options.finish()?;
    Ok(choice)
}

/// What is drawn of a diagnosis.
pub(crate) fn shown(given: Vec<String>) -> Result<Shown, Failure> {
    let mut options = Options::new(given);
    let what = options.text("what");
    let what = what.iter().flat_map(|text| text.split(','));
    let shown = Shown {
        axis: options.text("axis"),
        step: options.one("step")?,
        what: what
            .map(|text| chosen("what", text))
            .collect::<Result<_, _>>()?,
    };
    options.finish()?;
    Ok(shown)
}

/// The unit of axes that were read in pieces.
pub(crate) fn unit(given: Vec<String>) -> Result<Unit, Failure> {
    let mut options = Options::new(given);
    let unit = options.choice("unit")?;
    options.finish()?;
    Ok(unit.unwrap_or(Unit::DegreesPerSecond))
}

/// What is known of samples in memory.
pub(crate) fn sensor(given: Vec<String>) -> Result<Sensor, Failure> {
    let mut options = Options::new(given);
    let sensor = Sensor {
        rate_hz: options
            .one("rate")?
            .ok_or_else(|| Failure::option("the rate is not known", "give it with --rate"))?,
        rate_per_count: options.one("scale")?.unwrap_or(1.0),
        unit: options.choice("unit")?.unwrap_or(Unit::DegreesPerSecond),
        axes: options
            .list("axes")?
            .unwrap_or_else(|| vec!["gyro".to_owned()]),
    };
    options.finish()?;
    Ok(sensor)
}
