//! What is known of a record in addition to its curve.

use crate::{
    covariate::{CrossCurve, Pair},
    integrity::Reason,
    kurtosis::Kurtosis,
};

/// What is known of a record in addition to its curve. All of it is optional.
#[derive(Clone, Copy, Debug)]
pub struct Evidence<'a, const K: usize> {
    /// The kurtosis, which distinguishes effects that share their Allan variance.
    pub kurtosis: Option<&'a Kurtosis<K>>,
    /// The covariates that the rate may follow. One of them is taken into account, the one with the
    /// surest slope, or a pair of them. If two covariates take the same course, their cross sums with the
    /// gyro do not tell which one the rate follows.
    pub covariates: &'a [CrossCurve<K>],
    /// The covariates that may act together, such as a temperature and its rate of change.
    pub pairs: &'a [Pair<K>],
    /// Why the curve is not valid, as judged by [`Integrity`](crate::integrity::Integrity); `None` if
    /// it is valid.
    pub invalid: Option<Reason>,
}

impl<const K: usize> Evidence<'_, K> {
    /// No evidence in addition to the curve.
    pub const NONE: Self = Self {
        kurtosis: None,
        covariates: &[],
        pairs: &[],
        invalid: None,
    };
}
