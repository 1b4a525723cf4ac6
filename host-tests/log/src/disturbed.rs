//! Where a record is disturbed: the stretches whose values spread or lie far beyond those of the rest.

/// The number of blocks that are kept at most. A record of eight hours at 100 Hz then has blocks of 2.6 s. Chosen by hand.
const MOST: usize = 1 << 14;

/// Samples of the shortest block. Fewer say little about the spread of white noise. Chosen by hand.
const SHORTEST: u64 = 16;

/// A stretch is found where a block deviates by this many of the usual deviations, and reaches as far as blocks deviate by
/// that many. Chosen by hand; `host-tests/tests/cli/cuts.rs` knocks and picks up with them.
const FOUND: f64 = 12.0;
const REACHES: f64 = 4.0;

/// The blocks on either side of one that tell its usual mean. Chosen by hand.
const BESIDE: usize = 64;

/// Stretches that are closer to each other than this, in seconds, are one. Chosen by hand: a knock rings.
const RINGS_S: f64 = 0.5;

/// The sum and the extremes of the samples in a block of time.
#[derive(Clone, Copy, Debug)]
struct Block {
    sum: i64,
    samples: u32,
    least: i32,
    most: i32,
}

impl Block {
    const EMPTY: Self = Self {
        sum: 0,
        samples: 0,
        least: i32::MAX,
        most: i32::MIN,
    };

    fn with(self, other: Self) -> Self {
        Self {
            sum: self.sum + other.sum,
            samples: self.samples + other.samples,
            least: self.least.min(other.least),
            most: self.most.max(other.most),
        }
    }
}

/// The extremes of an axis over time, in blocks that double their length when they are full.
#[derive(Clone, Debug)]
pub(super) struct Extremes {
    length: u64,
    filled: u64,
    open: Block,
    blocks: Vec<Block>,
}

impl Extremes {
    pub(super) const fn new() -> Self {
        Self {
            length: SHORTEST,
            filled: 0,
            open: Block::EMPTY,
            blocks: Vec::new(),
        }
    }

    /// Adds samples that follow each other.
    pub(super) fn push(&mut self, counts: &[i32]) {
        let mut rest = counts;
        while !rest.is_empty() {
            let room = (self.length - self.filled).min(rest.len() as u64);
            let (within, after) = rest.split_at(room as usize);
            let (mut least, mut most, mut sum) = (i32::MAX, i32::MIN, 0);
            for &count in within {
                least = least.min(count);
                most = most.max(count);
                sum += i64::from(count);
            }
            self.open = self.open.with(Block {
                sum,
                samples: room as u32,
                least,
                most,
            });
            self.pass(room);
            rest = after;
        }
    }

    /// Lets the time of missing samples pass.
    pub(super) fn lost(&mut self, samples: u64) {
        let mut left = samples;
        while left > 0 && self.length < 1 << 40 {
            let room = (self.length - self.filled).min(left);
            self.pass(room);
            left -= room;
        }
    }

    fn pass(&mut self, samples: u64) {
        self.filled += samples;
        if self.filled < self.length {
            return;
        }
        self.blocks
            .push(std::mem::replace(&mut self.open, Block::EMPTY));
        self.filled = 0;
        if self.blocks.len() == MOST {
            let pairs = self.blocks.chunks_exact(2);
            self.blocks = pairs.map(|pair| pair[0].with(pair[1])).collect();
            self.length *= 2;
        }
    }

    /// The distance of the least sample from the greatest one.
    pub(super) fn span(&self) -> u64 {
        let blocks = self.blocks.iter().chain([&self.open]);
        let all = blocks.fold(Block::EMPTY, |all, &block| all.with(block));
        u64::try_from(i64::from(all.most) - i64::from(all.least)).unwrap_or(0)
    }

    /// The time that has passed, in samples.
    pub(super) fn time(&self) -> u64 {
        self.blocks.len() as u64 * self.length + self.filled
    }

