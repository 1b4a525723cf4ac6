//! A contiguous part of a record.

use super::{
    edges::{Edges, Joint, boundaries},
    powers::{Powers, segments},
    squares::{Angle, NEAR, Near, difference},
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
        if is_near(counts, constant) {
            Self::of_angles::<Near>(start, counts, constant)
        } else {
            Self::of_angles::<i64>(start, counts, constant)
        }
    }

    fn of_angles<A: Angle>(start: u64, counts: &[i32], constant: i64) -> Self {
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
        let starts = starts(&range, stride, cluster);
        let number = starts.end.saturating_sub(starts.start);
        (number, self.squares.get(octave).copied().unwrap_or(0))
    }

    /// The number of segments of a level of the spectrum, and their powers.
    pub(super) fn level(&self, level: usize) -> (u64, &Powers) {
        let range = boundaries(&self.range(), 1 << (RADIX_BITS * level));
        let segments = segments(&range);
        (segments.end - segments.start, &self.powers[level])
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
            self.edges[length] = joint.edges();
        }
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
        self.start < self.end
            && self.end <= MOST_SAMPLES
            && edges.all(|is_possible| is_possible)
            && levels.all(|is_possible| is_possible)
            && octaves.all(|is_possible| is_possible)
    }
}

/// Whether all angles of these counts without a constant are near zero.
fn is_near(counts: &[i32], constant: i64) -> bool {
    // The counts alone tell it of most records, and do so in a fraction of the time.
    let ends = counts
        .iter()
        .fold([i32::MAX, i32::MIN], |[least, most], &count| {
            [least.min(count), most.max(count)]
        });
    let ends = ends.map(|end| (i64::from(end) - constant).unsigned_abs());
    let near = NEAR.unsigned_abs();
    if ends[0].max(ends[1]).saturating_mul(counts.len() as u64) < near {
        return true;
    }
    let (mut angle, mut farthest) = (0_i64, 0_u64);
    for &count in counts {
        angle += i64::from(count) - constant;
        farthest = farthest.max(angle.unsigned_abs());
    }
    farthest < near
}

/// The starts of differences between these boundaries, in units of their stride.
fn starts(boundaries: &Range<u64>, stride: u64, cluster: u64) -> Range<u64> {
    let first = boundaries.start.div_ceil(stride);
    let last = boundaries.end.checked_sub(2 * cluster + 1);
    first..last.map_or(first, |last| first.max(last / stride + 1))
}

/// The sum of the squares of the differences that lie within neither piece.
fn across(joint: &Joint<'_>, (stride, cluster): (u64, u64)) -> u128 {
    let [left, right] = [&joint.left.0, &joint.right.0].map(|range| starts(range, stride, cluster));
    let all = starts(&joint.range(), stride, cluster);
    let crossing = left.end.max(all.start)..right.start.min(all.end);
    let squares = crossing.filter_map(|start| {
        let [oldest, middle, newest] =
            [0, 1, 2].map(|clusters| joint.angle(start * stride + clusters * cluster));
        let magnitude = difference(oldest?, middle?, newest?).unsigned_abs();
        Some(u128::from(magnitude) * u128::from(magnitude))
    });
    squares.fold(0, u128::saturating_add)
}
