//! The spectrum against scipy 1.17.1: `scipy.signal.welch(y, fs=100/M, window="hann", nperseg=64, noverlap=32,
//! detrend=False, scaling="density")`, where `y` are means over `M` of the 65 536 integers of
//! [`counts`](super::counts).

use super::counts;
use crate::{
    Scale,
    numerics::real::{by_precision, double},
    spectrum::{Spectrum, SpectrumAccumulator},
};

/// The number of samples in a block, the bin, its frequency in Hz and its density.
const TABLE: [(u32, u32, f64, f64); 21] = [
    (1, 4, 6.25, 419.8314517633656),
    (1, 5, 7.8125, 412.8404904576374),
    (1, 9, 14.0625, 350.30008036169323),
    (1, 16, 25.0, 216.61730464796202),
    (1, 23, 35.9375, 79.61854086945088),
    (1, 30, 46.875, 4.546364807749249),
    (1, 31, 48.4375, 1.364565000116496),
    (8, 4, 0.78125, 419.04809433385094),
    (8, 5, 0.9765625, 405.8839764798003),
    (8, 9, 1.7578125, 424.9833448398924),
    (8, 16, 3.125, 430.7228934488475),
    (8, 23, 4.4921875, 425.5935633847891),
    (8, 30, 5.859375, 332.01246393304274),
    (8, 31, 6.0546875, 360.16475341630854),
    (64, 4, 0.09765625, 1222.2821035937893),
    (64, 5, 0.1220703125, 886.620702848548),
    (64, 9, 0.2197265625, 592.9807297948947),
    (64, 16, 0.390625, 513.8195592437692),
    (64, 23, 0.5615234375, 424.8732217890299),
    (64, 30, 0.732421875, 333.1291612951304),
    (64, 31, 0.7568359375, 525.4894448172056),
];

#[test]
fn densities_are_those_of_scipy() {
    let mut accumulator = SpectrumAccumulator::<64, 4>::new();
    accumulator.push_slice(&counts(65_536));
    let scale = Scale::new(1.0, 100.0).expect("valid");
    let spectrum: Spectrum<112> = accumulator.spectrum(scale);
    assert_eq!(spectrum.bins().len(), 3 * 28);
    for (block, index, frequency_hz, density) in TABLE {
        let mut bins = spectrum.bins().iter();
        let bin = bins.find(|bin| (bin.block, bin.index) == (block, index));
        let bin = bin.expect("the bin is there");
        assert_eq!(double(bin.frequency_hz), frequency_hz);
        // The sums are in single precision even where the result is not.
        let off = double(bin.density) / density - 1.0;
        let most = double(by_precision(1e-5, 1e-5));
        assert!(off.abs() < most, "{block}, {index}: off by {off:e}");
    }
}
