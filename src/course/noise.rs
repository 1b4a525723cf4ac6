//! Changes of the noise, and bursts.

use super::{
    BLOCKS,
    baseline::{deviation_of_median, median, standardised_ratio},
    event::{Event, Largest, What},
};
use crate::{
    evidence::course::Level,
    limits::TWO_SIDED_95,
    list::{self, numbered},
    numerics::{
        chi_squared::chi_squared_tail,
        math,
        real::{Real, consts::PI, real},
    },
    theory::model::{Model, Term},
};
use heapless::Vec;

/// A noise change is reported from this standardised ratio on. `cargo xtask study course` measures how often it is
/// exceeded in clean records: in 0.1 % of those of white noise, whatever their length.
const CHANGE: f64 = 4.3;

/// A burst is reported from this standardised ratio on. `cargo xtask study course` measures how often it is exceeded in
/// clean records.
const BURST: f64 = 4.85;

/// Bursts are also reported if the noise is not the same in all blocks between two changes, with this p-value or less.
const HOMOGENEOUS: f64 = 1e-5;

/// The standardised ratio from which on a block has a burst, where there are bursts.
const MARKED: f64 = 3.0;

/// The largest number of noise changes that are reported.
pub(super) const MAX_CHANGES: usize = 3;

/// The number of blocks in the neighbourhood of a block, itself included.
const NEIGHBOURS: usize = 9;

/// The differences that a block needs to be tested.
const MIN_DIFFERENCES: Real = 32.0;

/// Blocks scatter more than the model says, and not by chance, if their deviation is this many times as large. With
/// 63 pairs of neighbours, it is a distance of more than four standard errors. Chosen by hand.
const OVERDISPERSED: Real = 1.8;

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
        let of = |(term, square): (&Term, &Real)| {
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
    // Bursts are left out, because they would look like the scatter of all blocks.
    bursts(&mut blocks, real(MARKED));
    let widened = overdispersion(&blocks);
    for block in &mut blocks {
        block.freedom /= widened * widened;
    }
    let mut strongest = bursts(&mut blocks, real(BURST));
    let mut found = changes(&blocks, largest);
    let has_bursts = blocks.iter().any(|block| block.is_burst);
    if has_bursts || homogeneity(&blocks, &found) < real(HOMOGENEOUS) {
        // Where there are bursts, weaker ones are likely. They would pass for changes of the noise.
        strongest = bursts(&mut blocks, real(MARKED));
        found = changes(&blocks, largest);
    }
    if let Some(strongest) = strongest {
        largest.burst = strongest.z;
        if let Some(event) = strongest.event(&blocks, block_s) {
            each(event);
        }
    }
    tell_changes(&blocks, &found, block_s, each);
}

/// The probability that blocks of the same noise differ as much as these do between the changes, bursts left out:
/// the test of Bartlett, Proceedings of the Royal Society A 160, 268, 1937. 1 if there are too few blocks.
fn homogeneity(blocks: &[Noise], changes: &[usize]) -> Real {
    let (mut statistic, mut freedom) = (0.0, 0);
    let mut from = 0;
    for to in changes.iter().copied().chain([blocks.len()]) {
        let part = blocks.get(from..to).unwrap_or_default();
        from = to;
        let (square, whole) = pooled(part);
        let steady = || part.iter().filter(|block| !block.is_burst);
        let number = list::count(steady());
        if number < 2 {
            continue;
        }
        let (mut sum, mut reciprocals) = (0.0, 0.0);
        for block in steady() {
            sum += block.freedom * math::log(square / block.square);
            reciprocals += 1.0 / block.freedom;
        }
        let others = number.saturating_sub(1);
        let bias = (reciprocals - 1.0 / whole) / (3.0 * real(others as u32));
        statistic += sum / (1.0 + bias);
        freedom = others.saturating_add(freedom);
    }
    if freedom == 0 {
        return 1.0;
    }
    chi_squared_tail(statistic, freedom)
}

