//! Curves of parts of a record, merged as if a gap lay between the parts.

use super::{AxisCurve, ShortOctave, SpectrumLevel, SpectrumLevels};
use allanite::octave::{Bridged, OctaveSum};
use std::collections::BTreeMap;

/// Differences and the sum of their squares, by averaging factor.
type Sums = BTreeMap<u32, (u64, u128)>;

impl AxisCurve {
    /// The curve of all these parts of the record of one axis. Parts that all have [pieces](AxisCurve::pieces) become the record
    /// that they are parts of, and lose nothing between neighbours. Others are merged as if a gap lay between them. The sums are integers, so that they are those of one
    /// record with gaps between its parts, to the bit, in whatever order and in whatever groups the parts are merged.
    /// The densities are weighted by their segments, in the order of the parts' numbers, so that the order of the
    /// arguments changes no bit of them; merging in groups may change the last one.
    ///
    /// # Errors
    /// When the parts differ in rate, unit, scale or the noise of a sample, or a sum exceeds its range, with the number of the part.
    pub fn merged(parts: &[Self]) -> Result<Self, (usize, String)> {
        let Some(first) = parts.first() else {
            return Err((0, "there is nothing to merge".into()));
        };
        for (i, part) in parts.iter().enumerate() {
            first.agrees_with(part).map_err(|what| (i, what))?;
        }
        if parts.iter().all(|part| part.pieces.is_some()) {
            return rejoined(parts);
        }
        // A sum in a finer unit has larger numbers. A quantum is a power of two, so that the ratio is one too.
        let finest = parts.iter().map(|part| part.rate_per_count);
        let finest = finest.fold(f64::INFINITY, f64::min);
        let mut sums = Sums::new();
        let mut bridged = Bridged::NONE;
        let (mut samples, mut gaps) = (0_u64, parts.len() as u64 - 1);
        for (i, part) in parts.iter().enumerate() {
            let too_large = || (i, "the sums of all parts exceed 128 bits".to_owned());
            let ratio = part.rate_per_count / finest;
            if ratio.log2().fract() != 0.0 || ratio > 2f64.powi(30) {
                let what = format!(
                    "rate_per_count {} is not {finest} times a power of two",
                    part.rate_per_count
                );
                return Err((i, what));
            }
            let factor = (ratio * ratio) as u128;
            let long = part.octaves.iter();
            let long = long.map(|octave| (octave.m, octave.differences, octave.sum));
            let short = part.short.iter();
            let short = short.map(|octave| (octave.m, octave.differences, octave.sum));
            for (m, differences, sum) in long.chain(short) {
                let scaled = sum.checked_mul(factor).ok_or_else(too_large)?;
                let all = sums.entry(m).or_default();
                all.0 = all.0.saturating_add(differences);
                all.1 = all.1.checked_add(scaled).ok_or_else(too_large)?;
            }
            bridged.merge(&part.bridged);
            samples = samples.saturating_add(part.samples);
            gaps = gaps.saturating_add(part.gaps);
        }
        let sums: Vec<ShortOctave> = sums
            .into_iter()
            .map(|(m, (differences, sum))| ShortOctave {
                m,
                differences,
                sum,
            })
            .collect();
        let sensor = (first.rate_hz, first.unit, finest);
        Ok(Self {
            gaps,
            source: joined(parts.iter().map(|part| &part.source)),
            licence: joined(parts.iter().map(|part| &part.licence)),
            invalid: parts.iter().find_map(|part| part.invalid),
            mean_rate: mean_rate(parts),
            spectrum: spectrum(parts),
            course: match parts {
                [only] => only.course.clone(),
                // The time between two parts is not known.
                _ => None,
            },
            ..Self::of_sums(&first.axis, (samples, &bridged), sensor, &sums)
        })
    }

    fn agrees_with(&self, other: &Self) -> Result<(), String> {
        if other.rate_hz != self.rate_hz {
            return Err(format!(
                "the rate is {} Hz, and that of the first file {} Hz",
                other.rate_hz, self.rate_hz
            ));
        }
        if other.unit != self.unit {
            return Err(format!(
                "the unit is {}, and that of the first file {}",
                other.unit, self.unit
            ));
        }
        let finest = self.rate_per_count.min(other.rate_per_count);
        let [ours, theirs] = [self, other].map(|part| part.first(finest));
        if let (Some(ours), Some(theirs)) = (ours, theirs)
            && !ours.is_like(&theirs)
        {
            let variance = |octave: &OctaveSum| {
                let sum = octave.sum.to_u128().unwrap_or(0) as f64;
                sum / octave.differences as f64
            };
            return Err(format!(
                "the noise of a sample is {:.2} times that of the first file, as of another sensor, range or filter",
                (variance(&theirs) / variance(&ours)).sqrt()
            ));
        }
        Ok(())
    }
}

impl AxisCurve {
    /// The shortest octave, with its sum in counts of this size, which is that of this part or finer.
    fn first(&self, rate_per_count: f64) -> Option<OctaveSum> {
        let octave = self.octaves.first().filter(|octave| octave.m == 1)?;
        let ratio = self.rate_per_count / rate_per_count;
        Some(OctaveSum {
            m: 1,
            differences: octave.differences,
            sum: octave.sum.checked_mul((ratio * ratio) as u128)?.into(),
        })
    }
}

