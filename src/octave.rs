//! The accumulator: from counts to one exact sum of squares per octave of averaging time.

use crate::square_sum::SquareSum;

/// Angles kept per level: those of the last eight block boundaries.
const RING: usize = 8;

/// Octaves below the first level: averaging factors 1 and 2 are read from the ring of factor 4.
const FIRST: usize = 2;

/// Angles at block boundaries, oldest overwritten first. They wrap modulo 2^64, differences of
/// them do not.
type Ring = [u64; RING];

/// Octave-spaced, quarter-overlapping Allan accumulator in fixed memory: octave `k` has the
/// averaging factor `m = 2^k`, `k = 0 … OCTAVES − 1`.
///
/// With the angle `θ_n` (the sum of the first `n` counts) every octave sums the squares of
///
/// ```text
/// D_s = θ_{s+2m} − 2θ_{s+m} + θ_s,      s = 0, h, 2h, …,   h = max(1, m/4)
/// ```
///
/// from which `σ²(τ) = ½ mean D² / m²` in counts² (IEEE Std 952-1997, annex C; overlap as in NIST
/// SP 1065, 2008, eq. 11, thinned to a quarter of a cluster, which keeps 93 % of the degrees of
/// freedom on white noise at constant memory).
///
/// # How it works
///
/// Level `L` keeps the angle at the last eight boundaries of blocks of `2^L` samples and serves
/// the octave `m = 4 · 2^L`; level 0 serves `m = 1` and `m = 2` as well. A level takes its new
/// boundary from the level below, half a block after it was reached, so that sample `n` updates
/// level 0 and exactly one other level, the one picked by the trailing zeros of `n`. Ring
/// positions, fill states and the numbers of differences all follow from `n`.
///
/// # Cost
///
/// [`push`](Self::push) is constant-time in the number of octaves. Integers only: a constant
/// offset cancels exactly, host and target agree to the bit, and the order in which records are
/// [merged](Self::merge) does not matter. `cargo xtask bench` prints instructions and bytes.
///
/// # Example
///
/// ```
/// use allanite::Accumulator;
///
/// let mut accumulator = Accumulator::<10>::new();
/// accumulator.push_slice(&[3, 1, -2, 4, 0, 7, 2, 2]);
/// accumulator.push(5);
/// // Nine counts: eight differences of neighbours.
/// assert_eq!(accumulator.octave(0).unwrap().differences, 8);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Accumulator<const OCTAVES: usize> {
    /// Samples since the last gap.
    position: u64,
    /// The angle now, in counts.
    angle: u64,
    rings: [Ring; OCTAVES],
    sums: [SquareSum; OCTAVES],
    /// Differences in the segments before the last gap.
    differences: [u64; OCTAVES],
    /// Samples in the segments before the last gap.
    earlier_samples: u64,
    gaps: u64,
}

/// What the accumulator knows of one octave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct OctaveSum {
    /// Averaging factor: samples in a cluster.
    pub m: u32,
    /// How many differences of adjacent clusters were summed.
    pub differences: u64,
    /// Σ D², in counts².
    pub sum: SquareSum,
}

impl<const OCTAVES: usize> Accumulator<OCTAVES> {
    /// The proof that no input overflows, checked when the type is used: a difference fits `i64`
    /// ([`SquareSum`] bounds the sums), and two octaves are the least that make a curve.
    const BOUNDS: () = {
        assert!(OCTAVES >= 2, "an Allan curve needs two octaves or more");
        assert!(OCTAVES <= 30, "30 octaves are the most that cannot overflow");
        // |D| ≤ m (2^32 − 1) < 2^(OCTAVES − 1 + 32), two bits below i64's sign.
        assert!(OCTAVES - 1 + 32 < 62 + 1);
    };

    /// An empty accumulator.
    pub const fn new() -> Self {
        const { Self::BOUNDS };
        Self {
            position: 0,
            angle: 0,
            rings: [[0; RING]; OCTAVES],
            sums: [SquareSum::ZERO; OCTAVES],
            differences: [0; OCTAVES],
            earlier_samples: 0,
            gaps: 0,
        }
    }

