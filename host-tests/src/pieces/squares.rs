//! Sums of squared differences.

/// The second differences of angles at a distance of `lag` boundaries: their number, and the sum of their squares, which stays
/// at the largest number if 128 bits do not hold it.
pub(super) fn squares(angles: &[i64], lag: usize) -> u128 {
    let number = angles.len().saturating_sub(2 * lag);
    let (oldest, middle, newest) = (
        &angles[..number],
        &angles[lag.min(angles.len())..],
        &angles[(2 * lag).min(angles.len())..],
    );
    let differences = oldest.iter().zip(middle).zip(newest);
    let magnitudes = differences
        .map(|((&oldest, &middle), &newest)| difference(oldest, middle, newest).unsigned_abs());
    // A square of 32 bits is added in two halves, of which 2^32 fit in 64 bits. This needs no carry, so that the compiler
    // computes several at once.
    let (mut low, mut high, mut bits) = (0_u64, 0_u64, 0_u64);
    for magnitude in magnitudes.clone() {
        let narrow = u64::from(magnitude as u32);
        let square = narrow.wrapping_mul(narrow);
        low = low.wrapping_add(square & u64::from(u32::MAX));
        high = high.wrapping_add(square >> 32);
        bits |= magnitude;
    }
    if bits <= u64::from(u32::MAX) {
        return (u128::from(high) << 32) + u128::from(low);
    }
    let squares = magnitudes.map(|magnitude| u128::from(magnitude) * u128::from(magnitude));
    squares.fold(0, u128::saturating_add)
}

/// `newest − 2 middle + oldest`, which is exact although the angles wrap.
#[inline]
pub(super) fn difference(oldest: i64, middle: i64, newest: i64) -> i64 {
    let late = newest.wrapping_sub(middle);
    late.wrapping_sub(middle.wrapping_sub(oldest))
}
