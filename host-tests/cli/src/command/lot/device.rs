//! A device of a lot, as its certificate describes it.

use allanite::{
    diagnosis::Verdict,
    storage::{AxisCertificate, Certificate, CertifiedTerm},
};
use allanite_host::{lot::Measurement, stationarity::is_disturbed};
use allanite_log::unit::Unit;
use std::path::PathBuf;

/// What a coefficient of an axis is called: the place of the axis, and the name of the effect.
pub(super) type Place = (usize, &'static str);

/// What the results of a device were read from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    Certificate,
    Curve,
    Log,
}

impl Source {
    /// The source as it is written in tables.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Certificate => "certificate",
            Self::Curve => "curve",
            Self::Log => "log",
        }
    }
}

/// A device of a lot.
pub(super) struct Device {
    /// Its identity; that of a log or a curve file is the name of the file.
    pub(super) id: String,
    pub(super) unit: Unit,
    pub(super) file: PathBuf,
    pub(super) source: Source,
    pub(super) certificate: Certificate,
}

impl Device {
    /// The axes whose coefficients mean something, each with its place.
    fn valid(&self) -> impl Iterator<Item = (usize, &AxisCertificate)> {
        let axes = self.certificate.axes.iter().enumerate();
        axes.filter(|(_, axis)| !is_invalid(axis) && !is_disturbed(axis))
    }

    /// The terms of these axes, each with its place.
    pub(super) fn terms(&self) -> impl Iterator<Item = (Place, &CertifiedTerm)> {
        self.valid().flat_map(|(i, axis)| {
            let terms = axis.terms.iter();
            terms.map(move |term| ((i, term.effect.name()), term))
        })
    }

    /// What is known of a coefficient; `None` if nothing is.
    pub(super) fn measurement(&self, place: Place) -> Option<Measurement> {
        let mut terms = self.terms();
        let (_, term) = terms.find(|(other, _)| *other == place)?;
        Measurement::of(term)
    }

    /// The places of the axes whose verdict is one of these.
    pub(super) fn axes_with(&self, wanted: fn(Verdict) -> bool) -> impl Iterator<Item = usize> {
        let axes = self.certificate.axes.iter().enumerate();
        let with = axes.filter(move |(_, axis)| axis.verdict.is_some_and(wanted));
        with.map(|(i, _)| i)
    }
}

/// Whether the record of an axis is not valid.
pub(super) fn is_invalid(axis: &AxisCertificate) -> bool {
    matches!(axis.verdict, Some(Verdict::Invalid(_)))
}
