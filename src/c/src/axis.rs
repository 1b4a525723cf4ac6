//! One axis alone, for a core with little memory: its curve, the five terms of IEEE Std 952, and limits for them. A program
//! that calls nothing else of this library takes 24 KiB of a Cortex-M0+.

use crate::{
    codes::{
        ALLANITE_EFFECT_ANGLE_RANDOM_WALK, ALLANITE_EFFECT_BIAS_INSTABILITY,
        ALLANITE_EFFECT_QUANTIZATION, ALLANITE_EFFECT_RATE_RAMP, ALLANITE_EFFECT_RATE_RANDOM_WALK,
    },
    coefficient::AllaniteCoefficient,
    curve::{AllanitePoint, write_points},
    memory::{self, Memory, get, get_mut, put, slice, status},
    sizes::{ALLANITE_AXIS_WORDS, ALLANITE_OCTAVES},
    status::AllaniteStatus,
};
use allanite::{
    Accumulator, Curve, Real, Scale,
    ieee_952::{self, TERMS},
};

/// The record of one axis: its octaves alone, without a watch for motion, stuck values and spikes. It may be copied and
/// moved while no function works on it.
#[repr(C)]
pub struct AllaniteAxis {
    /// Nothing for the caller to read.
    words: [u64; ALLANITE_AXIS_WORDS],
}

// SAFETY: the type is words, and the mark is its own.
unsafe impl Memory for AllaniteAxis {
    type Value = Accumulator<ALLANITE_OCTAVES>;
    const MARK: u64 = 0x6779_726f_0000_0007 + ALLANITE_OCTAVES as u64 * 0x100;
}

/// The five terms of a curve.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct AllaniteFiveTerms {
    /// Quantization, angle random walk, bias instability, rate random walk and rate ramp.
    pub coefficients: [AllaniteCoefficient; ALLANITE_TERMS],
    /// The squared residuals in units of their covariance.
    pub chi_squared: f32,
    /// Its degrees of freedom.
    pub degrees_of_freedom: i32,
    /// The tolerance that was granted to the model, relative to a variance.
    pub tolerance: f32,
    /// The factor by which the intervals are widened because the terms do not explain the curve.
    pub birge_ratio: f32,
}

/// The number of terms of IEEE Std 952.
pub const ALLANITE_TERMS: usize = 5;
const _: () = assert!(ALLANITE_TERMS == TERMS);

/// What limits say of the five terms.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AllaniteChecked {
    /// The interval of each coefficient keeps its limit.
    Pass = 0,
    /// The interval of a coefficient lies above its limit.
    Fail = 1,
    /// The interval of a coefficient contains its limit: record longer.
    GuardBand = 2,
    /// The terms do not explain the curve, so that their intervals say nothing about limits.
    Misfit = 3,
}

/// Makes an empty record. `bytes` is `sizeof(AllaniteAxis)`.
///
/// # Safety
/// `axis` is null, or points to an `AllaniteAxis` that nothing else uses.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_axis_init(
    axis: *mut AllaniteAxis,
    bytes: usize,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `make` wants.
    status(unsafe { memory::make(axis, bytes, || Ok(const { Accumulator::new() })) })
}

/// Adds counts, oldest first.
///
/// # Safety
/// `axis` is null, or points to an `AllaniteAxis`; `counts` is null, or points to `length` counts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_axis_push(
    axis: *mut AllaniteAxis,
    counts: *const i32,
    length: usize,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `slice` wants.
    let counts = match unsafe { slice(counts, length) } {
        Ok(counts) => counts,
        Err(error) => return error,
    };
    // SAFETY: the caller promises what `get_mut` wants.
    status(unsafe { get_mut(axis) }.map(|axis| {
        for &count in counts {
            axis.push(count);
        }
    }))
}

/// Notes that so many samples were lost before the next one. Long octaves go on across a few.
///
/// # Safety
/// `axis` is null, or points to an `AllaniteAxis`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_axis_lost(
    axis: *mut AllaniteAxis,
    samples: u64,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get_mut` wants.
    status(unsafe { get_mut(axis) }.map(|axis| axis.lost(samples)))
}

/// Writes the octaves of the Allan curve, shortest first, and their number. `rate_per_count` is the rate of one count, and
/// `rate_hz` the number of samples per second. [`ALLANITE_OCTAVES`] points always suffice.
///
/// # Safety
/// `axis` is null, or points to an `AllaniteAxis`; `points` is null, or points to `capacity` points; `number` is null, or points
/// to a number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_axis_curve(
    axis: *const AllaniteAxis,
    rate_per_count: f32,
    rate_hz: f32,
    points: *mut AllanitePoint,
    capacity: usize,
    number: *mut usize,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get` wants.
    let curve = unsafe { get(axis) }.and_then(|axis| curve(axis, rate_per_count, rate_hz));
    // SAFETY: the caller promises what `write_points` wants.
    status(curve.and_then(|curve| unsafe { write_points(&curve, points, capacity, number) }))
}

