//! The spectrum in a curve file.

use allanite::spectrum::{Bin, Spectrum};
use allanite_log::BINS;
use serde::{Deserialize, Serialize};

/// Largest relative error of a number that follows from other numbers of the file. Chosen by hand:
/// numbers are written with all their digits, so that only rounding remains, some 1e-15.
pub(super) const TOLERANCE: f64 = 1e-9;

/// The most power of a level, in Allan variances of one of its blocks. An octave's response to the frequencies of the
/// level is 0.075 at least, so that a record without gaps has 14 at most. Chosen by hand: gaps leave out segments, so
/// that a record with many of them may have more.
const MOST_POWER: f64 = 1e6;

/// The spectrum of one axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpectrumLevels {
    /// Number of blocks in a segment.
    pub segment: u32,
    /// The levels, shortest blocks first.
    pub levels: Vec<SpectrumLevel>,
}

/// One level of a spectrum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpectrumLevel {
    /// Number of samples in a block, a power of 8.
    pub block: u32,
    /// Number of segments that overlap by half.
    pub segments: u32,
    /// Number of segments that would scatter as much as each bin, where filled gaps make a bin scatter more.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub segments_of_bins: Vec<u32>,
    /// One-sided densities in rate units squared per hertz, from the bin `segment/16` to the bin before `segment/2`.
    pub density: Vec<f64>,
    /// Spectral kurtosis of each bin.
    pub kurtosis: Vec<f64>,
}

impl SpectrumLevel {
    /// Number of segments that would scatter as much as a bin does.
    pub(super) fn segments_of(&self, bin: usize) -> u32 {
        let own = self.segments_of_bins.get(bin);
        own.copied().unwrap_or(self.segments)
    }
}

impl SpectrumLevels {
    /// The levels of a spectrum.
    pub fn of(spectrum: &Spectrum<BINS>) -> Self {
        let levels = spectrum.all().chunk_by(|one, next| one.block == next.block);
        let levels = levels.map(|level| SpectrumLevel {
            block: level.first().map_or(0, |bin| bin.block),
            segments: level.iter().map(|bin| bin.segments).max().unwrap_or(0),
            segments_of_bins: match level {
                [first, rest @ ..] if rest.iter().any(|bin| bin.segments != first.segments) => {
                    level.iter().map(|bin| bin.segments).collect()
                }
                _ => Vec::new(),
            },
            density: level.iter().map(|bin| bin.density).collect(),
            kurtosis: level.iter().map(|bin| bin.spectral_kurtosis).collect(),
        });
        Self {
            segment: spectrum.segment(),
            levels: levels.collect(),
        }
    }

    /// The spectrum of a record with this rate, as the library's type.
    ///
    /// # Errors
    /// When the library refuses a number.
    pub fn spectrum(&self, rate_hz: f64) -> Result<Spectrum<BINS>, allanite::Error> {
        let bins = self.levels.iter().flat_map(|level| {
            let measured = level.density.iter().zip(&level.kurtosis);
            let indices = self.segment / 16..;
            let bins = measured.zip(indices).enumerate();
            bins.map(|(place, ((density, kurtosis), index))| Bin {
                block: level.block,
                index,
                frequency_hz: 0.0,
                density: *density,
                segments: level.segments_of(place),
                spectral_kurtosis: *kurtosis,
            })
        });
        Spectrum::new(rate_hz, self.segment, bins)
    }

    /// Checks the numbers of the levels against each other and against their axis: its samples and rate, and the Allan
    /// variance of an averaging factor.
    pub(super) fn check(
        &self,
        samples: u64,
        rate_hz: f64,
        variance: impl Fn(u32) -> Option<f64>,
    ) -> Result<(), String> {
        let blocks = (0..10).map(|level| 1_u32 << (3 * level));
        let right = self.levels.iter().zip(blocks);
        if self.levels.len() > 10 || right.clone().any(|(level, block)| level.block != block) {
            return Err("spectrum: the blocks of the levels are not 1, 8, 64, …".into());
        }
        for level in &self.levels {
            let here = |what: &str| Err(format!("spectrum, block {}: {what}", level.block));
            let bins = (self.segment / 2 - self.segment / 16) as usize;
            if level.density.len() != bins || level.kurtosis.len() != bins {
                return here("the number of bins is impossible");
            }
            let half = u64::from(level.block) * u64::from(self.segment / 2);
            let most = (samples / half.max(1)).saturating_sub(1);
            if u64::from(level.segments) > most {
                return here("there are more segments than samples for them");
            }
            let least = Spectrum::<BINS>::SPARSE_SEGMENTS;
            if level.segments < least {
                return here("there are too few segments");
            }
            let each = &level.segments_of_bins;
            let is_possible = |&segments: &u32| (least..=level.segments).contains(&segments);
            if !(each.is_empty() || each.len() == bins && each.iter().all(is_possible)) {
                return here("the numbers of segments of the bins are impossible");
            }
            // By Cauchy and Schwarz, n ΣP² is at least (ΣP)² and at most n (ΣP)².
            let most = f64::from(level.segments) + 1.0;
            if level
                .kurtosis
                .iter()
                .any(|&kurtosis| kurtosis > most * (1.0 + TOLERANCE))
            {
                return here("a spectral kurtosis is impossible");
            }
            let Some(variance) = variance(level.block) else {
                return here("there is no octave of this length");
            };
            let bin_hz = rate_hz / (f64::from(level.block) * f64::from(self.segment));
            let power = bin_hz * level.density.iter().sum::<f64>();
            if power > MOST_POWER * variance {
                return here("the densities contradict the octaves");
            }
        }
        let spectrum = self.spectrum(rate_hz);
        spectrum
            .map(|_| ())
            .map_err(|error| format!("spectrum: {error}"))
    }
}