/// How much more neighbouring blocks differ than their degrees of freedom say, as a ratio of standard deviations; 1
/// if it may be chance. Counts of few levels, telegraph noise and other noise that is not Gaussian have a larger one.
fn overdispersion(blocks: &[Noise]) -> Real {
    let pairs = blocks.windows(2).filter_map(|pair| match pair {
        [a, b] if !a.is_burst && !b.is_burst => {
            let ratio = b.square / a.square;
            Some(standardised_ratio(ratio, b.freedom, a.freedom))
        }
        _ => None,
    });
    let sizes = pairs.map(|z| if z < 0.0 { -z } else { z });
    let ratio = deviation_of_median(median(sizes));
    if ratio > OVERDISPERSED { ratio } else { 1.0 }
}

/// The block that exceeds its neighbourhood most.
struct Strongest {
    z: Real,
    block: Noise,
    /// The mean square of the neighbourhood, and its degrees of freedom.
    near: (Real, Real),
}

impl Strongest {
    /// The event of all blocks that are marked; `None` if there is none.
    fn event(&self, blocks: &[Noise], block_s: Real) -> Option<Event> {
        let number = list::count(blocks.iter().filter(|block| block.is_burst));
        let what = What::Bursts {
            blocks: number.min(BLOCKS) as u8,
        };
        let at_s = (real(self.block.place) + 0.5) * block_s;
        let own = (self.block.square, self.block.freedom);
        (number > 0).then(|| ratio(what, at_s, self.z, own, self.near))
    }
}

/// Marks the blocks whose noise exceeds that of their neighbourhood by a standardised ratio of `limit`, and returns
/// the strongest block.
fn bursts(blocks: &mut Vec<Noise, BLOCKS>, limit: Real) -> Option<Strongest> {
    let mut strongest: Option<Strongest> = None;
    let mut marked = [false; BLOCKS];
    for (b, (block, mark)) in numbered(blocks.iter().zip(&mut marked)) {
        let last_first = blocks.len().saturating_sub(NEIGHBOURS);
        let first = b.saturating_sub(NEIGHBOURS / 2).min(last_first);
        let near = || blocks.iter().skip(first).take(NEIGHBOURS);
        let level = median(near().map(|block| block.square));
        // The median of normal variables has π/2 times the variance of their mean.
        let freedom = near().map(|block| block.freedom).sum::<Real>() * (2.0 / PI);
        let z = standardised_ratio(block.square / level, block.freedom, freedom);
        *mark = z > limit;
        if strongest.as_ref().is_none_or(|other| z > other.z) {
            strongest = Some(Strongest {
                z,
                block: *block,
                near: (level, freedom),
            });
        }
    }
    for (block, mark) in blocks.iter_mut().zip(marked) {
        block.is_burst = mark;
    }
    strongest
}

/// The first block after each change of the noise, in the order of time: the split with the largest standardised
/// ratio, and then those of its two parts.
fn changes(blocks: &[Noise], largest: &mut Largest) -> Vec<usize, MAX_CHANGES> {
    let mut found: Vec<usize, MAX_CHANGES> = Vec::new();
    let mut parts: Vec<(usize, usize), { 2 * MAX_CHANGES + 1 }> = Vec::new();
    let _ = parts.push((0, blocks.len()));
    let mut next = 0_usize;
    while let Some(&(from, to)) = parts.get(next) {
        let is_first = next == 0;
        next = next.saturating_add(1);
        let Some((at, z)) = split(blocks, from, to) else {
            continue;
        };
        if is_first {
            largest.noise_change = z;
        }
        if z * z <= real(CHANGE * CHANGE) || found.is_full() {
            continue;
        }
        list::rank(&mut found, at, |&other| other > at);
        let _ = parts.push((from, at));
        let _ = parts.push((at, to));
    }
    found
}

/// Hands every change of the noise to `each`, with the noise between its two neighbouring changes.
fn tell_changes(blocks: &[Noise], found: &[usize], block_s: Real, each: &mut dyn FnMut(Event)) {
    let mut from = 0;
    for (i, &at) in numbered(found.iter()) {
        let next = found.get(i.saturating_add(1)).copied();
        let part = |from: usize, to: usize| pooled(blocks.get(from..to).unwrap_or_default());
        let before = part(from, at);
        let after = part(at, next.unwrap_or(blocks.len()));
        from = at;
        let z = standardised_ratio(after.0 / before.0, after.1, before.1);
        let place = blocks.get(at).map_or(0, |block| block.place);
        let at_s = real(place) * block_s;
        each(ratio(What::NoiseChange, at_s, z, after, before));
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
