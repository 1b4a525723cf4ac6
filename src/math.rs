//! Every transcendental function of the library, by name: a method such as `x.sqrt()` becomes
//! std's once anything in a build links std, and host and target would compute different numbers.

use core::f64::consts::PI;
pub(crate) use libm::{cbrt, ceil, erfc, exp, expm1, floor, log, sqrt};

/// Sine and cosine of an angle in turns: whole quadrants are taken off exactly, which spares libm's
/// reduction, its time and its 700 bytes of stack.
pub(crate) fn sincos_of_turns(turns: f64) -> (f64, f64) {
    let turns = turns - floor(turns);
    let quadrant = floor(4.0 * turns + 0.5);
    let rest = 2.0 * PI * (turns - 0.25 * quadrant);
    let (sine, cosine) = (libm::sin(rest), libm::cos(rest));
    match quadrant as u8 {
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        3 => (-cosine, sine),
        _ => (sine, cosine),
    }
}

/// The binary logarithm to a percent or so, for the number of steps of a search grid.
pub(crate) fn log2_roughly(x: f64) -> f64 {
    f64::from(micromath::F32(x as f32).log2().0)
}

/// The natural logarithm of an integer above 0, for tables computed by the compiler.
pub(crate) const fn log_of_integer(i: u32) -> f64 {
    // i = 2^exponent · mantissa, with the mantissa in [1, 2): ln = 2 artanh((x − 1)/(x + 1)).
    let exponent = i.ilog2();
    let mantissa = i as f64 / (1_u64 << exponent) as f64;
    let t = (mantissa - 1.0) / (mantissa + 1.0);
    let t2 = t * t;
    // t² ≤ 1/9: eighteen terms leave less than 1e-18.
    let mut k = 37;
    let mut sum = 0.0;
    while k > 0 {
        sum = sum * t2 + 1.0 / k as f64;
        k -= 2;
    }
    exponent as f64 * core::f64::consts::LN_2 + 2.0 * t * sum
}
