//! The densities that a record is expected to show where noise has any density: a sum over narrow bands.

use crate::own::Density;
use allanite::{
    effect::{Description, Distribution, Effect, MAX_PARAMETERS, SampledShape},
    spectrum::Spectrum,
};
use std::{
    collections::HashMap,
    sync::{Mutex, PoisonError},
};

/// The lowest frequency at which a response changes, in cycles per sample.
const LOWEST: f64 = 0.002;
/// Bands in each octave, until they are as wide as [`WIDEST`] cycles per sample. Chosen by hand: between two bands, a response is
/// a straight line.
const PER_OCTAVE: f64 = 10.0;
const WIDEST: f64 = 1.0 / 256.0;

/// What the bins of a spectrum show of a density of one in each band.
pub(super) struct Bands {
    /// The frequencies of the bands, in cycles per sample, from zero to a half.
    pub(super) frequencies: Vec<f64>,
    /// For each band, the expected densities of the bins.
    pub(super) shown: Vec<Vec<f64>>,
}

impl Bands {
    /// The bands of a spectrum.
    pub(super) fn of<const B: usize>(spectrum: &Spectrum<B>) -> Self {
        let mut frequencies = vec![0.0, LOWEST];
        let mut at = LOWEST;
        loop {
            at += (at * (2.0_f64.powf(1.0 / PER_OCTAVE) - 1.0)).min(WIDEST);
            if at >= 0.5 - 0.5 * WIDEST {
                break;
            }
            frequencies.push(at);
        }
        frequencies.push(0.5);
        let ends = |at: usize| {
            let below = at.checked_sub(1).map_or(0.0, |below| frequencies[below]);
            [
                below,
                frequencies[at],
                frequencies.get(at + 1).copied().unwrap_or(0.5),
            ]
        };
        let shown = (0..frequencies.len()).map(|at| {
            let band = Band::new(ends(at), spectrum.rate_hz());
            let shown = spectrum.expected(&band, [0.0; MAX_PARAMETERS]);
            shown.iter().copied().collect()
        });
        Self {
            shown: shown.collect(),
            frequencies,
        }
    }

    /// Adds what the bins show of this density, whose values at the bands are given.
    pub(super) fn add(&self, values: impl Iterator<Item = f64>, sum: &mut [f64]) {
        for (value, shown) in values.zip(&self.shown) {
            if value != 0.0 {
                for (sum, shown) in sum.iter_mut().zip(shown) {
                    *sum += value * shown;
                }
            }
        }
    }
}

/// Noise in a band: its density rises from zero at one frequency to one and falls to zero again.
struct Band {
    density: Density,
    /// The covariances by the bits of the lag: a spectrum asks for each of them several times.
    lags: Mutex<HashMap<u64, f64>>,
}

impl Band {
    fn new([low, middle, high]: [f64; 3], rate_hz: f64) -> Self {
        let [low, middle, high] = [low, middle, high].map(|f| f * rate_hz);
        let density = move |f: f64| {
            let rises = (f - low) / (middle - low);
            let falls = (high - f) / (high - middle);
            let side = if f <= middle { rises } else { falls };
            // At either end of all frequencies there is one side alone.
            if side.is_finite() { side.max(0.0) } else { 1.0 }
        };
        Self {
            density: Density::new(density, 1.0 / rate_hz),
            lags: Mutex::default(),
        }
    }
}

static DESCRIPTION: Description = Description {
    name: "band",
    symbol: "c",
    coefficient: "size",
    half_seconds: 1,
    reference_s: None,
    parameters: &[],
    code: 0,
    replaces: None,
    mirror: None,
    special_case: None,
    distribution: Distribution::Gaussian,
};

impl Effect for Band {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn kernel(&self, lag: f64, _: &SampledShape) -> f64 {
        let mut lags = self.lags.lock().unwrap_or_else(PoisonError::into_inner);
        let known = lags.entry(lag.to_bits());
        *known.or_insert_with(|| self.density.covariance(lag))
    }
}
