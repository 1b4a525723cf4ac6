//! Changes of the noise, and bursts.

use super::{
    BLOCKS, Level,
    baseline::{deviation_of_median, median, standardised_ratio},
    event::{Event, Largest, What},
};
use crate::{
    limits::TWO_SIDED_95,
    list::{self, numbered},
    math,
    model::Model,
    real::{Real, real},
};
use heapless::Vec;

/// A noise change is told from this standardised ratio on. `cargo xtask study course` measures how often it is
/// exceeded in clean records.
const CHANGE: f64 = 4.5;

/// A burst is told from this standardised ratio on. `cargo xtask study course` measures how often it is exceeded in
/// clean records.
const BURST: f64 = 4.9;

/// The number of noise changes that are told at most.
pub(super) const MAX_CHANGES: usize = 3;

/// The number of blocks in the neighbourhood of a block, itself included.
const NEIGHBOURS: usize = 9;

/// The differences that a block needs to be tested.
const MIN_DIFFERENCES: Real = 32.0;

/// Blocks scatter more than the model says, and not by chance, if their deviation is this many times as large. With
/// 63 pairs of neighbours, it is a distance of four standard errors. Chosen by hand.
const OVERDISPERSED: Real = 1.5;

/// The number of lags at which the differences of neighbouring samples may be correlated.
const LAGS: u32 = 64;

/// The degrees of freedom of a mean square of differences of neighbouring samples, per difference.
///
/// A sum of n squares of Gaussian differences with the autocovariance `c(ℓ)` has the variance `2n Σ_ℓ c(ℓ)²` over all lags
/// (Isserlis 1918), as many as `n c(0)²/Σ_ℓ c(ℓ)²` independent ones. White noise has `c = 2, −1, 0, …`, and 2/3.
pub(super) fn freedom_per_difference(model: &Model, squares: &[Real], interval_s: Real) -> Real {
    let terms = || model.terms().iter().zip(squares);
    // Second differences of G, whose second differences are the autocovariance but for a factor.
    let second = |lag: Real| -> Real {
        let of = |(term, square): (&crate::model::Term, &Real)| {
            let shape = term.sampled_shape(interval_s);
            square * term.effect.second_difference(lag, 1.0, &shape)
        };
        terms().map(of).sum()
    };
    let (mut before, mut at) = (second(1.0), second(0.0));
    let (mut variance, mut sum) = (0.0, 0.0);
    for lag in 0..LAGS {
        let after = second(real(lag) + 1.0);
        let covariance = after - 2.0 * at + before;
        if lag == 0 {
            variance = covariance;
            sum = covariance * covariance;
        } else {
            sum += 2.0 * covariance * covariance;
        }
        (before, at) = (at, after);
    }
    let share = variance * variance / sum;
    if share.is_finite() && share > 0.0 {
        share.min(1.0)
    } else {
        2.0 / 3.0
    }
}

/// The noise of one block.
#[derive(Clone, Copy)]
struct Noise {
    /// Mean square of the differences.
    square: Real,
    freedom: Real,
    /// The place of the block.
    place: u32,
    is_burst: bool,
}

/// The pooled mean square of some blocks, and its degrees of freedom.
fn pooled(blocks: &[Noise]) -> (Real, Real) {
    let steady = blocks.iter().filter(|block| !block.is_burst);
    let (sum, freedom) = steady.fold((0.0, 0.0), |(sum, freedom), block| {
        (sum + block.square * block.freedom, freedom + block.freedom)
    });
    if freedom > 0.0 {
        (sum / freedom, freedom)
    } else {
        (0.0, 0.0)
    }
}

/// Adds the changes of the noise and the bursts to `events`. `freedom` is the number of degrees of freedom per
/// difference, and `block_s` is the duration of a block.
#[inline(never)]
pub(super) fn find(
    levels: &[Level],
    freedom: Real,
    block_s: Real,
    largest: &mut Largest,
    each: &mut dyn FnMut(Event),
) {
    let usable = levels.iter().filter(|level| {
        level.differences >= MIN_DIFFERENCES && level.square > 0.0 && level.square.is_finite()
    });
    let mut blocks: Vec<Noise, BLOCKS> = list::fill(usable.map(|level| Noise {
        square: level.square,
        freedom: level.differences * freedom,
        place: level.place,
        is_burst: false,
    }));
    if blocks.len() < NEIGHBOURS {
        return;
    }
    let widened = overdispersion(&blocks);
    for block in &mut blocks {
        block.freedom /= widened * widened;
    }
    if let Some(event) = bursts(&mut blocks, block_s, largest) {
        each(event);
    }
    changes(&blocks, block_s, largest, each);
}