    /// Adds one count.
    #[inline]
    pub fn push(&mut self, count: i32) {
        let before = self.angle;
        let angle = before.wrapping_add_signed(i64::from(count));
        self.angle = angle;
        self.position = self.position.wrapping_add(1);
        // Up to 30 octaves, ring positions and the schedule need the low 32 bits only.
        let n = self.position as usize;

        let ring = &mut self.rings[0];
        let two_before = ring[n.wrapping_sub(2) % RING];
        let four_before = ring[n.wrapping_sub(4) % RING];
        let eight_before = ring[n % RING];
        ring[n % RING] = angle;
        if self.position >= 8 {
            self.sums[0].add_square(second_difference(angle, before, two_before));
            self.sums[1].add_square(second_difference(angle, two_before, four_before));
            if OCTAVES > FIRST {
                self.sums[FIRST].add_square(second_difference(angle, four_before, eight_before));
            }
        } else {
            if self.position >= 2 {
                self.sums[0].add_square(second_difference(angle, before, two_before));
            }
            if self.position >= 4 {
                self.sums[1].add_square(second_difference(angle, two_before, four_before));
            }
        }
        self.complete_scheduled(self.position);
    }

    /// Adds counts: the state afterwards is that of pushing them one by one, sooner.
    pub fn push_slice(&mut self, counts: &[i32]) {
        let lead = (RING - self.position as usize % RING) % RING;
        let (head, rest) = counts.split_at(lead.min(counts.len()));
        for &count in head {
            self.push(count);
        }
        let (chunks, tail) = rest.as_chunks::<RING>();
        for chunk in chunks {
            self.push_ring(chunk);
        }
        for &count in tail {
            self.push(count);
        }
    }

    /// Adds eight counts at a position that is a multiple of eight.
    #[inline]
    fn push_ring(&mut self, counts: &[i32; RING]) {
        if self.position < RING as u64 {
            for &count in counts {
                self.push(count);
            }
            return;
        }
        let n = self.position;
        // These take over the boundary at n, which the loop below overwrites in level 0.
        self.complete_scheduled(n + 1);
        self.complete_scheduled(n + 2);
        self.complete_scheduled(n + 4);

        // The boundaries n − 8 … n + 8, the ring's own order being that of their numbers.
        let mut angles = [0; 2 * RING + 1];
        angles[1..RING].copy_from_slice(&self.rings[0][1..]);
        angles[RING] = self.rings[0][0];
        for i in 0..RING {
            angles[RING + 1 + i] = angles[RING + i].wrapping_add_signed(i64::from(counts[i]));
        }
        // The boundary n − 8 shares its slot with n and is gone; level 0 at n used it already.
        for i in RING + 1..=2 * RING {
            self.sums[0].add_square(second_difference(angles[i], angles[i - 1], angles[i - 2]));
            self.sums[1].add_square(second_difference(angles[i], angles[i - 2], angles[i - 4]));
            if OCTAVES > FIRST {
                self.sums[FIRST]
                    .add_square(second_difference(angles[i], angles[i - 4], angles[i - 8]));
            }
        }
        self.rings[0][1..].copy_from_slice(&angles[RING + 1..2 * RING]);
        self.rings[0][0] = angles[2 * RING];
        self.angle = angles[2 * RING];
        self.position = n + RING as u64;

        for offset in [3, 5, 6, 7, 8] {
            self.complete_scheduled(n + offset);
        }
    }

    /// Updates the one level above 0 whose turn it is at sample `n`: level `L` has its turn half
    /// a block after each of its block boundaries, when level `L − 1` has long passed them.
    #[inline(always)]
    fn complete_scheduled(&mut self, n: u64) {
        let level = (n as u32).trailing_zeros() as usize + 1;
        if level + FIRST >= OCTAVES {
            return;
        }
        // Of the boundary at n − 2^(level−1): its number at this level and at the one below.
        let block = n >> level;
        let new = self.rings[level - 1][(2 * block) as usize % RING];
        let ring = &mut self.rings[level];
        let i = block as usize % RING;
        let (oldest, middle) = (ring[i], ring[i ^ 4]);
        ring[i] = new;
        if block >= 8 {
            self.sums[level + FIRST].add_square(second_difference(new, middle, oldest));
        }
    }

