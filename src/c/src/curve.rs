//! The octaves of an Allan curve.

use crate::{
    memory::{put, slice_mut},
    status::AllaniteStatus,
};
use allanite::Curve;

/// An octave of a curve.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct AllanitePoint {
    /// The averaging factor: samples in a cluster.
    pub m: u32,
    /// The averaging time, in seconds.
    pub tau_s: f32,
    /// The Allan variance, in rate units squared.
    pub variance: f32,
    /// The number of differences that it is the mean of.
    pub differences: u64,
}

/// Writes the points of a curve, and their number.
///
/// # Safety
/// `points` is null, or points to `capacity` writable points; `number` is null, or points to a number.
// The casts change nothing in single precision, in which every published library is built.
#[allow(clippy::unnecessary_cast)]
pub(crate) unsafe fn write_points<const K: usize>(
    curve: &Curve<K>,
    points: *mut AllanitePoint,
    capacity: usize,
    number: *mut usize,
) -> Result<(), AllaniteStatus> {
    let found = curve.points();
    if capacity < found.len() {
        return Err(AllaniteStatus::BufferTooSmall);
    }
    // SAFETY: the caller promises what `slice_mut` wants.
    let places = unsafe { slice_mut(points, capacity) }?;
    for (place, point) in places.iter_mut().zip(found) {
        *place = AllanitePoint {
            m: point.m,
            tau_s: point.tau_s as f32,
            variance: point.variance as f32,
            differences: point.differences,
        };
    }
    // SAFETY: the caller promises what `put` wants.
    unsafe { put(number, found.len()) }
}
