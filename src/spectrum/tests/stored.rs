//! Spectra from stored numbers, and how their bins scatter together.

use super::std::vec::Vec;
use crate::{
    Error,
    numerics::real::{Real, real},
    spectrum::{BAND, Bin, Spectrum, covariance_rows, relative_covariance},
};

const BIN: Bin = Bin {
    block: 1,
    index: 4,
    frequency_hz: 0.0,
    density: 1.0,
    segments: 100,
    spectral_kurtosis: 1.0,
};

#[test]
fn a_spectrum_is_made_from_stored_bins() {
    let bins = [BIN, Bin { index: 31, ..BIN }, Bin { block: 8, ..BIN }];
    let spectrum = Spectrum::<3>::new(100.0, 64, bins).expect("possible");
    let frequencies: Vec<Real> = spectrum.bins().iter().map(|bin| bin.frequency_hz).collect();
    assert_eq!(frequencies, [6.25, 48.4375, 0.781_25]);
    assert_eq!((spectrum.rate_hz(), spectrum.segment()), (100.0, 64));
    let levels: Vec<usize> = spectrum.levels().map(<[Bin]>::len).collect();
    assert_eq!(levels, [2, 1]);
}

#[test]
fn impossible_bins_are_refused() {
    let of = |bin: Bin| Spectrum::<3>::new(100.0, 64, [BIN, bin]);
    let next = Bin { index: 5, ..BIN };
    assert!(of(next).is_ok());
    for bin in [
        BIN,
        Bin { index: 3, ..next },
        Bin { index: 32, ..next },
        Bin { block: 0, ..next },
        Bin { block: 2, ..next },
        Bin {
            block: 1 << 30,
            ..next
        },
        Bin {
            segments: 0,
            ..next
        },
        Bin {
            density: -1.0,
            ..next
        },
        Bin {
            density: Real::NAN,
            ..next
        },
        Bin {
            density: Real::INFINITY,
            ..next
        },
        Bin {
            spectral_kurtosis: -1.0,
            ..next
        },
        Bin {
            spectral_kurtosis: Real::NAN,
            ..next
        },
    ] {
        let Bin { block, index, .. } = bin;
        assert_eq!(of(bin), Err(Error::InvalidBin { block, index }), "{bin:?}");
    }
    for length in [0, 16, 48, 512] {
        let found = Spectrum::<3>::new(100.0, length, [BIN]);
        assert_eq!(found, Err(Error::InvalidSegment { length }));
    }
    let found = Spectrum::<3>::new(0.0, 64, [BIN]);
    assert_eq!(found, Err(Error::InvalidRate(0.0)));
    let found = Spectrum::<1>::new(100.0, 64, [BIN, next]);
    assert_eq!(found, Err(Error::TooManyBins { capacity: 1 }));
}

#[test]
fn bins_scatter_with_their_neighbours() {
    let bins = [4, 5, 7].map(|index| Bin { index, ..BIN });
    let bins = [bins[0], bins[1], bins[2], Bin { block: 8, ..BIN }];
    let rows: Vec<[Real; BAND]> = covariance_rows(&bins, &[]).collect();
    let n = 100.0 * 18.0 / 19.0;
    let expected = [
        [1.0, 0.458_974, 0.0],
        [1.0, 0.039_473_7, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
    ];
    for (row, expected) in rows.iter().zip(expected) {
        for (found, expected) in row.iter().zip(expected) {
            assert!((found * n - expected).abs() < 1e-5, "{rows:?}");
        }
    }
    assert_eq!(rows.len(), 4);
}

#[test]
fn a_line_alone_does_not_scatter() {
    // (c + g)² − g² relative to (c + g)².
    for share in [0.0, 0.25, 0.9, 1.0] {
        let found = relative_covariance(0, 10.0, [share, share]);
        assert!((10.0 * found - (1.0 - share * share)).abs() < 1e-6);
    }
}

/// A factor of the banded matrix exists for shares that change from bin to bin.
#[test]
fn the_covariance_is_positive_definite() {
    let bins: Vec<Bin> = (4..32).map(|index| Bin { index, ..BIN }).collect();
    for seed in 0..200 {
        let mut random = crate::numerics::test_random::Random::new(seed);
        let share = |_: &Bin| match random.below(3) {
            0 => 0.0,
            1 => real(0.999),
            _ => real(0.5 + 0.499 * random.signed()),
        };
        let shares: Vec<Real> = bins.iter().map(share).collect();
        // A Cholesky factor in the band, row by row.
        let mut left = [[0.0_f64; BAND]; 2];
        for row in covariance_rows(&bins, &shares) {
            let [mut own, mut next, after] = row.map(f64::from);
            own -= left[0][1] * left[0][1] + left[1][2] * left[1][2];
            next -= left[0][1] * left[0][2];
            assert!(own > 0.0, "{seed}: {own:e}");
            let root = libm::sqrt(own);
            left = [[root, next / root, after / root], left[0]];
        }
    }
}
