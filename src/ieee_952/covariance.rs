//! The covariance of two octaves from the [table](super::table).

use super::{
    row::Row,
    table::{DISTANCES, END_STEP_BITS, PAIRS, STEP_BITS, TABLE},
    terms::{TERMS, power},
};

use core::num::Wrapping;

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
    let Some([common, at_ends]) = TABLE.get(row).and_then(|row| row.get(near)) else {
        return 0.0;
    };
    let fallen = Fallen::new(&longer.shares, beyond);
    let mut all = total(common, &shorter.shares, &fallen) as f32 * power(SUM_BITS);
    if longer.ends > FEW_ENDS {
        let step = END_STEP_BITS.get(near).copied().unwrap_or(0);
        let cost = total(at_ends, &shorter.shares, &fallen) as f32;
        let cost = cost * power(step.wrapping_add(SHARE_BITS)) * longer.ends;
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

/// The shares of the longer octave, fallen as far as those beside each term of the shorter one are beyond the table.
struct Fallen {
    beside_q: [i32; 5],
    beside_n: [i32; 4],
    beside_b: [i32; 3],
    beside_k: [i32; 2],
}

impl Fallen {
    #[inline(always)]
    fn new(&[q, n, b, k, r]: &[u16; TERMS], beyond: usize) -> Self {
        let fallen = |share: u16, powers: u32| {
            let shift = (beyond as u32).wrapping_mul(powers).min(31);
            u32::from(share).wrapping_shr(shift) as i32
        };
        Self {
            beside_q: [q.into(), fallen(n, 1), fallen(b, 2), fallen(k, 3), r.into()],
            beside_n: [fallen(n, 1), fallen(b, 2), fallen(k, 2), r.into()],
            beside_b: [fallen(b, 1), fallen(k, 1), fallen(r, 1)],
            beside_k: [k.into(), r.into()],
        }
    }
}

/// The sum of the entries of a table by the shares of both octaves.
///
/// It is written out, because what a loop looks up for each pair takes longer than the products. Shares are at most 2^15 and add
/// to one, and the table is below 2^15, so that all sums stay below 2^31.
#[inline(never)]
fn total(table: &[i16; PAIRS], shares: &[u16; TERMS], fallen: &Fallen) -> i32 {
    let &[qq, qn, qb, qk, qr, nn, nb, nk, nr, bb, bk, br, kk, kr] = table;
    let &[own_q, own_n, own_b, own_k, _] = shares;
    let [q, n, b, k, r] = &fallen.beside_q;
    let of_q = times(qq, q) + times(qn, n) + times(qb, b) + times(qk, k) + times(qr, r);
    let [n, b, k, r] = &fallen.beside_n;
    let of_n = times(nn, n) + times(nb, b) + times(nk, k) + times(nr, r);
    let [b, k, r] = &fallen.beside_b;
    let of_b = times(bb, b) + times(bk, k) + times(br, r);
    let [k, r] = &fallen.beside_k;
    let of_k = times(kk, k) + times(kr, r);
    let all = by_share(own_q, of_q)
        + by_share(own_n, of_n)
        + by_share(own_b, of_b)
        + by_share(own_k, of_k);
    all.0
}

#[inline(always)]
fn times(entry: i16, share: &i32) -> Wrapping<i32> {
    Wrapping(i32::from(entry)) * Wrapping(*share)
}

/// A sum, whose unit is a share, by the share of the other octave.
#[inline(always)]
fn by_share(own: u16, sum: Wrapping<i32>) -> Wrapping<i32> {
    Wrapping(own.into()) * Wrapping((sum + Wrapping(1 << 14)).0 >> 15)
}
