//! Motion that never stops: a gyro that was held in a hand, driven or swung while it was recorded.
//!
//! Integrity tells motion by its beginning and its end. Motion without rest looks like noise behind a low pass, and is told
//! by what no resting gyro does: its slow parts are larger than any gyro's, they are common to the axes, or one axis has
//! far more of them than another; and they become smaller again for still longer times, which drift does not. All of it is
//! taken from the quieter blocks of the record, so that a touch is not motion.

/// The axes of a sensor.
pub const AXES: usize = 3;

/// The products of the axes with each other: xx, xy, xz, yy, yz, zz.
const PRODUCTS: usize = 6;

/// The places of xx, yy and zz among them.
const SQUARES: [usize; AXES] = [0, 3, 5];

/// Octaves of up to 20 s at 25 kHz.
const OCTAVES: usize = 20;

/// Differences of clusters of four start at each block of a level, as in the accumulator.
const RING: usize = 8;

/// Half of the blocks of time that are kept at most.
const HALF: usize = 32;

/// The samples of the shortest block of time. Longer records join pairs of blocks.
const SHORTEST: u64 = 256;

/// The least number of blocks of time that tell anything. Each has room for so many clusters of the longest octave that is
/// compared between axes, because axes correlate by chance in fewer.
const LEAST_BLOCKS: usize = 8;
const LEAST_CLUSTERS: u64 = 8;

/// Gaps of up to so many samples are filled with the mean of a window that ends at a block of this level.
const LONGEST_FILLED: u64 = 64;
const WINDOW: u64 = 32;
const WINDOW_LEVEL: usize = 3;

/// The rate at which octave 5 is that of 0.32 s. The octaves of other rates are counted from the one next to it.
const REFERENCE_HZ: f64 = 100.0;

/// No resting gyro has as much noise as this at 0.1 s to 3 s, in °/s/√Hz. Chosen by hand: the worst consumer gyros have a
/// twentieth.
const LEVEL: f64 = 0.5;
const LEVEL_OCTAVES: std::ops::Range<i32> = 3..9;

/// Motion in several axes: by how much, in powers of ten, the spectral density of an octave lies above the lowest one of the
/// octaves before, and how much the axes must correlate then. Less of a rise needs more. Chosen on simulated records;
/// `study motion` tells how often rest and motion are confused.
const TOGETHER: [(i32, f64, f64); 3] = [(5, 1.8, 0.25), (6, 1.0, 0.35), (7, 1.0, 0.5)];

/// Motion about one axis: by how much, in powers of ten, it is above the others in an octave. Chosen like those.
const ALONE: [(i32, f64); 2] = [(5, 1.5), (6, 1.8)];

/// The octaves whose densities, times their averaging times, must be at least this share of that of the highest one before, in
/// the mean. They fall with the frequency of a line or a resonance: at 0.64 s, the mean is an eighth of the peak for 2.3 Hz.
/// Hands, bodies and vehicles move more slowly than that; machines shake benches faster. In a single octave, a line may have
/// its maximum, or vanish.
const SLOW: std::ops::Range<i32> = 6..9;
const SLOW_SHARE: f64 = 0.125;

/// The octaves from which on the variance must fall again, and by which power of two an octave.
const FALLS_FROM: i32 = 5;
const FALLS_TO: i32 = 11;
const FALLS: f64 = -0.2;

/// Products of the differences that end in a block of time.
#[derive(Clone)]
struct Block {
    sums: [[f64; PRODUCTS]; OCTAVES],
    differences: [u32; OCTAVES],
}

impl Block {
    const EMPTY: Self = Self {
        sums: [[0.0; PRODUCTS]; OCTAVES],
        differences: [0; OCTAVES],
    };

    fn add(&mut self, other: &Self) {
        for (own, other) in self.sums.iter_mut().zip(&other.sums) {
            for (own, other) in own.iter_mut().zip(other) {
                *own += other;
            }
        }
        for (own, other) in self.differences.iter_mut().zip(other.differences) {
            *own = own.saturating_add(other);
        }
    }

