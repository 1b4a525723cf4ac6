//! Every history of up to seven events gives the sums of the definition: an accumulator alone, and an axis behind a gate,
//! which holds samples back.

use allanite::{Accumulator, Axis, axis::Gated};
use std::{collections::VecDeque, ops::Range};

/// Enough octaves that 64 samples in a row can be filled.
const OCTAVES: usize = 8;

/// The longest history.
const LONGEST: usize = 7;

/// The samples that an event pushes: enough that lost ones behind them are filled, and few enough that the gate, which
/// holds back 128 of them, sometimes holds back all.
const BLOCK: usize = 40;

/// The samples that are lost if that is the first event, the second, and so on. 70 are too many to be filled.
const LOST: [u64; LONGEST] = [3, 1, 5, 70, 64, 2, 9];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Event {
    Push,
    Gap,
    Lost,
    /// Another record is added.
    Merge,
    /// The record is added to another one, which goes on.
    MergeInto,
    Snapshot,
    Restore,
    Release,
}

const EVENTS: [Event; 8] = [
    Event::Push,
    Event::Gap,
    Event::Lost,
    Event::Merge,
    Event::MergeInto,
    Event::Snapshot,
    Event::Restore,
    Event::Release,
];

/// The counts of a gyro at rest.
fn counts(first: usize) -> impl Iterator<Item = i32> {
    (first..first + BLOCK).map(|n| {
        let mixed = (n as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        ((mixed ^ mixed >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 32) as i32 % 50
    })
}

/// What is recorded, and what can happen to it.
trait Recorder: Clone {
    fn push(&mut self, count: i32);
    fn gap(&mut self);
    fn lost(&mut self, samples: u64);
    fn merge(&mut self, other: &Self);
    fn snapshot(&self) -> Vec<u8>;
    fn restore(&mut self, bytes: &[u8]);
    fn release(&mut self);
    fn accumulator(&self) -> &Accumulator<OCTAVES>;
}

impl Recorder for Accumulator<OCTAVES> {
    fn push(&mut self, count: i32) {
        self.push(count);
    }

    fn gap(&mut self) {
        self.gap();
    }

    fn lost(&mut self, samples: u64) {
        self.lost(samples);
    }

    fn merge(&mut self, other: &Self) {
        self.merge(other);
    }

    fn snapshot(&self) -> Vec<u8> {
        self.snapshot(&mut [0; 1000]).unwrap().to_vec()
    }

    fn restore(&mut self, bytes: &[u8]) {
        *self = Self::restore(bytes).unwrap();
    }

    fn release(&mut self) {}

    fn accumulator(&self) -> &Self {
        self
    }
}

type Gyro = Axis<OCTAVES, 0, Gated, ()>;

impl Recorder for Gyro {
    fn push(&mut self, count: i32) {
        self.push(count);
    }

    fn gap(&mut self) {
        self.gap();
    }

    fn lost(&mut self, samples: u64) {
        self.lost(samples);
    }

    fn merge(&mut self, other: &Self) {
        self.merge(other);
    }

    fn snapshot(&self) -> Vec<u8> {
        self.snapshot(&[], &mut [0; 2000]).unwrap().to_vec()
    }

    fn restore(&mut self, bytes: &[u8]) {
        self.restore(&mut [], bytes).unwrap();
    }

    fn release(&mut self) {
        self.release();
    }

    fn accumulator(&self) -> &Accumulator<OCTAVES> {
        assert_eq!(self.left_out(), 0, "the gyro is at rest");
        self.accumulators()[0]
    }
}

/// What waits in the gate.
#[derive(Clone, Copy)]
enum Waiting {
    Count(i32),
    /// So many samples are missing, or 0 for an unknown number.
    Missing(u64),
}

/// A record by definition. The sums of stretches that have ended stay, and that of the running one is computed anew each
/// time, in 128 bits.
#[derive(Clone, Default)]
struct Definition {
    is_gated: bool,
    waiting: VecDeque<Waiting>,
    ended: [(u64, u128); OCTAVES],
    samples: u64,
    filled: u64,
    gaps: u64,
    running: Vec<i32>,
    /// The places of filled values, and the averaging factor from which on differences use them.
    places: Vec<(Range<usize>, usize)>,
    /// What rounding left, in 32nds.
    rest: i64,
}

impl Definition {
    fn wait(&mut self, next: Waiting) {
        if !self.is_gated {
            return self.take(next);
        }
        if let (Some(Waiting::Missing(before)), Waiting::Missing(more)) =
            (self.waiting.back_mut(), next)
        {
            // Missing samples that adjoin are one gap, of unknown length if one of them is.
            let is_known = *before > 0 && more > 0;
            *before = if is_known { *before + more } else { 0 };
            return;
        }
        if self.waiting.len() == 128 {
            let oldest = self.waiting.pop_front().unwrap();
            self.take(oldest);
        }
        self.waiting.push_back(next);
    }

    fn release(&mut self) {
        while let Some(next) = self.waiting.pop_front() {
            self.take(next);
        }
    }

    fn take(&mut self, next: Waiting) {
        match next {
            Waiting::Count(count) => {
                self.running.push(count);
                self.samples += 1;
            }
            Waiting::Missing(samples) => self.miss(samples),
        }
    }

    /// Up to 64 samples are filled with the mean of the 32 samples before the last multiple of eight, rounded down with
    /// what rounding left before.
    fn miss(&mut self, samples: u64) {
        let begin = self.running.len();
        let first = (2 * samples.next_power_of_two()).max(4) as usize;
        if samples == 0 || samples > 64 || begin < 32 || first > 1 << (OCTAVES - 1) {
            return self.end();
        }
        let end = begin / 8 * 8;
        let sum: i64 = self.running[end - 32..end]
            .iter()
            .map(|&n| i64::from(n))
            .sum();
        for _ in 0..samples {
            let all = sum + self.rest;
            self.rest = all.rem_euclid(32);
            self.running.push(all.div_euclid(32) as i32);
        }
        self.filled += samples;
        self.places.push((begin..self.running.len(), first));
    }

    /// The running stretch ends.
    fn end(&mut self) {
        if self.running.is_empty() {
            return;
        }
        self.ended = self.octaves();
        self.gaps += 1;
        self.running.clear();
        self.places.clear();
        self.rest = 0;
    }

    fn merge(&mut self, other: &Self) {
        let mut other = other.clone();
        self.release();
        other.release();
        // An accumulator goes on where an empty one is added to it.
        if !self.is_gated && other.samples == 0 {
            return;
        }
        self.end();
        other.end();
        for (own, other) in self.ended.iter_mut().zip(other.ended) {
            *own = (own.0 + other.0, own.1 + other.1);
        }
        self.samples += other.samples;
        self.filled += other.filled;
        self.gaps += other.gaps;
    }

    /// A power cut: what waits is lost, and the record ends where it was stored.
    fn restored(stored: &Self) -> Self {
        let mut restored = stored.clone();
        restored.waiting.clear();
        restored.end();
        restored
    }

    /// The number of differences and the sum of their squares for each octave.
    fn octaves(&self) -> [(u64, u128); OCTAVES] {
        let mut theta = vec![0_i128];
        for &count in &self.running {
            theta.push(theta[theta.len() - 1] + i128::from(count));
        }
        let mut octaves = self.ended;
        for (k, (differences, sum)) in octaves.iter_mut().enumerate() {
            let m = 1 << k;
            for start in (0..theta.len().saturating_sub(2 * m)).step_by((m / 4).max(1)) {
                let touches = |(places, first): &(Range<usize>, usize)| {
                    m < *first && places.start < start + 2 * m && start < places.end
                };
                if !self.places.iter().any(touches) {
                    let d = theta[start + 2 * m] - 2 * theta[start + m] + theta[start];
                    *differences += 1;
                    *sum += d.unsigned_abs().pow(2);
                }
            }
        }
        octaves
    }

    fn check(&self, accumulator: &Accumulator<OCTAVES>, history: &[Event]) {
        let expected = self.octaves();
        for (octave, expected) in accumulator.octaves().zip(expected) {
            let [low, high, highest] = octave.sum.limbs();
            let sum = u128::from(low) | u128::from(high) << 64;
            let found = (octave.differences, sum);
            assert!(found == expected && highest == 0, "{history:?}: {found:?}");
        }
        let found = (
            accumulator.samples(),
            accumulator.gaps(),
            accumulator.bridged().lost(),
        );
        assert_eq!(found, (self.samples, self.gaps, self.filled), "{history:?}");
    }
}

/// A record and its definition, with what was stored of both.
#[derive(Clone)]
struct Both<R> {
    recorder: R,
    definition: Definition,
    stored: Option<(Vec<u8>, Definition)>,
    pushed: usize,
}

impl<R: Recorder> Both<R> {
    fn new(empty: R, is_gated: bool) -> Self {
        let definition = Definition {
            is_gated,
            ..Definition::default()
        };
        Self {
            recorder: empty,
            definition,
            stored: None,
            pushed: 0,
        }
    }

    fn push(&mut self) {
        for count in counts(self.pushed) {
            self.recorder.push(count);
            self.definition.wait(Waiting::Count(count));
        }
        self.pushed += BLOCK;
    }

    /// Lets an event happen as the one of a number. Returns false if it changes nothing.
    fn happen(&mut self, event: Event, number: usize, other: &Self) -> bool {
        match event {
            Event::Push => self.push(),
            Event::Gap => {
                self.recorder.gap();
                self.definition.wait(Waiting::Missing(0));
            }
            Event::Lost => {
                self.recorder.lost(LOST[number]);
                self.definition.wait(Waiting::Missing(LOST[number]));
            }
            Event::Merge => {
                self.recorder.merge(&other.recorder);
                self.definition.merge(&other.definition);
            }
            Event::MergeInto => {
                let before = self.clone();
                self.recorder = other.recorder.clone();
                self.definition = other.definition.clone();
                self.recorder.merge(&before.recorder);
                self.definition.merge(&before.definition);
            }
            Event::Snapshot => {
                self.stored = Some((self.recorder.snapshot(), self.definition.clone()));
            }
            Event::Restore => {
                let Some((bytes, stored)) = &self.stored else {
                    return false;
                };
                self.recorder.restore(bytes);
                self.definition = Definition::restored(stored);
            }
            Event::Release => {
                if !self.definition.is_gated {
                    return false;
                }
                self.recorder.release();
                self.definition.release();
            }
        }
        true
    }

    /// Checks every history that begins with this one, and returns how many there are.
    fn check_all(&self, other: &Self, history: &mut Vec<Event>, longest: usize) -> u64 {
        self.definition.check(self.recorder.accumulator(), history);
        let mut checked = 1;
        if history.len() < longest {
            for event in EVENTS {
                let mut next = self.clone();
                if next.happen(event, history.len(), other) {
                    history.push(event);
                    checked += next.check_all(other, history, longest);
                    history.pop();
                }
            }
        }
        checked
    }
}

/// Checks every history of a record, with another record that has two stretches, filled values, and more to come.
fn check_all<R: Recorder>(empty: &R, is_gated: bool, longest: usize) -> u64 {
    let mut other = Both::new(empty.clone(), is_gated);
    // Other counts than those of the record.
    other.pushed = 1000;
    for event in [
        Event::Push,
        Event::Gap,
        Event::Push,
        Event::Lost,
        Event::Push,
    ] {
        other.happen(event, 0, &Both::new(empty.clone(), is_gated));
    }
    Both::new(empty.clone(), is_gated).check_all(&other, &mut Vec::new(), longest)
}

#[test]
fn every_history_of_five_gives_the_sums_of_the_definition() {
    assert_eq!(check_all(&Accumulator::new(), false, 5), 11_757);
    assert_eq!(check_all(&Gyro::new(), true, 5), 23_390);
}

mod thorough {
    use super::*;

    #[test]
    fn every_history_of_an_accumulator_gives_the_sums_of_the_definition() {
        assert_eq!(check_all(&Accumulator::new(), false, LONGEST), 529_228);
    }

    #[test]
    fn every_history_of_an_axis_behind_a_gate_gives_the_sums_of_the_definition() {
        assert_eq!(check_all(&Gyro::new(), true, LONGEST), 1_366_334);
    }
}
