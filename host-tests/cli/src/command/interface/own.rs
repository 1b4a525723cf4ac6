//! An effect of the caller's own, as a function of the lag.

use allanite::effect::{CATALOGUE, Description, Distribution, Effect, SampledShape};
use allanite_log::failure::Failure;
use std::{
    collections::HashMap,
    sync::{Mutex, PoisonError},
};

/// The generalised covariance `G` of the angle at a lag in seconds, for a coefficient of one: in s² times the rate unit squared.
pub type Covariance = Box<dyn Fn(f64) -> f64 + Send + Sync>;

/// An effect without shape parameters, whose covariance another program computes. Every lag is asked for once.
pub struct Own {
    description: &'static Description,
    covariance: Covariance,
    known: Mutex<HashMap<u64, f64>>,
}

impl Own {
    /// The effect with this name and symbol. Effects live as long as the program, because models refer to them.
    ///
    /// # Errors
    /// When the name is one of the catalogue's, or is not in lower case with underscores.
    pub fn new(
        name: &str,
        symbol: &str,
        half_seconds: i8,
        covariance: Covariance,
    ) -> Result<&'static Self, Failure> {
        let is_name = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        if name.is_empty() || !name.chars().all(is_name) {
            return Err(Failure::option(
                format!("{name:?} is no name of an effect"),
                "use lower case and underscores",
            ));
        }
        if CATALOGUE.iter().any(|effect| effect.name() == name) {
            return Err(Failure::option(
                format!("{name} is an effect of the catalogue"),
                "give another name",
            ));
        }
        let leaked = |text: &str| -> &'static str { Box::leak(text.to_owned().into_boxed_str()) };
        let name = leaked(name);
        let description = Description {
            name,
            symbol: leaked(symbol),
            coefficient: name,
            half_seconds,
            reference_s: None,
            parameters: &[],
            code: 0,
            replaces: None,
            mirror: None,
            special_case: None,
            distribution: Distribution::Gaussian,
        };
        Ok(Box::leak(Box::new(Self {
            description: Box::leak(Box::new(description)),
            covariance,
            known: Mutex::default(),
        })))
    }
}

impl Own {
    /// The name of the effect.
    pub fn name(&self) -> &'static str {
        self.description.name
    }
}

impl Effect for Own {
    fn description(&self) -> &'static Description {
        self.description
    }

    fn kernel(&self, lag: f64, shape: &SampledShape) -> f64 {
        let lag_s = lag * shape.interval_s;
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(&value) = known().get(&lag_s.to_bits()) {
            return value;
        }
        // The lock is free meanwhile, because the other program may have locks of its own.
        let value = (self.covariance)(lag_s);
        known().insert(lag_s.to_bits(), value);
        value
    }
}