/// Fits the five terms of IEEE Std 952 to the curve: some 3 million instructions on a Cortex-M0+, and 1 million on a
/// Cortex-M4F.
///
/// # Safety
/// `axis` is null, or points to an `AllaniteAxis`; `to` is null, or points to an `AllaniteFiveTerms`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_axis_fit(
    axis: *const AllaniteAxis,
    rate_per_count: f32,
    rate_hz: f32,
    to: *mut AllaniteFiveTerms,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `fit` wants.
    let fit = unsafe { fit(axis, rate_per_count, rate_hz) };
    // SAFETY: the caller promises what `put` wants.
    status(fit.and_then(|fit| unsafe { put(to, AllaniteFiveTerms::of(&fit)) }))
}

/// Compares the five terms of a curve with limits: the largest value that each may have, where an infinite one requires
/// nothing. `place` becomes that of the first term that fails or is in the guard band.
///
/// # Safety
/// `axis` is null, or points to an `AllaniteAxis`; `most` is null, or points to [`ALLANITE_TERMS`] limits; `checked` and `place`
/// are null, or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_axis_check(
    axis: *const AllaniteAxis,
    rate_per_count: f32,
    rate_hz: f32,
    most: *const f32,
    checked: *mut AllaniteChecked,
    place: *mut usize,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `slice` wants.
    let most = match unsafe { slice(most, ALLANITE_TERMS) } {
        Ok(most) => most,
        Err(error) => return error,
    };
    let mut limits = ieee_952::Limits {
        most: [Real::INFINITY; TERMS],
    };
    for (to, &from) in limits.most.iter_mut().zip(most) {
        *to = Real::from(from);
    }
    // SAFETY: the caller promises what `fit` wants.
    let (said, at) = match unsafe { fit(axis, rate_per_count, rate_hz) } {
        Err(error) => return error,
        Ok(fit) => match limits.check(&fit) {
            ieee_952::Checked::Pass => (AllaniteChecked::Pass, 0),
            ieee_952::Checked::Fail { place } => (AllaniteChecked::Fail, place),
            ieee_952::Checked::GuardBand { place } => (AllaniteChecked::GuardBand, place),
            ieee_952::Checked::Misfit => (AllaniteChecked::Misfit, 0),
        },
    };
    // SAFETY: the caller promises what `put` wants.
    let written = unsafe { put(place, at) };
    // SAFETY: the caller promises what `put` wants.
    status(written.and_then(|()| unsafe { put(checked, said) }))
}

/// The fit of the curve of an axis.
///
/// # Safety
/// `axis` is null, or points to an `AllaniteAxis`.
#[inline(never)]
unsafe fn fit(
    axis: *const AllaniteAxis,
    rate_per_count: f32,
    rate_hz: f32,
) -> Result<ieee_952::Fit, AllaniteStatus> {
    // SAFETY: the caller promises what `get` wants.
    let axis = unsafe { get(axis) }?;
    Ok(ieee_952::fit(&curve(axis, rate_per_count, rate_hz)?)?)
}

#[inline(never)]
fn curve(
    axis: &Accumulator<ALLANITE_OCTAVES>,
    rate_per_count: f32,
    rate_hz: f32,
) -> Result<Curve<ALLANITE_OCTAVES>, AllaniteStatus> {
    let scale = Scale::new(Real::from(rate_per_count), Real::from(rate_hz))?;
    Ok(axis.curve(scale))
}

impl AllaniteFiveTerms {
    // The casts change nothing in single precision, in which every published library is built.
    #[allow(clippy::unnecessary_cast)]
    fn of(fit: &ieee_952::Fit) -> Self {
        let [q, n, b, k, r] = &fit.coefficients;
        let of = AllaniteCoefficient::of;
        Self {
            coefficients: [
                of(q, ALLANITE_EFFECT_QUANTIZATION),
                of(n, ALLANITE_EFFECT_ANGLE_RANDOM_WALK),
                of(b, ALLANITE_EFFECT_BIAS_INSTABILITY),
                of(k, ALLANITE_EFFECT_RATE_RANDOM_WALK),
                of(r, ALLANITE_EFFECT_RATE_RAMP),
            ],
            chi_squared: fit.chi_squared as f32,
            degrees_of_freedom: fit.degrees_of_freedom as i32,
            tolerance: fit.tolerance as f32,
            birge_ratio: fit.birge_ratio as f32,
        }
    }
}
