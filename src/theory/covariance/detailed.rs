//! A random effect with more detail than the lattice resolves: a resonance, or a filter that spans many samples.
//!
//! Such an effect is known at every lag of the kinks. Beyond them it vanishes, or it gives two differences the
//! covariance `p_ℓ = Re[F qⁱ + B qⁿ⁻ⁱ]`. Here `q` is the pole's power from one start to the next, and `i` and
//! `n − i` are the distances from the kinks on both sides. The number of pairs `N_ℓ` is linear there. So the sum of
//! `N_ℓ p_ℓ²` consists of geometric series of the ratios `q²` and `|q|²`, and the products with another resonance
//! or a sinusoid do as well. A smooth effect `c_ℓ` is taken as linear between the lags of the lattice, as it is
//! without a resonance, and its product with each power of `q` is summed in closed form (Filon 1928).

use super::{
    series::{ONE, Series, ZERO, joined},
    starts::{LEVELS, advance},
};
use crate::{
    numerics::{
        math::{self, floor_log2},
        real::{Real, consts::PI, real, single},
    },
    theory::effect::{self, Effect, SampledShape},
};
use nalgebra::Complex;

/// The turn and decay, in radians, over a step of the lattice up to which a product with an oscillation is smooth
/// enough for the trapezoidal rule. The rule's error is a twelfth of the square. Chosen by hand, and held to the
/// sum over all pairs by `host-tests/tests/library/covariance`.
pub(super) const SMOOTH: f32 = 0.25;

/// The most lags of which the second differences are tabulated. The widest decimation filter needs 95.
const MOST: usize = 96;

/// A random effect with detail, as the differences of one octave see it. Lags are counted in the starts of the
/// shorter difference.
pub(super) struct Detailed {
    /// The lag from which on the tail applies.
    pub(super) start: u32,
    /// The magnitude of the logarithm of `q`.
    pub(super) speed: f32,
    kind: Kind,
}

// Either kind takes half a kilobyte.
#[allow(clippy::large_enum_variant)]
enum Kind {
    /// The second differences vanish from the start on.
    Finite { near: [f32; MOST] },
    /// They are `Re amplitude · q^(x − start)` from there on.
    Decaying {
        /// The second differences up to the start, less that at the start.
        near: [f32; 4],
        amplitude: Complex<f32>,
        steps: [Step; LEVELS],
    },
}

/// A step of `n` starts, where `n` is a power of two.
#[derive(Clone, Copy)]
struct Step {
    /// `1 − qⁿ`.
    rest: Complex<f32>,
    /// `Σ (1 − i/n) qⁱ` over `0 ≤ i ≤ n`, with half of either end.
    early: Complex<f32>,
    /// `Σ (i/n) qⁱ` over the same steps.
    late: Complex<f32>,
}

impl Detailed {
    /// One part of an effect with this tail for clusters of `m` samples, times `scale`. `None` if there is no such part,
    /// or no room for it here.
    pub(super) fn of(
        tail: &effect::Tail,
        part: usize,
        effect: &dyn Effect,
        shape: &SampledShape,
        m: u32,
        scale: Real,
    ) -> Option<Self> {
        let step = real(advance(m));
        let start = math::ceil(tail.start / step) as u32;
        let second_difference = |x: u32| {
            let x = real(x) * step;
            let value = effect.second_difference(x, real(m), shape);
            let all = tail.decays.iter().flatten().map(|decay| decay.cosine);
            single(scale * (value - all.sum::<Real>()))
        };
        let Some(decay) = tail.decays.get(part)? else {
            let mut near = [0.0; MOST];
            for (x, near) in (0..start).zip(&mut near) {
                *near = second_difference(x);
            }
            return (part == 0 && start as usize <= MOST).then_some(Self {
                start,
                speed: 0.0,
                kind: Kind::Finite { near },
            });
        };
        // The first part has all that the effect gives up to the start.
        let mut near = [0.0; 4];
        for (x, near) in (0..start).zip(&mut near).filter(|_| part == 0) {
            *near = second_difference(x);
        }
        let mut level = Series::first(rest(decay.decay * step, decay.phase * step), ZERO);
        let steps = core::array::from_fn(|_| {
            let last = ONE - level.rest;
            let late = level.moment / level.count + last * 0.5;
            let step = Step {
                rest: level.rest,
                early: level.sum + last * 0.5 - late - 0.5,
                late,
            };
            level = level.then(&level);
            step
        });
        let speed = math::sqrt(decay.decay * decay.decay + decay.phase * decay.phase);
        (start as usize <= near.len()).then_some(Self {
            start,
            speed: single(step * speed),
            kind: Kind::Decaying {
                near,
                amplitude: Complex::new(single(scale * decay.cosine), single(scale * decay.sine)),
                steps,
            },
        })
    }

    /// The second difference at a lag, less a constant.
    fn second_difference(&self, lag: u32) -> f32 {
        let at = lag as usize;
        match &self.kind {
            Kind::Finite { near } => near.get(at).copied().unwrap_or(0.0),
            Kind::Decaying {
                near,
                amplitude,
                steps,
            } => match lag.checked_sub(self.start) {
                Some(beyond) => -(amplitude * rest_of(steps, beyond)).re,
                None => near.get(at).copied().unwrap_or(0.0),
            },
        }
    }

    /// The covariance at a lag.
    pub(super) fn at(&self, lag: u32, middle: u32) -> f32 {
        let here = self.second_difference(lag);
        self.second_difference(lag.abs_diff(middle)) - (here + here)
            + self.second_difference(lag.saturating_add(middle))
    }

