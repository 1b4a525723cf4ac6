//! A deterministic effect, as the differences of two octaves see it.

use super::{
    detailed,
    starts::{LEVELS, advance},
};
use crate::{
    curve::Point,
    numerics::{
        math::{self, floor_log2},
        real::{Real, consts::PI, real, single},
    },
    theory::model::Term,
};
use heapless::Vec;
use nalgebra::Complex;

/// What a deterministic effect adds to the product of two differences, times two. It is
/// `product · cos(phase · ℓ)` at a lag of `ℓ` quarters of the shorter cluster.
pub(super) struct Wave<'a> {
    pub(super) term: &'a Term,
    pub(super) square: Real,
    /// Its [`coherent`] share of the shorter octave.
    pub(super) scatter: Real,
    /// The phase from one sample to the next, in radians.
    pub(super) sample_phase: Real,
    /// The product without the factor of the longer octave.
    pub(super) size: Real,
    pub(super) product: f32,
    pub(super) phase: Real,
    pub(super) turn: Option<usize>,
    /// `e^(i · phase · ℓ)` at the present lag.
    pub(super) now: Complex<f32>,
}

impl Wave<'_> {
    pub(super) fn value(&self) -> f32 {
        self.product * self.now.re
    }

    /// `product · e^(i · phase · lag)`, at any lag.
    pub(super) fn from(&self, lag: u32) -> Complex<f32> {
        let turns = self.phase / (2.0 * PI) * real(lag);
        let (sine, cosine) = math::sincos_of_turns(turns);
        Complex::new(single(cosine), single(sine)) * self.product
    }

    /// `1 − e^(i · phase)` for the phase over a number of quarters.
    pub(super) fn rest(&self, quarters: u32) -> Complex<f32> {
        detailed::rest(0.0, self.phase * real(quarters))
    }

    /// The magnitude of that phase below half a turn, or a little less.
    pub(super) fn speed(&self, quarters: u32) -> f32 {
        let rest = self.rest(quarters);
        rest.re.abs().max(rest.im.abs())
    }

    /// Advances from a lag by a step, which is a power of two.
    pub(super) fn advance(&mut self, lag: u32, step: u32, turns: &[Turn]) {
        if self.phase == 0.0 {
            return;
        }
        let turn = self
            .turn
            .and_then(|turn| turns.get(turn)?.steps.get(floor_log2(step) as usize));
        self.now = match turn {
            Some(turn) => self.now * turn,
            None => {
                let turns = self.phase / (2.0 * PI) * (real(lag) + real(step));
                Complex::new(single(math::sincos_of_turns(turns).1), 0.0)
            }
        };
    }
}

pub(super) const START: Complex<f32> = Complex::new(1.0, 0.0);

/// The number of oscillations of a model whose turns are kept in tables. Any further one takes a cosine
/// per lag.
pub(super) const TABLES: usize = 2;

/// The powers `e^(i · phase · 2^k)`, by repeated squaring: one exponential replaces the cosines of a
/// lattice.
pub(super) struct Turn {
    phase: Real,
    steps: [Complex<f32>; LEVELS],
}

impl Turn {
    /// The place of a phase's turns in `known`, where they are added if they are missing. `None` if
    /// there is no room.
    pub(super) fn of(phase: Real, known: &mut Vec<Self, TABLES>) -> Option<usize> {
        if let Some(at) = known.iter().position(|turn| turn.phase == phase) {
            return Some(at);
        }
        let (sine, cosine) = math::sincos_of_turns(phase / (2.0 * PI));
        let mut turn = Complex::new(cosine, sine);
        let steps = core::array::from_fn(|_| {
            let here = Complex::new(single(turn.re), single(turn.im));
            turn *= turn;
            here
        });
        known.push(Self { phase, steps }).ok()?;
        known.len().checked_sub(1)
    }
}

/// The part of an oscillation's variance in an octave that depends on its phase, which nobody knows: the
/// amplitude of `σ̂² = σ²(τ) + coherent · cos 2φ`.
///
/// A difference of phase `φ + ωs` contributes `2σ² cos²(φ + ωs)` to the average, and `cos 2(φ + ωs)` sums
/// over `n` starts that are `a` samples apart to `sin(nωa)/sin(ωa)`. Only a record of many periods averages
/// it away. The phase `2φ` is that in the [`middle`] of the octave.
pub(super) fn coherent(term: &Term, square: Real, point: &Point, interval_s: Real) -> Real {
    let shape = term.sampled_shape(interval_s);
    let Some(sample) = term
        .effect
        .response(1.0, &shape)
        .filter(|sample| sample.phase != 0.0)
    else {
        return 0.0;
    };
    let apart = sample.phase / (2.0 * PI) * real(advance(point.m));
    let count = point.differences as Real;
    let sine = math::sincos_of_turns(apart).0;
    // Starts that are whole half periods apart all have the same phase.
    let mean = if sine.abs() * count < 1e-3 {
        1.0
    } else {
        math::sincos_of_turns(apart * count).0 / (count * sine)
    };
    square * term.effect.variance(real(point.m), &shape) * mean
}

/// The time, in samples, around which an octave's differences lie.
pub(super) fn middle(point: &Point) -> Real {
    let starts = (point.differences as Real - 1.0) * real(advance(point.m));
    0.5 * starts + real(point.m)
}
