//! Studies slow Gauss–Markov noise: a published benchmark, and noise of a size at its ideal limit of detection.

use super::{RATE_HZ, measured::Measured, periodogram::Periodogram, said::Said};
use allanite_host::simulate::{Coefficients, Hidden, Preset, Random, Simulator};
use rand::{RngExt, SeedableRng, seq::IndexedRandom};
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF as _, Normal};
use std::f64::consts::PI;

/// The benchmark of Nikolic (2016): white noise and Gauss–Markov noise, in rad and s, for 12 h at 400 Hz.
pub const BENCHMARK: Benchmark = Benchmark {
    rate_hz: 400.0,
    samples: 12 * 3600 * 400,
    angle_random_walk: 1.064e-4,
    correlation_time_s: 530.8,
    // A driving noise of 1.148e-6 rad/s/√s.
    rms: 1.870e-5,
};

/// A record of white noise and Gauss–Markov noise.
#[derive(Clone, Copy, Debug)]
pub struct Benchmark {
    /// The sample rate.
    pub rate_hz: f64,
    /// The number of samples.
    pub samples: usize,
    /// The angle random walk.
    pub angle_random_walk: f64,
    /// The correlation time of the Gauss–Markov noise.
    pub correlation_time_s: f64,
    /// Its root mean square.
    pub rms: f64,
}

/// The counts of records of the benchmark.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// All records.
    pub records: usize,
    /// Gauss–Markov noise is named, alone.
    pub named: usize,
    /// It is named, or said to explain the record as well.
    pub among: usize,
    /// B or K is called measured.
    pub measured: usize,
    /// The intervals of N, of the root mean square and of the correlation time contain their true values.
    pub covered: [usize; 3],
    /// What was said of other records.
    pub others: Vec<String>,
}

/// Diagnoses records of the benchmark.
pub fn benchmark(records: u64) -> Tally {
    let own = BENCHMARK;
    let coefficients = Coefficients {
        angle_random_walk: own.angle_random_walk,
        ..Coefficients::default()
    };
    let hidden = Hidden::new("gauss_markov", [own.correlation_time_s], own.rms);
    let hidden = [hidden.expect("of the catalogue")];
    let said: Vec<Said> = (0..records)
        .into_par_iter()
        .map(|seed| {
            let mut simulator = Simulator::with_hidden(coefficients, &hidden, own.rate_hz, seed);
            let measured = Measured::at(own.rate_hz, &mut simulator, coefficients, own.samples);
            Said::of(&measured)
        })
        .collect();
    let mut tally = Tally::default();
    for said in &said {
        let compared = said.compared(&["gauss_markov"]);
        tally.records += 1;
        tally.named += usize::from(compared.exact);
        tally.among += usize::from(compared.among);
        tally.measured += usize::from(said.measures("B") || said.measures("K"));
        let time = said
            .intervals
            .iter()
            .find(|(name, _)| *name == "correlation_time_s");
        let covers_time = time.is_some_and(|(_, [_, lower, upper])| {
            (*lower..=*upper).contains(&own.correlation_time_s)
        });
        let covered = [
            said.covers("N", own.angle_random_walk),
            said.covers("s", own.rms),
            covers_time,
        ];
        for (sum, covered) in tally.covered.iter_mut().zip(covered) {
            *sum += usize::from(covered);
        }
        if !compared.exact {
            tally.others.push(said.words());
        }
    }
    tally
}

/// A record with slow noise of a size relative to its limit.
#[derive(Clone, Debug)]
pub struct Limited {
    /// The gyro.
    pub preset: Preset,
    /// The number of samples.
    pub samples: usize,
    /// The correlation time in s.
    pub correlation_time_s: f64,
    /// The root mean square.
    pub rms: f64,
    /// How far `−2 ln L` of the whole periodogram is expected to fall with noise of this size.
    pub fall: f64,
    /// Whether the noise was told, alone or as an alternative.
    pub told: bool,
    /// What was said.
    pub said: String,
}

