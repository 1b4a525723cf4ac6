//! A contiguous part of a record.

use super::{
    edges::{Edges, Joint, boundaries},
    extremes::Extremes,
    powers::{Powers, segments},
    runs::Runs,
    sizes::Sizes,
    squares::{Angle, NEAR, Near, difference},
    stale::Stale,
};
use crate::sizes::{LEVELS, MOST_SAMPLES, OCTAVES, SEGMENT};
use serde::{Deserialize, Serialize};
use std::{array::from_fn, cell::Cell, ops::Range};

/// The number of block lengths at whose boundaries angles are kept: 1, 8, 64, … An octave `m` needs those of `m/4` samples, which
/// are every first, second or fourth one of these.
const LENGTHS: usize = OCTAVES.div_ceil(3);

/// The number of bits by which the length grows.
const RADIX_BITS: usize = 3;

/// The octave whose differences begin at boundaries of the shortest blocks, four of which are its cluster.
const FIRST: usize = 2;

/// The sums of neighbouring samples, and what their neighbours need.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Piece {
    /// The number of the first sample in the record.
    start: u64,
    /// The number behind that of the last sample.
    end: u64,
    /// The sum of all counts, which wraps.
    total: i64,
    /// For each octave, the sum of the squares of its differences.
    squares: [u128; OCTAVES],
    /// For each block length, the angles at the ends.
    edges: [Edges; LENGTHS],
    /// For each level of the spectrum, the powers of its segments.
    powers: [Powers; LEVELS],
    /// For each length of [`SIZED`], the sizes of the differences of neighbouring blocks.
    sizes: [Sizes; SIZED.len()],
    /// The number of samples that equal the one before.
    repeats: u64,
    runs: Runs,
    extremes: Extremes,
    stale: Stale,
}

/// The block lengths whose differences are counted by their sizes, as places among the lengths, which are 1, 64 and 512 samples; and
/// the number of differences that are counted together. Of samples, that is more than one, because there are so many of them.
const SIZED: [(usize, u64); 3] = [(0, 32), (2, 1), (3, 1)];

/// The groups of so many differences of neighbouring blocks that lie between these boundaries.
fn groups(boundaries: &Range<u64>, together: u64) -> Range<u64> {
    starts(boundaries, together, together + 1)
}

/// The number of boundaries of blocks of `8^length` samples from one to the next start of a difference of an octave, and
/// from its start to the end of its first cluster.
const fn strides(octave: usize) -> (u64, u64) {
    match octave.checked_sub(FIRST) {
        Some(above) => {
            let stride = 1 << (above % RADIX_BITS);
            (stride, 4 * stride)
        }
        None => (1, 1 << octave),
    }
}

/// The block length at whose boundaries an octave's differences begin, as a place among the lengths.
const fn length_of(octave: usize) -> usize {
    octave.saturating_sub(FIRST) / RADIX_BITS
}

impl Piece {
    /// The piece of these counts, of which the first one is sample `start` of the record. There is one at least.
    pub(super) fn of(start: u64, counts: &[i32]) -> Self {
        // A constant takes no part in differences and in powers. Without the first count, nearly all records have small angles.
        let constant = counts.first().map_or(0, |&count| i64::from(count));
        let extremes = Extremes::of(counts);
        if is_near(counts, constant, &extremes) {
            Self::of_angles::<Near>(start, counts, constant, extremes)
        } else {
            Self::of_angles::<i64>(start, counts, constant, extremes)
        }
    }

