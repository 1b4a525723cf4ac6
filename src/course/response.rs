//! The contribution of a step or a warm-up to an Allan variance.

use crate::numerics::{
    math,
    real::{Real, real},
};

/// The starts of the differences of an octave: 0, h, 2h, … with `h = max(1, m/4)`, as those of an
/// [`Accumulator`](crate::Accumulator).
#[derive(Clone, Copy, Debug)]
pub(super) struct Starts {
    pub(super) m: u32,
    /// The distance of starts, in samples.
    pub(super) distance: u32,
    /// The number of starts in a record of `n` samples.
    pub(super) number: u64,
}

impl Starts {
    pub(super) const fn new(m: u32, n: u64) -> Self {
        let distance = if m < 4 { 1 } else { m / 4 };
        let room = n.checked_sub(2 * m as u64);
        let number = match room {
            Some(room) => match room.checked_div(distance as u64) {
                Some(last) => last.saturating_add(1),
                None => 0,
            },
            None => 0,
        };
        Self {
            m,
            distance,
            number,
        }
    }

    /// The starts whose clusters a step at the sample `at` divides: at most eight, each with the difference of the
    /// cluster means that a step of size 1 makes.
    pub(super) fn around(self, at: Real) -> impl Iterator<Item = (u64, Real)> {
        let (m, distance) = (real(self.m), real(self.distance));
        let first = math::floor((at - 2.0 * m) / distance) + 1.0;
        let first = if first > 0.0 { first as u64 } else { 0 };
        (first..self.number).map_while(move |j| {
            let after = at - j as Real * distance;
            let response = if after < m { after } else { 2.0 * m - after };
            (after > 0.0).then_some((j, response / m))
        })
    }
}

/// The contribution of a step to the Allan variance at the averaging factor `m`, in the square of the unit of
/// `size`. The record has `n` samples without a gap, and the samples from `at` on are `size` higher. A step within
/// a sample has a fractional `at`.
///
/// ```text
/// ½ size² Σ_s Λ((at − s)/m)² / N,      Λ(u) = min(u, 2 − u) for 0 < u < 2, and 0 elsewhere
/// ```
///
/// The sum runs over the N starts `s` of the octave's quarter-overlapping differences, of which at most eight have
/// the step in their clusters. The result is exact but for rounding, and 0 if no difference fits the record.
pub fn allan_variance_of_step(m: u32, n: u64, at: Real, size: Real) -> Real {
    let starts = Starts::new(m, n);
    if starts.number == 0 {
        return 0.0;
    }
    let squares = starts.around(at).map(|(_, response)| response * response);
    0.5 * size * size * squares.sum::<Real>() / starts.number as Real
}

/// The contribution of a warm-up to the Allan variance at the averaging factor `m`, in the square of the unit of
/// `size`. The record has `n` samples without a gap, and sample `i` is `size · e^(−i/t)` higher, for a time constant of
/// `t` samples, above zero.
///
/// With `q = e^(−1/t)`, the difference of the cluster means from the start `s` is `size q^s (1 − q^m)²/(m (1 − q))`.
/// The sum of its squares over the starts is a geometric series. The result is 0 if no difference fits the record.
pub fn allan_variance_of_warm_up(m: u32, n: u64, time_constant: Real, size: Real) -> Real {
    let starts = Starts::new(m, n);
    if starts.number == 0 {
        return 0.0;
    }
    let number = starts.number as Real;
    let rate = 2.0 * real(starts.distance) / time_constant;
    let series = decayed(rate * number) / decayed(rate);
    let difference = size * warm_up_response(m, time_constant);
    0.5 * difference * difference * series / number
}

/// The difference of the means of two clusters of `m` samples, the earlier less the later, that a warm-up of size 1
/// makes at its start.
pub(super) fn warm_up_response(m: u32, time_constant: Real) -> Real {
    let m = real(m);
    let lost = decayed(m / time_constant);
    lost * lost / (m * decayed(1.0 / time_constant))
}

/// `1 − e^(−x)` for `x ≥ 0`, without loss of digits near 0.
pub(super) fn decayed(x: Real) -> Real {
    if x > 0.5 {
        return 1.0 - math::exp(-x);
    }
    // The series is x (1 − x/2 (1 − x/3 (1 − …))). At x = 0.5, the terms left out are below 1e-17.
    let series = (2..16).rev();
    x * series.fold(1.0, |sum, k: u32| 1.0 - x / real(k) * sum)
}
