//! Checks at compile time that the sizes in the header suffice.

use crate::{
    axis::AllaniteAxis,
    certificate::AllaniteCertificate,
    diagnosis::AllaniteDiagnosis,
    fit::AllaniteRecord,
    gyro::{AllaniteGyro, Gyro},
    memory::{Marked, Memory},
    self_test::{AllaniteLook, AllaniteSelfTest},
    sizes::{
        ALLANITE_AXIS_WORDS, ALLANITE_CERTIFICATE_BYTES, ALLANITE_CERTIFICATE_WORDS,
        ALLANITE_DIAGNOSIS_WORDS, ALLANITE_GYRO_WORDS, ALLANITE_LOOK_WORDS, ALLANITE_RECORD_WORDS,
        ALLANITE_SELF_TEST_WORDS, ALLANITE_SNAPSHOT_BYTES,
    },
};
use allanite::{Real, storage::Certificate};

/// The words that a value takes, the mark before it included.
const fn words<M: Memory>() -> usize {
    size_of::<Marked<M::Value>>().div_ceil(8)
}

/// Whether a limit suffices for what is needed, and is at most a tenth larger.
const fn suits(limit: usize, needed: usize) -> bool {
    limit >= needed && 10 * limit <= 11 * needed + 100
}

// Double precision needs more. `memory::make` then refuses all memory.
const _: () = assert!(
    size_of::<Real>() > 4
        || size_of::<usize>() < 8
        || (suits(ALLANITE_AXIS_WORDS, words::<AllaniteAxis>())
            && suits(ALLANITE_GYRO_WORDS, words::<AllaniteGyro>())
            && suits(ALLANITE_RECORD_WORDS, words::<AllaniteRecord>())
            && suits(ALLANITE_SELF_TEST_WORDS, words::<AllaniteSelfTest>())
            && suits(ALLANITE_LOOK_WORDS, words::<AllaniteLook>())
            && suits(ALLANITE_DIAGNOSIS_WORDS, words::<AllaniteDiagnosis>())
            && suits(ALLANITE_CERTIFICATE_WORDS, words::<AllaniteCertificate>()))
);
// No core needs more than the host.
const _: () = assert!(
    size_of::<Real>() > 4
        || (ALLANITE_AXIS_WORDS >= words::<AllaniteAxis>()
            && ALLANITE_GYRO_WORDS >= words::<AllaniteGyro>()
            && ALLANITE_RECORD_WORDS >= words::<AllaniteRecord>()
            && ALLANITE_SELF_TEST_WORDS >= words::<AllaniteSelfTest>()
            && ALLANITE_LOOK_WORDS >= words::<AllaniteLook>()
            && ALLANITE_DIAGNOSIS_WORDS >= words::<AllaniteDiagnosis>()
            && ALLANITE_CERTIFICATE_WORDS >= words::<AllaniteCertificate>())
);
const _: () = assert!(suits(ALLANITE_SNAPSHOT_BYTES, Gyro::snapshot_bytes(1)));
const _: () = assert!(suits(ALLANITE_CERTIFICATE_BYTES, Certificate::MAX_BYTES));
