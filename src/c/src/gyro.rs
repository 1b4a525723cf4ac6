//! The record of a gyro: three axes and a temperature.

use crate::{
    memory::{self, Memory, get, get_mut, put, slice, status},
    sizes::{ALLANITE_AXES, ALLANITE_GYRO_WORDS, ALLANITE_OCTAVES},
    status::AllaniteStatus,
};
use allanite::{
    Axes, Real,
    axis::{Courses, Gated, Moments, Spectral},
    covariate::Lags,
};

/// The bins of a spectrum of five levels.
pub(crate) const BINS: usize = 140;

/// The temperature as it is, and behind three lags. With two lags of the same range, a rate that follows the temperature keeps a false
/// random walk in a quarter of the records of `host-tests/tests/library/covariate_lag.rs` (its bank `[0, 10, 12]`); with three, in
/// one of a hundred at most.
pub(crate) const COVARIATES: usize = 4;

/// The longest lag takes no more than this, and more than half of it. The bank then follows any lag up to 43 s.
const LONGEST_S: Real = 256.0;
/// Each lag is so many powers of two longer than the one before, as in that test.
const APART: u32 = 2;

/// The record: a gate, fourth moments, a temperature and its lags, spectra and courses.
pub(crate) type Gyro = Axes<
    ALLANITE_OCTAVES,
    COVARIATES,
    Gated,
    Moments,
    ALLANITE_AXES,
    Spectral<64, 7, BINS>,
    Courses,
>;

/// A record, and the thermometer's lags.
pub(crate) struct Recorded {
    pub(crate) axes: Gyro,
    pub(crate) lags: Lags<COVARIATES>,
}

impl Recorded {
    const EMPTY: Self = Self {
        axes: Gyro::new(),
        lags: Lags::new([0; COVARIATES]),
    };
}

/// The lags at a sampling rate. `None` if there is no such rate.
pub(crate) fn lags(rate_hz: Real) -> Option<Lags<COVARIATES>> {
    let longest = LONGEST_S * rate_hz;
    let (least, most) = ((1_u32 << (2 * APART)) as Real, (1_u32 << 30) as Real);
    if !(least..=most).contains(&longest) {
        return None;
    }
    let log2 = (longest as u32).ilog2();
    let lags = [2, 1, 0].map(|shorter| log2.saturating_sub(shorter * APART));
    Some(Lags::new([0, lags[0], lags[1], lags[2]]))
}

/// The record of a gyro. It may be copied and moved while no function works on it.
#[repr(C)]
pub struct AllaniteGyro {
    /// Nothing for the caller to read.
    words: [u64; ALLANITE_GYRO_WORDS],
}

// SAFETY: the type is words, and the mark is its own.
unsafe impl Memory for AllaniteGyro {
    type Value = Recorded;
    const MARK: u64 = 0x6779_726f_0000_0011 + ALLANITE_OCTAVES as u64 * 0x100;
}

/// Makes an empty record. `bytes` is `sizeof(AllaniteGyro)`. `rate_hz` is the nominal number of samples per second, between 1/16 and
/// 4 million: it sets the lags with which the rate may follow the temperature.
///
/// # Safety
/// `gyro` is null, or points to an `AllaniteGyro` that nothing else uses.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_gyro_init(
    gyro: *mut AllaniteGyro,
    bytes: usize,
    rate_hz: f32,
) -> AllaniteStatus {
    let Some(lags) = lags(Real::from(rate_hz)) else {
        return AllaniteStatus::InvalidArgument;
    };
    // A constant is written where it belongs, without a copy of it on the stack.
    // SAFETY: the caller promises what `make` wants.
    let made = unsafe { memory::make(gyro, bytes, || Ok(const { Recorded::EMPTY })) };
    // SAFETY: there is a value now.
    let recorded = made.and_then(|()| unsafe { get_mut(gyro) });
    status(recorded.map(|recorded| recorded.lags = lags))
}

