//! What filled values change in a spectrum, which is taken off.
//!
//! A record `x` with filled gaps is `y_t = x_t − q_t (x_t − f_t)`, where `q_t` is 1 in a gap, and `f_t` is the mean `H x` of
//! 32 samples before it. For gaps at random places, which take the share `p` of the record, its density is
//!
//! ```text
//! S_y = |1 − p (1 − H)|² S_x + (1 − p) A
//! ```
//!
//! where `A` is the density of what is left of `x − f` in the gaps alone, as if they were independent. It follows from the
//! autocovariance of `x`, which is the cosine transform of the densities themselves. So no model is needed. What is taken
//! off is right to the second order in `p`, and in levels of longer blocks as far as the two nearest aliases reach.

use super::{
    density::{Bin, Spectrum, levels_of},
    window::first_bin,
};
use crate::{
    list::{count, fill, numbered},
    numerics::{
        math::{self, sincos_of_turns},
        real::{Real, real},
    },
    record::octave::{
        Bridged,
        bridge::{BEFORE, WINDOW},
    },
};
use heapless::Vec;

/// The longest gap that is filled.
const LONGEST: usize = 64;

/// The distances of the window's end from the gap that are averaged. With 0 to 7 samples, they share the mean, and nearly
/// the variance.
const ENDS: [usize; 2] = [(BEFORE as usize - 1) / 2 - 2, BEFORE as usize / 2 + 2];

/// The number of distances at which the autocovariance is needed: up to that of the window's start from the gap's end.
const REACH: usize = LONGEST + WINDOW as usize + ENDS[1] + 1;

/// The least share of a measured density that is left, and the least factor. Where noise is nearly nothing, the change may
/// be wrong by more than the noise.
const LEAST: Real = 0.05;

/// A level of which this share is left, in the mean of its bins, is left out with those of longer blocks: its densities would
/// be differences of large numbers.
const LEFT_OUT: Real = 0.25;

/// Where fewer samples than one in so many are filled, the densities of the filled record give its autocovariance well
/// enough, and a device saves the time of a second round.
const SECOND_ROUND: u64 = 256;

/// Up to this frequency, in turns a sample, a parabola in its square through three places gives what changes: the cosines
/// are those of less than a radian.
const SLOW: Real = 1.0 / 512.0;

/// The number of levels from which the autocovariance is made. What lies below is the same in a gap and before it.
const LEVELS: usize = 3;

/// The sine and the cosine of an angle.
#[derive(Clone, Copy)]
struct Angle {
    sine: Real,
    cosine: Real,
}

impl Angle {
    fn of_turns(turns: Real) -> Self {
        let (sine, cosine) = sincos_of_turns(turns);
        Self { sine, cosine }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            sine: self.sine * other.cosine + self.cosine * other.sine,
            cosine: self.cosine * other.cosine - self.sine * other.sine,
        }
    }

    /// The angle times a number, by doubling. Each doubling doubles what rounding left.
    fn multiple(self, times: u32) -> Self {
        let mut sum = Self {
            sine: 0.0,
            cosine: 1.0,
        };
        let (mut power, mut left) = (self, times);
        while left > 0 {
            if left % 2 == 1 {
                sum = sum.plus(power);
            }
            power = power.plus(power);
            left /= 2;
        }
        sum
    }
}

/// The samples in each class of gaps, and the mean length of one of them.
fn lengths(bridged: &Bridged) -> impl Iterator<Item = (u32, u32)> {
    let classes = bridged.gaps.iter().zip(&bridged.samples);
    classes.map(|(&gaps, &lost)| {
        let mean = lost.wrapping_add(gaps / 2).checked_div(gaps).unwrap_or(1);
        (lost, mean.clamp(1, LONGEST as u32))
    })
}

/// The mean length of the longest gaps of a record.
fn longest(bridged: &Bridged) -> usize {
    let present = lengths(bridged).filter(|&(lost, _)| lost > 0);
    present.map(|(_, length)| length).max().unwrap_or(1) as usize
}

