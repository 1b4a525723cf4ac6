//! Deterministic rates. Records differ only in the phase of a sinusoid.

use super::{Random, Source};
use allanite::effect::Response;
use rand::RngExt;
use std::f64::consts::{PI, SQRT_2};

/// A ramp, or a sinusoid of random phase.
pub(super) enum Deterministic {
    /// The rate changes by the same amount from every sample to the next.
    Ramp {
        /// The change per sample, in rate units.
        step: f64,
        /// The number of samples so far.
        samples: u64,
    },
    /// The rate is a sinusoid.
    Sinusoid {
        /// The amplitude, in rate units.
        amplitude: f64,
        /// The number of periods per sample.
        cycles: f64,
        /// The phase one sample before the first, in turns.
        phase: f64,
        /// The number of samples so far.
        samples: u64,
    },
}

impl Deterministic {
    /// The signal whose differences of adjacent samples have the given response. The differences of
    /// a sinusoid of amplitude `A` have the root-mean-square `√2 A |sin(phase/2)|`.
    pub(super) fn new(
        response: Response,
        coefficient: f64,
        interval_s: f64,
        random: &mut Random,
    ) -> Self {
        let difference = coefficient * response.amplitude.abs() / interval_s;
        if response.phase == 0.0 {
            return Self::Ramp {
                step: difference,
                samples: 0,
            };
        }
        Self::Sinusoid {
            amplitude: difference / (SQRT_2 * (0.5 * response.phase).sin().abs()),
            cycles: response.phase / (2.0 * PI),
            phase: random.random(),
            samples: 0,
        }
    }
}

impl Source for Deterministic {
    fn next(&mut self, _: &mut Random) -> f64 {
        match self {
            Self::Ramp { step, samples } => {
                *samples += 1;
                *step * *samples as f64
            }
            Self::Sinusoid {
                amplitude,
                cycles,
                phase,
                samples,
            } => {
                *samples += 1;
                let turns = (*cycles * *samples as f64 + *phase).fract();
                *amplitude * (2.0 * PI * turns).sin()
            }
        }
    }
}