/// Adds one sample: a count of every axis, and one of the thermometer.
///
/// # Safety
/// `gyro` is null, or points to an `AllaniteGyro`; `counts` is null, or points to [`ALLANITE_AXES`] counts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_gyro_push(
    gyro: *mut AllaniteGyro,
    counts: *const i32,
    temperature: i32,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `slice` wants.
    let counts = match unsafe { slice(counts, ALLANITE_AXES) } {
        Ok(counts) => counts,
        Err(error) => return error,
    };
    // SAFETY: the caller promises what `get_mut` wants.
    status(unsafe { get_mut(gyro) }.map(|gyro| {
        let mut sample = [0; ALLANITE_AXES];
        for (to, from) in sample.iter_mut().zip(counts) {
            *to = *from;
        }
        gyro.axes.push((sample, gyro.lags.push(temperature)));
    }))
}

/// Notes that the next sample does not adjoin the one before it.
///
/// # Safety
/// `gyro` is null, or points to an `AllaniteGyro`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_gyro_gap(gyro: *mut AllaniteGyro) -> AllaniteStatus {
    // SAFETY: the caller promises what `get_mut` wants.
    status(unsafe { get_mut(gyro) }.map(|gyro| gyro.axes.gap()))
}

/// Notes that so many samples are missing at this place. Does nothing for 0.
///
/// # Safety
/// `gyro` is null, or points to an `AllaniteGyro`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_gyro_lost(
    gyro: *mut AllaniteGyro,
    samples: u64,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get_mut` wants.
    status(unsafe { get_mut(gyro) }.map(|gyro| gyro.axes.lost(samples)))
}

/// Does a part of the spectra's work that waits, for a main loop with nothing else to do. `more` says whether there is
/// more; it may be null.
///
/// # Safety
/// `gyro` is null, or points to an `AllaniteGyro`; `more` is null, or points to a `bool`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_gyro_advance(
    gyro: *mut AllaniteGyro,
    more: *mut bool,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get_mut` wants.
    let advanced = unsafe { get_mut(gyro) }.map(|gyro| gyro.axes.advance());
    match advanced {
        Err(error) => error,
        Ok(_) if more.is_null() => AllaniteStatus::Ok,
        // SAFETY: the caller promises what `put` wants.
        Ok(is_more) => status(unsafe { put(more, is_more) }),
    }
}

/// Adds the samples that the gate holds back, at the end of a record.
///
/// # Safety
/// `gyro` is null, or points to an `AllaniteGyro`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_gyro_release(gyro: *mut AllaniteGyro) -> AllaniteStatus {
    // SAFETY: the caller promises what `get_mut` wants.
    status(unsafe { get_mut(gyro) }.map(|gyro| gyro.axes.release()))
}

/// Adds another record of the same gyro, as if a gap lay between the two. Where the noise of an axis differs by more than a
/// gyro's does, nothing is added, and the status is `ALLANITE_STATUS_OTHER_SENSOR`.
///
/// # Safety
/// Both are null or point to an `AllaniteGyro`, and not to the same one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_gyro_merge(
    gyro: *mut AllaniteGyro,
    other: *const AllaniteGyro,
) -> AllaniteStatus {
    if core::ptr::eq(gyro, other) {
        return AllaniteStatus::InvalidArgument;
    }
    // SAFETY: the caller promises what `get` wants.
    let other = match unsafe { get(other) } {
        Ok(other) => other,
        Err(error) => return error,
    };
    // SAFETY: the caller promises what `get_mut` wants, and the two records are not the same.
    match unsafe { get_mut(gyro) } {
        Ok(gyro) if !gyro.axes.is_like(&other.axes) => AllaniteStatus::OtherSensor,
        gyro => status(gyro.map(|gyro| gyro.axes.merge(&other.axes))),
    }
}

/// The numbers of samples that are kept and that the gate left out. Either pointer may be null.
///
/// # Safety
/// `gyro` is null, or points to an `AllaniteGyro`; the others are null, or point to a `uint64_t`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_gyro_samples(
    gyro: *const AllaniteGyro,
    kept: *mut u64,
    left_out: *mut u64,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get` wants.
    let gyro = match unsafe { get(gyro) } {
        Ok(gyro) => &gyro.axes,
        Err(error) => return error,
    };
    for (to, value) in [(kept, gyro.samples()), (left_out, gyro.left_out())] {
        if !to.is_null() {
            // SAFETY: the caller promises what `put` wants.
            if let Err(error) = unsafe { put(to, value) } {
                return error;
            }
        }
    }
    AllaniteStatus::Ok
}
