//! The Hann window, and the angles of the transform.

use crate::numerics::real::{Real, real};
use crate::{limits::MAX_SEGMENT, numerics::math};

/// The number of angles in a turn, which the table of sines divides evenly.
const TURN: usize = MAX_SEGMENT;

const QUARTER: usize = TURN / 4;

/// The sines of the angles from 0 to one and a quarter turns. A cosine lies a quarter further on.
static SINES: [Real; 5 * QUARTER] = {
    let mut sines = [0.0; 5 * QUARTER];
    let mut i = 0;
    while i < sines.len() {
        sines[i] = sine(i % TURN) as Real;
        i += 1;
    }
    sines
};

/// The sine of the angle `i` of [`TURN`], for the table.
const fn sine(i: usize) -> f64 {
    let (half, sign) = if i < 2 * QUARTER {
        (i, 1.0)
    } else {
        (i - 2 * QUARTER, -1.0)
    };
    // Below an eighth of a turn, the series of the sine is used, above it that of the cosine.
    let near = if half <= QUARTER {
        half
    } else {
        2 * QUARTER - half
    };
    if 2 * near <= QUARTER {
        sign * math::sine_series(near, TURN)
    } else {
        sign * math::cosine_series(QUARTER - near, TURN)
    }
}

/// The number of places of the table from one angle of `length` to the next. `length` is a power of two up to
/// [`MAX_SEGMENT`].
#[inline(always)]
pub(super) const fn places(length: usize) -> usize {
    match TURN.checked_div(length) {
        Some(places) => places,
        None => 0,
    }
}

/// The cosine of the angle at a place. Any multiple of a turn may be added to it.
#[inline(always)]
pub(super) fn cosine(place: usize) -> Real {
    SINES[place % TURN + QUARTER]
}

/// The cosine and the sine of the angle at a place. Any multiple of a turn may be added to it.
#[inline(always)]
pub(super) fn cosine_and_sine(place: usize) -> (Real, Real) {
    (cosine(place), SINES[place % TURN])
}

/// The cosine and the sine of the angle `πk/P`, which is half an angle of a segment of `length` blocks.
#[inline(always)]
pub(super) fn half_cosine_and_sine(k: usize, length: usize) -> (Real, Real) {
    match places(length.wrapping_mul(2)) {
        // The table has no halves of the angles of the longest segment.
        0 => {
            let (sine, cosine) = math::sincos_of_turns(0.5 * real(k) / real(length));
            (cosine, sine)
        }
        places => cosine_and_sine(k.wrapping_mul(places)),
    }
}

/// The first bin of a level with segments of this length.
pub(super) const fn first_bin(length: usize) -> usize {
    length / 16
}

/// The number of bins of a level with segments of this length.
pub(super) const fn bins(length: usize) -> usize {
    length / 2 - length / 16
}

/// The sum of the squares of the window's weights, `Σ w² = 3P/8`.
pub(super) fn sum_of_squares(length: Real) -> Real {
    0.375 * length
}

/// Whether segments can have this length: it is a power of two from 32 to [`MAX_SEGMENT`]. The lowest bin must
/// be 2 or more, because the window spreads a constant to the bins 0 and 1.
pub(super) const fn is_possible(length: usize) -> bool {
    length.is_power_of_two() && length >= 32 && length <= MAX_SEGMENT
}

/// The window's products `c(l) = Σ_j w_j w_{j+l}`, for segments of one length.
///
/// ```text
/// c(l) = ¼ [(P − l)(1 + ½ cos θl) + (¾ q + ¼/q) sin θl],      θ = 2π/P,  q = cot ½θ
/// ```
pub(super) struct Products {
    length: usize,
    /// The factor of the sine.
    factor: Real,
}

impl Products {
    /// The products for segments of this length.
    pub(super) fn new(length: usize) -> Self {
        // The half of θ is not in the table if the length is the largest one.
        let (sine, cosine) = math::sincos_of_turns(0.5 / real(length));
        let cotangent = cosine / sine;
        Self {
            length,
            factor: 0.75 * cotangent + 0.25 / cotangent,
        }
    }

    /// The product at a distance of `l` blocks, less than the length.
    pub(super) fn at(&self, l: usize) -> Real {
        let overlap = real(self.length.saturating_sub(l));
        let (cosine, sine) = cosine_and_sine(l.wrapping_mul(places(self.length)));
        0.25 * (overlap * (1.0 + 0.5 * cosine) + self.factor * sine)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::real::{by_precision, double};
    use core::f64::consts::PI;

    #[test]
    fn the_tables_are_sines_and_cosines() {
        for length in [32_usize, 64, MAX_SEGMENT] {
            for i in 0..3 * length {
                let angle = 2.0 * PI * (i % length) as f64 / length as f64;
                let most = double(by_precision(1e-15, 6e-8));
                let (cosine, sine) = cosine_and_sine(i * places(length));
                assert!((double(cosine) - libm::cos(angle)).abs() < most);
                assert!((double(sine) - libm::sin(angle)).abs() < most);
            }
        }
    }

    #[test]
    fn products_are_those_of_the_window() {
        for length in [32_usize, 64, 256] {
            let weight = |j: usize| 0.5 - 0.5 * libm::cos(2.0 * PI * j as f64 / length as f64);
            let products = Products::new(length);
            for l in 0..length {
                let expected: f64 = (0..length - l).map(|j| weight(j) * weight(j + l)).sum();
                let off = double(products.at(l)) - expected;
                let most = length as f64 * double(by_precision(1e-15, 6e-8));
                assert!(off.abs() < most, "{length}, {l}: {off:e} of {expected}");
            }
            let off = double(products.at(0) - sum_of_squares(real(length)));
            assert!(off.abs() < length as f64 * double(by_precision(1e-15, 1e-7)));
        }
    }
}