/// The gaps of a record, and what they do to its density.
struct Change {
    /// The share of samples that lie so many places behind the start of a gap.
    filled: [Real; LONGEST],
    /// The autocovariance of what is left in the gaps alone, for one sample of the record.
    left: [Real; LONGEST],
    /// The length of the longest class of gaps: what is left does not reach further.
    longest: usize,
    /// The share of samples that are filled.
    share: Real,
    /// What changes at no frequency, at half of [`SLOW`], and there.
    slow: [(Real, Real); 3],
}

impl Change {
    /// The change by gaps in a record of so many places that has this autocovariance.
    fn new(bridged: &Bridged, places: u64, covariance: &[Real; REACH]) -> Self {
        let at = |distance: usize| covariance.get(distance).copied().unwrap_or(0.0);
        let window = WINDOW as usize;
        let mut of_window = real(WINDOW) * at(0);
        for distance in 1..window {
            of_window += 2.0 * real(window.wrapping_sub(distance)) * at(distance);
        }
        of_window /= real(WINDOW * WINDOW);
        // The sums, over the first samples of a gap, of their covariance with the window's mean.
        let longest = longest(bridged);
        let mut with_window = [0.0; LONGEST + 1];
        let mut sum = 0.0;
        for (t, place) in numbered(with_window.iter_mut().skip(1).take(longest)) {
            for end in ENDS {
                let first = t.wrapping_add(end).wrapping_add(1);
                let near = (first..first.wrapping_add(window)).map(at);
                sum += near.sum::<Real>() / real(2 * WINDOW);
            }
            *place = sum;
        }
        let until = |t: usize| with_window.get(t).copied().unwrap_or(0.0);

        let mut change = Self {
            filled: [0.0; LONGEST],
            left: [0.0; LONGEST],
            longest,
            share: 0.0,
            slow: [(1.0, 0.0); 3],
        };
        for (lost, mean) in lengths(bridged) {
            let share = real(lost) / real(places);
            let length = mean as usize;
            change.share += share;
            let both = change.left.iter_mut().zip(&mut change.filled);
            for (k, (left, filled)) in numbered(both.take(length)) {
                let rest = length.wrapping_sub(k);
                let both = until(rest) + until(length) - until(k);
                let sum = real(rest) * (at(k) + of_window) - both;
                *left += share / real(length) * sum;
                *filled += share / real(length);
            }
        }
        // The mean over no phase at all is 1, which is no quotient.
        change.slow = [1e-3, 0.5, 1.0].map(|part| change.exactly_at(part * SLOW));
        change
    }

    /// The factor of the density, and what is added to it, at a frequency in turns a sample. What is added is the
    /// variance of independent samples that would have as much.
    fn at(&self, turns: Real) -> (Real, Real) {
        if turns > SLOW {
            return self.exactly_at(turns);
        }
        let u = 4.0 * turns * turns / (SLOW * SLOW);
        let [zero, half, one] = self.slow;
        let weights = [
            (u - 1.0) * (u - 4.0) / 4.0,
            u * (4.0 - u) / 3.0,
            u * (u - 1.0) / 12.0,
        ];
        let mix = |values: [Real; 3]| -> Real {
            values
                .iter()
                .zip(weights)
                .map(|(value, weight)| value * weight)
                .sum()
        };
        (mix([zero.0, half.0, one.0]), mix([zero.1, half.1, one.1]))
    }

    fn exactly_at(&self, turns: Real) -> (Real, Real) {
        let half = Angle::of_turns(0.5 * turns);
        let one = half.multiple(2);
        // Sums over multiples of the angle, from the last one on (C. W. Clenshaw, 1955, A note on the summation of Chebyshev
        // series).
        let double = 2.0 * one.cosine;
        let (mut left, mut left_behind) = (0.0, 0.0);
        let (mut filled, mut filled_behind) = (0.0, 0.0);
        let both = self.left.iter().zip(&self.filled).take(self.longest);
        for (own_left, own_filled) in both.skip(1).rev() {
            (left, left_behind) = (own_left + double * left - left_behind, left);
            (filled, filled_behind) = (own_filled + double * filled - filled_behind, filled);
        }
        let added = self.left[0] + 2.0 * (one.cosine * left - left_behind);
        let gaps = (
            self.filled[0] + one.cosine * filled - filled_behind,
            one.sine * filled,
        );

        // The mean of the phases of the window's samples is that of its middle, times this, also for both distances.
        let of_window = one.multiple(WINDOW / 2).sine / (real(WINDOW) * half.sine);
        let apart = half.multiple((ENDS[1] - ENDS[0]) as u32).cosine;
        let window = of_window * apart;
        // From the middle of the windows to the first sample of a gap.
        let between = half.multiple(ENDS[0] as u32 + ENDS[1] as u32 + WINDOW + 1);
        let re = window * (gaps.0 * between.cosine - gaps.1 * between.sine);
        let im = window * (gaps.0 * between.sine + gaps.1 * between.cosine);
        let re = 1.0 - self.share + re;
        (re * re + im * im, (1.0 - self.share) * added)
    }

