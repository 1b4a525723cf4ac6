//! The lags at which the differences of two octaves meet.

use crate::{curve::Point, numerics::math::floor_log2, theory::lattice};

/// The outward tail of the sum ends after two lags in a row that each add less than this share of the
/// sum. Chosen by hand, and held to 1 % of the full sum by `host-tests/tests/library/covariance`.
pub(super) const NEGLIGIBLE: f32 = 1e-4;

/// The number of powers of two among the steps of the sum.
pub(super) const LEVELS: usize = (lattice::END / 2).ilog2() as usize;

/// Up to this distance from 0 or from the middle, the sum takes the lags one by one, in quarters of the
/// shorter cluster. The kinks lie within one cluster, which is four quarters. Chosen by hand, and held
/// to 1 % of the full sum by `host-tests/tests/library/covariance`.
const KINK: u32 = 6;
/// Up to this distance, the sum takes every second lag. Beyond it, the step is the distance's power of
/// two, or half of that for octaves less than [`FAR`] apart. Chosen by hand, and held to 1 % of the
/// full sum by `host-tests/tests/library/covariance`.
pub(super) const NEAR: u32 = 8;
/// The distance of two octaves, in quarters of the shorter cluster, from which on the longer steps are
/// enough. Chosen by hand, and held to 1 % of the full sum by `host-tests/tests/library/covariance`.
const FAR: u32 = 256;

/// Where the differences of two octaves start.
pub(super) struct Starts {
    /// The binary logarithm of the number of samples between two starts of the longer difference.
    advance_bits: u32,
    /// The binary logarithm of the shorter cluster's length in samples. It turns quarters of the
    /// cluster into samples, with a shift by two less.
    quarter_bits: u32,
    /// The room that the longer difference leaves on either side of the shorter one, in samples.
    inside: u64,
    /// The last start of the shorter difference, in samples.
    last: u64,
    /// The number of starts of the longer difference.
    count: u64,
    /// The number of stretches without gaps in which these starts lie.
    stretches: u32,
}

impl Starts {
    pub(super) fn new(shorter: &Point, longer: &Point) -> Self {
        Self {
            advance_bits: floor_log2(advance(longer.m)),
            quarter_bits: floor_log2(shorter.m),
            inside: u64::from(longer.m.saturating_sub(shorter.m)),
            last: places(shorter, longer)
                .saturating_sub(1)
                .wrapping_shl(floor_log2(advance(shorter.m))),
            count: longer.differences,
            stretches: longer.stretches.max(1),
        }
    }

    /// The number of pairs of starts whose differences have their middles `lag` quarters of the shorter
    /// cluster apart, in either order.
    pub(super) fn pairs(&self, lag: u32) -> u64 {
        let distance = u64::from(lag).wrapping_shl(self.quarter_bits) >> 2;
        // In one order, the partners of these starts of the longer difference would lie before the
        // record.
        let outside = distance.saturating_sub(self.inside);
        let advance = 1_u64.wrapping_shl(self.advance_bits);
        let partly = outside.saturating_add(advance.saturating_sub(1));
        let before = partly.wrapping_shr(self.advance_bits);
        if self.stretches > 1 {
            // Every stretch has its own ends. At both, as many starts lack their partner.
            let before = u64::from(before.min(u32::MAX.into()) as u32) * u64::from(self.stretches);
            return self.count.saturating_sub(before) << 1;
        }
        // In the other order, these starts have a partner that does not lie beyond the end of the
        // record.
        let end = distance.saturating_add(self.inside);
        let after = match self.last.checked_sub(end) {
            Some(room) => room.wrapping_shr(self.advance_bits).saturating_add(1),
            None => 0,
        };
        let kept = self.count.saturating_sub(before);
        kept.saturating_add(after.min(self.count))
    }

    /// The number of pairs at a lag of so many starts of the shorter difference, which are `step` samples apart.
    /// It is averaged over the starts between two starts of the longer difference, so that it is linear.
    pub(super) fn mean_pairs(&self, lag: u32, step: u32) -> f32 {
        let advance = 1_u64.wrapping_shl(self.advance_bits) as f32;
        let half = 0.5 - 0.5 * step as f32 / advance;
        let count = self.count as f32;
        let distance = u64::from(lag).saturating_mul(u64::from(step));
        let outside = distance.saturating_sub(self.inside);
        if self.stretches > 1 {
            let before = outside as f32 / advance + if outside == 0 { 0.0 } else { half };
            return 2.0 * (count - self.stretches as f32 * before).max(0.0);
        }
        let before = if outside == 0 {
            count
        } else {
            count - outside as f32 / advance - half
        };
        let end = distance.saturating_add(self.inside);
        let after = match self.last.checked_sub(end) {
            Some(room) => (room as f32 / advance + 1.0 - half).min(count),
            None => 0.0,
        };
        before.max(0.0) + after
    }

    /// The pairs that each further start of a lag loses beyond all kinks, where the starts are `step` samples
    /// apart.
    pub(super) fn slope(&self, step: u32) -> f32 {
        let lost = self.stretches as f32 * step as f32;
        2.0 * lost / 1_u64.wrapping_shl(self.advance_bits) as f32
    }
}

/// The number of places at which a shorter difference is taken to start beside a longer one. Octaves that leave out
/// differences across filled gaps have fewer than longer ones, which lie among the places that are left out, too: what both
/// have in common is a share of all pairs of places, and not of those that the shorter octave has.
pub(super) fn places(shorter: &Point, longer: &Point) -> u64 {
    let bits = floor_log2(advance(longer.m)).saturating_sub(floor_log2(advance(shorter.m)));
    let beside = longer.differences.saturating_mul(1_u64.wrapping_shl(bits));
    match shorter.m == longer.m {
        true => shorter.differences,
        false => shorter.differences.max(beside),
    }
}

/// The number of samples from one start to the next.
pub(super) fn advance(m: u32) -> u32 {
    (m / 4).max(1)
}

/// The step from a lag of the sum to the next one: a quarter of a cluster near 0 and near the middle,
/// where the kinks are, then two quarters, then the power of two of the distance.
pub(super) fn step_after(lag: u32, middle: u32, stride: u32) -> u32 {
    // Octaves that lie far apart are correlated too little for half steps to matter.
    let halvings = if middle < FAR { 1 } else { 0 };
    let power = |distance: u32| 1_u32.wrapping_shl(floor_log2(distance).saturating_sub(halvings));
    let away = |distance: u32| match distance {
        0..KINK => stride,
        KINK..NEAR => stride.max(2),
        _ => power(distance),
    };
    let towards = |distance: u32| match distance {
        0..=KINK => stride,
        _ if distance <= NEAR => stride.max(2),
        _ => power(distance.saturating_sub(1)),
    };
    if lag >= middle {
        away(lag - middle)
    } else if middle <= 2 * NEAR {
        stride
    } else if lag < middle / 2 {
        away(lag)
    } else {
        towards(middle - lag)
    }
}
