//! Three axes with gate, covariate, fourth moments and spectrum, under any sequence of samples and losses, against a
//! gate that is written after the description of the library's own.
//!
//! What this gate passes enters axes without a gate. Their results have to be the same, and their sums those of the
//! definition in 128-bit integers.

use crate::accumulator::{Stretch, definition};
use allanite::{
    Axes, Scale,
    axis::{Gated, Moments, Sample, Spectral},
    integrity::{Integrity, Observation, Tally},
};
use std::collections::VecDeque;

const OCTAVES: usize = 8;
type Sums = Spectral<32, 2, 28>;
type Ours = Axes<OCTAVES, 1, Gated, Moments, 3, Sums>;
type Ungated = Axes<OCTAVES, 1, (), Moments, 3, Sums>;

/// The number of samples that a gate holds back, and the number of those that it leaves out after motion.
const HELD: usize = 128;
const BEHIND: u32 = 64;

/// The most samples, whose sums are computed by their definition.
const MOST: usize = 6_000;

/// Plays the events that the bytes encode on two records.
pub fn check(bytes: &[u8]) {
    let mut records = [Record::new(), Record::new()];
    let mut bytes = bytes.iter().copied();
    while let Some(event) = bytes.next() {
        let [first, second] = &mut records;
        let (record, other) = match event & 0x80 {
            0 => (first, second),
            _ => (second, first),
        };
        let times = 1 << ((event >> 4) & 7);
        match event & 0x0F {
            0 => record.lose(None),
            1 => {
                let samples = bytes.next().unwrap_or(0);
                record.lose(Some(u64::from(samples) << (samples % 40)));
            }
            2 => record.release(),
            3 => (0..times).for_each(|_| {
                let _ = record.ours.advance();
            }),
            4 if record.pushed + other.pushed < MOST as u64 => record.merge(other),
            4 => {}
            5 => record.restore(),
            kind => {
                let mut next = || bytes.next().unwrap_or(0);
                let mut random = u32::from_le_bytes([next(), next(), next(), next()]);
                for _ in 0..4 * times {
                    record.push(sample(kind, &mut random));
                }
            }
        }
        if records[0].pushed + records[1].pushed > MOST as u64 {
            break;
        }
    }
    for record in &mut records {
        record.release();
        record.compare();
    }
}

/// A sample of noise, of full range, of a constant, at a rail, with a spike, of motion, or of noise beside a constant.
fn sample(kind: u8, random: &mut u32) -> Sample<3, 1> {
    let mut next = || {
        *random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        *random
    };
    let mut noise = |bits: u32| (next() >> (32 - bits)) as i32;
    let noises = [noise(5), noise(6), noise(7)];
    let [x, y, z] = noises;
    let counts = match kind {
        6..=8 => noises,
        9 => [(); 3].map(|()| noise(32)),
        10 => [5, 5, 5],
        11 => [i32::MAX, y, i32::MIN],
        12 if noise(6) == 0 => [x + 30_000, y, z],
        13 => [x + 5_000 * noise(1), y, z - 2_000 * noise(1)],
        14 => [x, 7, z],
        _ => noises,
    };
    (counts, [noise(4) - 8]).into()
}

/// What the gate holds back.
#[derive(Clone, Copy)]
enum Held {
    Sample(Sample<3, 1>),
    /// So many samples are missing, and others if the number is not known.
    Gap(u64, bool),
}

#[derive(Clone)]
struct Record {
    ours: Ours,
    pushed: u64,
    losses: u64,
    missing: u64,
    /// The gate as it is described.
    seen: [Integrity; 3],
    held: VecDeque<Held>,
    behind: u32,
    left_out: u64,
    /// What it passed.
    ungated: Ungated,
    kept: [Integrity; 3],
    stretches: [Vec<Stretch>; 4],
}

impl Record {
    fn new() -> Self {
        Self {
            ours: Ours::new(),
            pushed: 0,
            losses: 0,
            missing: 0,
            seen: [(); 3].map(|()| Integrity::new()),
            held: VecDeque::new(),
            behind: 0,
            left_out: 0,
            ungated: Ungated::new(),
            kept: [(); 3].map(|()| Integrity::new()),
            stretches: [(); 4].map(|()| vec![Stretch::default()]),
        }
    }

