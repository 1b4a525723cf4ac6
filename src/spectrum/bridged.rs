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
        Bridged, CLASSES,
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

/// The number of levels from which the autocovariance is made. What lies below is the same in a gap and before it.
const LEVELS: usize = 3;

/// The gaps of a record, and what they do to its density.
struct Change {
    /// The share of samples that are filled, and the length of the gaps, class by class.
    classes: [(Real, u32); CLASSES],
    /// The autocovariance of what is left in the gaps alone, for one sample of the record.
    left: [Real; LONGEST],
    /// The share of samples that are filled.
    share: Real,
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
        let mut with_window = [0.0; LONGEST + 1];
        let mut sum = 0.0;
        for (t, place) in numbered(with_window.iter_mut().skip(1)) {
            for end in ENDS {
                let first = t.wrapping_add(end).wrapping_add(1);
                let near = (first..first.wrapping_add(window)).map(at);
                sum += near.sum::<Real>() / real(2 * WINDOW);
            }
            *place = sum;
        }
        let until = |t: usize| with_window.get(t).copied().unwrap_or(0.0);

        let mut change = Self {
            classes: [(0.0, 1); CLASSES],
            left: [0.0; LONGEST],
            share: 0.0,
        };
        let classes = bridged.gaps.iter().zip(&bridged.samples);
        for (own, (&gaps, &lost)) in change.classes.iter_mut().zip(classes) {
            if gaps == 0 {
                continue;
            }
            let mean = (lost.wrapping_add(gaps / 2) / gaps).clamp(1, LONGEST as u32);
            let share = real(lost) / real(places);
            *own = (share, mean);
            let length = mean as usize;
            change.share += share;
            for (k, left) in numbered(change.left.iter_mut().take(length)) {
                let rest = length.wrapping_sub(k);
                let both = until(rest) + until(length) - until(k);
                let sum = real(rest) * (at(k) + of_window) - both;
                *left += share / real(length) * sum;
            }
        }
        change
    }

    /// The factor of the density, and what is added to it, at a frequency in turns a sample. What is added is the
    /// variance of independent samples that would have as much.
    fn at(&self, turns: Real) -> (Real, Real) {
        let (_, cosine) = sincos_of_turns(turns);
        let mut added = 0.0;
        // The cosines of the multiples of the angle, one after the other.
        let (mut near, mut before) = (1.0, cosine);
        let mut sides = 1.0;
        for left in &self.left {
            added += sides * left * near;
            (near, before) = (2.0 * cosine * near - before, near);
            sides = 2.0;
        }

        // The mean of the phases of neighbouring samples is that of their middle, times this.
        let (half, _) = sincos_of_turns(0.5 * turns);
        let mean = |n: u32| sincos_of_turns(0.5 * real(n) * turns).0 / (real(n) * half);
        let (_, apart) = sincos_of_turns(0.5 * real(ENDS[1] - ENDS[0]) * turns);
        let window = apart * mean(WINDOW);
        let (mut re, mut im) = (1.0, 0.0);
        for &(share, length) in &self.classes {
            if share > 0.0 {
                let between = real(ENDS[0] + ENDS[1]) + real(WINDOW) + real(length);
                let (sine, cosine) = sincos_of_turns(0.5 * between * turns);
                let filter = window * mean(length);
                re -= share * (1.0 - filter * cosine);
                im += share * filter * sine;
            }
        }
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

/// The autocovariance of a record with these densities, up to a constant, in units of half the rate. Each level takes over
/// below the one of shorter blocks.
fn autocovariance(bins: &[Bin], segment: u32) -> [Real; REACH] {
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
            for covariance in &mut covariance {
                *covariance += power * near;
                (near, before) = (2.0 * cosine * near - before, near);
            }
        }
    }
    covariance
}

impl<const B: usize> Spectrum<B> {
    /// The spectrum without what filled gaps change in its densities, for a record of so many samples without those that
    /// were lost, whose segments go on across filled gaps. [`Axes`](crate::Axes) treats a loss as a gap of the spectrum
    /// instead. The spectrum stays as it is if no gap was filled.
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
        // The first autocovariance is that of the filled record. The second one is closer to that of the record.
        for is_last in [false, true] {
            let change = Change::new(bridged, places, &autocovariance(bins, segment));
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
                if is_last {
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