    /// The same for means over blocks of samples, of which the two nearest aliases share a bin as they do in white noise.
    fn of_blocks(&self, block: u32, turns: Real) -> (Real, Real) {
        let (factor, added) = self.at(turns);
        if block == 1 {
            return (factor, added);
        }
        let alias = self.at(1.0 / real(block) - turns);
        let (of_block, _) = sincos_of_turns(0.5 * real(block) * turns);
        let (of_sample, _) = sincos_of_turns(0.5 * turns);
        let amplitude = of_block / (real(block) * of_sample);
        let own = amplitude * amplitude;
        let mix = |near: Real, far: Real| own * near + (1.0 - own) * far;
        (mix(factor, alias.0), mix(added, alias.1))
    }
}

/// The autocovariance of a record with these densities at so many distances, up to a constant, in units of half the rate.
/// Each level takes over below the one of shorter blocks.
fn autocovariance(bins: &[Bin], segment: u32, distances: usize) -> [Real; REACH] {
    let mut covariance = [0.0; REACH];
    let length = segment as usize;
    let first = first_bin(length) as u32;
    let levels = count(levels_of(bins)).min(LEVELS);
    for (level, number) in levels_of(bins).zip(1..=levels) {
        // The lower edge of a level lies at this bin of the next one.
        let edge = (segment / 2).wrapping_sub(4);
        for bin in level {
            // A bin reaches half-way to its neighbours, the lowest one of all to zero, the highest one to half the rate.
            let is_lowest = bin.index == first && number == levels;
            let below = if is_lowest { real(first) } else { 0.5 };
            let is_highest = bin.block == 1 && bin.index.wrapping_add(1) == segment / 2;
            let above = match () {
                () if is_highest => 1.0,
                () if bin.block > 1 && bin.index > edge => continue,
                () if bin.block > 1 && bin.index == edge => 0.0,
                () => 0.5,
            };
            let turns = real(bin.index) / (real(segment) * real(bin.block));
            let power = bin.density * (below + above) * 2.0 / (real(segment) * real(bin.block));
            let (_, cosine) = sincos_of_turns(turns);
            let (mut near, mut before) = (1.0, cosine);
            for covariance in covariance.iter_mut().take(distances) {
                *covariance += power * near;
                (near, before) = (2.0 * cosine * near - before, near);
            }
        }
    }
    covariance
}

impl<const B: usize> Spectrum<B> {
    /// The spectrum without what filled gaps change in its densities, for a record of so many samples without those that
    /// were lost, whose segments go on across filled gaps. [`Axes`](crate::Axes) does this itself. The spectrum stays as it
    /// is if no gap was filled.
    ///
    /// What filled gaps add scatters too. So a bin counts [fewer segments](Bin::segments) than its level has.
    #[must_use]
    pub fn without_bridges(mut self, bridged: &Bridged, samples: u64) -> Self {
        self.take_off_bridges(bridged, samples);
        self
    }

