//! Snapshots of a record and of its self-test.

use crate::{
    gyro::AllaniteGyro,
    memory::{get, get_mut, put, slice, slice_mut, status},
    self_test::AllaniteSelfTest,
    sizes::ALLANITE_OCTAVES,
    status::AllaniteStatus,
};
use allanite::self_test::SelfTest;

/// Writes a snapshot of the record and of a self-test, which may be null, to a buffer of
/// `ALLANITE_SNAPSHOT_BYTES`. `written` is set to the number of those that it took.
///
/// # Safety
/// `gyro` is null, or points to an `AllaniteGyro`; `test` is null, or points to an `AllaniteSelfTest`; `buffer` is null, or
/// points to `capacity` bytes; `written` is null, or points to a `size_t`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_gyro_snapshot(
    gyro: *const AllaniteGyro,
    test: *const AllaniteSelfTest,
    buffer: *mut u8,
    capacity: usize,
    written: *mut usize,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get` wants.
    let gyro = match unsafe { get(gyro) } {
        Ok(gyro) => &gyro.axes,
        Err(error) => return error,
    };
    let tests: &[SelfTest<ALLANITE_OCTAVES>] = if test.is_null() {
        &[]
    } else {
        // SAFETY: the caller promises what `get` wants.
        match unsafe { get(test) } {
            Ok(test) => core::slice::from_ref(test),
            Err(error) => return error,
        }
    };
    // SAFETY: the caller promises what `slice_mut` wants.
    let buffer = match unsafe { slice_mut(buffer, capacity) } {
        Ok(buffer) => buffer,
        Err(error) => return error,
    };
    match gyro.snapshot(tests, buffer) {
        Err(error) => error.into(),
        // SAFETY: the caller promises what `put` wants.
        Ok(stored) => status(unsafe { put(written, stored.len()) }),
    }
}

/// Restores a snapshot into a record and into a self-test of the same plan, which must be null if the snapshot was taken
/// without one. After an error, the record is empty and the self-test must be made anew.
///
/// # Safety
/// `gyro` is null, or points to an `AllaniteGyro`; `test` is null, or points to an `AllaniteSelfTest`; `bytes` is null, or
/// points to `length` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_gyro_restore(
    gyro: *mut AllaniteGyro,
    test: *mut AllaniteSelfTest,
    bytes: *const u8,
    length: usize,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `slice` wants.
    let bytes = match unsafe { slice(bytes, length) } {
        Ok(bytes) => bytes,
        Err(error) => return error,
    };
    // SAFETY: the caller promises what `get_mut` wants.
    let gyro = match unsafe { get_mut(gyro) } {
        Ok(gyro) => &mut gyro.axes,
        Err(error) => return error,
    };
    let tests: &mut [SelfTest<ALLANITE_OCTAVES>] = if test.is_null() {
        &mut []
    } else {
        // SAFETY: the caller promises what `get_mut` wants.
        match unsafe { get_mut(test) } {
            Ok(test) => core::slice::from_mut(test),
            Err(error) => return error,
        }
    };
    status(gyro.restore(tests, bytes).map_err(AllaniteStatus::from))
}
