//! allanite for C: the record of a three-axis gyro with a temperature, its record, fit, diagnosis, self-test, snapshots
//! and certificates.
//!
//! `include/allanite.h` declares all of it, and `cargo xtask c` builds a static library for every core. All memory belongs
//! to the caller, and all work is done in pieces, so that a main loop goes on:
//!
//! ```c
//! #include "allanite.h"
//!
//! static AllaniteGyro gyro;
//! static AllaniteRecord record;
//! static AllaniteDiagnosis diagnosis;
//!
//! static bool pause(void *context) { feed_watchdog(); return true; }
//!
//! allanite_gyro_init(&gyro, sizeof gyro);
//! while (recording) allanite_gyro_push(&gyro, counts, temperature);
//! allanite_gyro_release(&gyro);
//! allanite_record_take(&record, sizeof record, &gyro, 0, 1.0f / 131, 100.0f, 0.01f);
//! allanite_diagnosis_begin(&diagnosis, sizeof diagnosis, &record);
//! AllaniteProgress progress;
//! do {
//!     allanite_diagnosis_advance_with(&diagnosis, &progress, pause, NULL);
//! } while (progress <= ALLANITE_PROGRESS_STEP);
//! AllaniteFit fit;
//! allanite_diagnosis_fit(&diagnosis, &fit);
//! ```
//!
//! Every function returns an [`AllaniteStatus`]. It refuses null pointers, memory of another size than that of this
//! library, and memory in which no value was made. It cannot check that a pointer points to as much memory as its type
//! says, and that nothing else uses it: the callers' duties stand under *Safety*.
//!
//! A core with little memory records one axis and fits the five terms alone: `AllaniteAxis`. A library with the feature
//! `one-axis` has nothing else, and C code then defines `ALLANITE_ONE_AXIS`.
//!
//! A static library computes in single precision and for one number of octaves: 20, or 14 or 26 with the feature
//! `octaves-14` or `octaves-26`, for which C code defines `ALLANITE_OCTAVES_14` or `ALLANITE_OCTAVES_26`.

#![cfg_attr(target_os = "none", no_std)]
// A value of C is behind a pointer. Each block says why it is sound.
#![allow(unsafe_code)]

mod axis;
#[cfg(not(feature = "one-axis"))]
mod certificate;
#[cfg(not(feature = "one-axis"))]
mod checks;
mod codes;
mod coefficient;
mod curve;
#[cfg(not(feature = "one-axis"))]
mod diagnosis;
#[cfg(not(feature = "one-axis"))]
mod fit;
#[cfg(not(feature = "one-axis"))]
mod gyro;
mod memory;
#[cfg(not(feature = "one-axis"))]
mod names;
#[cfg(not(feature = "one-axis"))]
mod reason;
#[cfg(not(feature = "one-axis"))]
mod self_test;
mod sizes;
#[cfg(not(feature = "one-axis"))]
mod snapshot;
mod status;

pub use axis::*;
#[cfg(not(feature = "one-axis"))]
pub use certificate::*;
pub use codes::*;
pub use coefficient::*;
pub use curve::*;
#[cfg(not(feature = "one-axis"))]
pub use diagnosis::*;
#[cfg(not(feature = "one-axis"))]
pub use fit::*;
#[cfg(not(feature = "one-axis"))]
pub use gyro::*;
#[cfg(not(feature = "one-axis"))]
pub use names::*;
#[cfg(not(feature = "one-axis"))]
pub use reason::*;
#[cfg(not(feature = "one-axis"))]
pub use self_test::*;
pub use sizes::*;
#[cfg(not(feature = "one-axis"))]
pub use snapshot::*;
pub use status::*;

/// The panic handler of the static library. No code can panic; the linker needs it nevertheless.
#[cfg(all(target_os = "none", not(test)))]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
