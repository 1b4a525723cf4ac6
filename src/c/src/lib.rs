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
//! allanite_gyro_init(&gyro, sizeof gyro, 100.0f);
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
//! A core with little memory records one axis and fits the five terms alone: `AllaniteAxis`. A library without the
//! feature `whole` has nothing else, and C code then defines `ALLANITE_ONE_AXIS`.
//!
//! A static library computes in single precision and for one number of octaves: 20, or 14 or 26 with the feature
//! `octaves-14` or `octaves-26`, for which C code defines `ALLANITE_OCTAVES_14` or `ALLANITE_OCTAVES_26`.

#![cfg_attr(target_os = "none", no_std)]
// A value of C is behind a pointer. Each block says why it is sound.
#![allow(unsafe_code)]

mod axis;
#[cfg(feature = "whole")]
mod certificate;
#[cfg(feature = "whole")]
mod checks;
mod codes;
mod coefficient;
mod curve;
#[cfg(feature = "whole")]
mod diagnosis;
#[cfg(feature = "whole")]
mod fit;
#[cfg(feature = "whole")]
mod gyro;
mod memory;
#[cfg(feature = "whole")]
mod names;
#[cfg(feature = "whole")]
mod reason;
#[cfg(feature = "whole")]
mod self_test;
mod sizes;
#[cfg(feature = "whole")]
mod snapshot;
mod status;

pub use axis::*;
#[cfg(feature = "whole")]
pub use certificate::*;
pub use codes::*;
pub use coefficient::*;
pub use curve::*;
#[cfg(feature = "whole")]
pub use diagnosis::*;
#[cfg(feature = "whole")]
pub use fit::*;
#[cfg(feature = "whole")]
pub use gyro::*;
#[cfg(feature = "whole")]
pub use names::*;
#[cfg(feature = "whole")]
pub use reason::*;
#[cfg(feature = "whole")]
pub use self_test::*;
pub use sizes::*;
#[cfg(feature = "whole")]
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