    /// The stretches that are disturbed, each with its first sample and the one behind its last, the earliest first.
    pub(super) fn disturbed(&self, rate_hz: f64) -> Vec<(u64, u64)> {
        let blocks = self
            .blocks
            .iter()
            .chain((self.filled > 0).then_some(&self.open));
        let blocks: Vec<&Block> = blocks.collect();
        let is_whole = |block: &&&Block| 2 * u64::from(block.samples) >= self.length;
        let whole: Vec<usize> = (0..blocks.len())
            .filter(|&b| is_whole(&&blocks[b]))
            .collect();
        let spread = |&b: &usize| f64::from(blocks[b].most) - f64::from(blocks[b].least);
        let spreads: Vec<f64> = whole.iter().map(spread).collect();
        let mean = |&b: &usize| blocks[b].sum as f64 / f64::from(blocks[b].samples);
        let means: Vec<f64> = whole.iter().map(mean).collect();
        let (usual, deviation) = centre(&spreads);
        // A count is rounded.
        let deviation = deviation.max(0.02 * usual).max(0.5);
        let beside = |i: usize| {
            let near = &means[i.saturating_sub(BESIDE)..means.len().min(i + BESIDE + 1)];
            (means[i] - centre(near).0).abs()
        };
        let away: Vec<f64> = (0..means.len()).map(beside).collect();
        let (_, far) = centre(&away);
        let far = far.max(0.05);
        let size = |i: usize| ((spreads[i] - usual) / deviation).max(away[i] / (2.0 * far));
        let mut found: Vec<(u64, u64)> = Vec::new();
        let mut i = 0;
        while i < whole.len() {
            let end = (i..whole.len())
                .find(|&j| size(j) < REACHES)
                .unwrap_or(whole.len());
            if (i..end).any(|j| size(j) >= FOUND) {
                let (from, to) = (
                    whole[i] as u64 * self.length,
                    (whole[end - 1] as u64 + 1) * self.length,
                );
                match found.last_mut() {
                    Some(last) if ((from - last.1) as f64) < RINGS_S * rate_hz => last.1 = to,
                    _ => found.push((from, to.min(self.time()))),
                }
            }
            i = end.max(i + 1);
        }
        found
    }
}

/// The median of some values, and the usual deviation from it, which is that of Gaussian values.
fn centre(values: &[f64]) -> (f64, f64) {
    let median = |mut values: Vec<f64>| {
        let at = values.len() / 2;
        if values.is_empty() {
            return 0.0;
        }
        *values.select_nth_unstable_by(at, f64::total_cmp).1
    };
    let middle = median(values.to_vec());
    (
        middle,
        1.4826 * median(values.iter().map(|value| (value - middle).abs()).collect()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniform noise within ±`size`.
    fn noise(n: u32, size: i32) -> i32 {
        let mixed = n.wrapping_mul(2_654_435_761) ^ (n.wrapping_mul(40_503) << 7);
        (mixed.wrapping_mul(2_246_822_519) >> 8) as i32 % (2 * size + 1) - size
    }

    #[test]
    fn a_knock_is_found_where_it_is_and_lost_time_passes() {
        let mut extremes = Extremes::new();
        let mut counts: Vec<i32> = (0..60_000)
            .map(|n| noise(n, 50) + n as i32 / 3000)
            .collect();
        for (n, count) in counts[31_120..31_260].iter_mut().enumerate() {
            *count += 2000 - 14 * n as i32;
        }
        extremes.push(&counts[..20_000]);
        extremes.lost(500);
        extremes.push(&counts[20_000..]);
        assert_eq!(extremes.time(), 60_500);
        let found = extremes.disturbed(100.0);
        let [(from, to)] = found[..] else {
            panic!("{found:?}")
        };
        assert!(
            (31_600..=31_620).contains(&from) && (31_750..=31_800).contains(&to),
            "{found:?}"
        );
    }

    #[test]
    fn rest_has_no_disturbed_stretch() {
        let mut extremes = Extremes::new();
        let counts: Vec<i32> = (0..600_000)
            .map(|n| noise(n, 3) + n as i32 / 30_000)
            .collect();
        extremes.push(&counts);
        assert_eq!(extremes.disturbed(100.0), []);
        assert_eq!(Extremes::new().disturbed(100.0), []);
    }
}