    fn of_angles<A: Angle>(start: u64, counts: &[i32], constant: i64, extremes: Extremes) -> Self {
        let mut angles = Vec::with_capacity(counts.len() + 1);
        let mut angle = A::default();
        angles.push(angle);
        angles.extend(counts.iter().map(|&count| {
            angle = angle.after(i64::from(count).wrapping_sub(constant));
            angle
        }));
        let range = start..start + counts.len() as u64;
        let mut sums = [0; OCTAVES];
        for (octave, sum) in sums.iter_mut().enumerate().take(FIRST) {
            *sum = A::squares(&angles, 1 << octave);
        }
        let mut powers: [Powers; LEVELS] = Default::default();
        let mut edges = from_fn(|_| Edges::default());
        let mut sizes: [Sizes; SIZED.len()] = Default::default();
        let pairs = counts.iter().zip(counts.iter().skip(1));
        let repeats: u64 = pairs.map(|(one, next)| u64::from(one == next)).sum();
        for (bits, sum) in sums[FIRST..].iter_mut().enumerate() {
            let places = boundaries(&range, 1 << bits);
            *sum = A::squares(&angles, 4);
            if bits.is_multiple_of(RADIX_BITS) {
                let length = bits / RADIX_BITS;
                edges[length] = Edges::of(angles.len() as u64, |place| {
                    let samples = ((places.start + place) << bits) - start;
                    let of_constant = constant.wrapping_mul(samples as i64);
                    angles[place as usize].wide().wrapping_add(of_constant)
                });
                let sized = SIZED.iter().position(|&(sized, _)| sized == length);
                if let Some(at) = sized {
                    for group in groups(&places, SIZED[at].1) {
                        let first = (group * SIZED[at].1 - places.start) as usize;
                        let angles = angles.get(first..first + SIZED[at].1 as usize + 2);
                        sizes[at].add_all(A::together(angles.unwrap_or_default()));
                    }
                }
                if let Some(powers) = powers.get_mut(length) {
                    let values = |start: u64, factor: f32, values: &mut [f32; SEGMENT]| {
                        let angles = &angles[(start - places.start) as usize..];
                        A::blocks(angles, factor, values);
                    };
                    powers.add(segments(&places), bits as u32, values);
                }
            }
            // Of the boundaries, those with even numbers are the ones of blocks of twice the length.
            let skipped = places.start as usize % 2;
            let cells = Cell::from_mut(angles.as_mut_slice()).as_slice_of_cells();
            let evens = cells.get(skipped..).unwrap_or_default().chunks(2);
            let kept = evens.len();
            for (to, pair) in cells.iter().zip(evens) {
                to.set(pair[0].get());
            }
            angles.truncate(kept);
        }
        Self {
            start,
            end: range.end,
            total: angle
                .wide()
                .wrapping_add(constant.wrapping_mul(counts.len() as i64)),
            squares: sums,
            edges,
            powers,
            runs: Runs::of(counts, repeats),
            repeats,
            sizes,
            extremes,
            stale: Stale::of(counts),
        }
    }

    /// The numbers of its samples in the record.
    pub(super) fn range(&self) -> Range<u64> {
        self.start..self.end
    }

    /// The number of samples.
    pub(super) fn samples(&self) -> u64 {
        self.end - self.start
    }

    /// The number of differences of an octave, and the sum of their squares.
    pub(super) fn octave(&self, octave: usize) -> (u64, u128) {
        let block = 1 << (RADIX_BITS * length_of(octave));
        let range = boundaries(&self.range(), block);
        let (stride, cluster) = strides(octave);
        let starts = starts(&range, stride, 2 * cluster);
        let number = starts.end.saturating_sub(starts.start);
        (number, self.squares.get(octave).copied().unwrap_or(0))
    }

    /// The number of segments of a level of the spectrum, and their powers.
    pub(super) fn level(&self, level: usize) -> (u64, &Powers) {
        let range = boundaries(&self.range(), 1 << (RADIX_BITS * level));
        let segments = segments(&range);
        (segments.end - segments.start, &self.powers[level])
    }

    /// The number of samples that equal the one before.
    pub(super) fn repeats(&self) -> u64 {
        self.repeats
    }

    /// The sizes of the differences of neighbouring samples, 32 together, of blocks of 64 and of blocks of 512.
    pub(super) fn sizes(&self) -> &[Sizes; 3] {
        &self.sizes
    }

    /// Runs of equal samples.
    pub(super) fn runs(&self) -> &Runs {
        &self.runs
    }

    /// Blocks that are there twice.
    pub(super) fn stale(&self) -> &Stale {
        &self.stale
    }

    /// The extreme samples.
    pub(super) fn extremes(&self) -> &Extremes {
        &self.extremes
    }

