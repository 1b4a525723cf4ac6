//! The judgement of a record.

use crate::{OCTAVES, Verdict};
use allanite::{
    Accumulator, Curve, Scale,
    ieee_952::{self, Checked, Fit, Limits},
    integrity::Screen,
    sensor::LSM6DSO,
};

/// The largest coefficients that pass: quantization, angle random walk in °/s/√Hz, bias instability in °/s, rate random walk
/// and rate ramp. Write those of your product here. An infinite limit asks for nothing.
const LIMITS: [f32; ieee_952::TERMS] = [f32::INFINITY, 0.0054, 0.005, f32::INFINITY, f32::INFINITY];

/// Holds a record with so many samples per second to the limits.
// The curve stays where it is while the fit reads it: each function hands a result on by reference, which saves half a
// kilobyte of stack.
#[inline(never)]
pub fn judge(gyro: &Accumulator<OCTAVES>, screen: &Screen, rate_hz: f32) -> Verdict {
    let Some(scale) = Scale::new(LSM6DSO.scale_dps, rate_hz).ok() else {
        return Verdict::NoFit;
    };
    match &curve(gyro, scale) {
        Some(curve) => match screen.verdict(curve, scale) {
            Some(reason) => Verdict::Invalid(reason.name()),
            None => judge_curve(curve),
        },
        None => Verdict::NoFit,
    }
}

/// The Allan curve of a record in which no gap was filled, because the station calls [`Accumulator::gap`] for lost samples.
#[inline(never)]
fn curve(gyro: &Accumulator<OCTAVES>, scale: Scale) -> Option<Curve<OCTAVES>> {
    gyro.unbridged_curve(scale)
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
