//! Records that are read in pieces: on several machines, from several files, in any order.
//!
//! A gap ends every octave, so that a curve whose parts are merged depends on where the record was cut, by 3 to 40 % in long
//! octaves. A piece keeps, beside its sums, the angles at the first and the last boundaries of its blocks. From these,
//! neighbours form every difference and every segment of the spectrum that the cut goes through. So a record gives the same
//! [state](Pieces), byte by byte, however it is cut and in whatever order its pieces are joined.
//!
//! ```text
//! counts of some samples → Piece → Pieces (joined where they touch) → curve → fit, diagnosis, lot
//! ```
//!
//! Blocks begin at multiples of their length in the record's own sample numbers. A piece therefore needs to know with which
//! sample it begins, and pieces find their neighbours by that number alone, never by the order in which they arrive. Where
//! samples are missing between two pieces is a gap, and samples that come twice are refused.

mod edges;
mod exact_sum;
mod extremes;
mod gathered;
mod invalid;
mod piece;
mod powers;
mod runs;
mod sizes;
mod squares;
mod stale;
mod state;
#[cfg(test)]
mod tests;

pub use gathered::Gathered;
pub use powers::UNIT_BITS;

use crate::{failure::Failure, sizes::MOST_SAMPLES};
use piece::Piece;
use powers::Powers;
use serde::{Deserialize, Serialize};
use std::{collections::BTreeMap, ops::Range};

/// The number of samples whose angles are in memory at once.
const CHUNK: usize = 1 << 16;

/// The bytes that a stretch of 40 000 samples has beyond the size of a [`Piece`]: its angles and its powers.
const OF_A_STRETCH: usize = 12_000;

/// What is kept of one axis of a record, as far as it was read. It takes some kilobytes for each contiguous stretch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pieces {
    /// Samples per second.
    rate_hz: f64,
    /// Rate units per count.
    rate_per_count: f64,
    /// The stretches, each under the number of its first sample. No two of them touch.
    stretches: BTreeMap<u64, Box<Piece>>,
}

impl Pieces {
    /// No samples yet, of a sensor with this rate in samples per second and this scale in rate units per count.
    ///
    /// # Errors
    /// When one of them is not positive and finite.
    pub fn new(rate_hz: f64, rate_per_count: f64) -> Result<Self, Failure> {
        let scale = allanite::Scale::new(rate_per_count, rate_hz);
        scale.map_err(|error| Failure::option(format!("{error:#}"), error.remedy()))?;
        Ok(Self {
            rate_hz,
            rate_per_count,
            stretches: BTreeMap::new(),
        })
    }

    /// No samples, of a sensor with one sample per second and one rate unit per count.
    pub const EMPTY: Self = Self {
        rate_hz: 1.0,
        rate_per_count: 1.0,
        stretches: BTreeMap::new(),
    };

    /// The same samples of a sensor with another rate and scale, which are positive and finite.
    pub fn of_sensor(self, rate_hz: f64, rate_per_count: f64) -> Self {
        Self {
            rate_hz,
            rate_per_count,
            ..self
        }
    }

    /// Samples per second.
    pub fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    /// Rate units per count.
    pub fn rate_per_count(&self) -> f64 {
        self.rate_per_count
    }

    /// The number of samples.
    pub fn samples(&self) -> u64 {
        self.pieces().map(Piece::samples).sum()
    }

    /// About how many bytes of memory it has beyond its own size: a stretch counts as one of 40 000 samples.
    fn allocated(&self) -> usize {
        self.stretches.len() * (size_of::<Piece>() + OF_A_STRETCH)
    }

