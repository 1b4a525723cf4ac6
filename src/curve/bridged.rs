//! What filled values change in a curve, which is taken off.
//!
//! A filled gap changes the variance of the differences that touch it. How much follows from the generalised covariance
//! `G` of the angle, whatever the noise: the second difference of the filled angle is a combination of angles at seven
//! places. And the curve itself gives `G` at the powers of two, up to a polynomial that all second differences ignore:
//!
//! ```text
//! m² σ²(m) = 3 G(0) − 4 G(m) + G(2m)
//! ```
//!
//! Between powers of two, `G` is a cubic through four of them, which is exact for quantization, white noise and random
//! walk. So no model is needed.
//!
//! To the second order in the share `p` of lost samples, gaps at random places do less than all of them alone: with `e` for
//! what one gap changes in a difference, `E e²` counts `1 − p` times only, because the mean over all places is no noise. In
//! its stead comes what the record loses to its own running mean `H x` everywhere, which is `p² |1 − H|²` of the variance.

use crate::{
    list::numbered,
    numerics::real::{Real, real},
    record::octave::{
        Bridged,
        bridge::{BEFORE, WINDOW},
    },
};
use heapless::Vec;

/// The number of powers of two at which `G` is known: the largest distance is that of `m = 128` and a gap of 64.
const NODES: usize = 11;

/// The octave from which on the change falls in proportion to the number of samples of a cluster.
const LONG: u32 = 7;

/// The distances of the window's end from the gap that are averaged. With 0 to 7 samples, they share the mean, and nearly
/// the variance.
const ENDS: [i32; 2] = [(BEFORE as i32 - 1) / 2 - 2, BEFORE as i32 / 2 + 2];

/// Where fewer samples than one in so many are filled, the second order of their share moves nothing by a tenth of its
/// standard error, and a device saves the time.
const SECOND_ORDER: u64 = 256;

/// The largest number of parts in which the starts of a difference are summed.
const PARTS: i32 = 16;

/// The generalised covariance of the angle at powers of two, in samples squared.
struct Covariance([Real; NODES]);

impl Covariance {
    fn of(octaves: &[(u32, Real)]) -> Self {
        let mut nodes = [0.0; NODES];
        let mut variance = 0.0;
        let (mut last, mut m) = (0.0, 1_u32);
        for node in nodes.iter_mut().skip(1) {
            // Behind the last octave, the variance is taken to stay.
            let octave = octaves.iter().find(|octave| octave.0 == m);
            variance = octave.map_or(variance, |octave| octave.1);
            last = 4.0 * last + real(m) * real(m) * variance;
            *node = last;
            m = m.wrapping_shl(1);
        }
        // Without the part that grows with the square, the numbers are small.
        let square = last / (real(m) * real(m));
        let mut m = 1.0;
        for node in &mut nodes {
            *node -= square * m * m;
            m *= 2.0;
        }
        Self(nodes)
    }

    fn at(&self, distance: i32) -> Real {
        let distance = distance.unsigned_abs();
        if distance == 0 {
            return 0.0;
        }
        let node = |k: usize| self.0.get(k).copied().unwrap_or(0.0);
        let octave = 31_u32.saturating_sub(distance.leading_zeros()) as usize;
        if distance.is_power_of_two() {
            return node(octave);
        }
        let first = octave.saturating_sub(1).min(NODES - 4);
        // In units of the first of four powers of two.
        let t = real(distance) / real(1_u32.wrapping_shl(first as u32));
        let [one, two, four, eight] = [t - 1.0, t - 2.0, t - 4.0, t - 8.0];
        node(first) * two * four * eight / -21.0
            + node(first.saturating_add(1)) * one * four * eight / 12.0
            - node(first.saturating_add(2)) * one * two * eight / 24.0
            + node(first.saturating_add(3)) * one * two * four / 168.0
    }

    /// The sum over all starts of what a gap of `lost` samples changes in the Allan variance at `m`, and the part of it that
    /// is the square of what the gap changes in a difference.
    fn change(&self, m: i32, lost: i32, with_squares: bool) -> [Real; 2] {
        let double = m.wrapping_mul(2);
        let plain = self.at(double) - 4.0 * self.at(m);
        let starts = double.wrapping_add(lost).wrapping_sub(1);
        let parts = starts.min(PARTS);
        let (mut sum, mut squares) = (0.0, 0.0);
        for end in ENDS {
            for part in 0..parts {
                // The middle of the part, from the first start whose difference touches the gap.
                let place = starts.wrapping_mul(part.wrapping_mul(2).wrapping_add(1));
                let place = place.wrapping_div_euclid(parts.wrapping_mul(2));
                let start = place.wrapping_add(1).wrapping_sub(double);
                let [filled, square] = self.filled(start, m, lost, end, with_squares);
                sum += filled - 2.0 * plain;
                squares += square;
            }
        }
        let all = real(starts as u32) / real((2 * parts) as u32);
        [sum, squares].map(|sum| 0.5 * sum * all / (real(m as u32) * real(m as u32)))
    }

