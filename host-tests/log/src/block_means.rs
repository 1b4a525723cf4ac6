//! Means of an axis and of the columns beside it, in blocks of equal duration.

use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The number of blocks that are kept at most. A record of eight hours at 100 Hz then has blocks of 2.6 s. Chosen by
/// hand: short beside the lags of a thermal mass, and small beside the log.
pub const MOST: usize = 1 << 14;

/// The sums of some columns in blocks of equal length. The blocks double their length when they are full, so that a
/// record of any length takes the same memory. All sums are exact.
#[derive(Clone, Debug)]
pub struct BlockSums {
    /// The most blocks.
    most: usize,
    /// Samples of a block.
    length: usize,
    /// Samples of the open block, and its sums.
    filled: usize,
    open: Vec<i64>,
    /// Whether samples are missing before or in the open block.
    is_broken: bool,
    /// The complete blocks of each column.
    complete: Vec<Vec<i64>>,
    broken: Vec<bool>,
}

/// The means of an axis and of the columns beside it.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(from = "Stored", into = "Stored")]
pub struct BlockMeans {
    /// Samples of a block: a power of two.
    pub samples: u32,
    /// Duration of a block, in seconds.
    pub block_s: f64,
    /// Whether samples are missing in a block. The time of a gap is not known and counts as none.
    pub broken: Arc<[bool]>,
    /// Mean rates, in rate units.
    pub rate: Arc<[f64]>,
    /// The columns with their means.
    pub columns: Arc<[(String, Arc<[f64]>)]>,
}

/// The same without what axes share.
#[derive(Serialize, Deserialize)]
struct Stored {
    samples: u32,
    block_s: f64,
    broken: Vec<bool>,
    rate: Vec<f64>,
    columns: Vec<(String, Vec<f64>)>,
}

impl From<BlockMeans> for Stored {
    fn from(means: BlockMeans) -> Self {
        let columns = means.columns.iter();
        Self {
            samples: means.samples,
            block_s: means.block_s,
            broken: means.broken.to_vec(),
            rate: means.rate.to_vec(),
            columns: columns
                .map(|(name, means)| (name.clone(), means.to_vec()))
                .collect(),
        }
    }
}

impl From<Stored> for BlockMeans {
    fn from(stored: Stored) -> Self {
        let columns = stored.columns.into_iter();
        Self {
            samples: stored.samples,
            block_s: stored.block_s,
            broken: stored.broken.into(),
            rate: stored.rate.into(),
            columns: columns.map(|(name, means)| (name, means.into())).collect(),
        }
    }
}

impl BlockMeans {
    /// The means of a column.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let mut columns = self.columns.iter();
        let (_, means) = columns.find(|(column, _)| column == name)?;
        Some(means)
    }

    /// The duration of all blocks, in seconds.
    pub fn duration_s(&self) -> f64 {
        self.block_s * self.rate.len() as f64
    }
}

impl BlockSums {
    /// No samples yet of some columns.
    pub fn new(columns: usize) -> Self {
        Self::with_most(columns, MOST)
    }

    fn with_most(columns: usize, most: usize) -> Self {
        Self {
            most,
            length: 1,
            filled: 0,
            open: vec![0; columns],
            is_broken: false,
            complete: vec![Vec::new(); columns],
            broken: Vec::new(),
        }
    }

    /// Adds rows that follow each other: the counts of every column, which are equally many.
    pub fn push(&mut self, columns: &[Vec<i32>]) {
        let rows = columns.first().map_or(0, Vec::len);
        let mut at = 0;
        while at < rows {
            let end = rows.min(at + self.length - self.filled);
            for (open, counts) in self.open.iter_mut().zip(columns) {
                let sum: i64 = counts[at..end].iter().map(|&count| i64::from(count)).sum();
                *open += sum;
            }
            self.filled += end - at;
            at = end;
            if self.filled == self.length {
                self.close();
            }
        }
    }

    /// Tells that samples are missing here.
    pub const fn gap(&mut self) {
        self.is_broken = true;
    }

    fn close(&mut self) {
        if self.broken.len() == self.most {
            self.merge_pairs();
            // The block that has just been filled is half of one of the new length.
            return;
        }
        for (complete, open) in self.complete.iter_mut().zip(&mut self.open) {
            complete.push(*open);
            *open = 0;
        }
        self.broken.push(self.is_broken);
        self.is_broken = false;
        self.filled = 0;
    }

    fn merge_pairs(&mut self) {
        for blocks in &mut self.complete {
            *blocks = blocks
                .chunks_exact(2)
                .map(|pair| pair[0] + pair[1])
                .collect();
        }
        let pairs = self.broken.chunks_exact(2);
        self.broken = pairs.map(|pair| pair[0] || pair[1]).collect();
        self.length *= 2;
    }

    /// Samples of a block.
    pub fn samples(&self) -> u32 {
        self.length as u32
    }

    /// Whether samples are missing in each of the complete blocks.
    pub fn broken(&self) -> &[bool] {
        &self.broken
    }

    /// The means of a column in the complete blocks, in counts.
    pub fn means(&self, column: usize) -> impl Iterator<Item = f64> {
        let sums = self.complete.get(column).into_iter().flatten();
        sums.map(|&sum| sum as f64 / self.length as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_double_and_hold_the_means_of_their_samples() {
        let counts = |column: i32| -> Vec<i32> { (0..150).map(|n| n * n % 37 + column).collect() };
        let whole = [counts(0), counts(7)];
        let mut sums = BlockSums::with_most(2, 8);
        for piece in [0..1, 1..50, 50..150] {
            if piece.start == 50 {
                sums.gap();
            }
            let rows: Vec<_> = whole
                .iter()
                .map(|all| all[piece.clone()].to_vec())
                .collect();
            sums.push(&rows);
        }
        // 150 samples make 4 complete blocks of 32.
        assert_eq!((sums.samples(), sums.broken().len()), (32, 4));
        assert_eq!(sums.broken(), [false, true, false, false]);
        for (column, all) in whole.iter().enumerate() {
            let mean = |block: &[i32]| f64::from(block.iter().sum::<i32>()) / 32.0;
            let expected: Vec<f64> = all.chunks_exact(32).map(mean).collect();
            assert_eq!(sums.means(column).collect::<Vec<_>>(), expected);
        }
    }
}
