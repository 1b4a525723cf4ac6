//! The judgement of a record.

use crate::{OCTAVES, Verdict};
use allanite::{
    Accumulator, Curve, Error,
    ieee_952::{self, Checked, Fit, Limits},
    sensor::LSM6DSO,
};

/// The largest coefficients that pass: quantization, angle random walk in °/s/√Hz, bias instability in °/s, rate random walk
/// and rate ramp. Write those of your product here. An infinite limit asks for nothing.
const LIMITS: [f32; ieee_952::TERMS] = [f32::INFINITY, 0.0054, 0.005, f32::INFINITY, f32::INFINITY];

/// The differences that an octave needs to be fitted.
const LEAST: u64 = Curve::<OCTAVES>::MIN_DIFFERENCES;

/// Holds a record to the limits.
// The curve stays where it is while the fit reads it: each function hands a result on by reference, which saves half a
// kilobyte of stack.
#[inline(never)]
pub fn judge(gyro: &Accumulator<OCTAVES>) -> Verdict {
    match &curve(gyro) {
        Ok(curve) => judge_curve(curve),
        Err(_) => Verdict::NoFit,
    }
}

/// The Allan curve of a record in which no gap was filled. [`Accumulator::curve`] could take off what filled gaps change as
/// well, which takes 2.5 KB of flash.
#[inline(never)]
fn curve(gyro: &Accumulator<OCTAVES>) -> Result<Curve<OCTAVES>, Error> {
    let octaves = gyro.octaves().filter(|octave| octave.differences >= LEAST);
    let octaves = octaves.map(|octave| {
        // σ² = ½ mean (D/m)², in °²/s².
        let scale = LSM6DSO.scale_dps / octave.m as f32;
        let mean_square = octave.sum.to_real() / octave.differences as f32;
        let variance = 0.5 * mean_square * scale * scale;
        (octave.m, octave.differences, variance)
    });
    Curve::new(LSM6DSO.rate_hz, octaves)
}

#[inline(never)]
fn judge_curve(curve: &Curve<OCTAVES>) -> Verdict {
    match &ieee_952::fit(curve) {
        Ok(fit) => compare(fit),
        Err(_) => Verdict::NoFit,
    }
}

fn compare(fit: &Fit) -> Verdict {
    let name = |place: usize| fit.coefficients.get(place).map_or("", |found| found.name);
    match (Limits { most: LIMITS }).check(fit) {
        Checked::Pass => Verdict::Pass,
        Checked::Fail { place } => Verdict::Fail(name(place)),
        Checked::GuardBand { place } => Verdict::Undecided(name(place)),
        Checked::Misfit => Verdict::Misfit,
    }
}
