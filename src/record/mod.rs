//! What runs for every sample: integers only, in a bounded number of instructions.
//!
//! Nothing in this folder knows a unit, a rate or a floating-point number, and it names no module outside of it but
//! lists and the encoding of stored data. A test of the sources keeps it so. The floats begin in `evidence`, which
//! reads these sums, and in `spectrum`, whose segments are transformed while the main loop has nothing else to do.

pub(crate) mod axis;
pub(crate) mod course;
pub(crate) mod cross_sums;
pub(crate) mod faults;
pub(crate) mod fourth_moments;
pub mod integrity;
pub(crate) mod lags;
pub mod octave;
pub mod queue;
pub(crate) mod reads;
pub(crate) mod screen;
pub(crate) mod square_sum;
