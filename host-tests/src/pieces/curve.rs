//! The curve of a record that was read in pieces.

use super::{
    Pieces,
    powers::{BINS, UNIT_BITS},
};
use crate::{
    curve_file::{AxisCurve, ShortOctave, SpectrumLevel, SpectrumLevels},
    failure::Failure,
    sizes::{self, LEVELS, OCTAVES, SEGMENT},
    unit::Unit,
};
use allanite::{octave::Bridged, spectrum::Spectrum};

impl Pieces {
    /// The curve and the spectrum of an axis. Its sums are those of an [accumulator](allanite::Accumulator) that takes the
    /// samples one by one, to the bit, if none is missing and the first one has the number 0. Behind a gap, an accumulator
    /// begins to count again, and pieces go on with the numbers of the record.
    ///
    /// # Errors
    /// When there are too few samples, or a sum exceeds 128 bits.
    pub fn curve(&self, axis: &str, unit: Unit) -> Result<AxisCurve, Failure> {
        let fail =
            |what: String, remedy: &str| Failure::option(format!("axis {axis}: {what}"), remedy);
        let raw = (0..OCTAVES).map(|octave| {
            let mut all = ShortOctave {
                m: 1 << octave,
                differences: 0,
                sum: 0,
            };
            for piece in self.pieces() {
                let (differences, sum) = piece.octave(octave);
                all.differences += differences;
                all.sum = all.sum.saturating_add(sum);
            }
            all
        });
        let raw: Vec<ShortOctave> = raw.take_while(|octave| octave.differences > 0).collect();
        if let Some(octave) = raw.iter().find(|octave| octave.sum == u128::MAX) {
            let what = format!("octave m = {}: the sum exceeds 128 bits", octave.m);
            return Err(fail(what, "check the scale and the sensor"));
        }
        let sensor = (self.rate_hz, unit, self.rate_per_count);
        let curve = AxisCurve {
            first_sample: self.stretches().next().map_or(0, |range| range.start),
            gaps: (self.stretches.len() as u64).saturating_sub(1),
            spectrum: self.spectrum(),
            ..AxisCurve::of_sums(axis, (self.samples(), &Bridged::NONE), sensor, &raw)
        };
        curve
            .check()
            .map_err(|what| fail(what, "give more samples"))?;
        Ok(curve)
    }

    /// The same, with the pieces in it, so that it can be rejoined with its neighbours.
    ///
    /// # Errors
    /// As of [`curve`](Self::curve).
    pub fn part(self, axis: &str, unit: Unit) -> Result<AxisCurve, Failure> {
        let curve = self.curve(axis, unit)?;
        Ok(AxisCurve {
            pieces: Some(self),
            ..curve
        })
    }

    /// Whether they are those of a curve that was read with them.
    pub(crate) fn check(&self, curve: &AxisCurve) -> Result<(), String> {
        let own = match self.is_possible() {
            true => self.curve(&curve.axis, curve.unit).ok(),
            false => None,
        };
        let without = AxisCurve {
            pieces: None,
            source: None,
            licence: None,
            ..curve.clone()
        };
        match own {
            Some(own) if own == without => Ok(()),
            _ => Err("the pieces contradict the curve".into()),
        }
    }

    /// The levels of the spectrum that have enough segments.
    fn spectrum(&self) -> Option<SpectrumLevels> {
        let levels = (0..LEVELS).map_while(|level| self.level(level));
        let levels: Vec<SpectrumLevel> = levels.collect();
        (!levels.is_empty()).then_some(SpectrumLevels {
            segment: SEGMENT as u32,
            levels,
        })
    }

    fn level(&self, level: usize) -> Option<SpectrumLevel> {
        let mut segments = 0_u64;
        let mut powers = super::powers::Powers::default();
        for piece in self.pieces() {
            let (own, sums) = piece.level(level);
            segments += own;
            powers.join(sums);
        }
        if segments < u64::from(Spectrum::<{ sizes::BINS }>::SPARSE_SEGMENTS) {
            return None;
        }
        let block = 1_u32 << (3 * level);
        let n = segments as f64;
        // As of the accumulator: with the window's weights, Σ w² = 3P/8.
        let unit = self.rate_per_count * f64::from(1_u32 << UNIT_BITS);
        let weights = 0.375 * SEGMENT as f64;
        let per_power = 2.0 * f64::from(block) / (self.rate_hz * weights);
        let (mut density, mut kurtosis) = (Vec::with_capacity(BINS), Vec::with_capacity(BINS));
        for [power, square] in powers.sums() {
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
}
