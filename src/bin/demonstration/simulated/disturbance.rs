//! Effects of a simulated gyro that the five terms do not describe.

use super::{FRACTION, Pole, Random, rounded};

/// An effect that is hidden in a simulated gyro, also computed in integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Disturbance {
    /// A sinusoid.
    Sinusoid {
        /// The amplitude in 2^-24 counts.
        amplitude: u32,
        /// The value `2 sin(π f τ₀)` for the frequency `f`, in 2^-24.
        turn: u32,
    },
    /// Exponentially correlated noise.
    GaussMarkov {
        /// The standard deviation in 2^-24 counts.
        deviation: u32,
        /// The binary logarithm of the correlation time in samples.
        relaxation: u32,
    },
    /// A moving average of the white noise.
    MovingAverage {
        /// The number of samples that are averaged, at most 16.
        length: u8,
    },
    /// White noise behind a low pass of two poles (Butterworth), instead of the white noise. The cut-off
    /// frequency is a fifth of the sample rate.
    TwoPoleLowPass {
        /// The standard deviation in 2^-24 counts. White noise of the same density has 1.503 times as much.
        deviation: u32,
    },
}

/// One step of the low pass: a state of unit variance, its rate of change in the same unit, and two
/// independent normal numbers. The rows give the next state and its rate, in 2^-24.
///
/// The oscillator `ẍ + √2 ω ẋ + ω² x = white noise` has the transition `F = exp(A τ₀)`, and the noise of a step
/// the covariance `1 − F Fᵀ`, whose Cholesky factor makes the last two columns.
const STEP: [[i64; 4]; 2] = [
    [9_705_439, 7_573_396, 11_398_382, 0],
    [-7_573_396, -1_004_961, 7_116_281, 13_132_678],
];

/// The state of a disturbance.
#[derive(Clone, Debug)]
pub(super) enum Source {
    None,
    Sinusoid {
        turn: i64,
        state: [i64; 2],
    },
    GaussMarkov {
        pole: Pole,
        relaxation: u32,
    },
    MovingAverage {
        ring: [i64; 16],
        length: usize,
        next: usize,
    },
    TwoPoleLowPass {
        deviation: u32,
        state: [i64; 2],
    },
}

impl Source {
    pub(super) fn new(disturbance: Option<Disturbance>, random: &mut Random) -> Self {
        match disturbance {
            None => Self::None,
            Some(Disturbance::Sinusoid { amplitude, turn }) => Self::Sinusoid {
                turn: turn.into(),
                state: [0, amplitude.into()],
            },
            Some(Disturbance::GaussMarkov {
                deviation,
                relaxation,
            }) => Self::GaussMarkov {
                pole: Pole::new(deviation, relaxation, random),
                relaxation,
            },
            Some(Disturbance::MovingAverage { length }) => Self::MovingAverage {
                ring: [0; 16],
                length: usize::from(length).clamp(1, 16),
                next: 0,
            },
            Some(Disturbance::TwoPoleLowPass { deviation }) => Self::TwoPoleLowPass {
                deviation,
                state: [(); 2].map(|()| random.normal(deviation)),
            },
        }
    }

    /// The sum of the white noise and the disturbance for the next sample.
    pub(super) fn next(&mut self, white: i64, random: &mut Random) -> i64 {
        match self {
            Self::None => white,
            Self::Sinusoid { turn, state } => {
                // Two shears make a rotation on an ellipse that never grows (Minsky, HAKMEM 1972, item 149).
                let [sine, cosine] = state;
                *sine += rounded(*turn * *cosine, FRACTION);
                *cosine -= rounded(*turn * *sine, FRACTION);
                white + *sine
            }
            Self::GaussMarkov { pole, relaxation } => {
                white + pole.next(*relaxation, random.bits() & 1 == 1)
            }
            Self::MovingAverage { ring, length, next } => {
                ring[*next] = white;
                *next = (*next + 1) % *length;
                ring[..*length].iter().sum::<i64>() / *length as i64
            }
            Self::TwoPoleLowPass { deviation, state } => {
                let [x, rate] = *state;
                let from = [
                    x,
                    rate,
                    random.normal(*deviation),
                    random.normal(*deviation),
                ];
                *state = STEP.map(|row| {
                    let sum = row.iter().zip(from).map(|(&weight, value)| weight * value);
                    rounded(sum.sum(), FRACTION)
                });
                state[0]
            }
        }
    }
}
