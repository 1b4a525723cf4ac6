//! How much estimates that look at the same samples scatter together.

use super::{
    density::Bin,
    window::{Products, cosine, places},
};
use crate::{
    limits::MAX_SEGMENT,
    list::numbered,
    numerics::real::{Real, real},
};

/// A weighted sum of quadratic estimates, as a function of the distance of the two samples that it multiplies. Of bins,
/// this is a sum of the window's products times cosines, which is linear between whole blocks.
pub(crate) struct Lags {
    /// The values at distances of 0 to `P` blocks, relative to that of one estimate at 0.
    nodes: [Real; MAX_SEGMENT + 1],
}

impl Lags {
    /// Of no estimate.
    pub(super) const ZEROS: Self = Self {
        nodes: [0.0; MAX_SEGMENT + 1],
    };

    /// Adds a value at a frequency, whose angle from one block to the next is that of a place of the table of cosines.
    pub(super) fn add(&mut self, value: Real, length: usize, place: usize) {
        let nodes = self.nodes.iter_mut().take(length.saturating_add(1));
        for (l, node) in numbered(nodes) {
            *node += value * cosine(place.wrapping_mul(l));
        }
    }

    /// The sum of the bins of a level with segments of `length` blocks, each times its weight. Only the values at
    /// distances of up to `last` blocks are needed.
    #[inline(never)]
    pub(crate) fn of_bins(
        length: usize,
        level: &[Bin],
        last: usize,
        weight: &dyn Fn(usize) -> Real,
    ) -> Self {
        let mut nodes = [0.0; MAX_SEGMENT + 1];
        // The cosines at the distances l and P − l agree.
        let half = length / 2;
        for (b, bin) in (0..).zip(level) {
            let weight = weight(b);
            let step = (bin.index as usize).wrapping_mul(places(length));
            let mut place = 0_usize;
            for node in nodes.iter_mut().take(half.min(last).saturating_add(1)) {
                *node += weight * cosine(place);
                place = place.wrapping_add(step);
            }
        }
        let products = Products::new(length);
        let all = 1.0 / products.at(0);
        for l in (0..=last.min(length)).rev() {
            let sum = nodes.get(l.min(length.saturating_sub(l))).copied();
            if let (Some(sum), Some(node)) = (sum, nodes.get_mut(l)) {
                *node = sum * products.at(l) * all;
            }
        }
        Self { nodes }
    }

    /// The value at a distance of `l` blocks.
    pub(crate) fn at(&self, l: usize) -> Real {
        self.nodes.get(l).copied().unwrap_or(0.0)
    }

    /// The value between two blocks, at `eighths` of a block.
    pub(crate) fn at_eighths(&self, eighths: usize) -> Real {
        let (l, share) = (eighths / 8, real(eighths % 8) / 8.0);
        self.at(l) + share * (self.at(l.saturating_add(1)) - self.at(l))
    }

    /// The covariance of this sum with another one of estimates of the same noise, relative to the product of
    /// the density that each estimate expects with itself. The values of `other` are at distances of whole blocks of
    /// this sum, too. `block` is the number of samples in a block, and `segments` that of segments of `length` blocks.
    ///
    /// For Gaussian noise, whose density changes little within the width of the estimates, with the number `n` of
    /// samples of the record,
    ///
    /// ```text
    /// Cov(Σ a_i P_i, Σ b_j P_j) = (2/n) Σ_l A(l) B(l)
    /// ```
    ///
    /// where `l` runs over the samples' distances of both signs: Parseval's theorem for the product of the spectral
    /// windows (Blackman & Tukey 1958, B.6). Between blocks, both are linear.
    #[inline(never)]
    pub(crate) fn covariance(
        &self,
        other: &dyn Fn(usize) -> Real,
        length: usize,
        block: u32,
        segments: u32,
    ) -> Real {
        let blocks = 0.5 * real(length) * (real(segments) + 1.0);
        let curved = (1.0 - 1.0 / (real(block) * real(block))) / 6.0;
        let mut sum = 0.0;
        let mut last = (self.at(0), other(0));
        for l in 1..=length {
            let next = (self.at(l), other(l));
            sum += 0.5 * (last.0 * last.1 + next.0 * next.1)
                - curved * (next.0 - last.0) * (next.1 - last.1);
            last = next;
        }
        4.0 * sum / blocks
    }
}

/// The product of the differences that an octave's Allan variance squares, at a distance of so many averaging times: 1
/// at 0, −½ at 1 and 0 from 2 on.
pub(crate) fn octave_lag(distance: Real) -> Real {
    if distance < 1.0 {
        1.0 - 1.5 * distance
    } else {
        (0.5 * distance - 1.0).min(0.0)
    }
}
