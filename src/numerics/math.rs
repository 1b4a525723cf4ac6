//! Every transcendental function of the library, as a named function. A method such as `x.sqrt()`
//! becomes std's once anything in a build links std, and then host and target compute different
//! numbers.

use crate::numerics::real::{Real, consts::PI, real, single};
#[cfg(feature = "double")]
pub(crate) use libm::sqrt as short_sqrt;
#[cfg(feature = "double")]
pub(crate) use libm::{ceil, erfc, exp, floor, log, sqrt};
#[cfg(not(feature = "double"))]
pub(crate) use libm::{ceilf as ceil, expf as exp, floorf as floor, logf as log, sqrtf as sqrt};
/// The square root where flash counts for more than the last bit.
#[cfg(not(feature = "double"))]
pub(crate) use root as short_sqrt;

/// The complementary error function, accurate to 2e-5 of its value. That of libm takes 1.3 KB of
/// flash on a Cortex-M0.
///
/// For small numbers, it is the series of Abramowitz & Stegun 1964, eq. 7.1.6, and for large ones the continued fraction of
/// eq. 7.1.14.
#[cfg(not(feature = "double"))]
pub(crate) fn erfc(x: f32) -> f32 {
    use core::f32::consts::FRAC_2_SQRT_PI;
    /// The square from which on the fraction is better, and the terms of both.
    const LARGE: f32 = 2.0;
    const SERIES_TERMS: u8 = 14;
    const FRACTION_TERMS: u8 = 30;

    let (size, square) = (x.abs(), x * x);
    let decay = FRAC_2_SQRT_PI * exp(-square);
    let above = if square < LARGE {
        let (mut sum, mut term) = (1.0, 1.0);
        for n in 1..=SERIES_TERMS {
            term *= 2.0 * square / (2.0 * f32::from(n) + 1.0);
            sum += term;
        }
        1.0 - size * decay * sum
    } else {
        let mut fraction = 0.0;
        for n in (1..=FRACTION_TERMS).rev() {
            fraction = 0.5 * f32::from(n) / (size + fraction);
        }
        0.5 * decay / (size + fraction)
    };
    if x < 0.0 { 2.0 - above } else { above }
}

/// The integer part. What `as` does for a float costs three comparisons, and each of them is a call on a core that has no
/// unit for floats.
#[cfg_attr(target_abi = "eabihf", inline(always))]
#[cfg_attr(not(target_abi = "eabihf"), inline(never))]
pub(crate) fn truncated(value: f32) -> i32 {
    // One instruction, with the same numbers.
    if cfg!(target_abi = "eabihf") {
        return (value as i32).max(-i32::MAX);
    }

    let bits = value.to_bits();
    let mantissa = (bits & 0x7F_FFFF | 0x80_0000) as i32;
    // The mantissa is the size times this power of two.
    let shift = 150_i32.wrapping_sub((bits.wrapping_shr(23) & 0xFF) as i32);
    let size = match shift {
        0.. => mantissa.wrapping_shr(shift.min(31) as u32),
        -7..0 => mantissa.wrapping_shl(shift.wrapping_neg() as u32),
        _ => i32::MAX,
    };
    if (bits as i32) < 0 {
        size.wrapping_neg()
    } else {
        size
    }
}

/// The square root of a normal number to the last bit or so, and 0 for others: Newton's method from a start that halves the
/// exponent. That of libm needs a table, and half a kilobyte in all.
pub(crate) fn root(x: f32) -> f32 {
    // A number above zero that is normal, by its bits: a comparison is a call on a core that has no unit for floats.
    let least = f32::MIN_POSITIVE.to_bits();
    let is_normal = x.to_bits().wrapping_sub(least) < f32::INFINITY.to_bits().wrapping_sub(least);
    if !is_normal {
        return 0.0;
    }
    // Within 4 %, which three steps square to 1e-11.
    let mut root = f32::from_bits((x.to_bits() >> 1).wrapping_add(0x1FBB_67A8));
    for _ in 0..3 {
        root = 0.5 * (root + x / root);
    }
    root
}

/// Sine and cosine of an angle in turns, accurate to 3e-16 (2e-7 in single precision). Whole quadrants
/// are subtracted exactly, and the rest is small enough for Taylor's series. libm's reduction of angles
/// of any size would cost 4 KB of flash and 700 bytes of stack.
pub(crate) fn sincos_of_turns(turns: Real) -> (Real, Real) {
    let turns = turns - floor(turns);
    let quadrant = floor(4.0 * turns + 0.5);
    let rest = 2.0 * PI * (turns - 0.25 * quadrant);
    let square = rest * rest;
    // The series are x − x³/3! + … for the sine and 1 − x²/2! + … for the cosine.
    let (mut sine, mut cosine) = (0.0, 0.0);
    for [odd, even] in SERIES {
        sine = odd - square * sine;
        cosine = even - square * cosine;
    }
    let sine = rest * sine;
    match quadrant as u8 {
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        3 => (-cosine, sine),
        _ => (sine, cosine),
    }
}

/// The number of terms of the series. At an eighth of a turn, the terms left out are below 1e-17, or
/// below 1e-9 in single precision.
const TERMS: usize = if cfg!(feature = "double") { 10 } else { 6 };