    /// Adds the difference of three angles of every axis.
    fn push(
        &mut self,
        octave: usize,
        newest: &[i64; AXES],
        middle: &[i64; AXES],
        oldest: &[i64; AXES],
    ) {
        let difference = |axis: usize| {
            let second = newest[axis].wrapping_sub(middle[axis]);
            second.wrapping_sub(middle[axis].wrapping_sub(oldest[axis])) as f64
        };
        let [x, y, z] = [difference(0), difference(1), difference(2)];
        let products = [x * x, x * y, x * z, y * y, y * z, z * z];
        for (sum, product) in self.sums[octave].iter_mut().zip(products) {
            *sum += product;
        }
        self.differences[octave] += 1;
    }
}

/// The motion of the three axes of a sensor, in octaves and blocks of time.
#[derive(Clone)]
pub struct Unrest {
    /// Samples since the last gap.
    number: u64,
    angle: [i64; AXES],
    /// The angles at the last boundaries of blocks of `2^level` samples.
    levels: [[[i64; AXES]; RING]; OCTAVES - 2],
    blocks: Vec<Block>,
    open: Block,
    /// Samples of time in a block, and in the open one.
    length: u64,
    filled: u64,
}

/// Motion that never stopped, in the octave that shows it best.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Found {
    /// Samples in a cluster.
    pub cluster: u64,
    /// The share of the variance of their means that is at least due to motion, in percent.
    pub percent: u8,
}

impl Default for Unrest {
    fn default() -> Self {
        Self::new()
    }
}

impl Unrest {
    /// No samples yet.
    pub fn new() -> Self {
        Self {
            number: 0,
            angle: [0; AXES],
            levels: [[[0; AXES]; RING]; OCTAVES - 2],
            blocks: Vec::new(),
            open: Block::EMPTY,
            length: SHORTEST,
            filled: 0,
        }
    }

    /// Adds samples that follow each other, of each axis.
    pub fn push(&mut self, axes: [&[i32]; AXES]) {
        let rows = axes.map(<[i32]>::len).into_iter().min().unwrap_or(0);
        let mut row = 0;
        while row < rows {
            let room = (self.length - self.filled).min((rows - row) as u64) as usize;
            for at in row..row + room {
                self.push_row(axes.map(|axis| i64::from(axis[at])));
            }
            self.pass(room as u64);
            row += room;
        }
    }

    fn push_row(&mut self, counts: [i64; AXES]) {
        for (angle, count) in self.angle.iter_mut().zip(counts) {
            *angle = angle.wrapping_add(count);
        }
        self.number += 1;
        let n = self.number;
        let i = n as usize % RING;
        let ring = &self.levels[0];
        for (octave, m) in [(0, 1), (1, 2)] {
            if n >= 2 * m as u64 {
                let [middle, oldest] =
                    [m, 2 * m].map(|before| &ring[i.wrapping_sub(before) % RING]);
                self.open.push(octave, &self.angle, middle, oldest);
            }
        }
        let last = self.levels.len() - 1;
        for level in 0..=(n.trailing_zeros() as usize).min(last) {
            let block = n >> level;
            let i = block as usize % RING;
            let ring = &mut self.levels[level];
            if block >= RING as u64 {
                self.open
                    .push(level + 2, &self.angle, &ring[i ^ 4], &ring[i]);
            }
            ring[i] = self.angle;
        }
    }

    /// Marks a place where so many samples are missing, or an unknown number if it is 0. A short gap is filled with the mean
    /// of 32 samples before, so that single losses do not hide the slow parts.
    pub fn gap(&mut self, missing: u64) {
        if (1..=LONGEST_FILLED).contains(&missing) && self.number >= WINDOW {
            let newest = self.number >> WINDOW_LEVEL;
            let ring = &self.levels[WINDOW_LEVEL];
            let [last, first] = [newest, newest - (WINDOW >> WINDOW_LEVEL)]
                .map(|block| ring[block as usize % RING]);
            let mean = std::array::from_fn(|axis| (last[axis] - first[axis]) / WINDOW as i64);
            for _ in 0..missing {
                self.push_row(mean);
                self.pass(1);
            }
            return;
        }
        self.number = 0;
        self.angle = [0; AXES];
        for ring in &mut self.levels {
            ring[0] = [0; AXES];
        }
        let mut left = missing;
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
        if self.blocks.len() == 2 * HALF {
            self.blocks = joined(&self.blocks);
            self.length *= 2;
        }
    }

