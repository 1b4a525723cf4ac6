//! Fit and diagnosis of any curve and spectrum: they end after a bounded number of steps, with finite numbers or
//! an error.

use allanite::{
    Curve, Model, Record,
    diagnosis::{Diagnosis, Options, Step},
    effect::CATALOGUE,
    spectrum::{Bin, Spectrum},
};
use std::ops::ControlFlow;

pub(crate) const OCTAVES: usize = 12;
pub(crate) const BINS: usize = 140;
/// The number of blocks of a segment.
const SEGMENT: u32 = 64;

/// The most pieces of work. A diagnosis of a record takes some thousands.
const MOST_PIECES: u32 = 200_000;

/// Diagnoses what the bytes encode.
pub fn check(bytes: &[u8]) {
    let Some((curve, spectrum)) = measured(bytes) else {
        return;
    };
    let model = Model::ieee_952();
    let (record, options) = (Record::new(&curve, &spectrum), Options::default());
    let mut diagnosis = Diagnosis::new(record, &model, &CATALOGUE, options);
    let mut pieces = 0;
    let mut pause = || {
        pieces += 1;
        if pieces < MOST_PIECES {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    };
    let report = |step: &Step<OCTAVES, BINS>| {
        let fit = &step.fit;
        assert!(fit.chi_squared.is_finite() && fit.chi_squared >= 0.0);
        let is_known = (0.0..=1.0).contains(&fit.p_value);
        // Without a degree of freedom there is no p-value.
        let has_none = fit.degrees_of_freedom == 0 && fit.p_value.is_nan();
        assert!(is_known || has_none, "p {}", fit.p_value);
    };
    let verdict = diagnosis.run(report, &mut pause);
    assert_ne!(
        verdict,
        Ok(None),
        "not finished after {MOST_PIECES} pieces of work"
    );
}

/// The curve and the spectrum that the bytes encode: the rate, the octaves of three bytes, then the bins of two bytes.
pub(crate) fn measured(bytes: &[u8]) -> Option<(Curve<OCTAVES>, Spectrum<BINS>)> {
    let (&[rate, many, small], rest) = bytes.split_first_chunk()?;
    let rate_hz = 10_f64.powf(f64::from(rate as i8) / 14.0);
    let level = 10_f64.powf(f64::from(small as i8) / 8.0);
    let octaves = usize::from(many) % (OCTAVES + 1);
    let (octaves, bins) = rest.split_at(rest.len().min(3 * octaves));
    let samples = 2_u64 << (octaves.len() / 3);
    let octaves = (0..).zip(octaves.chunks_exact(3)).map(|(k, three)| {
        let size = f64::from(i16::from_le_bytes([three[0], three[1]]));
        let differences = 1 + (samples >> k) * u64::from(three[2]);
        (1 << k, differences, variance(size, level))
    });
    let curve = Curve::<OCTAVES>::new(rate_hz, octaves).ok()?;
    let bins = (4..).zip(bins.chunks_exact(2)).map(|(index, two)| Bin {
        block: 1,
        index,
        frequency_hz: 0.0,
        density: variance(f64::from(two[0] as i8) * 256.0, level / rate_hz),
        // The levels with fewer than 16 segments are sparse.
        segments: 3 + u32::from(two[1]),
        spectral_kurtosis: f64::from(two[1]) / 64.0,
    });
    let spectrum = Spectrum::<BINS>::new(rate_hz, SEGMENT, bins).unwrap_or(Spectrum::EMPTY);
    Some((curve, spectrum))
}

/// A variance over eight decades about the level; 0 for the least number.
fn variance(size: f64, level: f64) -> f64 {
    if size <= f64::from(i16::MIN) {
        return 0.0;
    }
    level * 10_f64.powf(size / 8192.0)
}