    fn push(&mut self, sample: Sample<3, 1>) {
        self.ours.push(sample);
        self.pushed += 1;
        let Observation {
            stuck,
            railed,
            outlying,
            moving,
            ..
        } = self.see(&sample);
        if !(stuck || railed || outlying || moving || self.behind > 0) {
            return self.hold(Held::Sample(sample));
        }
        self.left_out += 1;
        self.behind = self.behind.saturating_sub(1);
        let (mut missing, mut is_known) = (1, true);
        if moving || stuck {
            for held in &self.held {
                match held {
                    Held::Sample(_) => missing += 1,
                    Held::Gap(samples, known) => {
                        missing += samples;
                        is_known &= known;
                    }
                }
            }
            let is_sample = |held: &&Held| matches!(held, Held::Sample(_));
            self.left_out += self.held.iter().filter(is_sample).count() as u64;
            self.held.clear();
        }
        if moving {
            self.behind = BEHIND;
        }
        self.hold_gap(missing, is_known);
    }

    /// What the integrity of any axis finds odd.
    fn see(&mut self, sample: &Sample<3, 1>) -> Observation {
        let mut any = Observation::default();
        for (integrity, count) in self.seen.iter_mut().zip(sample.counts) {
            let one = integrity.push(count);
            any.stuck |= one.stuck;
            any.railed |= one.railed;
            any.outlying |= one.outlying;
            any.moving |= one.moving;
        }
        any
    }

    fn hold(&mut self, held: Held) {
        if self.held.len() == HELD {
            self.pass();
        }
        self.held.push_back(held);
    }

    /// Gaps that follow each other are one.
    fn hold_gap(&mut self, missing: u64, is_known: bool) {
        match self.held.back_mut() {
            Some(Held::Gap(samples, known)) => {
                *samples += missing;
                *known &= is_known;
            }
            _ => self.hold(Held::Gap(missing, is_known)),
        }
    }

    /// Passes what is held longest.
    fn pass(&mut self) {
        match self.held.pop_front() {
            None => {}
            Some(Held::Gap(missing, is_known)) => self.kept_gap(if is_known { missing } else { 0 }),
            Some(Held::Sample(sample)) => {
                self.ungated.push(sample);
                let counts = sample.counts.iter().chain(&sample.covariates);
                for (stretches, &count) in self.stretches.iter_mut().zip(counts) {
                    if let Some(stretch) = stretches.last_mut() {
                        stretch.counts.push(count);
                    }
                }
                for (integrity, count) in self.kept.iter_mut().zip(sample.counts) {
                    integrity.push(count);
                }
            }
        }
    }

    /// So many samples are missing, or an unknown number if it is 0.
    fn kept_gap(&mut self, missing: u64) {
        self.ungated.miss(missing);
        self.kept.iter_mut().for_each(Integrity::gap);
        let mut last = self.stretches.iter_mut().filter_map(|all| all.last_mut());
        if !last.all(|last| last.fill(missing, OCTAVES)) {
            self.end_stretches();
        }
    }

    /// Begins a new stretch, unless the last one is still empty: merges of merges would double the number of empty ones.
    fn end_stretches(&mut self) {
        for stretches in &mut self.stretches {
            if stretches.last().is_none_or(|last| !last.counts.is_empty()) {
                stretches.push(Stretch::default());
            }
        }
    }

    /// A loss of so many samples, or of an unknown number.
    fn lose(&mut self, samples: Option<u64>) {
        match samples {
            None => self.ours.gap(),
            Some(samples) => self.ours.lost(samples),
        }
        if samples == Some(0) {
            return;
        }
        self.missing = self.missing.saturating_add(samples.unwrap_or(0));
        self.losses += 1;
        self.seen.iter_mut().for_each(Integrity::gap);
        self.hold_gap(samples.unwrap_or(0), samples.is_some());
    }

    fn release(&mut self) {
        self.ours.release();
        while !self.held.is_empty() {
            self.pass();
        }
        while self.ungated.advance() {}
    }

