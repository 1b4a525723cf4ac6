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
}

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
        }
    }
}