    /// Takes off what filled gaps change.
    #[inline(never)]
    pub(super) fn take_off_bridges(&mut self, bridged: &Bridged, samples: u64) {
        if bridged.is_empty() {
            return;
        }
        let places = samples.saturating_add(bridged.lost());
        let segment = self.segment();
        let bins = self.all_mut();
        let measured: Vec<Real, B> = fill(bins.iter().map(|bin| bin.density));
        let mut left_out = None;
        // No two samples of a gap and of the windows before it lie further apart.
        let distances = longest(bridged) + WINDOW as usize + ENDS[1] + 1;
        let rounds = if bridged.lost() > places / SECOND_ROUND {
            2
        } else {
            1
        };
        // The first autocovariance is that of the filled record. The second one is closer to that of the record.
        for left_rounds in (0..rounds).rev() {
            let change = Change::new(bridged, places, &autocovariance(bins, segment, distances));
            let (mut sum, mut number) = (0.0, 0.0);
            for (bin, &measured) in bins.iter_mut().zip(&measured) {
                let turns = real(bin.index) / (real(segment) * real(bin.block));
                let (factor, added) = change.of_blocks(bin.block, turns);
                let left = (measured - added).max(LEAST * measured);
                bin.density = left / factor.max(LEAST);
                let share = if measured > 0.0 { left / measured } else { 1.0 };
                if bin.index == first_bin(segment as usize) as u32 {
                    (sum, number) = (0.0, 0.0);
                }
                (sum, number) = (sum + share, number + 1.0);
                if left_rounds == 0 {
                    let segments = math::floor(real(bin.segments) * share * share + 0.5);
                    let least = bin.segments.min(Self::SPARSE_SEGMENTS);
                    bin.segments = (segments as u32).max(least);
                    let is_end = bin.index.wrapping_add(1) == segment / 2;
                    if is_end && sum < LEFT_OUT * number && left_out.is_none() {
                        left_out = Some(bin.block);
                    }
                }
            }
        }
        if let Some(block) = left_out {
            self.leave_out_from(block);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::real::double;
    use core::f64::consts::TAU;

    /// Gaps of 1, of 7 and of 60 samples, which take 2 % of a record of white noise and of one that moves slowly.
    fn changes() -> [(Bridged, Change); 2] {
        let mut bridged = Bridged::NONE;
        for (class, gaps, lost) in [(0, 300, 300), (3, 100, 700), (6, 20, 1200)] {
            bridged.gaps[class] = gaps;
            bridged.samples[class] = lost;
        }
        [1.0, 40.0].map(|scale| {
            let covariance = core::array::from_fn(|k| {
                let near = libm::exp(-(k as f64) / scale);
                real(if scale > 1.0 { near } else { f64::from(k == 0) })
            });
            (bridged, Change::new(&bridged, 110_000, &covariance))
        })
    }

    #[test]
    fn the_factor_is_that_of_the_mean_before_each_class_of_gaps() {
        for (bridged, change) in changes() {
            for place in 1..256 {
                let turns = f64::from(place) / 512.0;
                let (mut re, mut im) = (1.0, 0.0);
                for (lost, length) in lengths(&bridged) {
                    let share = f64::from(lost) / 110_000.0;
                    re -= share;
                    // A sample of the gap is filled by each of a window of samples, at both distances.
                    let all = f64::from(length * WINDOW) * 2.0;
                    for inside in 0..length {
                        for end in ENDS {
                            for before in 1..=WINDOW {
                                let distance = f64::from(inside + before) + end as f64;
                                re += share / all * libm::cos(TAU * turns * distance);
                                im += share / all * libm::sin(TAU * turns * distance);
                            }
                        }
                    }
                }
                let expected = re * re + im * im;
                let found = double(change.exactly_at(real(turns)).0);
                assert!(
                    (found - expected).abs() < 2e-5,
                    "{place}: {found} {expected}"
                );
            }
        }
    }

    #[test]
    fn slow_bins_lie_on_a_parabola() {
        for (_, change) in changes() {
            for place in 1..=100 {
                let turns = real(place) * SLOW / 100.0;
                let [exact, near] = [change.exactly_at(turns), change.at(turns)]
                    .map(|(factor, added)| (double(factor), double(added)));
                let largest = double(change.slow[0].1.abs()) + 0.02;
                assert!(
                    (exact.0 - near.0).abs() < 1e-4,
                    "{place}: {exact:?} {near:?}"
                );
                assert!(
                    (exact.1 - near.1).abs() < 4e-3 * largest,
                    "{place}: {exact:?} {near:?}"
                );
            }
        }
    }
}
