//! The expected densities of deterministic effects.

use super::window::{half_cosine_and_sine, sum_of_squares};
use crate::{
    numerics::{
        math,
        real::{Real, consts::PI, real},
    },
    theory::effect::Response,
};

/// A ramp or a sinusoid as means over blocks see it, in segments of `length` blocks.
pub(super) struct Line {
    segment: usize,
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
        /// Sine and cosine of `π periods/P`.
        place: (Real, Real),
        /// The square of the sine of `πx/P` at the border of the main lobe.
        lobe: Real,
    },
}

impl Line {
    /// The signal whose differences of adjacent samples have the given response, as means over `block`
    /// samples.
    pub(super) fn new(response: Response, interval_s: Real, segment: usize, block: u32) -> Self {
        let (length, m) = (real(segment), real(block));
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
            let (lobe, _) = math::sincos_of_turns(0.5 * MAIN_LOBE / length);
            Kind::Sinusoid {
                mean_square: 0.25 * amplitude * amplitude,
                periods,
                sine: math::sincos_of_turns(0.5 * periods).0,
                place: math::sincos_of_turns(0.5 * periods / length),
                lobe: lobe * lobe,
            }
        };
        let (bin, _) = math::sincos_of_turns(0.5 / length);
        Self {
            segment,
            length,
            bin: bin * bin,
            kind,
        }
    }

    /// The expected density of bin `k`, times the sampling rate of the block means.
    pub(super) fn density(&self, k: usize) -> Real {
        let (bin_cosine, bin_sine) = half_cosine_and_sine(k, self.segment);
        let power = match self.kind {
            Kind::Ramp { step } => {
                // Σ_j j e^(−2πijk/P) is ½P (i cot(πk/P) − 1), which the window mixes.
                let mixed = self.mixed_cotangent(bin_sine, bin_cosine);
                let amplitude = 0.5 * self.length * step * mixed;
                amplitude * amplitude
            }
            Kind::Sinusoid {
                mean_square,
                periods,
                sine,
                place: (place_sine, place_cosine),
                lobe,
            } => {
                // The sines and cosines of π(k − periods)/P and π(k + periods)/P follow from those of the two angles.
                let (near, far) = (bin_sine * place_cosine, bin_cosine * place_sine);
                let (both, turned) = (bin_cosine * place_cosine, bin_sine * place_sine);
                let leakage = |distance: Real, sine_of, cosine_of| {
                    let amplitude = if sine_of * sine_of < lobe {
                        self.main_lobe(distance)
                    } else {
                        sine * self.mixed_cotangent(sine_of, cosine_of)
                    };
                    amplitude * amplitude
                };
                // A sinusoid of random phase is two lines of half its mean square each.
                let k = real(k);
                let lines = leakage(k - periods, near - far, both + turned)
                    + leakage(k + periods, near + far, both - turned);
                0.5 * mean_square * lines
            }
        };
        2.0 * power / sum_of_squares(self.length)
    }

    /// `½ cot a − ¼ cot(a + h) − ¼ cot(a − h)` without its sign, where `h = π/P`, from the sine and the cosine of `a`. It
    /// is `½ cot a sin²h/(sin²a − sin²h)`, which does not cancel.
    fn mixed_cotangent(&self, sine: Real, cosine: Real) -> Real {
        0.5 * cosine * self.bin / (sine * (sine * sine - self.bin))
    }

    /// The window's transform at a distance of `x` bins, in its main lobe or that of an alias, without its sign.
    fn main_lobe(&self, x: Real) -> Real {
        // The nearest of the aliases.
        let x = x - self.length * math::floor(x / self.length + 0.5);
        0.5 * self.lobe(x) + 0.25 * (self.lobe(x + 1.0) + self.lobe(x - 1.0))
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
