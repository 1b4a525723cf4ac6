//! Everything that is kept of a record of one axis.

use crate::{
    curve::Curve,
    error::Error,
    evidence::{
        course::CosineTransform,
        covariate::{CrossCurve, Pair},
        kurtosis::Kurtosis,
        observed::Observed,
    },
    record::integrity::Reason,
    spectrum::Spectrum,
};

/// Everything that is kept of a record of one axis, which a [`Diagnosis`](crate::diagnosis::Diagnosis) judges. All but
/// the curve is optional: the more is kept, the more effects can be distinguished.
///
/// A curve alone is a record too: `(&curve).into()`.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Record<'a, const K: usize, const B: usize = 0> {
    /// The Allan curve. It knows the rate and the unit of the record.
    pub curve: &'a Curve<K>,
    /// The power spectral densities, which show lines, resonances and filters.
    pub spectrum: Option<&'a Spectrum<B>>,
    /// The cosine transform of the course, which shows slow noise.
    pub course: Option<&'a CosineTransform>,
    /// The kurtosis, which distinguishes effects that share their Allan variance.
    pub kurtosis: Option<&'a Kurtosis<K>>,
    /// The covariates that the rate may follow. One of them is taken into account, the one with the
    /// surest slope, or a pair of them. If two covariates take the same course, their cross sums with the
    /// gyro do not show which one the rate follows.
    pub covariates: &'a [CrossCurve<K>],
    /// The covariates that may act together, such as a temperature and its rate of change.
    pub pairs: &'a [Pair<K>],
    /// Why the curve is not valid, as judged by [`Integrity`](crate::integrity::Integrity); `None` if
    /// it is valid.
    pub invalid: Option<Reason>,
}

impl<'a, const K: usize, const B: usize> Record<'a, K, B> {
    /// A curve and the spectrum of the same record, and nothing else.
    pub const fn new(curve: &'a Curve<K>, spectrum: &'a Spectrum<B>) -> Self {
        Self {
            curve,
            spectrum: Some(spectrum),
            course: None,
            kurtosis: None,
            covariates: &[],
            pairs: &[],
            invalid: None,
        }
    }

    /// # Errors
    /// [`Error::Invalid`] if the record is not one of a gyro at rest.
    pub(crate) fn check(&self) -> Result<(), Error> {
        self.invalid
            .map_or(Ok(()), |reason| Err(Error::Invalid(reason)))
    }

    /// What a fit works on: the curve and the spectrum.
    pub(crate) fn observed(&self) -> Observed<'a, K, B> {
        match self.spectrum {
            Some(spectrum) => Observed::new(self.curve, spectrum),
            None => Observed::of_curve(self.curve),
        }
    }
}

impl<'a, const K: usize, const B: usize> From<&Record<'a, K, B>> for Record<'a, K, B> {
    fn from(record: &Self) -> Self {
        *record
    }
}

impl<'a, const K: usize> From<&'a Curve<K>> for Record<'a, K> {
    fn from(curve: &'a Curve<K>) -> Self {
        Self {
            curve,
            spectrum: None,
            course: None,
            kurtosis: None,
            covariates: &[],
            pairs: &[],
            invalid: None,
        }
    }
}
