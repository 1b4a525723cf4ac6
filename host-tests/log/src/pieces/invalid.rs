//! Why a record that was read in pieces is not that of a gyro at rest.
//!
//! [`Integrity`](allanite::integrity::Integrity) sees the samples one after the other, and its scales follow the record. What
//! follows a record is not the same under any cut, so that pieces count sizes and runs of the whole instead, and judge them by
//! the limits of `Integrity` in the end.

use super::{Pieces, runs::Closed, sizes::Sizes, stale};
use crate::OCTAVES;
use allanite::{
    curve::carries_rounding,
    integrity::{Limits, Reason},
};

/// The number of pairs of neighbours, of runs, and of differences of blocks from which they are judged, as in the library.
const JUDGED: u64 = 1000;
const JUDGED_RUNS: u64 = 256;
const JUDGED_BLOCKS: u64 = 16;

/// The largest of 32 differences of samples belongs to a spike from so many binary orders above its median on: it is more than 8 times
/// as large, and so more than 20 times the mean difference of white noise, of which the library makes a spike from 20 times on.
const SPIKED: usize = 3;

/// Differences of blocks are motion from so many orders on: 64 to 128 times the median, where the library's limit is 64 times
/// the mean.
const MOVED: usize = 6;

/// The bits of the counts of gyros, and the mean squares of differences, in thousandths of that of the range, from which on
/// counts jump between the ends of the range: without a sign, and with one. As in the library.
const FORMATS: [u32; 5] = [16, 18, 19, 20, 24];
const MISREAD: [u16; 2] = [10, 60];

/// The whole record.
struct Whole {
    samples: u64,
    missing: u64,
    /// The pairs of neighbours, those of them that differ, and the sum of their squared differences.
    pairs: u64,
    changes: u64,
    squares: u128,
    /// Of neighbouring samples, of blocks of 64 and of blocks of 512.
    sizes: [Sizes; 3],
    runs: Closed,
    ends: [i64; 2],
    hits: u64,
    stale: stale::Runs,
}

impl Pieces {
    /// Why the Allan curve of this record is not valid; `None` where it is valid. If there are several reasons, it is the one that
    /// may have caused the others: misread counts, rails, repeated samples, stuck values, noise below half a count, motion,
    /// spikes, missing samples, blocks that are there twice. However the record is cut, the answer is the same.
    pub fn invalid(&self) -> Option<Reason> {
        let whole = self.whole()?;
        let limits = &Limits::DEFAULT;
        let samples = whole.samples;
        if let Some(bits) = whole.misread() {
            return Some(Reason::Misread { bits });
        }
        if exceeds(whole.hits.into(), samples.into(), limits.rail_per_mille) {
            let hits = whole.hits;
            return Some(Reason::Railed { hits, samples });
        }
        let of_runs = whole.repeated().or_else(|| whole.stuck(limits));
        let coarse = || whole.coarse(limits).filter(|_| !self.carries_rounding());
        let of_noise = of_runs.or_else(coarse);
        let of_rest = of_noise.or_else(|| whole.disturbed(limits));
        let (missing, sent) = (whole.missing, samples.saturating_add(whole.missing));
        let is_missing = exceeds(missing.into(), sent.into(), limits.missing_per_mille);
        let of_samples = of_rest.or(is_missing.then_some(Reason::Missing { missing, sent }));
        of_samples.or_else(|| whole.stale.verdict(samples))
    }

    /// Whether rounding is carried over to the next sample.
    fn carries_rounding(&self) -> bool {
        carries_rounding((0..OCTAVES).map(|octave| {
            let (differences, squares) = self.octave(octave);
            let m = 1_u32 << octave;
            let mean_square = squares as f64 / differences.max(1) as f64;
            (m, differences, mean_square / f64::from(m).powi(2))
        }))
    }

