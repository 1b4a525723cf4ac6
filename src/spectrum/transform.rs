//! The windowed transform of one segment.

use super::window::{bins, cosine_and_sine, first_bin};
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
    /// The segment whose block `j` has the value `value(j)`.
    #[inline]
    pub(super) fn new(value: impl Fn(usize) -> f32) -> Self {
        let mut values = [0.0; P];
        let (pairs, _) = values.as_chunks_mut::<2>();
        // The number of bits in the number of a pair.
        let bits = (P / 2).trailing_zeros();
        for ([even, odd], slot) in pairs.iter_mut().zip(0_u32..) {
            let pair = slot
                .reverse_bits()
                .wrapping_shr(u32::BITS.wrapping_sub(bits)) as usize;
            *even = value(pair.wrapping_mul(2));
            *odd = value(pair.wrapping_mul(2).wrapping_add(1));
        }
        Self { values }
    }

    /// Hands `|8 Σ_j w_j y_j e^(−2πijk/P)|²` to `each`, for the bins `k` that are kept, in their order.
    #[inline]
    pub(super) fn powers(mut self, mut each: impl FnMut(f32)) {
        self.transform();
        let first = first_bin(P);
        let mut before = self.bin(first.wrapping_sub(1));
        let mut here = self.bin(first);
        for k in (first..P / 2).take(bins(P)) {
            let after = self.bin(k.wrapping_add(1));
            // The window is ½ − ¼ e^(iθj) − ¼ e^(−iθj), so that it mixes neighbouring bins.
            let re = 2.0 * here[0] - (before[0] + after[0]);
            let im = 2.0 * here[1] - (before[1] + after[1]);
            each(re * re + im * im);
            (before, here) = (here, after);
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

    /// `2 Σ_j y_j e^(−2πijk/P)` after the transform, for `k` from 1 to P/2.
    #[inline]
    fn bin(&self, k: usize) -> Complex {
        let [ar, ai] = self.pair(k);
        let [br, bi] = self.pair((P / 2).wrapping_sub(k));
        let [sum_re, sum_im] = [ar + br, ai - bi];
        let [difference_re, difference_im] = [ar - br, ai + bi];
        let (cosine, sine) = if k == P / 2 {
            (-1.0, 0.0)
        } else {
            twiddle(k, P)
        };
        [
            sum_re + (cosine * difference_im - sine * difference_re),
            sum_im - (cosine * difference_re + sine * difference_im),
        ]
    }

    /// The pair of a number up to P/2, which stands for 0.
    #[inline(always)]
    fn pair(&self, k: usize) -> Complex {
        let (pairs, _) = self.values.as_chunks::<2>();
        pairs.get(k % (P / 2)).copied().unwrap_or([0.0; 2])
    }
}

/// Joins the transforms in the two halves of a group to the transform of `length` pairs.
#[inline]
fn join(group: &mut [f32], length: usize) {
    let Some((low, high)) = group.split_at_mut_checked(length) else {
        return;
    };
    let ((low, _), (high, _)) = (low.as_chunks_mut::<2>(), high.as_chunks_mut::<2>());
    for ((low, high), i) in low.iter_mut().zip(high).zip(0_usize..) {
        let (cosine, sine) = twiddle(i, length);
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
    let (cosine, sine) = cosine_and_sine(i, length);
    (single(cosine), single(sine))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_random::Random;
    use core::f64::consts::PI;

    fn compare<const P: usize>() {
        let mut random = Random::new(7);
        let values: [f32; P] = core::array::from_fn(|_| random.signed() as f32);
        let mut found = [0.0; P];
        let mut slots = found.iter_mut();
        Segment::<P>::new(|j| values[j]).powers(|power| *slots.next().expect("room") = power);
        assert_eq!(slots.len(), P - bins(P));
        for (k, &power) in (first_bin(P)..).zip(&found[..bins(P)]) {
            let (mut re, mut im) = (0.0, 0.0);
            for (j, &value) in values.iter().enumerate() {
                let weight = 0.5 - 0.5 * libm::cos(2.0 * PI * j as f64 / P as f64);
                let angle = 2.0 * PI * ((j * k) % P) as f64 / P as f64;
                re += weight * f64::from(value) * libm::cos(angle);
                im -= weight * f64::from(value) * libm::sin(angle);
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