    /// Motion that never stopped, of a record with this rate in Hz and with these units per count. `per_degree` is that of
    /// 1 °/s in such units, if they are known.
    pub fn found(
        &self,
        rate_hz: f64,
        units: [f64; AXES],
        per_degree: Option<f64>,
    ) -> Option<Found> {
        let shift = (rate_hz / REFERENCE_HZ).log2().round() as i32;
        let longest = TOGETHER[TOGETHER.len() - 1].0 + shift;
        let least = LEAST_CLUSTERS << u32::try_from(longest).ok()?.min(40);
        let (mut blocks, mut length) = (self.blocks.clone(), self.length);
        while length < least {
            if blocks.len() < 2 * LEAST_BLOCKS {
                return None;
            }
            blocks = joined(&blocks);
            length *= 2;
        }
        let octaves = Octaves {
            shift,
            rate_hz,
            units,
            quiet: quiet(&blocks, units)?,
            blocks,
        };
        let (octave, share) = octaves.level(per_degree).or_else(|| {
            let found = octaves.together().or_else(|| octaves.alone());
            found.filter(|_| octaves.falls() && octaves.is_slow())
        })?;
        Some(Found {
            cluster: 1 << octave,
            percent: (100.0 * share).clamp(0.0, 99.0) as u8,
        })
    }
}

/// Blocks of twice the time.
fn joined(blocks: &[Block]) -> Vec<Block> {
    let pair = |pair: &[Block]| {
        let mut joined = pair[0].clone();
        joined.add(&pair[1]);
        joined
    };
    blocks.chunks_exact(2).map(pair).collect()
}

/// What the rules are applied to.
struct Octaves {
    /// The octave of the reference's octave 0.
    shift: i32,
    rate_hz: f64,
    units: [f64; AXES],
    blocks: Vec<Block>,
    /// The variance of each octave and axis that a quarter of the blocks does not reach.
    quiet: Vec<[f64; AXES]>,
}

/// Differences that a block needs at least for its variance to count.
const LEAST_DIFFERENCES: u32 = 8;

/// The variances of each octave that a quarter of the blocks does not reach, in units. `None` if an axis does not vary.
fn quiet(blocks: &[Block], units: [f64; AXES]) -> Option<Vec<[f64; AXES]>> {
    let mut quiet = Vec::new();
    for octave in 0..OCTAVES {
        let told = blocks
            .iter()
            .filter(|block| block.differences[octave] >= LEAST_DIFFERENCES);
        let told: Vec<&Block> = told.collect();
        if told.len() < LEAST_BLOCKS {
            break;
        }
        let of_axis = |axis: usize| {
            let variance = |block: &&Block| variance(block, octave, axis, units);
            lower_quartile(told.iter().map(variance).collect())
        };
        let variances = [of_axis(0), of_axis(1), of_axis(2)];
        if variances.iter().any(|&variance| variance <= 0.0) {
            return None;
        }
        quiet.push(variances);
    }
    Some(quiet)
}

/// The Allan variance of an axis.
fn variance(block: &Block, octave: usize, axis: usize, units: [f64; AXES]) -> f64 {
    let m = f64::from(1_u32 << octave);
    let sum = block.sums[octave][SQUARES[axis]];
    let differences = f64::from(block.differences[octave]);
    0.5 * sum / differences * (units[axis] / m).powi(2)
}

/// Interpolated between the two next values.
fn lower_quartile(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let place = (values.len() - 1) as f64 / 4.0;
    let (below, rest) = (place as usize, place.fract());
    let above = values[(below + 1).min(values.len() - 1)];
    values[below] + rest * (above - values[below])
}

fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

fn most(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, f64::max)
}

impl Octaves {
    /// The octave of the record for one of the reference.
    fn own(&self, octave: i32) -> Option<usize> {
        let own = usize::try_from(octave + self.shift).ok()?;
        (own < self.quiet.len()).then_some(own)
    }

    /// The one-sided spectral density of white noise with the variance of an octave, in units² per Hz, of each axis.
    fn densities(&self, octave: usize) -> [f64; AXES] {
        let time_s = f64::from(1_u32 << octave) / self.rate_hz;
        self.quiet[octave].map(|variance| variance * time_s)
    }

    /// By how much the density of an octave lies above the lowest one before, of the axis where it is most.
    fn rise(&self, octave: usize) -> f64 {
        let here = self.densities(octave);
        let ratio = |axis: usize| {
            let before = (0..octave).map(|other| self.densities(other)[axis]);
            here[axis] / before.fold(f64::INFINITY, f64::min)
        };
        most([ratio(0), ratio(1), ratio(2)])
    }

