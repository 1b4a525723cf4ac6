//! The expected densities of deterministic effects.

use super::window::sum_of_squares;
use crate::{
    effect::Response,
    math,
    real::{Real, consts::PI, real},
};

/// A ramp or a sinusoid as means over blocks see it, in segments of `length` blocks. The rate depends on the
/// sample interval, and so does the unit of the densities, which the caller applies.
pub(super) struct Line {
    length: Real,
    kind: Kind,
}

enum Kind {
    /// The rate changes by this much from block to block.
    Ramp { step: Real },
    /// The sinusoid has this mean square, and as many periods in a segment, up to a multiple of the length.
    Sinusoid { mean_square: Real, periods: Real },
}

impl Line {
    /// The signal whose differences of adjacent samples have the given response, as means over `block`
    /// samples.
    pub(super) fn new(response: Response, interval_s: Real, length: usize, block: u32) -> Self {
        let (length, m) = (real(length), real(block));
        let difference = response.amplitude / interval_s;
        let kind = if response.phase == 0.0 {
            Kind::Ramp {
                step: difference * m,
            }
        } else {
            // Differences of samples have √2 |sin(φ/2)| times the amplitude, and means over m samples
            // |sin(mφ/2)/(m sin(φ/2))| times.
            let turns = response.phase / (2.0 * PI);
            let (sine, _) = math::sincos_of_turns(0.5 * turns);
            let (block_sine, _) = math::sincos_of_turns(0.5 * turns * m);
            let amplitude = difference * block_sine / (m * sine * sine);
            let turns = turns * m;
            Kind::Sinusoid {
                mean_square: 0.25 * amplitude * amplitude,
                periods: length * (turns - math::floor(turns)),
            }
        };
        Self { length, kind }
    }

    /// The expected density of bin `k`, times the sampling rate of the block means.
    pub(super) fn density(&self, k: usize) -> Real {
        let (k, length) = (real(k), self.length);
        let power = match self.kind {
            Kind::Ramp { step } => {
                // Σ_j j e^(−2πijk/P) is ½P (i cot(πk/P) − 1), which the window mixes.
                let amplitude = 0.5 * length * step * mixed_cotangent(k, length);
                amplitude * amplitude
            }
            Kind::Sinusoid {
                mean_square,
                periods,
            } => {
                // A sinusoid of random phase is two lines of half its mean square each.
                0.5 * mean_square * (leakage(k - periods, length) + leakage(k + periods, length))
            }
        };
        2.0 * power / sum_of_squares(length as usize)
    }
}

/// `½ cot a − ¼ cot(a + h) − ¼ cot(a − h)` without its sign, where `a = πx/P` and `h = π/P`. It is
/// `½ cos a sin²h / [sin a sin(a + h) sin(a − h)]`, which does not cancel.
fn mixed_cotangent(x: Real, length: Real) -> Real {
    let sine = |x: Real| math::sincos_of_turns(0.5 * x / length).0;
    let (own, cosine) = math::sincos_of_turns(0.5 * x / length);
    let bin = sine(1.0);
    0.5 * (cosine / own) * (bin / sine(x + 1.0)) * (bin / sine(x - 1.0))
}

/// The square of the window's transform at a distance of `x` bins.
fn leakage(x: Real, length: Real) -> Real {
    // The nearest of the aliases, at a positive distance.
    let x = x - length * math::floor(x / length + 0.5);
    let x = if x < 0.0 { -x } else { x };
    let amplitude = if x < MAIN_LOBE {
        0.5 * lobe(x, length) + 0.25 * (lobe(x + 1.0, length) + lobe(x - 1.0, length))
    } else {
        math::sincos_of_turns(0.5 * x).0 * mixed_cotangent(x, length)
    };
    amplitude * amplitude
}

/// The distance below which the terms of the transform have one sign, and single ones of the other form have
/// poles.
const MAIN_LOBE: Real = 1.75;

/// `sin(πx) cot(πx/P)`, an even function.
fn lobe(x: Real, length: Real) -> Real {
    let x = if x < 0.0 { -x } else { x };
    let (sine, cosine) = math::sincos_of_turns(0.5 * x / length);
    if x == 0.0 {
        return length;
    }
    math::sincos_of_turns(0.5 * x).0 * (cosine / sine)
}
