//! Blocks of samples that are there twice.
//!
//! [`Reads`](allanite::faults::Reads) follows one distance at a time. What it follows depends on where the record begins, so that
//! pieces count every run by itself: whether it counts depends on the samples from a distance before its first one to the one
//! behind its last one, and on no other. A run that is cut is counted when the pieces are joined.

use allanite::{
    faults::{AtDistance, StaleRuns},
    integrity::Reason,
};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The samples of a hash that are looked up together.
const WINDOW: usize = 4;

/// The shortest length of runs of a class: each is the length from which a run is no chance for samples of some bits of surprise.
const CLASSES: [u32; 5] = [6, 7, 8, 11, 16];

const NEAREST: usize = *StaleRuns::DISTANCES.start() as usize;
const FARTHEST: usize = *StaleRuns::DISTANCES.end() as usize;
const ELSEWHERE: usize = StaleRuns::ELSEWHERE as usize;

/// The samples of a run from which on it is not counted. Blocks are shorter, and a period of the gyro may be longer.
const LONGEST: usize = 2 * FARTHEST + 3;

/// The samples that are kept at the ends: those on which a run depends.
const EDGE: usize = FARTHEST + LONGEST + 1;

/// The places of windows by their hashes.
const SLOTS: usize = 1 << 10;

/// The blocks of a piece that are there twice.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Stale {
    /// The hashes of the first samples and of the last ones.
    first: Vec<u8>,
    last: Vec<u8>,
    runs: Runs,
}

/// What is counted.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Runs {
    /// Samples that were compared with the one 11 before, and those that equal it.
    looked: u64,
    elsewhere: u64,
    /// Runs by their class.
    long: [u64; CLASSES.len()],
    /// Runs that have the length of a block.
    whole: BTreeMap<Place, Whole>,
}

/// A distance and a class as one number, which a document can have for a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
struct Place(u16);

impl Place {
    fn new(distance: usize, class: usize) -> Self {
        Self((distance << 3 | class) as u16)
    }

    fn distance(self) -> u16 {
        self.0 >> 3
    }

