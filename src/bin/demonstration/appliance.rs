//! A whole product that survives power cuts: three axes and a temperature, a self-test at start-up, snapshots in
//! flash, and a diagnosis with a certificate at the end. All of it is done in short pieces, so that a main loop
//! or a task can take the samples and feed a watchdog in between.
//!
//! The [`World`] is what a power cut leaves as it is: the gyros, the number of samples that they have made, and
//! the contents of the flash. A [`Recorder`] and a [`Report`] are the product's own state, which a cut destroys.
//!
//! What the product does depends on the numbers of the samples alone, and not on the time that a piece takes: a
//! snapshot shows the record after a certain sample, and a look of the self-test ends at a certain sample. So the
//! host computes the same bits from a list of the [cuts](Cut) by [`replay`].

mod flash;
mod recorder;
mod replay;
mod report;
mod saver;
mod world;

pub use flash::Flash;
pub use recorder::{Counts, Recorder, Restart};
pub use replay::replay;
pub use report::{GyroRecord, Report};
pub use world::{CUTS, Cut, Plan, Source, Stored, World};

pub use super::product::Failure;
use super::product::OCTAVES;
use allanite::{
    Axes, Real, Scale,
    axis::{Courses, Gated, Moments, Spectral},
};

/// Three axes and a temperature, with a gate, fourth moments, a spectrum and the course.
pub type Gyro = Axes<OCTAVES, 1, Gated, Moments, 3, Spectral<64, 7, 84>, Courses>;

/// The number of samples of the record: 5½ minutes.
pub const SAMPLES: u32 = 1 << 15;

/// The number of samples from one snapshot to the next.
pub const EVERY: u32 = 256;

/// The number of bytes of a buffer for a snapshot.
pub const BUFFER: usize = Gyro::snapshot_bytes(1);

/// The number of samples that the sensor's FIFO hands over at once.
pub const BURST: u32 = 8;

/// The scale of the temperature in kelvin per count.
const KELVIN: Real = 0.01;

/// The scale of the gyros: 131 counts per °/s at 100 Hz.
///
/// # Errors
/// None in practice, because the scale is valid.
pub fn scale() -> Result<Scale, allanite::Error> {
    Scale::new(1.0 / 131.0, 100.0)
}

/// What is left to do after a piece of work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// There is more to do at once.
    Working,
    /// There is nothing to do before the next sample.
    Idle,
    /// Everything is done.
    Complete,
}