/// The mean rate of all parts, if each has one.
fn mean_rate(parts: &[AxisCurve]) -> Option<f64> {
    let of = |part: &AxisCurve| Some((part.mean_rate? * part.samples as f64, part.samples as f64));
    let all: Option<Vec<(f64, f64)>> = parts.iter().map(of).collect();
    let mut all = all?;
    // The order of the parts changes no bit.
    all.sort_by(|one, other| one.0.total_cmp(&other.0));
    let (sums, samples): (Vec<f64>, Vec<f64>) = all.into_iter().unzip();
    Some(sums.iter().sum::<f64>() / samples.iter().sum::<f64>()).filter(|mean| mean.is_finite())
}

/// The curve of parts that know where they lie in one record.
fn rejoined(parts: &[AxisCurve]) -> Result<AxisCurve, (usize, String)> {
    let numbered = parts.iter().enumerate();
    let mut pieces = numbered.filter_map(|(i, part)| Some((i, part.pieces.clone()?)));
    let Some(((_, mut all), first)) = pieces.next().zip(parts.first()) else {
        return Err((0, "there is nothing to merge".into()));
    };
    for (i, part) in pieces {
        all.merge(part).map_err(|failure| (i, failure.found()))?;
    }
    let curve = AxisCurve::part(all, &first.axis, first.unit);
    Ok(AxisCurve {
        source: joined(parts.iter().map(|part| &part.source)),
        licence: joined(parts.iter().map(|part| &part.licence)),
        ..curve.map_err(|failure| (0, failure.found()))?
    })
}

/// The different texts, in alphabetical order.
fn joined<'a>(texts: impl Iterator<Item = &'a Option<String>>) -> Option<String> {
    let mut texts: Vec<&str> = texts.flatten().map(String::as_str).collect();
    texts.sort_unstable();
    texts.dedup();
    (!texts.is_empty()).then(|| texts.join("; "))
}

/// The spectrum of all parts, of the levels that any of them has.
fn spectrum(parts: &[AxisCurve]) -> Option<SpectrumLevels> {
    let spectra = parts.iter().filter_map(|part| part.spectrum.as_ref());
    let segment = spectra.clone().map(|spectrum| spectrum.segment).max()?;
    let mut blocks: BTreeMap<u32, Vec<&SpectrumLevel>> = BTreeMap::new();
    for spectrum in spectra.filter(|spectrum| spectrum.segment == segment) {
        for level in &spectrum.levels {
            blocks.entry(level.block).or_default().push(level);
        }
    }
    let levels = blocks.into_values().map(|mut levels| {
        // Sums of floats depend on their order.
        levels.sort_by(|one, other| {
            let numbers = |level: &SpectrumLevel| level.density.clone();
            let by_density = || numbers(one).partial_cmp(&numbers(other));
            let by_segments = one.segments.cmp(&other.segments);
            by_segments.then_with(|| by_density().unwrap_or(std::cmp::Ordering::Equal))
        });
        level(&levels)
    });
    Some(SpectrumLevels {
        segment,
        levels: levels.collect(),
    })
}

/// The level of all parts. A density is the mean power of the segments. The kurtosis of `n` segments is
/// `(n+1)/(n−1) (n ΣP²/(ΣP)² − 1)`, from which the sum of squares follows.
fn level(parts: &[&SpectrumLevel]) -> SpectrumLevel {
    let bins = parts.first().map_or(0, |level| level.density.len());
    let weights = || parts.iter().map(|level| f64::from(level.segments));
    let all: f64 = weights().sum();
    let mean = |k: usize, power: &dyn Fn(&SpectrumLevel, usize) -> f64| {
        let sum: f64 = weights()
            .zip(parts)
            .map(|(weight, level)| weight * power(level, k))
            .sum();
        sum / all
    };
    let density: Vec<f64> = (0..bins)
        .map(|k| mean(k, &|level, k| level.density[k]))
        .collect();
    // The ratio of n + 1 to n − 1.
    let slight = |n: f64| (n + 1.0) / (n - 1.0);
    let kurtosis = density.iter().enumerate().map(|(k, density)| {
        let square = mean(k, &|level, k| {
            let ratio = 1.0 + level.kurtosis[k] / slight(f64::from(level.segments));
            ratio * level.density[k].powi(2)
        });
        if *density > 0.0 {
            (slight(all) * (square / (density * density) - 1.0)).max(0.0)
        } else {
            1.0
        }
    });
    let segments_of = |k: usize| {
        let each = parts.iter().map(|level| level.segments_of(k));
        each.fold(0, u32::saturating_add)
    };
    let is_filled = parts.iter().any(|level| !level.segments_of_bins.is_empty());
    SpectrumLevel {
        segments_of_bins: (0..bins).filter(|_| is_filled).map(segments_of).collect(),
        block: parts.first().map_or(0, |level| level.block),
        segments: parts
            .iter()
            .fold(0_u32, |sum, level| sum.saturating_add(level.segments)),
        kurtosis: kurtosis.collect(),
        density,
    }
}
