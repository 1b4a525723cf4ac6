//! Data that survive a loss of power: snapshots of a record in progress, certificates of a finished record,
//! and a store in flash for them. Everything is stored in an [`envelope`] with a checksum.

pub mod axes;
pub mod certificate;
pub mod envelope;
mod error;
#[cfg(feature = "flash")]
mod flash;
mod interval;
#[cfg(feature = "flash")]
mod page_ring;
pub mod snapshot;
#[cfg(feature = "flash")]
mod store_error;

pub use certificate::{
    AxisCertificate, Certificate, CertifiedBand, CertifiedEvent, CertifiedLimit, CertifiedShape,
    CertifiedSlope, CertifiedState, CertifiedTerm, CertifiedWhat, Conditions, Doubt, EffectCode,
    Findings, MAX_AXES, MAX_COVARIATES, MAX_DEVICE_BYTES, MAX_DOUBTS, RateUnit,
};
pub use error::Error;
#[cfg(feature = "flash")]
pub use flash::SnapshotStore;
pub use interval::SnapshotInterval;
pub use snapshot::Snapshot;
#[cfg(feature = "flash")]
pub use store_error::StoreError;