    fn class(self) -> usize {
        usize::from(self.0 & 7)
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
struct Whole {
    runs: u64,
    longest: u16,
    samples: u64,
}

impl Runs {
    fn add(&mut self, distance: usize, length: usize) {
        let is_of = |class: &usize| CLASSES[*class] as usize <= length;
        let Some(class) = (0..CLASSES.len()).rev().find(is_of) else {
            return;
        };
        self.long[class] = self.long[class].saturating_add(1);
        // Samples of one bit of surprise are not judged.
        if StaleRuns::is_whole(distance as u16, length as u32, 2) {
            let place = Place::new(distance, class);
            self.whole.entry(place).or_default().join(&Whole {
                runs: 1,
                longest: length as u16,
                samples: length as u64,
            });
        }
    }

    /// Counts what ends in a sequence of hashes. `is_counted` is asked for the first and the last sample on which something depends.
    fn scan(&mut self, hashes: &[u8], is_counted: impl Fn(usize, usize) -> bool) {
        // The places behind the last windows, and behind the last runs.
        let mut seen = [0_u32; SLOTS];
        let mut done = [0_usize; FARTHEST + 1];
        let mut window = 0_u32;
        for (place, &hash) in hashes.iter().enumerate() {
            window = window << 8 | u32::from(hash);
            let Some(hash) = StaleRuns::window(window) else {
                continue;
            };
            let Some(before) = (place + 1).checked_sub(WINDOW) else {
                continue;
            };
            if place >= ELSEWHERE && is_counted(place - ELSEWHERE, place) {
                let is_equal = hashes[place] == hashes[place - ELSEWHERE];
                self.looked = self.looked.saturating_add(1);
                self.elsewhere = self.elsewhere.saturating_add(is_equal.into());
            }
            let slot = &mut seen[hash as usize / (1 << 22) % SLOTS];
            let other = std::mem::replace(slot, place as u32 + 1) as usize;
            let distance = place + 1 - other;
            let is_other = |before: usize, distance: usize| {
                let [own, other] = [before, before - distance];
                hashes[own..][..WINDOW] != hashes[other..][..WINDOW]
            };
            let is_near = other > 0 && (NEAREST..=FARTHEST).contains(&distance);
            if !is_near || done[distance] > place || is_other(before, distance) {
                continue;
            }
            let run = Run::around(place, distance, hashes);
            done[distance] = run.end;
            if let Some((first, last)) = run.depends_on(hashes.len())
                && is_counted(first, last)
            {
                self.add(distance, run.end - run.start);
            }
        }
    }

    /// Adds what was counted elsewhere.
    pub(super) fn join(&mut self, other: &Self) {
        self.looked = self.looked.saturating_add(other.looked);
        self.elsewhere = self.elsewhere.saturating_add(other.elsewhere);
        for (own, theirs) in self.long.iter_mut().zip(other.long) {
            *own = own.saturating_add(theirs);
        }
        for (place, theirs) in &other.whole {
            self.whole.entry(*place).or_default().join(theirs);
        }
    }

    /// What the blocks say of so many samples of one axis, by the rule of the library.
    pub(super) fn verdict(&self, samples: u64) -> Option<Reason> {
        let narrow = |number: u64| u32::try_from(number).unwrap_or(u32::MAX);
        let mut runs = StaleRuns {
            looked: narrow(self.looked),
            elsewhere: narrow(self.elsewhere),
            ..StaleRuns::NEW
        };
        let needed = runs.needed()?;
        let is_long = |class: usize| CLASSES.get(class).is_some_and(|&from| from >= needed);
        let long = self.long.iter().enumerate();
        let long = long.filter(|(class, _)| is_long(*class));
        runs.long = narrow(long.map(|(_, number)| *number).sum());
        let mut distances: BTreeMap<u16, Whole> = BTreeMap::new();
        for (place, whole) in &self.whole {
            if is_long(place.class()) {
                distances.entry(place.distance()).or_default().join(whole);
            }
        }
        runs.whole = narrow(distances.values().map(|whole| whole.runs).sum());
        let mut most: Vec<(u16, Whole)> = distances.into_iter().collect();
        most.sort_by_key(|(_, whole)| std::cmp::Reverse(whole.runs));
        for (place, (distance, whole)) in runs.distances.iter_mut().zip(most) {
            *place = AtDistance {
                distance,
                runs: narrow(whole.runs),
                longest: whole.longest.into(),
                samples: narrow(whole.samples),
            };
        }
        let reason = runs.verdict(narrow(samples), 1)?;
        Some(match reason {
            Reason::Stale {
                stale, distance, ..
            } => Reason::Stale {
                stale,
                distance,
                samples,
            },
            other => other,
        })
    }

    fn is_possible(&self, samples: u64) -> bool {
        let of_whole = |(place, whole): (&Place, &Whole)| {
            let from = CLASSES.get(place.class()).copied();
            let longest = u64::from(whole.longest);
            StaleRuns::DISTANCES.contains(&place.distance())
                && from.is_some_and(|from| from <= u32::from(whole.longest))
                && usize::from(whole.longest) <= LONGEST
                && whole.runs > 0
                && whole.samples >= longest
                && whole.samples <= longest.saturating_mul(whole.runs)
        };
        let runs = self.whole.values().map(|whole| whole.runs);
        let all = self.long.iter().copied().fold(0, u64::saturating_add);
        self.looked <= samples
            && self.elsewhere <= self.looked
            && runs.fold(0, u64::saturating_add) <= all
            && all <= samples.saturating_mul(FARTHEST as u64)
            && self.whole.iter().all(of_whole)
    }
}

impl Whole {
    fn join(&mut self, other: &Self) {
        self.runs = self.runs.saturating_add(other.runs);
        self.longest = self.longest.max(other.longest);
        self.samples = self.samples.saturating_add(other.samples);
    }
}

/// The places of neighbouring samples that equal those at a distance before them.
struct Run {
    start: usize,
    end: usize,
    distance: usize,
}

impl Run {
    /// The run with a place. It may be longer before than [`LONGEST`].
    fn around(place: usize, distance: usize, hashes: &[u8]) -> Self {
        let is_again = |at: usize| hashes[at] == hashes[at - distance];
        let mut start = place;
        while start > distance && place - start <= LONGEST && is_again(start - 1) {
            start -= 1;
        }
        let behind = (place + 1..hashes.len()).take_while(|&at| is_again(at));
        let end = place + 1 + behind.count();
        Self {
            start,
            end,
            distance,
        }
    }

    /// The first and the last of so many samples on which it depends, if both of its ends are there and it is not too long.
    fn depends_on(&self, samples: usize) -> Option<(usize, usize)> {
        let first = self.start.checked_sub(self.distance + 1)?;
        (self.end < samples && self.end - self.start <= LONGEST).then_some((first, self.end))
    }
}

impl Stale {
    pub(super) fn of(counts: &[i32]) -> Self {
        let hashes: Vec<u8> = counts.iter().map(|&count| StaleRuns::hash(count)).collect();
        let mut runs = Runs::default();
        runs.scan(&hashes, |_, _| true);
        let edge = hashes.len().min(EDGE);
        Self {
            first: hashes[..edge].to_vec(),
            last: hashes[hashes.len() - edge..].to_vec(),
            runs,
        }
    }

    /// Joins the samples behind these.
    pub(super) fn join(&mut self, next: &Self) {
        let boundary = self.last.len();
        let across = [&self.last[..], &next.first[..]].concat();
        self.runs.join(&next.runs);
        self.runs.scan(&across, |first, last| {
            (first..last).contains(&(boundary - 1)) && last >= boundary
        });
        let room = EDGE - self.first.len();
        let more = &next.first[..room.min(next.first.len())];
        self.first.extend_from_slice(more);
        self.last.extend_from_slice(&next.last);
        self.last.drain(..self.last.len().saturating_sub(EDGE));
    }

    pub(super) fn runs(&self) -> &Runs {
        &self.runs
    }

    /// Whether so many samples can have these.
    pub(super) fn is_possible(&self, samples: u64) -> bool {
        let edge = samples.min(EDGE as u64);
        let is_short = samples <= EDGE as u64;
        [&self.first, &self.last]
            .iter()
            .all(|end| end.len() as u64 == edge)
            && (!is_short || self.first == self.last)
            && self.runs.is_possible(samples)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use allanite::faults::Reads;
    use rand::{RngExt as _, SeedableRng as _};
    use rand_xoshiro::Xoshiro256PlusPlus as Random;

    /// Counts of so many levels, of which a block is sometimes left from before.
    fn counts(random: &mut Random, levels: i32, half: usize, blocks: usize) -> Vec<i32> {
        let mut counts: Vec<i32> = (0..30_000)
            .map(|_| random.random_range(0..levels) + random.random_range(0..levels))
            .collect();
        for _ in 0..blocks {
            let at = half * random.random_range(2..counts.len() / half - 1);
            for place in at..at + half {
                counts[place] = counts[place - 2 * half];
            }
        }
        counts
    }

    /// Every run by the definition, whatever window leads to it.
    #[test]
    fn runs_are_those_of_the_definition_that_a_window_finds() {
        let mut random = Random::seed_from_u64(1);
        for levels in [2, 3, 10, 200] {
            let counts = counts(&mut random, levels, 20, 300);
            let hashes: Vec<u8> = counts.iter().map(|&count| StaleRuns::hash(count)).collect();
            let mut all = Runs::default();
            for distance in NEAREST..=FARTHEST {
                let again: Vec<bool> = (distance..hashes.len())
                    .map(|at| hashes[at] == hashes[at - distance])
                    .collect();
                let mut place = 0;
                for run in again.chunk_by(|one, next| one == next) {
                    let is_inside = place > 0 && place + run.len() < again.len();
                    if run[0] && is_inside && run.len() <= LONGEST {
                        all.add(distance, run.len());
                    }
                    place += run.len();
                }
            }
            let own = Stale::of(&counts).runs;
            for (place, whole) in &own.whole {
                assert!(whole.runs <= all.whole[place].runs, "{levels}: {place:?}");
                assert!(whole.longest <= all.whole[place].longest);
            }
            if levels == 200 {
                // Nearly every block of 20 samples has a window that is looked up.
                let of = |runs: &Runs| -> u64 {
                    let whole = runs
                        .whole
                        .iter()
                        .filter(|(place, _)| place.distance() == 40);
                    whole.map(|(_, whole)| whole.runs).sum()
                };
                assert!(of(&own) * 10 > of(&all) * 8, "{} of {}", of(&own), of(&all));
            }
        }
    }

    #[test]
    fn blocks_that_are_there_twice_are_found_as_by_the_library() {
        let mut random = Random::seed_from_u64(2);
        let (mut found, mut of_library) = (0, 0);
        for half in [16, 25, 32, 50, 64] {
            for levels in [10, 100, 1000] {
                let counts = counts(&mut random, levels, half, 40);
                let samples = counts.len() as u64;
                let mut reads = Reads::<1>::new();
                for &count in &counts {
                    reads.push([count]);
                }
                of_library += u32::from(reads.verdict().is_some());
                match Stale::of(&counts).runs.verdict(samples) {
                    Some(Reason::Stale {
                        stale, distance, ..
                    }) => {
                        assert_eq!(usize::from(distance), 2 * half);
                        assert!(stale >= 20 * half as u64, "{stale} of {half}, {levels}");
                        found += 1;
                    }
                    other => assert_eq!(other, None),
                }
            }
        }
        assert!(found >= 14 && of_library >= 14, "{found}, {of_library}");
    }

    #[test]
    fn noise_pulses_and_lines_have_no_blocks() {
        let mut random = Random::seed_from_u64(3);
        for levels in [2, 3, 5, 10, 30, 100, 1000] {
            for trial in 0..20 {
                let period = [8.0, 17.3, 64.0, 100.0][trial % 4];
                let line = [0.0, 3.0][trial / 4 % 2] * f64::from(levels);
                let mut counts = counts(&mut random, levels, 16, 0);
                for (place, count) in counts.iter_mut().enumerate() {
                    let phase = std::f64::consts::TAU * place as f64 / period;
                    *count += (line * phase.sin()).round() as i32;
                }
                let verdict = Stale::of(&counts).runs.verdict(counts.len() as u64);
                assert_eq!(verdict, None, "{levels} levels, trial {trial}");
            }
        }
    }
}