impl Limited {
    /// The probability with which the ideal test, which knows the correlation time, finds the noise: that of a noncentral χ²
    /// of one degree of freedom on one side.
    pub fn ideal(&self) -> f64 {
        Normal::standard().cdf(self.fall.sqrt() - LIMIT.sqrt())
    }
}

/// The numbers of samples of a record.
const LENGTHS: [usize; 3] = [1 << 17, 1 << 18, 1 << 20];

/// The shortest correlation time in s, and the longest one as a share of the record.
const SHORTEST_S: f64 = 3.0;
const LONGEST: f64 = 0.1;

/// Diagnoses records with Gauss–Markov noise of this multiple of the ideal limit. A record whose noise five terms can
/// imitate at any size has no limit and is left out.
pub fn limited(factor: f64, records: u64) -> Vec<Limited> {
    (0..records)
        .into_par_iter()
        .filter_map(|seed| {
            let mut random = Random::seed_from_u64(seed ^ 0x736c_6f77);
            let preset = *[Preset::Mems, Preset::Fog].choose(&mut random)?;
            let samples = *LENGTHS.choose(&mut random)?;
            let longest = LONGEST * samples as f64 / RATE_HZ;
            let correlation_time_s =
                SHORTEST_S * (longest / SHORTEST_S).powf(random.random::<f64>());
            let base = preset.coefficients();
            let rms = factor * ideal_limit(base, samples, correlation_time_s)?;
            let hidden = [Hidden::new("gauss_markov", [correlation_time_s], rms)?];
            let mut simulator = Simulator::with_hidden(base, &hidden, RATE_HZ, seed);
            let said = Said::of(&Measured::of(&mut simulator, base, samples));
            Some(Limited {
                preset,
                samples,
                correlation_time_s,
                rms,
                fall: Periodogram::new(base, samples, &lorentzian(correlation_time_s))
                    .ratio(rms * rms),
                told: said.compared(&["gauss_markov"]).among,
                said: said.words(),
            })
        })
        .collect()
}

/// The fall of −2 ln L at the limit: the test with a known correlation time that errs in one of 200 clean records (6.6 for
/// one degree of freedom on one side) finds noise of this size in half of the records.
pub(super) const LIMIT: f64 = 6.6;

/// The density of Gauss–Markov noise with a root mean square of one, as a variance, at `x` periods per sample.
pub(super) fn lorentzian(correlation_time_s: f64) -> impl Fn(f64) -> f64 {
    let pole = (-1.0 / (RATE_HZ * correlation_time_s)).exp();
    move |x| (1.0 - pole * pole) / (1.0 - 2.0 * pole * (2.0 * PI * x).cos() + pole * pole)
}

/// The largest size that is tried, relative to the white noise of a sample.
const LARGEST: f64 = 30.0;

/// The root mean square at which the likelihood ratio of the whole periodogram (Whittle 1953) is expected to be [`LIMIT`],
/// beside the best fit of quantization, angle random walk, flicker and rate random walk. `None` if it never is.
pub fn ideal_limit(base: Coefficients, samples: usize, correlation_time_s: f64) -> Option<f64> {
    ideal_size(base, samples, &lorentzian(correlation_time_s), LIMIT)
}

/// The same for noise of any density, and for a likelihood ratio of `gain`.
pub(super) fn ideal_size(
    base: Coefficients,
    samples: usize,
    density: &dyn Fn(f64) -> f64,
    gain: f64,
) -> Option<f64> {
    let rows = Periodogram::new(base, samples, density);
    let (mut low, mut high) = (1e-6, LARGEST);
    let white = base.angle_random_walk * RATE_HZ.sqrt();
    let ratio = |size: f64| rows.ratio((size * white).powi(2));
    if ratio(high) < gain {
        return None;
    }
    for _ in 0..40 {
        let middle = (low * high).sqrt();
        if ratio(middle) < gain {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(high * white)
}