    fn whole(&self) -> Option<Whole> {
        let mut pieces = self.pieces();
        let first = pieces.next()?;
        let mut sizes = first.sizes().clone();
        let mut extremes = first.extremes().clone();
        let mut runs = first.runs().all();
        let mut stale = first.stale().runs().clone();
        let mut end = first.range().end;
        for piece in pieces {
            for (own, sizes) in sizes.iter_mut().zip(piece.sizes()) {
                own.join(sizes);
            }
            extremes.join(piece.extremes());
            piece.runs().add_to(&mut runs);
            stale.join(piece.stale().runs());
            end = piece.range().end;
        }
        let samples = self.samples();
        let (mut pairs, mut repeats, mut squares) = (0_u64, 0_u64, 0_u128);
        for piece in self.pieces() {
            let (number, sum) = piece.octave(0);
            pairs += number;
            squares = squares.saturating_add(sum);
            repeats = repeats.saturating_add(piece.repeats());
        }
        Some(Whole {
            samples,
            pairs,
            changes: pairs.saturating_sub(repeats),
            squares,
            missing: (end - first.range().start).saturating_sub(samples),
            sizes,
            runs,
            ends: extremes.ends(),
            hits: extremes.hits(Limits::DEFAULT.rails),
            stale,
        })
    }
}

impl Whole {
    /// The bits of a range between whose ends the counts jump.
    fn misread(&self) -> Option<u8> {
        let [lowest, highest] = self.ends;
        let ranges = FORMATS.into_iter().flat_map(|bits| {
            let whole = 1_i64 << bits;
            [
                (bits, 0, whole, MISREAD[0]),
                (bits, -whole / 2, whole / 2, MISREAD[1]),
            ]
        });
        let mut near = ranges.filter(|&(bits, from, to, _)| {
            let near = (1_i64 << bits) / 16;
            (from..from + near).contains(&lowest) && (to - near..to).contains(&highest)
        });
        let (bits, .., least) = near.next()?;
        let span = u128::from(highest.abs_diff(lowest));
        let jumps = exceeds(
            self.squares,
            (span * span).saturating_mul(self.pairs.into()),
            least,
        );
        (self.pairs >= JUDGED && jumps).then_some(bits as u8)
    }

    /// Whether most samples are there equally often.
    fn repeated(&self) -> Option<Reason> {
        let changes = self.changes;
        let times = self.runs.times(changes + 1)?;
        (changes + 1 >= JUDGED_RUNS).then_some(Reason::Repeated {
            times,
            changes,
            samples: self.samples,
        })
    }

    /// Whether values hang.
    fn stuck(&self, limits: &Limits) -> Option<Reason> {
        let (pairs, changes) = (self.pairs, self.changes);
        let is_frozen = pairs >= JUDGED
            && u128::from(changes) * 1000 < u128::from(pairs) * u128::from(limits.change_per_mille);
        let mean = self.samples / (changes + 1);
        let implausible = (mean + 1).saturating_mul(limits.run_factor.into());
        let stuck = self.runs.samples_from(implausible);
        let is_long = self.runs.longest() > implausible
            && exceeds(
                stuck.max(self.runs.longest()).into(),
                self.samples.into(),
                limits.stuck_per_mille,
            );
        (is_frozen || is_long).then_some(Reason::Stuck {
            longest_run: u32::try_from(self.runs.longest()).unwrap_or(u32::MAX),
            changes,
            samples: self.samples,
        })
    }

    /// Whether the differences of neighbours are those of rounding rather than of noise.
    fn coarse(&self, limits: &Limits) -> Option<Reason> {
        let pairs = self.pairs;
        let squares = self
            .squares
            .saturating_sub(self.sizes[0].outliers(SPIKED).squares);
        let per_mille = squares.saturating_mul(1000).checked_div(pairs.into())?;
        let is_coarse = pairs >= JUDGED && per_mille < limits.difference_per_mille.into();
        is_coarse.then_some(Reason::Coarse {
            per_mille: per_mille as u16,
        })
    }

