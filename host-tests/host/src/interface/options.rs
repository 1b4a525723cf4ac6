//! How records are read and fitted, searched and compared.

use crate::{fit::fitted::MethodName, limit::LimitArgument};
use allanite_log::{Covariates, Options, unit::Unit};

/// How a log is read.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The options of the reader.
    pub log: Options,
    /// The covariates that are tried.
    pub covariates: Covariates,
}

/// How axes are fitted.
#[derive(Clone)]
pub struct Fitting {
    /// The method that weights the octaves.
    pub method: MethodName,
    /// The largest values that coefficients may have.
    pub limits: Vec<LimitArgument>,
    /// The filter that is known to be in the signal path: `low_pass:cutoff_hz=42,poles=2`.
    pub filter: Option<String>,
}

impl Default for Fitting {
    fn default() -> Self {
        Self {
            method: MethodName::Covariance,
            limits: Vec::new(),
            filter: None,
        }
    }
}

/// How effects are searched for.
#[derive(Clone, Debug, Default)]
pub struct Search {
    /// The largest number of effects that are added; that of the library without one.
    pub max_effects: Option<usize>,
    /// The filter that is known to be in the signal path.
    pub filter: Option<String>,
    /// Effects of one's own that are tried beside the catalogue, as formulas.
    pub own: Vec<String>,
}

/// What is known of samples in memory.
#[derive(Clone, Debug)]
pub struct Sensor {
    /// Samples per second.
    pub rate_hz: f64,
    /// Rate units per count.
    pub rate_per_count: f64,
    /// The rate unit.
    pub unit: Unit,
    /// The names of the axes.
    pub axes: Vec<String>,
}
