//! The covariance of two octaves from the [table](super::table).

use super::{
    row::Row,
    table::{DISTANCES, END_STEP_BITS, FALL, STEP_BITS, TABLE},
    terms::{TERMS, power},
};

/// The value of one of a term's shares of an octave.
pub(super) const SHARE_BITS: i32 = -15;

/// One over the number of differences below which the starts that both ends cut are left out of the sums.
const PER_FEW: f32 = 1.0 / 12.0;

/// Ends that cost less than this share of the differences move no covariance by a thousandth.
const FEW_ENDS: f32 = 1.0 / 8192.0;

/// The value of one of the sums below.
const SUM_BITS: i32 = SHARE_BITS + STEP_BITS;

/// The covariance of octave `j` and of one that is `distance` octaves longer, relative to the model, times twice the number of
/// differences of octave `j`.
///
/// Shares and table are integers, so that a core without a floating-point unit takes one multiplication for a product.
#[inline(never)]
pub(super) fn covariance(shorter: &Row, longer: &Row, j: usize, distance: usize) -> f32 {
    let near = distance.min(DISTANCES - 1);
    let beyond = distance.saturating_sub(near);
    let row = if j >= 2 && PER_FEW < longer.per_difference {
        3
    } else {
        j.min(2)
    };
    let Some(mut entries) = TABLE
        .get(row)
        .and_then(|row| row.get(near))
        .map(|all| &all[..])
    else {
        return 0.0;
    };
    let mut falls = &FALL[..];
    let (mut sum, mut ends) = (0_i32, 0_i32);
    for (a, &own) in (0..TERMS).zip(&shorter.shares).take(TERMS - 1) {
        let later = TERMS.wrapping_sub(a);
        let (Some((its, rest)), Some((fall, next))) = (
            entries.split_at_checked(later),
            falls.split_at_checked(later),
        ) else {
            break;
        };
        (entries, falls) = (rest, next);
        if own == 0 {
            continue;
        }
        let others = longer.shares.get(a..).unwrap_or_default();
        let (mut its_sum, mut its_ends) = (0_i32, 0_i32);
        for ((&[t0, t1], &fall), &other) in its.iter().zip(fall).zip(others) {
            if other == 0 {
                continue;
            }
            let shift = (beyond as u32).wrapping_mul(fall.into()).min(31);
            let other = u32::from(other).wrapping_shr(shift) as i32;
            its_sum = its_sum.wrapping_add(other.wrapping_mul(t0.into()));
            its_ends = its_ends.wrapping_add(other.wrapping_mul(t1.into()));
        }
        // Shares are at most 2^15 and add to one, and the table is below 2^15, so that all sums stay below 2^31.
        let of = |its: i32| i32::from(own).wrapping_mul(its.wrapping_add(1 << 14) >> 15);
        sum = sum.wrapping_add(of(its_sum));
        ends = ends.wrapping_add(of(its_ends));
    }
    let mut all = sum as f32 * power(SUM_BITS);
    if longer.ends > FEW_ENDS {
        let step = END_STEP_BITS.get(near).copied().unwrap_or(0);
        let cost = ends as f32 * power(step.wrapping_add(SHARE_BITS)) * longer.ends;
        // Where stretches are so short that pairs far apart have no room in them, these cannot cost more than there are of
        // them. If the distances count alike, a quarter of the square is left.
        all = if cost > 0.5 * all {
            0.25 * all * (all / cost)
        } else {
            all - cost
        };
    }
    all
}
