//! The certificate of a factory.

use crate::{
    diagnosis::AllaniteDiagnosis,
    memory::{self, Memory, get, get_mut, put, slice, slice_mut, status},
    sizes::{ALLANITE_CERTIFICATE_WORDS, ALLANITE_OCTAVES},
    status::AllaniteStatus,
};
use allanite::storage::{Certificate, Conditions, RateUnit};

/// A certificate.
#[repr(C)]
pub struct AllaniteCertificate {
    /// Nothing for the caller to read.
    words: [u64; ALLANITE_CERTIFICATE_WORDS],
}

// SAFETY: the type is words, and the mark is its own.
unsafe impl Memory for AllaniteCertificate {
    type Value = Certificate;
    const MARK: u64 = 0x6779_726f_0000_0006 + ALLANITE_OCTAVES as u64 * 0x100;
}

/// The conditions of a measurement. The rates are in deg/s.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct AllaniteConditions {
    /// The duration in seconds.
    pub duration_s: f64,
    /// The number of samples per second.
    pub rate_hz: f64,
    /// The number of samples.
    pub samples: u64,
    /// The number of gaps among them.
    pub gaps: u64,
    /// The lowest temperature in °C, or NaN if it was not measured.
    pub lowest_c: f32,
    /// The highest temperature in °C, or NaN if it was not measured.
    pub highest_c: f32,
    /// The version of the firmware: major, minor, patch.
    pub firmware: [u16; 3],
}

/// Makes a certificate without axes, for a device with an identity of up to 16 bytes. `bytes` is
/// `sizeof(AllaniteCertificate)`.
///
/// # Safety
/// `certificate` is null, or points to an `AllaniteCertificate` that nothing else uses; `device` is null, or points to
/// `length` bytes; `conditions` is null, or points to what it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_certificate_init(
    certificate: *mut AllaniteCertificate,
    bytes: usize,
    device: *const u8,
    length: usize,
    conditions: *const AllaniteConditions,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `slice` wants.
    let device = match unsafe { slice(device, length) } {
        Ok(device) => device,
        Err(error) => return error,
    };
    // SAFETY: the caller promises what `slice` wants.
    let under = match unsafe { slice(conditions, 1) } {
        Ok([under]) => *under,
        Ok(_) => return AllaniteStatus::NullPointer,
        Err(error) => return error,
    };
    let made = || {
        let measured = !(under.lowest_c.is_nan() || under.highest_c.is_nan());
        let conditions = Conditions {
            temperature_c: measured.then_some((under.lowest_c, under.highest_c)),
            duration_s: under.duration_s,
            rate_hz: under.rate_hz,
            samples: under.samples,
            gaps: under.gaps,
        };
        let unit = RateUnit::DegreesPerSecond;
        Ok(Certificate::new(device, under.firmware, conditions, unit)?)
    };
    // SAFETY: the caller promises what `make` wants.
    status(unsafe { memory::make(certificate, bytes, made) })
}

/// Adds the next axis, as a diagnosis that has ended describes it.
///
/// # Safety
/// `certificate` is null, or points to an `AllaniteCertificate`; `diagnosis` is null, or points to an `AllaniteDiagnosis`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_certificate_add(
    certificate: *mut AllaniteCertificate,
    diagnosis: *const AllaniteDiagnosis,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get` wants.
    let diagnosis = match unsafe { get(diagnosis) } {
        Ok(diagnosis) if diagnosis.verdict.is_some() => diagnosis,
        Ok(_) => return AllaniteStatus::InvalidArgument,
        Err(error) => return error,
    };
    // SAFETY: the caller promises what `get_mut` wants.
    match unsafe { get_mut(certificate) } {
        Err(error) => error,
        Ok(certificate) => {
            let added = certificate.axes.push(diagnosis.certificate.clone());
            status(added.map_err(|_| AllaniteStatus::UnknownAxis))
        }
    }
}

/// Writes a certificate to a buffer of `ALLANITE_CERTIFICATE_BYTES`. `written` is set to their
/// number. `allanite decode` reads them on a workstation.
///
/// # Safety
/// `certificate` is null, or points to an `AllaniteCertificate`; `buffer` is null, or points to `capacity` bytes; `written`
/// is null, or points to a `size_t`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_certificate_encode(
    certificate: *const AllaniteCertificate,
    buffer: *mut u8,
    capacity: usize,
    written: *mut usize,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get` wants.
    let certificate = match unsafe { get(certificate) } {
        Ok(certificate) => certificate,
        Err(error) => return error,
    };
    // SAFETY: the caller promises what `slice_mut` wants.
    let buffer = match unsafe { slice_mut(buffer, capacity) } {
        Ok(buffer) => buffer,
        Err(error) => return error,
    };
    match certificate.encode(buffer) {
        Err(error) => error.into(),
        // SAFETY: the caller promises what `put` wants.
        Ok(stored) => status(unsafe { put(written, stored.len()) }),
    }
}
