//! The precision of everything behind the counts: curve, fit, comparison and diagnosis.

use num_traits::AsPrimitive;

/// The type of the numbers of a curve, a fit, a comparison and a diagnosis: `f64`, because the feature
/// `double` is on.
///
/// The feature is for final programs on a workstation only. A library must not ask for it: cargo builds
/// this crate once for a whole program, so that the type changes for every other crate in the build.
#[cfg(feature = "double")]
pub type Real = f64;

/// The type of the numbers of a curve, a fit, a comparison and a diagnosis: `f32`, because the feature
/// `double` is off.
///
/// Single precision needs two thirds of the flash of double precision, and a third of the time for a fit
/// on a core that computes single precision in hardware. The results differ by some 10⁻⁴ of their
/// standard errors. The feature `double` changes this type to `f64`. It is for final programs on a
/// workstation only. A library must not ask for it: cargo builds this crate once for a whole program, so
/// that the type changes for every other crate in the build. Code that shall compile with either type
/// writes `Real`.
#[cfg(not(feature = "double"))]
pub type Real = f32;

#[cfg(not(feature = "double"))]
pub(crate) use core::f32::consts;
#[cfg(feature = "double")]
pub(crate) use core::f64::consts;

/// The nearest number in the library's precision.
pub(crate) fn real(x: impl AsPrimitive<Real>) -> Real {
    x.as_()
}

/// The nearest number in single precision, for values on which nothing else depends.
pub(crate) fn single(x: Real) -> f32 {
    x.as_()
}

/// The same number in double precision, for values that are stored or logged.
#[cfg(any(test, feature = "storage"))]
pub(crate) fn double(x: Real) -> f64 {
    x.as_()
}

/// A constant that depends on the precision, such as a limit of rounding or of range.
#[cfg(feature = "double")]
pub(crate) const fn by_precision(double: f64, _single: f32) -> Real {
    double
}

/// A constant that depends on the precision, such as a limit of rounding or of range.
#[cfg(not(feature = "double"))]
pub(crate) const fn by_precision(_double: f64, single: f32) -> Real {
    single
}
