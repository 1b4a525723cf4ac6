//! What is known of a record beside its curve.

use crate::{covariate::CrossCurve, integrity::Reason, kurtosis::Kurtosis};

/// What is known of a record beside its curve: all of it optional.
#[derive(Clone, Copy, Debug)]
pub struct Evidence<'a, const K: usize> {
    /// Tells effects apart that share their Allan variance.
    pub kurtosis: Option<&'a Kurtosis<K>>,
    /// What the rate may follow. One covariate is taken into account, the one with the surest slope: of two
    /// that share their course, cross sums with the gyro do not tell which it is.
    pub covariates: &'a [CrossCurve<K>],
    /// Why the curve is not valid, as of [`Integrity`](crate::integrity::Integrity).
    pub invalid: Option<Reason>,
}

impl<const K: usize> Evidence<'_, K> {
    /// No evidence but the curve.
    pub const NONE: Self = Self {
        kurtosis: None,
        covariates: &[],
        invalid: None,
    };
}
