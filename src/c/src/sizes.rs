//! The sizes of the caller's memory, in words of 64 bits. They suffice for every core, and for a host of 64 bits.

/// The number of axes of a record.
pub const ALLANITE_AXES: usize = 3;

/// The number of octaves of a record. Code for another number is compiled with `ALLANITE_OCTAVES_14` or
/// `ALLANITE_OCTAVES_26`, as this library is with a feature.
#[cfg(feature = "octaves-14")]
pub const ALLANITE_OCTAVES: usize = 14;
/// The number of octaves of a record. Code for another number is compiled with `ALLANITE_OCTAVES_14` or
/// `ALLANITE_OCTAVES_26`, as this library is with a feature.
#[cfg(all(feature = "octaves-26", not(feature = "octaves-14")))]
pub const ALLANITE_OCTAVES: usize = 26;
/// The number of octaves of a record. Code for another number is compiled with `ALLANITE_OCTAVES_14` or
/// `ALLANITE_OCTAVES_26`, as this library is with a feature.
#[cfg(not(any(feature = "octaves-14", feature = "octaves-26")))]
pub const ALLANITE_OCTAVES: usize = 20;

/// Words of an `AllaniteGyro`.
pub const ALLANITE_GYRO_WORDS: usize = 4140 + 141 * ALLANITE_OCTAVES;
/// Words of an `AllaniteAxis`.
pub const ALLANITE_AXIS_WORDS: usize = 24 + 12 * ALLANITE_OCTAVES;
/// Words of an `AllaniteRecord`.
pub const ALLANITE_RECORD_WORDS: usize = 500 + 17 * ALLANITE_OCTAVES;
/// Words of an `AllaniteSelfTest`.
pub const ALLANITE_SELF_TEST_WORDS: usize = 38;
/// Words of an `AllaniteLook`.
pub const ALLANITE_LOOK_WORDS: usize = 74 + 3 * ALLANITE_OCTAVES;
/// Words of an `AllaniteDiagnosis`.
pub const ALLANITE_DIAGNOSIS_WORDS: usize = 1652 + 10 * ALLANITE_OCTAVES;
/// Words of an `AllaniteCertificate`.
pub const ALLANITE_CERTIFICATE_WORDS: usize = 560;
/// Bytes of a buffer for any snapshot of a record and a self-test.
pub const ALLANITE_SNAPSHOT_BYTES: usize = 26115 + 745 * ALLANITE_OCTAVES;
/// Bytes of a buffer for any certificate.
pub const ALLANITE_CERTIFICATE_BYTES: usize = 3700;
