//! The windowed transform of one segment.

use super::window::{cosine_and_sine, first_bin, places};
use crate::real::single;

/// A complex number: its real and its imaginary part.
type Complex = [f32; 2];

/// A segment as it enters the transform: its even blocks are real parts, its odd blocks imaginary parts, and
/// the pairs are in bit-reversed order.
///
/// A real transform of `P` values is a complex one of half the length (Press et al. 1992, *Numerical Recipes*,
/// section 12.3). Everything is computed in single precision, in an order that the program gives. So host and
/// target compute the same bits. No index here needs a check that could fail, which no published transform for
/// microcontrollers offers.
pub(super) struct Segment<const P: usize> {
    values: [f32; P],
}

impl<const P: usize> Segment<P> {
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
    pub(super) fn add_powers(mut self, powers: &mut [f32], squares: &mut [f32]) {
        self.transform();
        let highest = self.separate();
        let (pairs, _) = self.values.as_chunks::<2>();
        let Some([before, here, later @ ..]) = pairs.get(first_bin(P).wrapping_sub(1)..) else {
            return;
        };
        let (mut before, mut here) = (before, here);
        let mut sums = powers.iter_mut().zip(squares);
        for (after, (sum, square)) in later.iter().zip(&mut sums) {
            add_power(windowed_power(before, here, after), sum, square);
            (before, here) = (here, after);
        }
        // The neighbour of the last bin lies elsewhere.
        if let Some((sum, square)) = sums.next() {
            add_power(windowed_power(before, here, &highest), sum, square);
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
    fn separate(&mut self) -> Complex {
        let (pairs, _) = self.values.as_chunks_mut::<2>();
        let highest = pairs.first().map_or(0.0, |[re, im]| 2.0 * (re - im));
        let Some((low, high)) = pairs.split_at_mut_checked(P / 4) else {
            return [0.0; 2];
        };
        if let Some([re, im]) = high.first_mut() {
            [*re, *im] = [2.0 * *re, -2.0 * *im];
        }
        let low = low.split_first_mut().map_or(&mut [][..], |(_, rest)| rest);
        let both = low.iter_mut().zip(high.iter_mut().rev());
        for ((low, high), k) in both.zip(1..usize::MAX) {
            let ([ar, ai], [br, bi]) = (*low, *high);
            let [sum_re, sum_im] = [ar + br, ai - bi];
            let [difference_re, difference_im] = [ar - br, ai + bi];
            let (cosine, sine) = twiddle(k, P);
            let re = cosine * difference_im - sine * difference_re;
            let im = cosine * difference_re + sine * difference_im;
            *low = [sum_re + re, sum_im - im];
            *high = [sum_re - re, -(sum_im + im)];
        }
        [highest, 0.0]
    }
}

/// The power of a bin of the windowed segment, from twice the transform of the segment at the bin and its
/// neighbours: the window is `½ − ¼ e^(iθj) − ¼ e^(−iθj)`.
#[inline(always)]
fn windowed_power(before: &Complex, here: &Complex, after: &Complex) -> f32 {
    let re = 2.0 * here[0] - (before[0] + after[0]);
    let im = 2.0 * here[1] - (before[1] + after[1]);
    re * re + im * im
}

/// Adds a power and its square to the sums of a bin.
#[inline(always)]
fn add_power(power: f32, sum: &mut f32, square: &mut f32) {
    *sum += power;
    *square += power * power;
}

/// Joins the transforms in the two halves of a group to the transform of `length` pairs.
#[inline]
fn join(group: &mut [f32], length: usize) {
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
        let [turned_re, turned_im] = [cosine * re + sine * im, cosine * im - sine * re];
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
    use crate::spectrum::window::bins;
    use crate::test_random::Random;
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