    /// Motion, or spikes.
    fn disturbed(&self, limits: &Limits) -> Option<Reason> {
        let spikes = self.sizes[0].outliers(SPIKED);
        let total = self.squares;
        let is_spiked = exceeds(spikes.squares, total, limits.spike_per_mille);
        let mut blocks = self.sizes[1..].iter().zip([64, 512]);
        let moved = blocks.find_map(|(sizes, cluster)| {
            let moved = sizes.outliers(MOVED);
            let is_motion = sizes.number() >= JUDGED_BLOCKS
                && exceeds(moved.squares, sizes.squares(), limits.motion_per_mille);
            // What moves disturbs the samples of many blocks, and a spike those of one.
            let is_wide = !is_spiked || spikes.number > moved.number;
            (is_motion && is_wide).then_some(Reason::Moved {
                motions: moved.number.div_ceil(2),
                cluster,
                percent: percent(moved.squares, sizes.squares()),
            })
        });
        moved.or(is_spiked.then_some(Reason::Spiked {
            spikes: spikes.number,
            percent: percent(spikes.squares, total),
        }))
    }
}

/// Whether a part is more than so many thousandths of the whole.
fn exceeds(part: u128, whole: u128, per_mille: u16) -> bool {
    part.saturating_mul(1000) > whole.saturating_mul(per_mille.into())
}

