//! Samples that come in batches which are too short for a piece each.

use super::{Pieces, twice};
use crate::failure::Failure;

/// The number of samples from which on a piece is made. Fewer of them take longer each, and more of them take memory in each of
/// the groups of a large query. Chosen by hand.
const LONG: usize = 1 << 13;

/// Pieces, and neighbouring samples that wait to be long enough for a piece. What comes of them is the same.
#[derive(Clone, Debug)]
pub struct Gathered {
    pieces: Pieces,
    /// The number of the first sample that waits.
    first: u64,
    waiting: Vec<i32>,
}

impl Gathered {
    /// Goes on with these pieces.
    pub const fn new(pieces: Pieces) -> Self {
        Self {
            pieces,
            first: 0,
            waiting: Vec::new(),
        }
    }

    /// Adds the counts of neighbouring samples, as [`Pieces::push`] does.
    ///
    /// # Errors
    /// As of [`Pieces::push`]. Nothing is added then.
    pub fn push(&mut self, first: u64, counts: &[i32]) -> Result<(), Failure> {
        let range = Pieces::range(first, counts)?;
        self.pieces.is_free(&range)?;
        let waiting = self.first..self.first + self.waiting.len() as u64;
        let both = range.start.max(waiting.start)..range.end.min(waiting.end);
        if !both.is_empty() {
            return Err(twice(both));
        }
        if counts.len() >= LONG {
            // Long enough for a piece of its own, without a copy.
            self.work();
            self.pieces.put(first, counts);
            self.first = range.end;
            return Ok(());
        }
        if range.start != waiting.end {
            self.work();
            self.first = first;
        }
        self.waiting.extend_from_slice(counts);
        if self.waiting.len() >= LONG {
            self.work();
        }
        Ok(())
    }

    /// Adds samples with their numbers, as [`Pieces::push_numbered`] does.
    ///
    /// # Errors
    /// As of [`Pieces::push_numbered`]. Nothing is added then.
    pub fn push_numbered(&mut self, numbers: &[u64], counts: &[i32]) -> Result<(), Failure> {
        let is_run = |&first: &u64| {
            let mut pairs = numbers.windows(2);
            numbers.len() == counts.len()
                && first.checked_add(counts.len() as u64).is_some()
                && pairs.all(|pair| pair[1].checked_sub(pair[0]) == Some(1))
        };
        match numbers.first().filter(|first| is_run(first)) {
            Some(&first) => self.push(first, counts),
            None => {
                self.work();
                self.pieces.push_numbered(numbers, counts)
            }
        }
    }

    /// Makes a piece of what waits.
    fn work(&mut self) {
        self.pieces.put(self.first, &self.waiting);
        self.first += self.waiting.len() as u64;
        self.waiting.clear();
    }

    /// The pieces of all samples so far.
    pub fn pieces(&mut self) -> &mut Pieces {
        self.work();
        &mut self.pieces
    }

    /// The pieces of all samples, which take no more.
    pub fn into_pieces(mut self) -> Pieces {
        self.work();
        self.pieces
    }

    /// About how many bytes of memory it has beyond its own size, in a time that does not grow with the number of samples.
    pub fn allocated(&self) -> usize {
        self.waiting.capacity() * size_of::<i32>() + self.pieces.allocated()
    }
}