    /// The variance of the difference that starts at `start`, where the gap begins at 0, and that of what the gap changes in
    /// it.
    fn filled(&self, start: i32, m: i32, lost: i32, end: i32, with_squares: bool) -> [Real; 2] {
        let window = WINDOW as i32;
        let (until, from) = (end.wrapping_neg(), end.wrapping_add(window).wrapping_neg());
        let mut terms = [(0, 0.0); 7];
        let [zero, behind, newest, oldest, boundaries @ ..] = &mut terms;
        (zero.0, behind.0, newest.0, oldest.0) = (0, lost, until, from);
        let places = [0, m, m.wrapping_mul(2)].map(|step: i32| start.wrapping_add(step));
        for ((own, place), weight) in boundaries.iter_mut().zip(places).zip([1.0, -2.0, 1.0]) {
            if place <= 0 {
                *own = (place, weight);
                continue;
            }
            let inside = place.min(lost);
            let share = weight * real(inside) / real(window);
            zero.1 += weight;
            newest.1 += share;
            oldest.1 -= share;
            if place > lost {
                behind.1 -= weight;
                *own = (place, weight);
            }
        }
        let filled = self.variance(&terms);
        if !with_squares {
            return [filled, 0.0];
        }
        let [.., first, middle, last] = &mut terms;
        for ((place, own), weight) in [first, middle, last].into_iter().zip([1.0, -2.0, 1.0]) {
            *own = if (1..=lost).contains(place) {
                -weight
            } else {
                0.0
            };
        }
        [filled, self.variance(&terms)]
    }

    /// The variance of a combination of angles at places.
    fn variance(&self, terms: &[(i32, Real)]) -> Real {
        let mut sum = 0.0;
        for (i, (place, weight)) in numbered(terms.iter()) {
            if *weight == 0.0 {
                continue;
            }
            for (other, other_weight) in terms.iter().take(i) {
                if *other_weight != 0.0 {
                    sum += 2.0 * weight * other_weight * self.at(place.wrapping_sub(*other));
                }
            }
        }
        sum
    }
}

/// The share `|1 − H|²` of the variance of clusters of `m = 32, 64, …` samples that differs from the mean of the samples
/// before, at the frequency `1/(2m)` of a cluster's difference.
const OWN_SHARES: [f32; 6] = [1.893054, 0.810254, 0.230789, 0.059595, 0.015019, 0.003762];

/// The share of the variance of octave `k` that differs from the mean of the samples before. It is 1 for short clusters, of
/// which the mean has none, and below a thousandth for long ones.
fn own_share(k: u32) -> Real {
    match k.checked_sub(5) {
        None => 1.0,
        Some(place) => OWN_SHARES
            .get(place as usize)
            .map_or(0.0, |&share| real(share)),
    }
}

/// Takes off what filled gaps change in the variances of octaves `(m, variance)`. `places` is the number of samples with
/// those that were lost.
#[inline(never)]
pub(super) fn take_off<const K: usize>(
    octaves: &mut Vec<(u32, Real), K>,
    bridged: &Bridged,
    places: u64,
) {
    let read = octaves.clone();
    let with_squares = bridged.lost() > places / SECOND_ORDER;
    // The first covariance is that of the filled angle. The second one is closer to that of the angle.
    for _ in 0..2 {
        let covariance = Covariance::of(octaves);
        let mut last = None;
        for (own, &(_, variance)) in octaves.iter_mut().zip(&read) {
            // The largest power of two in `m`, where the logarithm of the standard library may panic.
            let octave = 31_u32.saturating_sub(own.0.leading_zeros());
            // All long octaves have the same sums.
            let shortened = octave.min(LONG);
            let sums = match last {
                Some((of, sums)) if of == shortened => sums,
                _ => Sums::of(&covariance, bridged, shortened, with_squares),
            };
            last = Some((shortened, sums));
            own.1 = within(variance, sums.change(octave, *own, places));
        }
    }
}

/// The variance without a change. Where noise is nearly nothing, the change may be wrong by more than the noise.
fn within(variance: Real, change: Real) -> Real {
    let (left, half) = (variance - change, 0.5 * variance);
    if left < half { half } else { left }
}

/// What all filled gaps of a record change in the sum of the squared differences of an octave.
#[derive(Clone, Copy)]
struct Sums {
    change: Real,
    /// The part that is the square of what they change in a difference, if it is asked for, and the samples in them.
    squares: Real,
    lost: Real,
}

impl Sums {
    fn of(covariance: &Covariance, bridged: &Bridged, octave: u32, with_squares: bool) -> Self {
        let mut sums = Self {
            change: 0.0,
            squares: 0.0,
            lost: 0.0,
        };
        let classes = bridged.gaps.iter().zip(&bridged.samples);
        for (class, (&gaps, &lost)) in numbered(classes) {
            let length = lost.wrapping_add(gaps / 2).checked_div(gaps);
            let reached = (octave as usize) >= Bridged::first_octave(class);
            let Some(length) = length.filter(|_| reached) else {
                continue;
            };
            let length = length.min(64) as i32;
            let [change, square] = covariance.change(1 << octave, length, with_squares);
            sums.change += real(gaps) * change;
            sums.squares += real(gaps) * square;
            if with_squares {
                sums.lost += real(lost);
            }
        }
        sums
    }

    /// What they change in the Allan variance of octave `(m, variance)`.
    fn change(&self, octave: u32, (m, variance): (u32, Real), places: u64) -> Real {
        let scale = real(1_u32 << octave.min(LONG)) / (real(m) * places as Real);
        let share = self.lost / places as Real;
        (self.change - share * self.squares) * scale + share * share * own_share(octave) * variance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::real::double;
    use core::f64::consts::PI;

    #[test]
    fn shares_are_those_of_the_mean_before_a_gap() {
        for k in 0..20_u32 {
            let turns = 0.5 / f64::from(1_u32 << k);
            let window = f64::from(WINDOW);
            let gain = libm::sin(PI * turns * window) / (window * libm::sin(PI * turns));
            let middle = 0.5 * (window + f64::from(ENDS[0] + ENDS[1]) + 1.0);
            let expected = 1.0 - gain * (2.0 * libm::cos(2.0 * PI * middle * turns) - gain);
            let found = double(own_share(k));
            assert!((found - expected).abs() < 1e-3, "{k}: {found} {expected}");
        }
    }
}