    /// Samples were lost, or the gyro was disturbed: no difference will span this moment. What was
    /// summed stays. Costs a pass over the octaves.
    pub fn gap(&mut self) {
        if self.position == 0 {
            return;
        }
        for k in 0..OCTAVES {
            let octave = self.read(k);
            self.sums[k] = octave.sum;
            self.differences[k] = octave.differences;
        }
        self.earlier_samples = self.samples();
        self.position = 0;
        self.angle = 0;
        self.rings = [[0; RING]; OCTAVES];
        self.gaps = self.gaps.saturating_add(1);
    }

    /// Adds another record of the same sensor, as if a gap lay between the two.
    pub fn merge(&mut self, other: &Self) {
        if other.samples() == 0 {
            return;
        }
        self.gap();
        for k in 0..OCTAVES {
            let octave = other.read(k);
            self.sums[k].add_sum(&octave.sum);
            self.differences[k] = self.differences[k].saturating_add(octave.differences);
        }
        self.earlier_samples = self.earlier_samples.saturating_add(other.samples());
        let ends = other.gaps.saturating_add(u64::from(other.position > 0));
        self.gaps = self.gaps.saturating_add(ends);
    }

    /// Forgets everything.
    pub fn reset(&mut self) {
        *self = Self::new();
    }

    /// Samples so far.
    pub const fn samples(&self) -> u64 {
        self.earlier_samples.saturating_add(self.position)
    }

    /// Ends of contiguous stretches so far: calls of [`gap`](Self::gap) that had samples before
    /// them, and one for each merged record.
    pub const fn gaps(&self) -> u64 {
        self.gaps
    }

    /// Octave `k`, of averaging factor `2^k`, as of now: what the schedule has put off is
    /// included, the state is untouched. `None` from `OCTAVES` on.
    pub fn octave(&self, k: usize) -> Option<OctaveSum> {
        (k < OCTAVES).then(|| self.read(k))
    }

    /// All octaves as of now, shortest averaging time first.
    pub fn octaves(&self) -> impl Iterator<Item = OctaveSum> + '_ {
        (0..OCTAVES).map(|k| self.read(k))
    }

    fn read(&self, k: usize) -> OctaveSum {
        let mut sum = self.sums[k];
        let level = k.saturating_sub(FIRST);
        if level > 0 && self.is_pending(level) {
            let block = self.position >> level;
            if block >= 8 {
                let ring = &self.rings[level];
                let i = block as usize % RING;
                sum.add_square(second_difference(self.boundary(level), ring[i ^ 4], ring[i]));
            }
        }
        // Blocks so far, less those that the first difference needs.
        let running = (self.position >> level).saturating_sub(match k {
            0 => 1,
            1 => 3,
            _ => 7,
        });
        OctaveSum {
            m: 1 << k,
            differences: self.differences[k].saturating_add(running),
            sum,
        }
    }

    /// Whether the level's newest boundary still waits for its turn in the schedule.
    fn is_pending(&self, level: usize) -> bool {
        level > 0 && self.position >> (level - 1) & 1 == 0
    }

    /// The angle at the level's newest block boundary, from the first level below that has it.
    fn boundary(&self, level: usize) -> u64 {
        let holder = (0..=level).rev().find(|&l| !self.is_pending(l)).unwrap_or(0);
        // While levels are pending, the boundary is the newest of the level below as well.
        self.rings[holder][(self.position >> holder) as usize % RING]
    }
}

impl<const OCTAVES: usize> Default for Accumulator<OCTAVES> {
    fn default() -> Self {
        Self::new()
    }
}

/// `newest − 2 middle + oldest`: the difference of two adjacent cluster sums, exact although the
/// angles wrap.
#[inline(always)]
fn second_difference(newest: u64, middle: u64, oldest: u64) -> i64 {
    newest.wrapping_sub(middle).wrapping_sub(middle.wrapping_sub(oldest)) as i64
}