/// How much more neighbouring blocks differ than their degrees of freedom say, as a ratio of standard deviations; 1
/// if it may be chance. Counts of few levels, telegraph noise and other noise that is not Gaussian have a larger one.
fn overdispersion(blocks: &[Noise]) -> Real {
    let pairs = blocks.windows(2).filter_map(|pair| match pair {
        [a, b] => Some(standardised_ratio(
            b.square / a.square,
            b.freedom,
            a.freedom,
        )),
        _ => None,
    });
    let sizes = pairs.map(|z| if z < 0.0 { -z } else { z });
    let ratio = deviation_of_median(median(sizes));
    if ratio > OVERDISPERSED { ratio } else { 1.0 }
}

/// Marks the bursts, and returns their event.
fn bursts(blocks: &mut Vec<Noise, BLOCKS>, block_s: Real, largest: &mut Largest) -> Option<Event> {
    let mut strongest: Option<(Real, Noise, Real, Real)> = None;
    let mut marked = [false; BLOCKS];
    for (b, (block, mark)) in numbered(blocks.iter().zip(&mut marked)) {
        let last_first = blocks.len().saturating_sub(NEIGHBOURS);
        let first = b.saturating_sub(NEIGHBOURS / 2).min(last_first);
        let near = || blocks.iter().skip(first).take(NEIGHBOURS);
        let level = median(near().map(|block| block.square));
        // The median of normal variables has π/2 times the variance of their mean.
        let freedom = near().map(|block| block.freedom).sum::<Real>() * real(0.637);
        let z = standardised_ratio(block.square / level, block.freedom, freedom);
        *mark = z > real(BURST);
        if strongest.is_none_or(|(other, ..)| z > other) {
            strongest = Some((z, *block, level, freedom));
        }
    }
    let mut number = 0_u8;
    for (block, mark) in blocks.iter_mut().zip(marked) {
        block.is_burst = mark;
        number = number.saturating_add(u8::from(mark));
    }
    let (z, block, level, freedom) = strongest?;
    largest.burst = z;
    let what = What::Bursts { blocks: number };
    let at_s = (real(block.place) + 0.5) * block_s;
    (number > 0).then(|| ratio(what, at_s, z, (block.square, block.freedom), (level, freedom)))
}

/// Hands every change of the noise to `each`: the split with the largest standardised ratio, and then those of its
/// two parts.
fn changes(
    blocks: &[Noise],
    block_s: Real,
    largest: &mut Largest,
    each: &mut dyn FnMut(Event),
) {
    // The first block after each change, in the order of time.
    let mut found: Vec<usize, MAX_CHANGES> = Vec::new();
    let mut parts: Vec<(usize, usize), { 2 * MAX_CHANGES + 1 }> = Vec::new();
    let _ = parts.push((0, blocks.len()));
    let mut next = 0;
    while let Some(&(from, to)) = parts.get(next) {
        next += 1;
        let Some((at, z)) = split(blocks, from, to) else {
            continue;
        };
        if next == 1 {
            largest.noise_change = z;
        }
        if z * z <= real(CHANGE * CHANGE) || found.is_full() {
            continue;
        }
        list::rank(&mut found, at, |&other| other > at);
        let _ = parts.push((from, at));
        let _ = parts.push((at, to));
    }
    for (i, &at) in numbered(found.iter()) {
        let from = i.checked_sub(1).and_then(|i| found.get(i)).copied();
        let to = found.get(i.saturating_add(1)).copied();
        let part = |from: usize, to: usize| pooled(blocks.get(from..to).unwrap_or_default());
        let before = part(from.unwrap_or(0), at);
        let after = part(at, to.unwrap_or(blocks.len()));
        let z = standardised_ratio(after.0 / before.0, after.1, before.1);
        let place = blocks.get(at).map_or(0, |block| block.place);
        each(ratio(
            What::NoiseChange,
            real(place) * block_s,
            z,
            after,
            before,
        ));
    }
}

/// The split of a part of the blocks with the largest standardised ratio: the first block after it, and the ratio.
fn split(blocks: &[Noise], from: usize, to: usize) -> Option<(usize, Real)> {
    let mut best: Option<(usize, Real)> = None;
    for at in from.saturating_add(1)..to {
        let before = pooled(blocks.get(from..at)?);
        let after = pooled(blocks.get(at..to)?);
        let z = standardised_ratio(after.0 / before.0, after.1, before.1);
        if best.is_none_or(|(_, other)| z * z > other * other) {
            best = Some((at, z));
        }
    }
    best
}

/// The event of a ratio of two mean squares, each with its degrees of freedom.
fn ratio(
    what: What,
    at_s: Real,
    z: Real,
    (after, a): (Real, Real),
    (before, b): (Real, Real),
) -> Event {
    let size = math::sqrt(after / before);
    // The logarithm of a standard deviation has the variance 1/(2 degrees of freedom).
    let error = math::sqrt(0.5 / a + 0.5 / b);
    let factor = math::exp(real(TWO_SIDED_95) * error);
    Event {
        what,
        at_s,
        size,
        lower: size / factor,
        upper: size * factor,
        z,
    }
}