/// A part of a whole in percent, rounded down.
fn percent(part: u128, whole: u128) -> u8 {
    (part.saturating_mul(100) / whole.max(1)).min(100) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use allanite::integrity::Integrity;
    use rand::{RngExt as _, SeedableRng as _};
    use rand_distr::{Distribution as _, StandardNormal};
    use rand_xoshiro::Xoshiro256PlusPlus as Random;
    use std::mem::discriminant;

    const SAMPLES: usize = 40_000;

    /// The verdict of pieces that are cut at random, and that of the library.
    fn verdicts(counts: &[i32], seed: u64) -> [Option<Reason>; 2] {
        let mut random = Random::seed_from_u64(seed);
        let mut pieces = Pieces::new(100.0, 0.01).unwrap();
        let mut parts = Vec::new();
        let mut start = 0;
        while start < counts.len() {
            let end = (start + random.random_range(1..6000)).min(counts.len());
            parts.push(start..end);
            start = end;
        }
        while !parts.is_empty() {
            let part = parts.swap_remove(random.random_range(0..parts.len()));
            pieces.push(part.start as u64, &counts[part]).unwrap();
        }
        let mut whole = Pieces::new(100.0, 0.01).unwrap();
        whole.push(0, counts).unwrap();
        assert!(pieces == whole, "seed {seed}");
        let mut integrity = Integrity::new();
        integrity.push_slice(counts);
        [pieces.invalid(), integrity.verdict()]
    }

    /// Rounded noise of so many counts.
    fn noise(random: &mut Random, counts: f64) -> i32 {
        let one: f64 = StandardNormal.sample(random);
        (counts * one).round() as i32
    }

    #[test]
    fn runs_and_extremes_are_those_of_the_definition() {
        let mut random = Random::seed_from_u64(5);
        for _ in 0..300 {
            let values = random.random_range(1..4);
            let length = random.random_range(1..700);
            let mut counts: Vec<i32> = (0..length)
                .map(|_| random.random_range(0..values))
                .collect();
            for _ in 0..random.random_range(0..3) {
                let from = random.random_range(0..length);
                let to = (from + random.random_range(0..200)).min(length);
                counts[from..to].fill(7);
            }
            let mut pieces = Pieces::new(100.0, 0.01).unwrap();
            let mut start = 0;
            while start < length {
                let end = (start + random.random_range(1..100)).min(length);
                pieces.push(start as u64, &counts[start..end]).unwrap();
                start = end;
            }
            let runs: Vec<u64> = counts
                .chunk_by(|one, next| one == next)
                .map(|run| run.len() as u64)
                .collect();
            let whole = pieces.whole().unwrap();
            assert_eq!(whole.changes + 1, runs.len() as u64);
            assert_eq!(whole.runs.longest(), runs.iter().copied().max().unwrap());
            for times in 2..=4 {
                let exact = runs.iter().filter(|&&run| run == times).count() as u64;
                let is_most = exact > 0 && whole.runs.times(2 * exact) == Some(times as u8);
                let others = (2..times)
                    .any(|other| runs.iter().filter(|&&run| run == other).count() as u64 >= exact);
                assert!(is_most || others || exact == 0, "{times}: {exact}");
            }
            for least in [2, 4, 8, 64] {
                let long: u64 = runs.iter().filter(|&&run| run >= least).sum();
                assert_eq!(whole.runs.samples_from(least), long, "{least}");
            }
            let ends =
                [counts.iter().min(), counts.iter().max()].map(|end| i64::from(*end.unwrap()));
            assert_eq!(whole.ends, ends);
            let hits = counts
                .iter()
                .filter(|&&count| ends.contains(&count.into()))
                .count();
            let rails = ends.map(|end| end as i32);
            let piece = pieces.pieces().next().unwrap();
            assert_eq!(piece.extremes().hits(&rails), hits as u64);
        }
    }

    #[test]
    fn what_a_logger_or_a_hand_did_is_told_as_by_the_library() {
        type Make = fn(&mut Random, usize, i32) -> i32;
        let kinds: [(&str, Make); 9] = [
            ("stuck", |_, n, one| if n % 8000 > 5000 { 40 } else { one }),
            ("twice", |_, _, one| one),
            ("clipped", |_, _, one| (700 * one).clamp(-32_768, 32_767)),
            ("unsigned", |_, _, one| {
                i32::from((one as i16).cast_unsigned())
            }),
            ("coarse", |random, _, _| noise(random, 0.3)),
            (
                "spiked",
                |_, n, one| if n % 4000 == 77 { 30_000 } else { one },
            ),
            ("moved", |_, n, one| {
                let part = (n as f64 - 20_000.0) / 500.0;
                one + (8_000.0 * (-part * part).exp()) as i32
            }),
            ("hit", |_, n, one| {
                if (20_000..20_200).contains(&n) {
                    one * 400
                } else {
                    one
                }
            }),
            ("nothing", |_, _, one| one),
        ];
        for seed in 0..3 {
            for (name, make) in kinds {
                let mut random = Random::seed_from_u64(seed);
                let mut counts: Vec<i32> = (0..SAMPLES)
                    .map(|n| {
                        let one = noise(&mut random, 40.0);
                        make(&mut random, n, one)
                    })
                    .collect();
                if name == "twice" {
                    counts = counts.iter().flat_map(|&count| [count; 2]).collect();
                }
                let [own, library] = verdicts(&counts, seed);
                let both = [&own, &library].map(|reason| reason.as_ref().map(discriminant));
                assert_eq!(both[0], both[1], "{name}: {own:?}, {library:?}");
                assert_eq!(own.is_none(), name == "nothing");
            }
        }
    }

    #[test]
    fn no_noise_of_a_gyro_at_rest_is_refused() {
        for seed in 0..4 {
            let mut random = Random::seed_from_u64(seed);
            let (mut walk, mut memory, mut side) = (0.0, 0.0, 1.0);
            let mut records: [Vec<i32>; 7] = Default::default();
            for n in 0..SAMPLES {
                let mut one = || -> f64 { StandardNormal.sample(&mut random) };
                walk += one();
                memory = 0.99 * memory + one();
                let white = 40.0 * one();
                if random.random_bool(0.01) {
                    side = -side;
                }
                let line = (0.3 * n as f64).sin();
                let values = [
                    white,
                    0.02 * white,
                    white + walk,
                    10.0 * memory,
                    white + 400.0 * line,
                    white + 100.0 * side,
                    white + 0.05 * n as f64,
                ];
                for (record, value) in records.iter_mut().zip(values) {
                    record.push(value.round() as i32);
                }
            }
            for (number, counts) in records.iter().enumerate() {
                let [own, library] = verdicts(counts, seed);
                assert_eq!((own, library), (None, None), "record {number}, seed {seed}");
            }
        }
    }

    #[test]
    fn samples_that_are_not_there_are_missing() {
        let mut random = Random::seed_from_u64(1);
        let mut pieces = Pieces::new(100.0, 0.01).unwrap();
        for start in [0_u64, 15_000, 30_000] {
            let counts: Vec<i32> = (0..10_000).map(|_| noise(&mut random, 40.0)).collect();
            pieces.push(start, &counts).unwrap();
        }
        let expected = Reason::Missing {
            missing: 10_000,
            sent: 40_000,
        };
        assert_eq!(pieces.invalid(), Some(expected));
    }
}
