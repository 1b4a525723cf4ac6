//! The arguments of Python as types: `rate=100` is a number, `unit="deg/s"` a unit, `columns=["gx", "gy"]` a list.

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
use pyo3::FromPyObject;
use std::{collections::BTreeMap, fmt::Display, str::FromStr};

/// The arguments of a call, by the names that options have.
pub(crate) type Arguments = BTreeMap<String, Given>;

/// A value of an argument.
#[derive(FromPyObject)]
pub(crate) enum Given {
    Flag(bool),
    Text(String),
    Number(f64),
    List(Vec<String>),
}

/// The arguments that have not been taken yet.
struct Options {
    given: Arguments,
    /// The names that were asked for.
    known: Vec<&'static str>,
}

impl Options {
    const fn new(given: Arguments) -> Self {
        Self {
            given,
            known: Vec::new(),
        }
    }

    fn take(&mut self, name: &'static str) -> Option<Given> {
        self.known.push(name);
        self.given.remove(name)
    }

    fn flag(&mut self, name: &'static str) -> bool {
        matches!(self.take(name), Some(Given::Flag(true)))
    }

    fn number(&mut self, name: &'static str) -> Result<Option<f64>, Failure> {
        match self.take(name) {
            Some(Given::Number(number)) => Ok(Some(number)),
            other => other.map(|other| parsed(name, &text(other))).transpose(),
        }
    }

    fn text(&mut self, name: &'static str) -> Option<String> {
        self.take(name).map(text)
    }

    fn one<T: FromStr<Err: Display>>(&mut self, name: &'static str) -> Result<Option<T>, Failure> {
        let text = self.text(name);
        text.map(|text| parsed(name, &text)).transpose()
    }

    /// The values of an argument: a list, or a text with commas between them.
    fn texts(&mut self, name: &'static str) -> Option<Vec<String>> {
        self.take(name).map(|given| match given {
            Given::List(list) => list,
            other => text(other).split(',').map(str::to_owned).collect(),
        })
    }

    /// The values of an argument whose texts may have commas.
    fn list(&mut self, name: &'static str) -> Vec<String> {
        match self.take(name) {
            None => Vec::new(),
            Some(Given::List(list)) => list,
            Some(other) => vec![text(other)],
        }
    }

    fn all<T: FromStr<Err: Display>>(
        &mut self,
        name: &'static str,
    ) -> Result<Option<Vec<T>>, Failure> {
        let texts = self.texts(name);
        let all = |texts: Vec<String>| texts.iter().map(|text| parsed(name, text)).collect();
        texts.map(all).transpose()
    }

    fn choice<T: ValueEnum>(&mut self, name: &'static str) -> Result<Option<T>, Failure> {
        let text = self.text(name);
        text.map(|text| chosen(name, &text)).transpose()
    }

    /// # Errors
    /// When an argument is left that nobody has asked for.
    fn finish(self) -> Result<(), Failure> {
        match self.given.keys().next() {
            None => Ok(()),
            Some(name) => {
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

/// A value as the command line writes it.
fn text(given: Given) -> String {
    match given {
        Given::Flag(flag) => flag.to_string(),
        Given::Text(text) => text,
        Given::Number(number) => number.to_string(),
        Given::List(list) => list.join(","),
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
pub(crate) fn reading(given: Arguments) -> Result<Reading, Failure> {
    let mut options = Options::new(given);
    let none = options.flag("no-covariates");
    let covariates = match options.all("covariates")? {
        Some(chosen) => Covariates::Chosen(chosen),
        None if none => Covariates::Chosen(Vec::new()),
        None => Covariates::Found,
    };
    let mut drop = Vec::new();
    for text in options.list("drop") {
        drop.push(parsed("drop", &text)?);
    }
    let log = LogOptions {
        rate_hz: options.number("rate")?,
        scale: options.number("scale")?,
        unit: options.choice("unit")?,
        columns: options.all("columns")?,
        sensor: options.choice("sensor")?,
        time: options.text("time"),
        time_unit: options.choice("time-unit")?,
        topic: options.text("topic"),
        rows: options.one("rows")?,
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
pub(crate) fn fitting(given: Arguments) -> Result<Fitting, Failure> {
    let mut options = Options::new(given);
    let fitting = Fitting {
        method: options.choice("method")?.unwrap_or(MethodName::Covariance),
        limits: LimitArgument::all(&options.list("limit"))?,
        filter: options.text("filter"),
    };
    options.finish()?;
    Ok(fitting)
}

/// How effects are searched for.
pub(crate) fn search(given: Arguments) -> Result<Search, Failure> {
    let mut options = Options::new(given);
    let search = Search {
        max_effects: options.one("max-effects")?,
        filter: options.text("filter"),
        own: options.list("try"),
    };
    options.finish()?;
    Ok(search)
}

/// The model that a record is compared with.
pub(crate) fn model(given: Arguments) -> Result<ModelChoice, Failure> {
    let mut options = Options::new(given);
    let choice = ModelChoice {
        with: options.list("with"),
        without: options.list("without"),
        filter: options.text("filter"),
    };
    options.finish()?;
    Ok(choice)
}

/// What is drawn of a diagnosis.
pub(crate) fn shown(given: Arguments) -> Result<Shown, Failure> {
    let mut options = Options::new(given);
    let what = options.texts("what").unwrap_or_default();
    let what = what.iter().map(String::as_str);
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
pub(crate) fn unit(given: Arguments) -> Result<Unit, Failure> {
    let mut options = Options::new(given);
    let unit = options.choice("unit")?;
    options.finish()?;
    Ok(unit.unwrap_or(Unit::DegreesPerSecond))
}

/// What is known of samples in memory.
pub(crate) fn sensor(given: Arguments) -> Result<Sensor, Failure> {
    let mut options = Options::new(given);
    let sensor = Sensor {
        rate_hz: options
            .number("rate")?
            .ok_or_else(|| Failure::option("the rate is not known", "give it with --rate"))?,
        rate_per_count: options.number("scale")?.unwrap_or(1.0),
        unit: options.choice("unit")?.unwrap_or(Unit::DegreesPerSecond),
        axes: options
            .texts("axes")
            .unwrap_or_else(|| vec!["gyro".to_owned()]),
    };
    options.finish()?;
    Ok(sensor)
}