    /// More noise than any gyro at rest has.
    fn level(&self, per_degree: Option<f64>) -> Option<(usize, f64)> {
        let limit = (LEVEL * per_degree?).powi(2);
        let own = LEVEL_OCTAVES.filter_map(|octave| self.own(octave));
        let density = |octave: usize| (octave, most(self.densities(octave)));
        let (octave, density) = own
            .map(density)
            .max_by(|one, other| one.1.total_cmp(&other.1))?;
        (density > limit).then(|| (octave, 1.0 - limit / density))
    }

    /// Whether the variance of the axis with most motion falls again within 20 s. Drift does not.
    fn falls(&self) -> bool {
        let mut all = Block::EMPTY;
        self.blocks.iter().for_each(|block| all.add(block));
        let own = |octaves: std::ops::RangeInclusive<i32>| {
            let own = octaves.filter_map(|octave| usize::try_from(octave + self.shift).ok());
            own.filter(|&octave| octave < OCTAVES && all.differences[octave] > 0)
        };
        let largest =
            |axis: &usize| most(own(4..=8).map(|octave| variance(&all, octave, *axis, self.units)));
        let axes = 0..AXES;
        let Some(axis) = axes.max_by(|one, other| largest(one).total_cmp(&largest(other))) else {
            return false;
        };
        let variances: Vec<f64> = own(FALLS_FROM..=FALLS_TO)
            .map(|octave| variance(&all, octave, axis, self.units))
            .collect();
        let mut steps = variances.windows(2);
        steps.any(|pair| (pair[1] / pair[0]).log2() < FALLS)
    }

    /// Whether the axis with most of the slow parts has no more of faster ones.
    fn is_slow(&self) -> bool {
        let slow: Vec<usize> = SLOW.filter_map(|octave| self.own(octave)).collect();
        let Some(&first) = slow.first() else {
            return false;
        };
        let weighted = |axis: usize| {
            let all = slow
                .iter()
                .map(|&octave| self.densities(octave)[axis] * f64::from(1_u32 << (octave - first)));
            all.sum::<f64>() / slow.len() as f64
        };
        let axes = 0..AXES;
        let Some(axis) = axes.max_by(|&one, &other| weighted(one).total_cmp(&weighted(other)))
        else {
            return false;
        };
        let before = (0..first).map(|octave| self.densities(octave)[axis]);
        weighted(axis) >= SLOW_SHARE * most(before)
    }

    /// Slow parts that are common to the axes.
    fn together(&self) -> Option<(usize, f64)> {
        let shows = |&(octave, rises, correlates): &(i32, f64, f64)| {
            let own = self.own(octave).filter(|&own| own >= 2)?;
            let rise = self.rise(own);
            let is_motion = rise > 10_f64.powf(rises) && self.correlation(own) > correlates;
            is_motion.then(|| (own, 1.0 - 1.0 / rise))
        };
        TOGETHER.iter().find_map(shows)
    }

    /// What the axes share: 1 less the determinant of their correlations, the median of the blocks. It is 0 for axes that
    /// are independent, and 1 where two move alike.
    fn correlation(&self, octave: usize) -> f64 {
        let of_block = |block: &Block| {
            let [xx, xy, xz, yy, yz, zz] = block.sums[octave];
            let [xy, xz, yz] = [
                xy / (xx * yy).sqrt(),
                xz / (xx * zz).sqrt(),
                yz / (yy * zz).sqrt(),
            ];
            xy * xy + xz * xz + yz * yz - 2.0 * xy * xz * yz
        };
        let told = self
            .blocks
            .iter()
            .filter(|block| block.differences[octave] >= LEAST_DIFFERENCES);
        median(told.map(of_block).collect())
    }

    /// Slow parts that one axis has and another lacks.
    fn alone(&self) -> Option<(usize, f64)> {
        let shows = |&(octave, exceeds): &(i32, f64)| {
            let own = self.own(octave)?;
            let variances = self.quiet[own];
            let least = variances.into_iter().fold(f64::INFINITY, f64::min);
            let ratio = most(variances) / least;
            (ratio > 10_f64.powf(exceeds)).then(|| (own, 1.0 - 1.0 / ratio))
        };
        ALONE.iter().find_map(shows)
    }
}

#[cfg(test)]
mod tests;