    /// The sample numbers of the contiguous stretches, earliest first.
    pub fn stretches(&self) -> impl Iterator<Item = Range<u64>> + '_ {
        self.pieces().map(Piece::range)
    }

    /// The number of differences of an octave, and the sum of their squares, in counts². It is `u128::MAX` where it exceeds 128
    /// bits.
    pub fn octave(&self, octave: usize) -> (u64, u128) {
        self.pieces().fold((0, 0), |(number, sum), piece| {
            let (differences, squares): (u64, u128) = piece.octave(octave);
            (number + differences, sum.saturating_add(squares))
        })
    }

    /// The number of segments of a level of the spectrum, and the sums of the powers and of their squares in each of its bins.
    pub fn level(&self, level: usize) -> (u64, Vec<[f64; 2]>) {
        let mut segments = 0;
        let mut powers = Powers::default();
        for piece in self.pieces() {
            let (own, sums) = piece.level(level);
            segments += own;
            powers.join(sums);
        }
        (segments, powers.sums().collect())
    }

    /// The stretches, earliest first.
    fn pieces(&self) -> impl Iterator<Item = &Piece> {
        self.stretches.values().map(AsRef::as_ref)
    }

    /// Adds the counts of neighbouring samples, of which the first one has the number `first` in the record.
    ///
    /// # Errors
    /// When some of these samples are there already, or their numbers are too large. Nothing is added then.
    pub fn push(&mut self, first: u64, counts: &[i32]) -> Result<(), Failure> {
        let range = Self::range(first, counts)?;
        self.is_free(&range)?;
        self.put(first, counts);
        Ok(())
    }

    /// The numbers of these samples.
    fn range(first: u64, counts: &[i32]) -> Result<Range<u64>, Failure> {
        let end = first.checked_add(counts.len() as u64);
        let end = end.filter(|&end| end <= MOST_SAMPLES);
        end.map(|end| first..end).ok_or_else(|| {
            Failure::option(
                format!("sample {first} has a number above 2^50"),
                "count the samples of a record from its first one on",
            )
        })
    }

    /// Adds samples of which none is there.
    fn put(&mut self, first: u64, counts: &[i32]) {
        // The first chunk may be shorter, so that the others begin at boundaries of long blocks.
        let room = CHUNK - (first % CHUNK as u64) as usize;
        let (head, rest) = counts.split_at(room.min(counts.len()));
        let mut number = first;
        for chunk in std::iter::once(head).chain(rest.chunks(CHUNK)) {
            if !chunk.is_empty() {
                self.insert(Piece::of(number, chunk));
            }
            number += chunk.len() as u64;
        }
    }

    /// Adds samples with their numbers in the record, in any order.
    ///
    /// # Errors
    /// When the slices differ in length, a sample comes twice or was there already, or a number is too large. Nothing is
    /// added then.
    pub fn push_numbered(&mut self, numbers: &[u64], counts: &[i32]) -> Result<(), Failure> {
        if numbers.len() != counts.len() {
            return Err(Failure::option(
                format!("{} numbers of {} samples", numbers.len(), counts.len()),
                "give each sample a number",
            ));
        }
        if !numbers.is_sorted() {
            let mut rows: Vec<(u64, i32)> = numbers
                .iter()
                .copied()
                .zip(counts.iter().copied())
                .collect();
            rows.sort_unstable_by_key(|&(number, _)| number);
            let (numbers, counts): (Vec<u64>, Vec<i32>) = rows.into_iter().unzip();
            return self.push_numbered(&numbers, &counts);
        }
        if let Some(pair) = numbers.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(twice(pair[0]..pair[0] + 1));
        }
        let mut all = self.without_samples();
        let mut rest = counts;
        for run in numbers.chunk_by(|&one, &next| next - one == 1) {
            let (taken, after) = rest.split_at(run.len());
            all.push(run[0], taken)?;
            rest = after;
        }
        self.merge(all)
    }

    /// The same sensor, without samples.
    fn without_samples(&self) -> Self {
        Self {
            stretches: BTreeMap::new(),
            ..*self
        }
    }

    /// Adds the pieces of another part of the same record. Neighbours are joined as if they had never been apart.
    ///
    /// # Errors
    /// When rate or scale differ, or some samples are in both. Nothing is added then.
    pub fn merge(&mut self, other: Self) -> Result<(), Failure> {
        for (what, ours, theirs) in [
            ("rate", self.rate_hz, other.rate_hz),
            ("scale", self.rate_per_count, other.rate_per_count),
        ] {
            if ours != theirs {
                return Err(Failure::option(
                    format!("a piece has the {what} {theirs}, and the others {ours}"),
                    "merge pieces of one axis of one record",
                ));
            }
        }
        other
            .stretches()
            .try_for_each(|range| self.is_free(&range))?;
        for piece in other.stretches.into_values() {
            self.insert(*piece);
        }
        Ok(())
    }

    /// Whether none of these samples is there.
    fn is_free(&self, range: &Range<u64>) -> Result<(), Failure> {
        // The last stretch that begins before their end.
        let before = self.stretches.range(..range.end).next_back();
        match before.map(|(_, piece)| piece.range()) {
            Some(own) if own.end > range.start && !range.is_empty() => {
                // Of several, the message names the first one.
                let mut all = self.pieces().map(Piece::range);
                let first = all.find(|own| own.end > range.start).unwrap_or(own);
                Err(twice(
                    first.start.max(range.start)..first.end.min(range.end),
                ))
            }
            _ => Ok(()),
        }
    }

    /// Adds a piece of which no sample is there.
    fn insert(&mut self, piece: Piece) {
        let range = piece.range();
        let next = self.stretches.remove(&range.end);
        let before = self.stretches.range_mut(..range.start).next_back();
        let own = match before {
            Some((_, before)) if before.range().end == range.start => {
                before.join(&piece);
                before
            }
            _ => self
                .stretches
                .entry(range.start)
                .or_insert_with(|| Box::new(piece)),
        };
        if let Some(next) = next {
            own.join(&next);
        }
    }
}

/// The failure of samples that come twice.
fn twice(range: Range<u64>) -> Failure {
    let Range { start, end } = range;
    let what = match end - start {
        1 => format!("sample {start} comes twice"),
        _ => format!("samples {start} to {} come twice", end - 1),
    };
    Failure::option(
        what,
        "give each sample once, under its number in the record of one axis of one sensor",
    )
}