    /// Joins the piece that begins where this one ends. Nothing of the record is lost.
    pub(super) fn join(&mut self, next: &Self) {
        let (before, after) = (self.range(), next.range());
        for length in 0..LENGTHS {
            let bits = RADIX_BITS * length;
            let joint = Joint {
                left: (boundaries(&before, 1 << bits), &self.edges[length]),
                right: (boundaries(&after, 1 << bits), &next.edges[length]),
                total: self.total,
            };
            let octaves = (0..OCTAVES).filter(|&octave| length_of(octave) == length);
            for octave in octaves {
                let across = across(&joint, strides(octave));
                let sum = &mut self.squares[octave];
                *sum = sum
                    .saturating_add(next.squares[octave])
                    .saturating_add(across);
            }
            if let Some(powers) = self.powers.get_mut(length) {
                powers.join(&next.powers[length]);
                // What lies within one of the two is there already.
                let [left, right] = [&joint.left.0, &joint.right.0].map(segments);
                let crossing = left.end..right.start.min(segments(&joint.range()).end);
                let values = |start: u64, factor: f32, values: &mut [f32; SEGMENT]| {
                    let angle = |place| joint.angle(start + place as u64).unwrap_or(0);
                    let angles: [i64; SEGMENT + 1] = from_fn(angle);
                    i64::blocks(&angles, factor, values);
                };
                powers.add(crossing, bits as u32, values);
            }
            if let Some(at) = SIZED.iter().position(|&(sized, _)| sized == length) {
                let together = SIZED[at].1;
                self.sizes[at].join(&next.sizes[at]);
                let [left, right] =
                    [&joint.left.0, &joint.right.0].map(|range| groups(range, together));
                let all = groups(&joint.range(), together);
                for group in left.end.max(all.start)..right.start.min(all.end) {
                    let boundaries = (group * together..).take(together as usize + 2);
                    let angles: Vec<i64> = boundaries.filter_map(|at| joint.angle(at)).collect();
                    self.sizes[at].add_all(i64::together(&angles));
                }
            }
            if length == 0 {
                // The difference of the last sample and the first one is the only one of neighbours that is across.
                let are_equal = differences_across(&joint, (1, 1)).any(|size| size == 0);
                self.repeats += next.repeats + u64::from(are_equal);
                self.runs.join(&next.runs, are_equal);
            }
            self.edges[length] = joint.edges();
        }
        self.extremes.join(&next.extremes);
        self.stale.join(&next.stale);
        self.total = self.total.wrapping_add(next.total);
        self.end = next.end;
    }

    /// Whether a piece can be like this.
    pub(super) fn is_possible(&self) -> bool {
        let lengths = self.edges.iter().enumerate();
        let mut edges = lengths.map(|(length, edges)| {
            let range = boundaries(&self.range(), 1 << (RADIX_BITS * length));
            edges.is_possible(range.end.saturating_sub(range.start))
        });
        let mut levels = (0..LEVELS).map(|level| {
            let (segments, powers) = self.level(level);
            powers.is_possible(segments)
        });
        let mut octaves = (0..OCTAVES).map(|octave| {
            let (differences, sum) = self.octave(octave);
            differences > 0 || sum == 0
        });
        let mut sized = SIZED.iter().zip(&self.sizes);
        let are_sizes = sized.all(|(&(length, together), sizes)| {
            let range = boundaries(&self.range(), 1 << (RADIX_BITS * length));
            let groups = groups(&range, together);
            sizes.is_possible(groups.end - groups.start, together)
        });
        self.start < self.end
            && self.end <= MOST_SAMPLES
            && are_sizes
            && self.runs.is_possible(self.samples(), self.repeats)
            && self.extremes.is_possible(self.samples())
            && self.stale.is_possible(self.samples())
            && edges.all(|is_possible| is_possible)
            && levels.all(|is_possible| is_possible)
            && octaves.all(|is_possible| is_possible)
    }
}

/// Whether all angles of these counts without a constant are near zero.
fn is_near(counts: &[i32], constant: i64, extremes: &Extremes) -> bool {
    let near = NEAR.unsigned_abs();
    // The extremes alone tell it of most records, and do so in a fraction of the time.
    if extremes
        .distance(constant)
        .saturating_mul(counts.len() as u64)
        < near
    {
        return true;
    }
    let (mut angle, mut farthest) = (0_i64, 0_u64);
    for &count in counts {
        angle += i64::from(count) - constant;
        farthest = farthest.max(angle.unsigned_abs());
    }
    farthest < near
}

/// The starts of what spans so many blocks between these boundaries, in units of their stride.
fn starts(boundaries: &Range<u64>, stride: u64, span: u64) -> Range<u64> {
    let first = boundaries.start.div_ceil(stride);
    let last = boundaries.end.checked_sub(span + 1);
    first..last.map_or(first, |last| first.max(last / stride + 1))
}

/// The sum of the squares of the differences that lie within neither piece.
fn across(joint: &Joint<'_>, strides: (u64, u64)) -> u128 {
    let squares =
        differences_across(joint, strides).map(|size| u128::from(size) * u128::from(size));
    squares.fold(0, u128::saturating_add)
}

/// The sizes of the differences that lie within neither piece.
fn differences_across<'a>(
    joint: &'a Joint<'_>,
    (stride, cluster): (u64, u64),
) -> impl Iterator<Item = u64> + 'a {
    let [left, right] =
        [&joint.left.0, &joint.right.0].map(|range| starts(range, stride, 2 * cluster));
    let all = starts(&joint.range(), stride, 2 * cluster);
    let crossing = left.end.max(all.start)..right.start.min(all.end);
    crossing.filter_map(move |start| {
        let [oldest, middle, newest] =
            [0, 1, 2].map(|clusters| joint.angle(start * stride + clusters * cluster));
        Some(difference(oldest?, middle?, newest?).unsigned_abs())
    })
}
