//! The windowed transform of one segment.

use super::window::{cosine_and_sine, first_bin, places};
use crate::numerics::real::single;
use core::ops::{Add, Mul, Neg, Sub};

/// What a transform computes with: a number, or the same place of several segments.
pub(super) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f32, Output = Self> + Neg<Output = Self>
{
    const ZERO: Self;

    fn squared(self) -> Self;
}

impl Number for f32 {
    const ZERO: Self = 0.0;

    #[inline(always)]
    fn squared(self) -> Self {
        self * self
    }
}

/// A complex number: its real and its imaginary part.
type Complex<T> = [T; 2];

/// A segment as it enters the transform: its even blocks are real parts, its odd blocks imaginary parts, and
/// the pairs are in bit-reversed order.
///
/// A real transform of `P` values is a complex one of half the length (Press et al. 1992, *Numerical Recipes*,
/// section 12.3). Everything is computed in single precision, in an order that the program gives. So host and
/// target compute the same bits. No index here needs a check that could fail, which no published transform for
/// microcontrollers offers.
pub(super) struct Segment<const P: usize, T = f32> {
    values: [T; P],
}

impl<const P: usize> Segment<P> {
    /// The segment that begins in slot `start` of a ring. Its blocks are taken less the first one, which is
    /// subtracted before anything is rounded, and times `scale`.
    #[inline]
    pub(super) fn new(ring: &[i32; P], start: usize, scale: f32) -> Self {
        let first = ring[start % P];
        let values = Self::ORDER.map(|block| {
            let block = start.wrapping_add(block as usize);
            ring[block % P].wrapping_sub(first) as f32 * scale
        });
        Self { values }
    }

    /// Adds `|8 Σ_j w_j y_j e^(−2πijk/P)|²` to `powers` and its square to `squares`, for the bins `k` that are
    /// kept, in their order.
    #[inline]
    pub(super) fn add_powers(self, powers: &mut [f32], squares: &mut [f32]) {
        let sums = powers.iter_mut().zip(squares);
        self.for_each_power(sums, |power, (sum, square)| add_power(power, sum, square));
    }
}

impl<const P: usize, T: Number> Segment<P, T> {
    /// The block of each value: pairs of blocks in bit-reversed order. A byte is enough, because a segment has at most
    /// 256 blocks.
    const ORDER: [u8; P] = {
        let mut order = [0; P];
        let bits = (P / 2).trailing_zeros();
        let mut pair = 0_u32;
        while pair < P as u32 / 2 {
            let block = 2 * (pair.reverse_bits() >> (u32::BITS - bits));
            order[2 * pair as usize] = block as u8;
            order[2 * pair as usize + 1] = block as u8 + 1;
            pair += 1;
        }
        order
    };

    /// The segment of which `block` tells the value of each block.
    #[inline]
    pub(super) fn of_blocks(mut block: impl FnMut(usize) -> T) -> Self {
        Self {
            values: Self::ORDER.map(|place| block(place.into())),
        }
    }

    /// Hands `|8 Σ_j w_j y_j e^(−2πijk/P)|²` to `keep`, each with the next one of the `places`, for the bins `k` that
    /// are kept, in their order.
    #[inline]
    pub(super) fn for_each_power<S>(
        mut self,
        mut places: impl Iterator<Item = S>,
        keep: impl Fn(T, S),
    ) {
        self.transform();
        let highest = self.separate();
        let (pairs, _) = self.values.as_chunks::<2>();
        let Some([before, here, later @ ..]) = pairs.get(first_bin(P).wrapping_sub(1)..) else {
            return;
        };
        let (mut before, mut here) = (before, here);
        for (after, place) in later.iter().zip(&mut places) {
            keep(windowed_power(before, here, after), place);
            (before, here) = (here, after);
        }
        // The neighbour of the last bin lies elsewhere.
        if let Some(place) = places.next() {
            keep(windowed_power(before, here, &highest), place);
        }
    }

    /// The complex transform of the pairs.
    #[inline]
    fn transform(&mut self) {
        // The first two stages multiply by 1 and −i only.
        let (fours, _) = self.values.as_chunks_mut::<8>();
        for four in fours {
            let [ar, ai, br, bi, cr, ci, dr, di] = *four;
            let [pr, pi, qr, qi] = [ar + br, ai + bi, ar - br, ai - bi];
            let [sr, si, tr, ti] = [cr + dr, ci + di, cr - dr, ci - di];
            *four = [
                pr + sr,
                pi + si,
                qr + ti,
                qi - tr,
                pr - sr,
                pi - si,
                qr - ti,
                qi + tr,
            ];
        }
        // A stage joins groups of `half` pairs to groups of twice as many.
        let mut half = 4_usize;
        while half < P / 2 {
            let length = half.wrapping_mul(2);
            // A group has 2 · length floats. It is never empty, which the compiler does not see.
            for group in self.values.chunks_exact_mut(length.wrapping_mul(2).max(1)) {
                join(group, length);
            }
            half = length;
        }
    }

