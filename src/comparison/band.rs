//! The bands of a spectrum in which a model fails.

use super::{ComparedBin, Comparison};
use crate::{
    list,
    numerics::{
        math,
        real::{Real, real},
    },
};
use heapless::Vec;

/// The largest number of bands that are reported.
pub const MAX_BANDS: usize = 3;

/// The smallest significance of a reported band, in standard errors. Chosen by hand: about one in a million bands of a true model.
const NOTICEABLE_BAND: Real = 5.0;

/// The fewest standard errors of each of its bins. By convention: a bin of a true model exceeds it with a probability
/// of 5 %.
const NOTICEABLE_BIN: Real = 2.0;

/// Neighbouring bins of a spectrum that all lie on one side of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Band {
    /// Frequency of the lowest bin, in hertz.
    pub from_hz: Real,
    /// Frequency of the highest bin, in hertz.
    pub to_hz: Real,
    /// How far the band lies above the model, in standard errors: the sum of the bins' `z` over the root of their
    /// number.
    pub z: Real,
}

impl<const K: usize, const B: usize> Comparison<K, B> {
    /// The bands in which the spectrum differs from the model by five standard errors or more, those that differ most
    /// first. A band ends where a bin differs by less than two standard errors. Empty without a spectrum.
    pub fn bands(&self) -> Vec<Band, MAX_BANDS> {
        let mut bands = Vec::new();
        // The bins of the longest blocks have the lowest frequencies.
        let levels = self
            .bins
            .chunk_by(|one, other| one.bin.block == other.bin.block);
        let bins = levels.rev().flatten();
        let mut run: Option<Run> = None;
        for bin in bins {
            match &mut run {
                Some(run) if run.side == side(bin) => run.add(bin),
                _ => {
                    let ended = run.replace(Run::of(bin));
                    keep(&mut bands, ended);
                }
            }
        }
        keep(&mut bands, run);
        bands
    }
}

/// Bins on one side of the model.
struct Run {
    side: i8,
    from_hz: Real,
    to_hz: Real,
    sum: Real,
    bins: u32,
}

impl Run {
    fn of(bin: &ComparedBin) -> Self {
        Self {
            side: side(bin),
            from_hz: bin.bin.frequency_hz,
            to_hz: bin.bin.frequency_hz,
            sum: bin.z,
            bins: 1,
        }
    }

    fn add(&mut self, bin: &ComparedBin) {
        self.to_hz = bin.bin.frequency_hz;
        self.sum += bin.z;
        self.bins = self.bins.saturating_add(1);
    }
}

/// The side of the model on which a bin lies: 1 above, −1 below, 0 where it hardly differs.
fn side(bin: &ComparedBin) -> i8 {
    if bin.z > NOTICEABLE_BIN {
        1
    } else if bin.z < -NOTICEABLE_BIN {
        -1
    } else {
        0
    }
}

/// Keeps a run that has ended if it is noticeable, and lies among those that differ most.
fn keep(bands: &mut Vec<Band, MAX_BANDS>, ended: Option<Run>) {
    let Some(run) = ended.filter(|run| run.side != 0) else {
        return;
    };
    let band = Band {
        from_hz: run.from_hz,
        to_hz: run.to_hz,
        z: run.sum / math::sqrt(real(run.bins)),
    };
    if size(&band) >= NOTICEABLE_BAND {
        list::rank(bands, band, |other| size(other) < size(&band));
    }
}

fn size(band: &Band) -> Real {
    if band.z < 0.0 { -band.z } else { band.z }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::Bin;

    /// A comparison whose bins differ by these standard errors, of blocks of 1 and of 8 samples.
    fn comparison(short: &[Real], long: &[Real]) -> Comparison<1, 16> {
        let mut comparison = Comparison::EMPTY;
        for (block, spacing, sides) in [(1, 8.0, short), (8, 1.0, long)] {
            for (i, &z) in (1_u8..).zip(sides) {
                let bin = Bin {
                    block,
                    index: u32::from(i),
                    frequency_hz: spacing * Real::from(i),
                    density: 1.0,
                    segments: 100,
                    spectral_kurtosis: 1.0,
                };
                let compared = ComparedBin { bin, model: 1.0, z };
                comparison.bins.push(compared).expect("room");
            }
        }
        comparison
    }

    #[test]
    fn bands_join_bins_on_one_side_across_levels() {
        // The levels meet at 4 and 8 Hz.
        let found = comparison(&[3.0, 4.0, 1.0, -6.0], &[0.5, -9.0, 2.5, 4.0]).bands();
        let band = |from_hz, to_hz, z| Band { from_hz, to_hz, z };
        assert_eq!(
            found,
            [
                band(2.0, 2.0, -9.0),
                band(3.0, 16.0, 6.75),
                band(32.0, 32.0, -6.0)
            ]
        );
    }

    #[test]
    fn bands_that_hardly_differ_and_those_beyond_the_first_three_are_left_out() {
        let found = comparison(&[3.0, 1.9, 4.0], &[]).bands();
        assert!(found.is_empty(), "{found:?}");
        let found = comparison(&[6.0, -7.0, 8.0, -9.0, 10.0], &[]).bands();
        let sizes = [found[0].z, found[1].z, found[2].z];
        assert_eq!((found.len(), sizes), (3, [10.0, -9.0, 8.0]));
        assert!(comparison(&[], &[]).bands().is_empty());
    }
}
