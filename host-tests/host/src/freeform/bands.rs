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

/// Narrow bands, whose sum with the values of a density at their frequencies is that density but for straight lines between them.
pub(super) struct Bands {
    /// The frequencies of the bands, in cycles per sample, from zero to a half.
    pub(super) frequencies: Vec<f64>,
    bands: Vec<Band>,
}

impl Bands {
    /// The bands at a rate.
    pub(super) fn new(rate_hz: f64) -> Self {
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
        let at = |place: Option<usize>| place.and_then(|at| frequencies.get(at)).copied();
        let bands = (0..frequencies.len()).map(|place| {
            let ends = [place.checked_sub(1), Some(place), Some(place + 1)];
            Band::new(ends.map(at), rate_hz)
        });
        Self {
            bands: bands.collect(),
            frequencies,
        }
    }

    /// For each band, the densities that the bins of a spectrum are expected to show of it.
    pub(super) fn shown<const B: usize>(&self, spectrum: &Spectrum<B>) -> Vec<Vec<f64>> {
        let shown = self.bands.iter().map(|band| {
            let shown = spectrum.expected(band, [0.0; MAX_PARAMETERS]);
            shown.iter().copied().collect()
        });
        shown.collect()
    }

    /// The generalised covariances of the bands at a lag.
    pub(super) fn covariances(&self, lag: f64) -> Vec<f64> {
        self.bands.iter().map(|band| band.at(lag)).collect()
    }
}

/// Noise in a band: its density rises from zero at one frequency to one and falls to zero again.
struct Band {
    density: Density,
    /// The covariances by the bits of the lag: a spectrum asks for each of them several times.
    lags: Mutex<HashMap<u64, f64>>,
}

/// The lowest edge of the band at zero, as a power of two of half the rate. A record of 2^34 samples would see it.
const DEEPEST: i32 = -33;
/// The factor from one edge to the next. Chosen by hand.
const FARTHER: f64 = 1.2;

impl Band {
    /// A band between its neighbours, of which there is one alone at either end.
    fn new(ends: [Option<f64>; 3], rate_hz: f64) -> Self {
        let [low, middle, high] = ends.map(|end| end.map(|end| end * rate_hz));
        let middle = middle.unwrap_or_default();
        let density = |f: f64| match (low, high) {
            (Some(low), _) if f <= middle => (f - low) / (middle - low),
            (_, Some(high)) => (high - f) / (high - middle),
            _ => 1.0,
        };
        let lowest = match low {
            Some(low) if low > 0.0 => low,
            _ => 0.5 * rate_hz * f64::from(DEEPEST).exp2(),
        };
        // Near zero the integrand changes from octave to octave, and at the middle it has a corner.
        let mut edges = vec![lowest];
        let mut last = lowest;
        for end in [middle, high.unwrap_or(middle)] {
            while FARTHER * last < end {
                last *= FARTHER;
                edges.push(last);
            }
            if end > last {
                last = end;
                edges.push(last);
            }
        }
        Self {
            density: Density::between(&edges, density, rate_hz.recip()),
            lags: Mutex::default(),
        }
    }

    fn at(&self, lag: f64) -> f64 {
        let mut lags = self.lags.lock().unwrap_or_else(PoisonError::into_inner);
        let known = lags.entry(lag.to_bits());
        *known.or_insert_with(|| self.density.covariance(lag))
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
        self.at(lag)
    }
}
