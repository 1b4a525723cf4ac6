//! The precision of everything behind the counts: curve, fit, comparison and diagnosis.

use num_traits::AsPrimitive;

/// A number of a curve, a fit, a comparison or a diagnosis: double precision with the feature `double`,
/// which is on unless default features are off; single precision without.
///
/// Without, a core with single precision in hardware fits in a third of the time, and any core in two
/// thirds of the flash. What comes out differs by some 10⁻⁴ of the standard errors. One program has one
/// precision: whatever asks for `double` gives it to all.
#[cfg(feature = "double")]
pub type Real = f64;

/// A number of a curve, a fit, a comparison or a diagnosis: single precision, as the feature `double` is
/// off.
#[cfg(not(feature = "double"))]
pub type Real = f32;

#[cfg(not(feature = "double"))]
pub(crate) use core::f32::consts;
#[cfg(feature = "double")]
pub(crate) use core::f64::consts;

/// The nearest number.
pub(crate) fn real(x: impl AsPrimitive<Real>) -> Real {
    x.as_()
}

/// The nearest number in single precision, for what nothing more depends on.
pub(crate) fn single(x: Real) -> f32 {
    x.as_()
}

/// The same number in double precision, for what is stored or logged.
pub(crate) fn double(x: Real) -> f64 {
    x.as_()
}

/// A constant that depends on the precision: a limit of rounding or of range.
#[cfg(feature = "double")]
pub(crate) const fn by_precision(double: f64, _single: f32) -> Real {
    double
}

/// A constant that depends on the precision: a limit of rounding or of range.
#[cfg(not(feature = "double"))]
pub(crate) const fn by_precision(_double: f64, single: f32) -> Real {
    single
}
