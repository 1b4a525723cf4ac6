//! The curve of a record that was read in pieces.

use super::{AxisCurve, ShortOctave, SpectrumLevel, SpectrumLevels};
use allanite::{octave::Bridged, spectrum::Spectrum};
use allanite_log::{
    failure::{Failure, Place},
    pieces::{Pieces, UNIT_BITS},
    sizes::{self, LEVELS, OCTAVES, SEGMENT},
    unit::Unit,
};

impl AxisCurve {
    /// The curve and the spectrum of an axis. Its sums are those of an [accumulator](allanite::Accumulator) that takes the
    /// samples one by one, to the bit, if none is missing and the first one has the number 0. Behind a gap, an accumulator
    /// begins to count again, and pieces go on with the numbers of the record.
    ///
    /// # Errors
    /// When there are too few samples, or a sum exceeds 128 bits.
    pub fn of_pieces(pieces: &Pieces, axis: &str, unit: Unit) -> Result<Self, Failure> {
        let fail = |what: String, remedy: &str| Place::default().axis_failure(axis, what, remedy);
        let raw = (0..OCTAVES).map(|octave| {
            let (differences, sum) = pieces.octave(octave);
            ShortOctave {
                m: 1 << octave,
                differences,
                sum,
            }
        });
        let raw: Vec<ShortOctave> = raw.take_while(|octave| octave.differences > 0).collect();
        if let Some(octave) = raw.iter().find(|octave| octave.sum == u128::MAX) {
            let what = format!("octave m = {}: the sum exceeds 128 bits", octave.m);
            return Err(fail(what, "check the scale and the sensor"));
        }
        let sensor = (pieces.rate_hz(), unit, pieces.rate_per_count());
        let curve = Self {
            first_sample: pieces.stretches().next().map_or(0, |range| range.start),
            gaps: (pieces.stretches().count() as u64).saturating_sub(1),
            spectrum: spectrum(pieces),
            ..Self::of_sums(axis, (pieces.samples(), &Bridged::NONE), sensor, &raw)
        };
        curve
            .check()
            .map_err(|what| fail(what, "give more samples"))?;
        Ok(curve)
    }

    /// The same, with the pieces in it, so that it can be rejoined with its neighbours.
    ///
    /// # Errors
    /// As of [`of_pieces`](Self::of_pieces).
    pub fn part(pieces: Pieces, axis: &str, unit: Unit) -> Result<Self, Failure> {
        let curve = Self::of_pieces(&pieces, axis, unit)?;
        Ok(Self {
            pieces: Some(pieces),
            ..curve
        })
    }

    /// Whether it is the curve of these pieces.
    pub(super) fn check_pieces(&self, pieces: &Pieces) -> Result<(), String> {
        let own = match pieces.is_possible() {
            true => Self::of_pieces(pieces, &self.axis, self.unit).ok(),
            false => None,
        };
        let without = Self {
            pieces: None,
            invalid: None,
            mean_rate: None,
            source: None,
            licence: None,
            ..self.clone()
        };
        match own {
            Some(own) if own == without => Ok(()),
            _ => Err("the pieces contradict the curve".into()),
        }
    }
}

/// The levels of the spectrum that have enough segments.
fn spectrum(pieces: &Pieces) -> Option<SpectrumLevels> {
    let levels = (0..LEVELS).map_while(|at| level(pieces, at));
    let levels: Vec<SpectrumLevel> = levels.collect();
    (!levels.is_empty()).then_some(SpectrumLevels {
        segment: SEGMENT as u32,
        levels,
    })
}

fn level(pieces: &Pieces, level: usize) -> Option<SpectrumLevel> {
    let (segments, sums) = pieces.level(level);
    if segments < u64::from(Spectrum::<{ sizes::BINS }>::SPARSE_SEGMENTS) {
        return None;
    }
    let block = 1_u32 << (3 * level);
    let n = segments as f64;
    // As of the accumulator: with the window's weights, Σ w² = 3P/8.
    let unit = pieces.rate_per_count() * f64::from(1_u32 << UNIT_BITS);
    let weights = 0.375 * SEGMENT as f64;
    let per_power = 2.0 * f64::from(block) / (pieces.rate_hz() * weights);
    let (mut density, mut kurtosis) = (
        Vec::with_capacity(sums.len()),
        Vec::with_capacity(sums.len()),
    );
    for [power, square] in sums {
        let mean = power / n;
        density.push(per_power * (mean * unit) * unit);
        // Nita & Gary 2010, PASP 122, 595, eq. 8.
        let ratio = square / n / mean / mean;
        kurtosis.push(match mean > 0.0 {
            true => ((n + 1.0) / (n - 1.0) * (ratio - 1.0)).max(0.0),
            false => 1.0,
        });
    }
    Some(SpectrumLevel {
        block,
        segments: u32::try_from(segments).unwrap_or(u32::MAX),
        segments_of_bins: Vec::new(),
        density,
        kurtosis,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use allanite::{Accumulator, Scale};
    use allanite_log::SpectrumSums;
    use rand::{RngExt as _, SeedableRng as _};
    use rand_xoshiro::Xoshiro256PlusPlus as Random;

    #[test]
    fn a_whole_record_has_the_sums_of_the_accumulator_and_its_spectrum() {
        let mut random = Random::seed_from_u64(2);
        for samples in [100, 5000, 300_000] {
            let mut count = || random.random_range(-2000..=2000) + 700;
            let counts: Vec<i32> = (0..samples).map(|_| count()).collect();
            let mut whole = Pieces::new(100.0, 0.01).unwrap();
            whole.push(0, &counts).unwrap();
            let curve = AxisCurve::of_pieces(&whole, "gx", Unit::DegreesPerSecond).unwrap();
            let mut accumulator = Accumulator::<OCTAVES>::new();
            accumulator.push_slice(&counts);
            let octaves = curve
                .octaves
                .iter()
                .map(|octave| (octave.differences, octave.sum));
            let octaves = octaves.chain(
                curve
                    .short
                    .iter()
                    .map(|short| (short.differences, short.sum)),
            );
            let expected = accumulator
                .octaves()
                .filter(|octave| octave.differences > 0);
            let expected =
                expected.map(|octave| (octave.differences, octave.sum.to_u128().unwrap()));
            assert!(octaves.eq(expected));

            let mut spectrum = SpectrumSums::new();
            spectrum.push_slice(&counts);
            let scale = Scale::new(0.01, 100.0).unwrap();
            let spectrum = spectrum.spectrum::<{ allanite_log::BINS }>(scale);
            let found = curve.spectrum().unwrap();
            assert_eq!(
                found.segment(),
                if samples < 200 { 0 } else { SEGMENT as u32 }
            );
            assert_eq!(found.all().len(), spectrum.all().len());
            for (own, other) in found.all().iter().zip(spectrum.all()) {
                assert_eq!(
                    (own.block, own.index, own.segments),
                    (other.block, other.index, other.segments)
                );
                // The accumulator sums in single precision.
                let off = own.density / other.density - 1.0;
                assert!(off.abs() < 1e-5, "{own:?} {other:?}");
                let off = own.spectral_kurtosis - other.spectral_kurtosis;
                assert!(off.abs() < 1e-4, "{own:?} {other:?}");
            }
        }
    }
}
