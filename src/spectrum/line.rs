//! The expected densities of deterministic effects.

use super::window::sum_of_squares;
use crate::{
    effect::Response,
    math,
    real::{Real, consts::PI, real},
};

/// A ramp or a sinusoid as means over blocks see it, in segments of `length` blocks.
pub(super) struct Line {
    length: Real,
    /// `sin²(π/P)`.
    bin: Real,
    kind: Kind,
}

enum Kind {
    /// The rate changes by this much from block to block.
    Ramp { step: Real },
    /// The sinusoid has this mean square, and as many periods in a segment, up to a multiple of the length.
    Sinusoid {
        mean_square: Real,
        periods: Real,
        /// `sin(π periods)`, which is that of any bin's distance but for its sign.
        sine: Real,
    },
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
            let periods = length * (turns - math::floor(turns));
            Kind::Sinusoid {
                mean_square: 0.25 * amplitude * amplitude,
                periods,
                sine: math::sincos_of_turns(0.5 * periods).0,
            }
        };
        let (bin, _) = math::sincos_of_turns(0.5 / length);
        Self {
            length,
            bin: bin * bin,
            kind,
        }
    }

    /// The expected density of bin `k`, times the sampling rate of the block means.
    pub(super) fn density(&self, k: usize) -> Real {
        let k = real(k);
        let power = match self.kind {
            Kind::Ramp { step } => {
                // Σ_j j e^(−2πijk/P) is ½P (i cot(πk/P) − 1), which the window mixes.
                let amplitude = 0.5 * self.length * step * self.mixed_cotangent(k);
                amplitude * amplitude
            }
            Kind::Sinusoid {
                mean_square,
                periods,
                sine,
            } => {
                // A sinusoid of random phase is two lines of half its mean square each.
                let both = self.leakage(k - periods, sine) + self.leakage(k + periods, sine);
                0.5 * mean_square * both
            }
        };
        2.0 * power / sum_of_squares(self.length)
    }

    /// `½ cot a − ¼ cot(a + h) − ¼ cot(a − h)` without its sign, where `a = πx/P` and `h = π/P`. It is
    /// `½ cot a sin²h/(sin²a − sin²h)`, which does not cancel.
    fn mixed_cotangent(&self, x: Real) -> Real {
        let (sine, cosine) = math::sincos_of_turns(0.5 * x / self.length);
        0.5 * cosine * self.bin / (sine * (sine * sine - self.bin))
    }

    /// The square of the window's transform at a distance of `x` bins, given `sin(πx)` but for its sign.
    fn leakage(&self, x: Real, sine: Real) -> Real {
        // The nearest of the aliases, at a positive distance.
        let x = x - self.length * math::floor(x / self.length + 0.5);
        let x = if x < 0.0 { -x } else { x };
        let amplitude = if x < MAIN_LOBE {
            0.5 * self.lobe(x) + 0.25 * (self.lobe(x + 1.0) + self.lobe(x - 1.0))
        } else {
            sine * self.mixed_cotangent(x)
        };
        amplitude * amplitude
    }

    /// `sin(πx) cot(πx/P)`, an even function.
    fn lobe(&self, x: Real) -> Real {
        let x = if x < 0.0 { -x } else { x };
        if x == 0.0 {
            return self.length;
        }
        let (sine, cosine) = math::sincos_of_turns(0.5 * x / self.length);
        math::sincos_of_turns(0.5 * x).0 * (cosine / sine)
    }
}

/// The distance in bins below which the cotangents are summed one by one. None of them cancels there, and the
/// other form has poles at 0 and 1.
const MAIN_LOBE: Real = 1.75;
