//! The forms of a shift of the mean: a step, and a warm-up.

use super::response::decayed;
use crate::numerics::{
    math,
    real::{Real, real},
};

/// The largest number of steps and warm-ups that are reported.
pub(super) const MAX_SHIFTS: usize = 4;

/// The number of columns of a shift: its form, and the derivative of the form by its time or its time constant.
pub(super) const PER_SHIFT: usize = 2;

/// The number of columns of all shifts.
pub(super) const COLUMNS: usize = PER_SHIFT * MAX_SHIFTS;

/// A step is reported from this standardised size on. `cargo xtask study course` measures how often it is exceeded in
/// clean records.
const STEP: f64 = 5.0;

/// A warm-up is reported from this standardised size on: less than that of a step, because it has no choice of a time.
/// `cargo xtask study course` measures how often it is exceeded in clean records.
const WARM_UP: f64 = 4.6;

/// The form of a shift of the mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Form {
    /// A step in the block `place`, when `fraction` of it has passed.
    Step { place: u32, fraction: Real },
    /// An exponential with this time constant, in blocks.
    WarmUp { time_constant: Real },
}

impl Form {
    /// The mean of the form over a block.
    pub(super) fn mean(self, block: u32) -> Real {
        match self {
            Self::Step { place, .. } if block < place => 0.0,
            Self::Step { place, fraction } if block == place => 1.0 - fraction,
            Self::Step { .. } => 1.0,
            Self::WarmUp { time_constant } => {
                let rate = 1.0 / time_constant;
                math::exp(-rate * real(block)) * time_constant * decayed(rate)
            }
        }
    }

    /// The derivative of the mean by the fraction of a step, or by the logarithm of a time constant.
    pub(super) fn derivative(self, block: u32) -> Real {
        match self {
            Self::Step { place, .. } => {
                if block == place {
                    -1.0
                } else {
                    0.0
                }
            }
            Self::WarmUp { time_constant } => {
                let at = |factor: Real| {
                    let time_constant = time_constant * factor;
                    Self::WarmUp { time_constant }.mean(block)
                };
                let step = real(1.02);
                (at(step) - at(1.0 / step)) / (2.0 * math::log(step))
            }
        }
    }

    /// The square of the standardised size from which on the form is reported.
    pub(super) fn limit_square(self) -> Real {
        match self {
            Self::Step { .. } => real(STEP * STEP),
            Self::WarmUp { .. } => real(WARM_UP * WARM_UP),
        }
    }

    /// The mean, or its derivative.
    pub(super) fn column(self, derivative: bool, block: u32) -> Real {
        if derivative {
            self.derivative(block)
        } else {
            self.mean(block)
        }
    }
}
