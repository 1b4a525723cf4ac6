//! White noise behind a low pass whose response was fitted to a record.

use super::{bands::Bands, response::Response};
use allanite::{
    curve::Span,
    effect::{
        AngleRandomWalk, Description, Distribution, Effect, Parameter, SampledShape, SearchRange,
    },
};
use std::{
    collections::HashMap,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

/// The name in studies.
pub const NAME: &str = "freeform_filter";

/// How far the cut-off may move from where the response was fitted. Chosen by hand.
const BEYOND: f64 = 1.5;

/// Cut-offs whose densities are kept.
const KEPT: usize = 8;

/// Angle random walk behind a filter whose response is known but for its cut-off. The coefficient is `N` in front of the filter.
pub(super) struct FreeformFilter {
    response: Response,
    rate_hz: f64,
    /// What was computed so far.
    computed: Mutex<Computed>,
}

/// Covariances, and what they are computed of.
#[derive(Default)]
struct Computed {
    bands: Option<Arc<Bands>>,
    /// The covariances of the bands by the bits of the lag.
    lags: HashMap<u64, Vec<f64>>,
    /// The last cut-offs by their bits, and the densities at the bands.
    densities: Vec<(u64, Vec<f64>)>,
}

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
    pub(super) fn leaked(response: Response, bands: Arc<Bands>, rate_hz: f64) -> &'static Self {
        Box::leak(Box::new(Self {
            response,
            rate_hz,
            computed: Mutex::new(Computed {
                bands: Some(bands),
                ..Computed::default()
            }),
        }))
    }

    /// Gives back the memory of the covariances.
    pub(super) fn rest(&self) {
        *self.computed() = Computed::default();
    }

    fn computed(&self) -> MutexGuard<'_, Computed> {
        self.computed.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The cut-off at which the response was fitted.
    pub(super) fn cutoff_hz(&self) -> f64 {
        self.response.cutoff * self.rate_hz
    }

    /// The two-sided densities of a coefficient of one at the bands.
    fn densities(&self, cutoff_hz: f64, bands: &Bands) -> Vec<f64> {
        let scale = self.cutoff_hz() / cutoff_hz;
        let frequencies = bands.frequencies.iter();
        frequencies.map(|f| self.response.at(f * scale)).collect()
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
        let mut computed = self.computed();
        let Computed {
            bands,
            lags,
            densities,
        } = &mut *computed;
        let bands = bands.get_or_insert_with(|| Arc::new(Bands::new(self.rate_hz)));
        let key = cutoff_hz.to_bits();
        let known = densities.iter().position(|(known, _)| *known == key);
        let at = known.unwrap_or_else(|| {
            if densities.len() >= KEPT {
                densities.remove(0);
            }
            densities.push((key, self.densities(cutoff_hz, bands)));
            densities.len() - 1
        });
        let lag_key = lag.to_bits();
        let of_bands = lags
            .entry(lag_key)
            .or_insert_with(|| bands.covariances(lag));
        let pairs = densities[at].1.iter().zip(of_bands.iter());
        pairs
            .map(|(density, covariance)| density * covariance)
            .sum()
    }
}