    /// The covariance between the kinks, which reach up to the lag `reach` and down from `middle − reach`. `None`
    /// if it is zero.
    pub(super) fn inner(&self, middle: u32, reach: u32) -> Option<Tail> {
        self.tail(reach, |steps| (-ONE - rest_of(steps, middle), ONE))
    }

    /// The covariance beyond all kinks, from the lag `middle + reach` on.
    pub(super) fn outer(&self, middle: u32, reach: u32) -> Option<Tail> {
        self.tail(reach, |steps| {
            let rest = rest_of(steps, middle);
            (rest * rest, ZERO)
        })
    }

    fn tail(
        &self,
        reach: u32,
        of: impl Fn(&[Step]) -> (Complex<f32>, Complex<f32>),
    ) -> Option<Tail> {
        let Kind::Decaying {
            amplitude, steps, ..
        } = &self.kind
        else {
            return None;
        };
        let [first, ..] = steps;
        let start = amplitude * (ONE - rest_of(steps, reach.saturating_sub(self.start)));
        let (forward, backward) = of(steps);
        Some(Tail {
            forward: start * forward,
            backward: start * backward,
            rest: first.rest,
        })
    }

    /// The sum of `p_ℓ y_ℓ` over a step of `2^level` starts, with half of either end. The smooth `y` goes
    /// linearly from `first` to `last`; `tail` begins `before` starts ahead of the step and ends `after` starts
    /// behind it.
    pub(super) fn step(
        &self,
        tail: &Tail,
        level: u32,
        [before, after]: [u32; 2],
        [first, last]: [f32; 2],
    ) -> f32 {
        let Kind::Decaying { steps, .. } = &self.kind else {
            return 0.0;
        };
        let Some(step) = steps.get(level as usize) else {
            return 0.0;
        };
        let forward = tail.forward * (ONE - rest_of(steps, before));
        let mut sum = (forward * (step.early * first + step.late * last)).re;
        if tail.backward != ZERO {
            let backward = tail.backward * (ONE - rest_of(steps, after));
            sum += (backward * (step.early * last + step.late * first)).re;
        }
        sum
    }
}

/// `1 − q^lag`.
fn rest_of(steps: &[Step], lag: u32) -> Complex<f32> {
    let (mut rest, mut left) = (ZERO, lag);
    while left > 0 {
        let level = floor_log2(left);
        left ^= 1_u32.wrapping_shl(level);
        let step = steps.get(level as usize);
        rest = joined(rest, step.map_or(ONE, |step| step.rest));
    }
    rest
}

/// The covariance beyond the kinks: `Re[forward · qⁱ + backward · qⁿ⁻ⁱ]` at the start `i` of `0 … n`.
pub(super) struct Tail {
    pub(super) forward: Complex<f32>,
    pub(super) backward: Complex<f32>,
    /// `1 − q`.
    pub(super) rest: Complex<f32>,
}

impl Tail {
    pub(super) fn doubled(self) -> Self {
        Self {
            forward: self.forward * 2.0,
            backward: self.backward * 2.0,
            rest: self.rest,
        }
    }

    /// The sum of the products with another tail over `0 ≤ i ≤ n`.
    pub(super) fn product(&self, other: &Self, n: u32) -> f32 {
        let (f, b) = (self.forward, self.backward);
        let half = |f2: Complex<f32>, b2: Complex<f32>, rest: Complex<f32>| {
            let count = n.saturating_add(1);
            let same = Series::of(joined(self.rest, rest), ZERO, count).sum;
            let mut sum = (f * f2 + b * b2) * same;
            if b != ZERO || b2 != ZERO {
                sum += (f * b2 + b * f2) * Series::of(self.rest, rest, count).sum;
            }
            0.5 * sum.re
        };
        half(other.forward, other.backward, other.rest)
            + half(
                other.forward.conj(),
                other.backward.conj(),
                other.rest.conj(),
            )
    }

    /// The sum of the products over all `i ≥ 0`, weighted with `pairs − slope · i` down to zero. There is no
    /// backward part.
    pub(super) fn outer_product(&self, other: &Self, pairs: f32, slope: f32) -> f32 {
        let count = (pairs / slope) as u32;
        let half = |forward: Complex<f32>, rest: Complex<f32>| {
            let series = Series::of(joined(self.rest, rest), ZERO, count.saturating_add(1));
            let sum = series.sum * pairs - series.moment * slope;
            0.5 * (self.forward * forward * sum).re
        };
        half(other.forward, other.rest) + half(other.forward.conj(), other.rest.conj())
    }
}

/// `1 − e^(−decay + i phase)`, without cancellation where both are small.
pub(super) fn rest(decay: Real, phase: Real) -> Complex<f32> {
    // With e^(i phase) = 1 − 2 sin²(phase/2) + i sin(phase) only 1 − e^(−decay) is left to compute.
    let (half_sine, half_cosine) = math::sincos_of_turns(phase / (4.0 * PI));
    let turn = Complex::new(2.0 * half_sine * half_sine, -2.0 * half_sine * half_cosine);
    // The series leaves 1e-6 of what is small.
    let decayed = if decay < 0.1 {
        decay * (1.0 - decay * (0.5 - decay * (1.0 / 6.0 - decay / 24.0)))
    } else {
        1.0 - math::exp(-decay)
    };
    let both = turn + decayed - turn * decayed;
    Complex::new(single(both.re), single(both.im))
}
