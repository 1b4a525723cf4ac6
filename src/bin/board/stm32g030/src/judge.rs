//! The judgement of a record.

use crate::{OCTAVES, Verdict};
use allanite::{
    Accumulator, Curve, Error,
    ieee_952::{self, Fit},
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

/// Does what [`ieee_952::Limits`] does. But the fit has widened its intervals if the five terms do not explain the curve, and
/// to ask for that instead of a p-value saves 1.2 KB of flash.
fn compare(fit: &Fit) -> Verdict {
    if fit.birge_ratio > 1.0 {
        return Verdict::Misfit;
    }
    let mut verdict = Verdict::Pass;
    for (found, limit) in fit.coefficients.iter().zip(LIMITS) {
        if found.lower > limit {
            return Verdict::Fail(found.name);
        }
        let is_kept = found.upper <= limit;
        if !is_kept {
            verdict = Verdict::Undecided(found.name);
        }
    }
    verdict
}
