//! White noise behind a low pass whose response was fitted to a record.

use super::response::Response;
use crate::own::Density;
use allanite::{
    curve::Span,
    effect::{
        AngleRandomWalk, Description, Distribution, Effect, Parameter, SampledShape, SearchRange,
    },
};
use std::{
    collections::HashMap,
    sync::{Mutex, PoisonError},
};

/// The name in studies.
pub const NAME: &str = "freeform_filter";

/// How far the cut-off may move from where the response was fitted. Chosen by hand.
const BEYOND: f64 = 1.5;

/// Shapes whose covariances are kept.
const KEPT: usize = 8;

/// Angle random walk behind a filter whose response is known but for its cut-off. The coefficient is `N` in front of the filter.
pub(super) struct FreeformFilter {
    response: Response,
    rate_hz: f64,
    /// The covariances of the last cut-offs.
    sampled: Mutex<Vec<Sampled>>,
}

/// The bits of a cut-off, its density, and its covariances by the bits of the lag.
type Sampled = (u64, Density, HashMap<u64, f64>);

static DESCRIPTION: Description = Description {
    name: NAME,
    symbol: "N",
    coefficient: "angle_random_walk",
    half_seconds: 1,
    reference_s: None,
    parameters: &[Parameter {
        name: "cutoff_hz",
        unit: "Hz",
        is_whole: false,
        search_range: |span| SearchRange {
            low: 1.0 / span.longest_tau_s,
            high: 0.5 / span.interval_s,
            steps_per_octave: 3.0,
        },
        reciprocal: None,
    }],
    code: 0,
    replaces: Some(&AngleRandomWalk),
    mirror: None,
    special_case: None,
    distribution: Distribution::Gaussian,
};

impl FreeformFilter {
    /// The effect of a response, in a record of this rate. It lives as long as the program, because models refer to it.
    pub(super) fn leaked(response: Response, rate_hz: f64) -> &'static Self {
        Box::leak(Box::new(Self {
            response,
            rate_hz,
            sampled: Mutex::default(),
        }))
    }

    /// Gives back the memory of the covariances.
    pub(super) fn rest(&self) {
        let mut sampled = self.sampled.lock().unwrap_or_else(PoisonError::into_inner);
        *sampled = Vec::new();
    }

    /// The cut-off at which the response was fitted.
    pub(super) fn cutoff_hz(&self) -> f64 {
        self.response.cutoff * self.rate_hz
    }

    /// The two-sided density of a coefficient of one at a frequency in Hz.
    fn density(&self, cutoff_hz: f64, frequency_hz: f64) -> f64 {
        let frequency = frequency_hz * self.response.cutoff / cutoff_hz;
        self.response.at(frequency)
    }
}

impl Effect for FreeformFilter {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn search_range(&self, parameter: usize, _: &Span) -> Option<SearchRange> {
        (parameter == 0).then(|| SearchRange {
            low: self.cutoff_hz() / BEYOND,
            high: self.cutoff_hz() * BEYOND,
            steps_per_octave: 3.0,
        })
    }

    fn needs_spectrum(&self) -> bool {
        true
    }

    fn kernel(&self, lag: f64, shape: &SampledShape) -> f64 {
        let cutoff_hz = match shape.parameters[0] {
            given if given > 0.0 => given,
            _ => self.cutoff_hz(),
        };
        let mut all = self.sampled.lock().unwrap_or_else(PoisonError::into_inner);
        let key = cutoff_hz.to_bits();
        let at = all.iter().position(|(known, ..)| *known == key);
        let at = at.unwrap_or_else(|| {
            if all.len() >= KEPT {
                all.remove(0);
            }
            let density = Density::new(|f| self.density(cutoff_hz, f), shape.interval_s);
            all.push((key, density, HashMap::new()));
            all.len() - 1
        });
        let (_, density, lags) = &mut all[at];
        let known = lags.entry(lag.to_bits());
        *known.or_insert_with(|| density.covariance(lag))
    }
}
