//! A coefficient, and what a record says about it.

use allanite::{Coefficient, fit::State};

/// What a record says about a coefficient.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AllaniteState {
    /// The 95 % interval excludes zero.
    Measured = 0,
    /// The interval includes zero, and `upper` is a one-sided 95 % bound.
    UpperBound = 1,
    /// The record says nothing about it.
    NotObservable = 2,
}

/// A coefficient, in the unit rate · s^(half_seconds/2).
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct AllaniteCoefficient {
    /// The code of the effect, for `allanite_effect_name`. A code never changes its meaning.
    pub effect: i32,
    /// What the record says about it.
    pub state: AllaniteState,
    /// Twice the exponent of the second in the unit.
    pub half_seconds: i32,
    /// The best value.
    pub value: f32,
    /// The lower end of the 95 % interval; 0 unless the coefficient is measured.
    pub lower: f32,
    /// The upper end of the interval, or a one-sided 95 % bound.
    pub upper: f32,
}

impl AllaniteCoefficient {
    // The casts change nothing in single precision, in which every published library is built.
    #[allow(clippy::unnecessary_cast)]
    pub(crate) fn of(coefficient: &Coefficient, effect: i32) -> Self {
        Self {
            effect,
            state: match coefficient.state {
                State::Measured => AllaniteState::Measured,
                State::UpperBound => AllaniteState::UpperBound,
                State::NotObservable { .. } => AllaniteState::NotObservable,
            },
            half_seconds: coefficient.half_seconds.into(),
            value: coefficient.value as f32,
            lower: coefficient.lower as f32,
            upper: coefficient.upper as f32,
        }
    }
}
