//! Numbers of the library as double precision, whatever the library computes in.

/// The same number in double precision.
pub(crate) fn double(x: impl Into<f64>) -> f64 {
    x.into()
}