    fn merge(&mut self, other: &Self) {
        self.ours.merge(&other.ours);
        let mut other = other.clone();
        while !self.held.is_empty() {
            self.pass();
        }
        while !other.held.is_empty() {
            other.pass();
        }
        self.ungated.merge(&other.ungated);
        for (own, other) in self.kept.iter_mut().zip(&other.kept) {
            own.gap();
            own.merge(other);
        }
        for (own, other) in self.seen.iter_mut().zip(&other.seen) {
            own.merge(other);
        }
        self.end_stretches();
        for (own, other) in self.stretches.iter_mut().zip(other.stretches) {
            own.extend(
                other
                    .into_iter()
                    .filter(|stretch| !stretch.counts.is_empty()),
            );
        }
        self.end_stretches();
        self.pushed += other.pushed;
        self.left_out += other.left_out;
        self.losses += other.losses;
        self.missing = self.missing.saturating_add(other.missing);
    }

    /// A snapshot and its restore lose what the gate holds back.
    fn restore(&mut self) {
        let mut buffer = vec![0; Ours::snapshot_bytes(0)];
        let stored = self.ours.snapshot(&[], &mut buffer).unwrap();
        let mut restored = Ours::new();
        restored.restore(&mut [], stored).unwrap();
        self.ours = restored;
        let is_sample = |held: &&Held| matches!(held, Held::Sample(_));
        self.pushed -= self.held.iter().filter(is_sample).count() as u64;
        self.held.clear();
        self.behind = 0;
        self.seen.iter_mut().for_each(Integrity::gap);
        let mut buffer = vec![0; Ungated::snapshot_bytes(0)];
        let stored = self.ungated.snapshot(&[], &mut buffer).unwrap();
        let mut restored = Ungated::new();
        restored.restore(&mut [], stored).unwrap();
        self.ungated = restored;
        self.kept.iter_mut().for_each(Integrity::gap);
        self.end_stretches();
    }

    /// Compares the two records. Both hold nothing back.
    fn compare(&self) {
        let ours = &self.ours;
        assert_eq!(ours.samples() + ours.left_out(), self.pushed);
        assert_eq!(
            (ours.left_out(), ours.losses()),
            (self.left_out, self.losses)
        );
        for (axis, accumulator) in ours.accumulators().iter().enumerate() {
            for (k, octave) in accumulator.octaves().enumerate() {
                let (sum, differences) = definition(&self.stretches[axis], k);
                let [low, middle, high] = octave.sum.limbs();
                let found = (u128::from(middle) << 64 | u128::from(low), high);
                assert_eq!(
                    (found, octave.differences),
                    ((sum, 0), differences),
                    "axis {axis}, octave {k}"
                );
            }
            let without_missing = |tally: Tally| Tally {
                missing: 0,
                ..tally
            };
            let found = ours.integrity()[axis].tally();
            assert_eq!(
                without_missing(found),
                without_missing(self.kept[axis].tally())
            );
            assert_eq!(found.missing, self.missing);
            let seen = without_missing(ours.seen()[axis].tally());
            assert_eq!(seen, without_missing(self.seen[axis].tally()));
            let scale = Scale::new(0.5, 100.0).unwrap();
            let ours = ours.record_so_far(axis, (scale, [0.25])).unwrap();
            let ungated = self.ungated.record_so_far(axis, (scale, [0.25])).unwrap();
            // Numbers that are not known are NaN, which equals nothing. Their texts tell all digits of the others.
            let texts = |one: String, other: String| assert_eq!(one, other, "axis {axis}");
            texts(format!("{:?}", ours.curve), format!("{:?}", ungated.curve));
            texts(
                format!("{:?}", ours.spectrum),
                format!("{:?}", ungated.spectrum),
            );
            texts(
                format!("{:?}", ours.kurtosis),
                format!("{:?}", ungated.kurtosis),
            );
            texts(
                format!("{:?}", ours.covariates),
                format!("{:?}", ungated.covariates),
            );
            assert_eq!(ours.samples, ungated.samples);
        }
    }
}