/// The numbers `1/(2k+1)!` and `1/(2k)!`, the highest k first.
const SERIES: [[Real; 2]; TERMS] = {
    let mut series = [[1.0; 2]; TERMS];
    let (mut factorial, mut k) = (1.0_f64, 1);
    while k < TERMS {
        factorial *= (2 * k) as f64;
        // factorial is (2k)!, which is exact in 53 bits up to 18!.
        series[TERMS - 1 - k][1] = (1.0 / factorial) as Real;
        factorial *= (2 * k + 1) as f64;
        series[TERMS - 1 - k][0] = (1.0 / factorial) as Real;
        k += 1;
    }
    series
};

/// The sine of the angle `i` of `turn`, up to an eighth of a turn, for tables computed by the compiler.
pub(crate) const fn sine_series(i: usize, turn: usize) -> f64 {
    series(i, turn, 1)
}

/// The cosine of the angle `i` of `turn`, up to an eighth of a turn, for tables computed by the compiler.
pub(crate) const fn cosine_series(i: usize, turn: usize) -> f64 {
    series(i, turn, 0)
}

/// Taylor's series whose first term is the power `first` of the angle: the sine for 1, the cosine for 0.
const fn series(i: usize, turn: usize, first: u32) -> f64 {
    let angle = 2.0 * core::f64::consts::PI * i as f64 / turn as f64;
    let square = angle * angle;
    // The terms left out are below 1e-20.
    let mut k = first + 20;
    let mut sum = 1.0;
    while k > first {
        sum = 1.0 - square * sum / (k * (k - 1)) as f64;
        k -= 2;
    }
    if first == 1 { angle * sum } else { sum }
}

/// The binary logarithm, accurate to about a percent. It sets the number of steps of a search grid.
pub(crate) fn log2_roughly(x: Real) -> Real {
    real(micromath::F32(single(x)).log2().0)
}

/// The whole part of the binary logarithm. It is 0 for 0, where `ilog2` panics.
pub(crate) const fn floor_log2(n: u32) -> u32 {
    (u32::BITS - 1) ^ (n | 1).leading_zeros()
}

/// The natural logarithm of an integer above 0, for tables computed by the compiler.
pub(crate) const fn log_of_integer(i: u32) -> f64 {
    // With i = 2^exponent · mantissa and the mantissa x in [1, 2), ln x = 2 artanh((x − 1)/(x + 1)).
    let exponent = i.ilog2();
    let mantissa = i as f64 / (1_u64 << exponent) as f64;
    let t = (mantissa - 1.0) / (mantissa + 1.0);
    let t2 = t * t;
    // Because t² ≤ 1/9, nineteen terms leave less than 1e-19.
    let mut k = 37;
    let mut sum = 0.0;
    while k > 0 {
        sum = sum * t2 + 1.0 / k as f64;
        k -= 2;
    }
    exponent as f64 * core::f64::consts::LN_2 + 2.0 * t * sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::real::{by_precision, double};

    #[test]
    fn roots_are_those_of_the_standard_library() {
        let mut x = 1e-37_f32;
        while x < 1e37 {
            let exact = libm::sqrtf(x);
            assert!((root(x) / exact - 1.0).abs() < 2e-7, "{x}");
            x *= 1.017;
        }
        for none in [0.0, -1.0, f32::NAN, 1e-40] {
            assert_eq!(root(none), 0.0);
        }
    }

    #[cfg(not(feature = "double"))]
    #[test]
    fn the_error_function_is_that_of_libm() {
        for i in -2000..6000 {
            let x = 0.0015 * i as f32;
            let (found, exact) = (f64::from(erfc(x)), libm::erfc(f64::from(x)));
            assert!((found / exact - 1.0).abs() < 2e-5, "{x}: {found} {exact}");
        }
        assert_eq!((erfc(30.0), erfc(-30.0)), (0.0, 2.0));
        assert!(erfc(f32::NAN).is_nan());
    }

    #[test]
    fn sine_and_cosine_are_those_of_libm() {
        for i in -3000..3000 {
            let turns = real(i) / 1009.0;
            // libm takes the angle in radians, which is rounded. Below one turn, the rounding is small.
            let angle = 2.0 * core::f64::consts::PI * double(turns - floor(turns));
            let (sine, cosine) = sincos_of_turns(turns);
            let off = |found: Real, expected: f64| (double(found) - expected).abs();
            let most = by_precision(8e-16, 4e-7);
            assert!(
                off(sine, libm::sin(angle)) < double(most),
                "sine of {turns}"
            );
            assert!(
                off(cosine, libm::cos(angle)) < double(most),
                "cosine of {turns}"
            );
        }
        assert_eq!(sincos_of_turns(0.25), (1.0, 0.0));
        assert_eq!(sincos_of_turns(-0.5), (0.0, -1.0));
    }

    #[test]
    fn integer_parts_are_those_of_the_language() {
        let mut random = 1_u32;
        for _ in 0..100_000 {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let value = f32::from_bits(random);
            let expected = if value.is_nan() {
                continue;
            } else {
                value as i32
            };
            // The language's range is not symmetric.
            assert_eq!(truncated(value), expected.max(-i32::MAX), "{value}");
        }
    }

    #[test]
    fn floors_of_binary_logarithms_are_those_of_core() {
        assert_eq!(floor_log2(0), 0);
        for n in (1..70_000).chain(u32::MAX - 3..=u32::MAX) {
            assert_eq!(floor_log2(n), n.ilog2());
        }
    }
}