    /// Turns the complex transform of the pairs into twice that of the blocks, for the bins from 1 to P/2 − 1,
    /// and returns that of bin P/2.
    #[inline]
    fn separate(&mut self) -> Complex<T> {
        let (pairs, _) = self.values.as_chunks_mut::<2>();
        let highest = pairs.first().map_or(T::ZERO, |&[re, im]| (re - im) * 2.0);
        let Some((low, high)) = pairs.split_at_mut_checked(P / 4) else {
            return [T::ZERO; 2];
        };
        if let Some([re, im]) = high.first_mut() {
            [*re, *im] = [*re * 2.0, *im * -2.0];
        }
        let low = low.split_first_mut().map_or(&mut [][..], |(_, rest)| rest);
        let both = low.iter_mut().zip(high.iter_mut().rev());
        for ((low, high), k) in both.zip(1..usize::MAX) {
            let ([ar, ai], [br, bi]) = (*low, *high);
            let [sum_re, sum_im] = [ar + br, ai - bi];
            let [difference_re, difference_im] = [ar - br, ai + bi];
            let (cosine, sine) = twiddle(k, P);
            let re = difference_im * cosine - difference_re * sine;
            let im = difference_re * cosine + difference_im * sine;
            *low = [sum_re + re, sum_im - im];
            *high = [sum_re - re, -(sum_im + im)];
        }
        [highest, T::ZERO]
    }
}

/// The power of a bin of the windowed segment, from twice the transform of the segment at the bin and its
/// neighbours: the window is `½ − ¼ e^(iθj) − ¼ e^(−iθj)`.
#[inline(always)]
fn windowed_power<T: Number>(before: &Complex<T>, here: &Complex<T>, after: &Complex<T>) -> T {
    let re = here[0] * 2.0 - (before[0] + after[0]);
    let im = here[1] * 2.0 - (before[1] + after[1]);
    re.squared() + im.squared()
}

/// Adds a power and its square to the sums of a bin.
#[inline(always)]
pub(super) fn add_power(power: f32, sum: &mut f32, square: &mut f32) {
    *sum += power;
    *square += power * power;
}

/// Joins the transforms in the two halves of a group to the transform of `length` pairs.
#[inline]
fn join<T: Number>(group: &mut [T], length: usize) {
    let Some((low, high)) = group.split_at_mut_checked(length) else {
        return;
    };
    let ((low, _), (high, _)) = (low.as_chunks_mut::<2>(), high.as_chunks_mut::<2>());
    let step = places(length);
    let mut place = 0_usize;
    for (low, high) in low.iter_mut().zip(high) {
        let (cosine, sine) = cosine_and_sine(place);
        let (cosine, sine) = (single(cosine), single(sine));
        place = place.wrapping_add(step);
        let [re, im] = *high;
        let [turned_re, turned_im] = [re * cosine + im * sine, im * cosine - re * sine];
        let [low_re, low_im] = *low;
        *low = [low_re + turned_re, low_im + turned_im];
        *high = [low_re - turned_re, low_im - turned_im];
    }
}

/// Cosine and sine of the angle `i` of `length`, below half a turn.
#[inline(always)]
fn twiddle(i: usize, length: usize) -> (f32, f32) {
    let (cosine, sine) = cosine_and_sine(i.wrapping_mul(places(length)));
    (single(cosine), single(sine))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::test_random::Random;
    use crate::spectrum::window::bins;
    use core::f64::consts::PI;

    fn compare<const P: usize>() {
        let mut random = Random::new(7);
        let ring: [i32; P] = core::array::from_fn(|_| random.bits() as i32 >> 8);
        let start = random.below(P);
        let scale = 1.0 / (1 << 23) as f32;
        let value = |j: usize| f64::from(ring[(start + j) % P] - ring[start]) * f64::from(scale);
        let (mut found, mut squares) = ([0.0; P], [0.0; P]);
        Segment::<P>::new(&ring, start, scale).add_powers(&mut found[..bins(P)], &mut squares);
        assert!(
            found
                .iter()
                .zip(squares)
                .all(|(power, square)| power * power == square)
        );
        for (k, &power) in (first_bin(P)..).zip(&found[..bins(P)]) {
            let (mut re, mut im) = (0.0, 0.0);
            for j in 0..P {
                let weight = 0.5 - 0.5 * libm::cos(2.0 * PI * j as f64 / P as f64);
                let angle = 2.0 * PI * ((j * k) % P) as f64 / P as f64;
                re += weight * value(j) * libm::cos(angle);
                im -= weight * value(j) * libm::sin(angle);
            }
            let expected = 64.0 * (re * re + im * im);
            let off = f64::from(power) - expected;
            // The typical power is 64 · P/8.
            assert!(off.abs() < 2e-5 * P as f64, "{P}, {k}: {power}, {expected}");
        }
    }

    #[test]
    fn powers_are_those_of_a_direct_sum() {
        compare::<32>();
        compare::<64>();
        compare::<128>();
        compare::<256>();
    }
}
