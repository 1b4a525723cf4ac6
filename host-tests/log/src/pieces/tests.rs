//! A record gives the same bytes however it is cut, and the sums of the definition.

use super::Pieces;
use crate::OCTAVES;
use rand::{RngExt as _, SeedableRng as _};
use rand_xoshiro::Xoshiro256PlusPlus as Random;
use std::ops::Range;

fn random(seed: u64) -> Random {
    Random::seed_from_u64(seed)
}

/// Counts of an amplitude, with an offset.
fn counts(random: &mut Random, number: usize, amplitude: i32) -> Vec<i32> {
    let offset = random.random_range(-amplitude..=amplitude) / 2;
    let mut count = || random.random_range(-amplitude..=amplitude) / 2 + offset;
    (0..number).map(|_| count()).collect()
}

/// Leaves blocks where they were already, as a buffer that is not refilled.
fn again(random: &mut Random, counts: &mut [i32]) {
    for _ in 0..counts.len() / 800 {
        let distance = random.random_range(8..=130);
        let block = distance * random.random_range(1..=5) / 2;
        let last = counts.len().saturating_sub(block + distance);
        if last > 0 {
            let at = random.random_range(0..last) + distance;
            for place in at..at + block {
                counts[place] = counts[place - distance];
            }
        }
    }
}

fn pieces() -> Pieces {
    Pieces::new(100.0, 0.01).unwrap()
}

fn bytes(pieces: &Pieces) -> Vec<u8> {
    pieces.to_bytes().unwrap()
}

/// The stretches of a record of so many samples: where it is cut, and which of the parts are there.
fn parts(random: &mut Random, samples: usize, cuts: usize, kept: f64) -> Vec<Range<usize>> {
    let mut places: Vec<usize> = (0..cuts)
        .map(|_| random.random_range(0..=samples))
        .collect();
    places.extend([0, samples]);
    places.sort_unstable();
    let all = places.windows(2).map(|pair| pair[0]..pair[1]);
    all.filter(|_| random.random_bool(kept)).collect()
}

/// The number of differences and the sum of their squares, by the definition, of a stretch that begins with sample `first`.
fn definition(first: u64, counts: &[i32], octave: usize) -> (u64, u128) {
    let m = 1_usize << octave;
    let h = (m / 4).max(1);
    let mut angles = vec![0_i128];
    for &count in counts {
        angles.push(angles[angles.len() - 1] + i128::from(count));
    }
    let skipped = (first.next_multiple_of(h as u64) - first) as usize;
    let starts = (skipped..)
        .step_by(h)
        .take_while(|s| s + 2 * m <= counts.len());
    let squares = starts.map(|s| (angles[s + 2 * m] - 2 * angles[s + m] + angles[s]).pow(2));
    squares.fold((0, 0), |(number, sum), square| {
        (number + 1, sum + square as u128)
    })
}

#[test]
fn however_a_record_is_cut_and_joined_its_bytes_are_the_same() {
    let mut random = random(1);
    for trial in 0..300 {
        let samples = match trial % 10 {
            0 => random.random_range(1..150_000),
            1..4 => random.random_range(1..8000),
            _ => random.random_range(1..600),
        };
        let amplitude = [3, 1000, 1 << 24, i32::MAX][trial % 4];
        let mut counts = counts(&mut random, samples, amplitude);
        again(&mut random, &mut counts);
        let first = [0, random.random_range(0..100_000)][trial % 2];
        let cuts = random.random_range(0..20);
        let kept = [1.0, 0.7][trial / 2 % 2];
        let parts = parts(&mut random, samples, cuts, kept);
        let number = |sample: usize| first + sample as u64;

        // Stretch by stretch, in their order.
        let mut whole = pieces();
        let mut stretches: Vec<Range<usize>> = Vec::new();
        for part in parts.iter().filter(|part| !part.is_empty()) {
            match stretches.last_mut() {
                Some(last) if last.end == part.start => last.end = part.end,
                _ => stretches.push(part.clone()),
            }
        }
        for stretch in &stretches {
            whole
                .push(number(stretch.start), &counts[stretch.clone()])
                .unwrap();
        }

        // Part by part in any order, in groups that are merged in any order.
        let mut groups = vec![pieces(); random.random_range(1..6)];
        let mut left = parts.clone();
        while !left.is_empty() {
            let part = left.swap_remove(random.random_range(0..left.len()));
            let group = random.random_range(0..groups.len());
            groups[group]
                .push(number(part.start), &counts[part])
                .unwrap();
        }
        while groups.len() > 1 {
            let group = groups.swap_remove(random.random_range(0..groups.len()));
            let other = random.random_range(0..groups.len());
            // Bytes go from machine to machine.
            let group = Pieces::from_bytes(&bytes(&group)).unwrap();
            groups[other].merge(group).unwrap();
        }
        assert_eq!(bytes(&groups[0]), bytes(&whole), "trial {trial}");

        // Sample by sample in any order, for short records.
        if samples < 600 {
            let mut rows: Vec<(u64, i32)> = stretches
                .iter()
                .flat_map(|stretch| stretch.clone().map(|s| (number(s), counts[s])))
                .collect();
            for i in (1..rows.len()).rev() {
                rows.swap(i, random.random_range(0..=i));
            }
            let (numbers, shuffled): (Vec<u64>, Vec<i32>) = rows.into_iter().unzip();
            let mut numbered = pieces();
            numbered.push_numbered(&numbers, &shuffled).unwrap();
            assert_eq!(bytes(&numbered), bytes(&whole), "trial {trial}");
        }

        for octave in 0..OCTAVES {
            let sums = stretches
                .iter()
                .map(|stretch| definition(number(stretch.start), &counts[stretch.clone()], octave));
            let expected = sums.fold((0, 0), |all, one| (all.0 + one.0, all.1 + one.1));
            let own = whole.pieces().map(|piece| piece.octave(octave));
            let found = own.fold((0, 0), |all, one| (all.0 + one.0, all.1 + one.1));
            assert_eq!(found, expected, "trial {trial}, octave {octave}");
        }
    }
}

#[test]
fn samples_that_come_twice_and_other_sensors_are_refused_and_nothing_is_added() {
    let mut all = pieces();
    all.push(100, &[1, 2, 3, 4]).unwrap();
    all.push(200, &[5; 50]).unwrap();
    let before = bytes(&all);
    let mut refused = |pieces: &Pieces, what: &str| {
        let failure = all.merge(pieces.clone()).unwrap_err().to_string();
        assert!(failure.starts_with(what), "{failure}");
        assert_eq!(bytes(&all), before);
    };
    for (first, number, what) in [
        (103, 2, "sample 103 comes twice; "),
        (98, 3, "sample 100 comes twice; "),
        (101, 2, "samples 101 to 102 come twice; "),
        (0, 1000, "samples 100 to 103 come twice; "),
        (249, 9, "sample 249 comes twice; "),
    ] {
        let mut other = pieces();
        other.push(0, &[7]).unwrap_or(());
        let mut other = if first == 0 { pieces() } else { other };
        other.push(first, &vec![9; number]).unwrap();
        refused(&other, what);
    }
    refused(
        &Pieces::new(200.0, 0.01).unwrap(),
        "a piece has the rate 200, and the others 100; ",
    );
    refused(
        &Pieces::new(100.0, 0.02).unwrap(),
        "a piece has the scale 0.02, and the others 0.01; ",
    );
    for (numbers, what) in [
        (vec![7, 5, 7], "sample 7 comes twice; "),
        (vec![7, 5, 103], "sample 103 comes twice; "),
        (vec![7, 5], "2 numbers of 3 samples; "),
        (
            vec![7, 5, 1 << 50],
            "sample 1125899906842624 has a number above 2^50; ",
        ),
        (
            vec![u64::MAX, 0, 5],
            "sample 18446744073709551615 has a number above 2^50; ",
        ),
    ] {
        let failure = all
            .push_numbered(&numbers, &[1, 2, 3])
            .unwrap_err()
            .to_string();
        assert!(failure.starts_with(what), "{failure}");
        assert_eq!(bytes(&all), before);
    }
}

#[test]
fn damaged_bytes_are_refused_or_those_of_pieces() {
    let mut random = random(3);
    let mut whole = pieces();
    let counts = counts(&mut random, 700, 100);
    whole.push(3, &counts[..500]).unwrap();
    whole.push(600, &counts[500..]).unwrap();
    let intact = bytes(&whole);
    assert_eq!(Pieces::from_bytes(&intact).unwrap(), whole);
    for trial in 0..4000 {
        let mut damaged = intact.clone();
        match trial % 3 {
            0 => damaged.truncate(random.random_range(0..intact.len())),
            1 => damaged.push(0),
            _ => {
                let place = random.random_range(0..intact.len());
                damaged[place] ^= 1 << random.random_range(0..8);
            }
        }
        match Pieces::from_bytes(&damaged) {
            // What can be read can be used, whatever it says.
            Ok(mut pieces) => {
                assert_eq!(trial % 3, 2);
                let _ = (pieces.octave(3), pieces.level(1));
                let _ = pieces.push(503, &[1; 97]);
            }
            Err(failure) => assert!(failure.to_string().starts_with("these are not the bytes")),
        }
    }
}

/// What may happen to a record while it is read.
#[derive(Clone, Copy)]
enum Operation {
    /// So many samples come.
    Push(usize),
    /// So many are lost.
    Lost(usize),
    /// Another machine goes on.
    Part,
    /// What the last machine before this one has comes here.
    Join,
    /// The state goes through its bytes.
    Restore,
    /// The state is looked at: its curve is computed.
    Release,
}

/// A record on its way: the samples so far, and what each machine has of it.
#[derive(Clone)]
struct History {
    next: usize,
    machines: Vec<Pieces>,
    stretches: Vec<Range<usize>>,
}

impl History {
    fn go_on(&mut self, operation: Operation, counts: &[i32]) {
        let Some(own) = self.machines.last_mut() else {
            return;
        };
        match operation {
            Operation::Push(samples) => {
                let range = self.next..self.next + samples;
                own.push(range.start as u64, &counts[range.clone()])
                    .unwrap();
                self.next = range.end;
                match self.stretches.last_mut() {
                    Some(last) if last.end == range.start => last.end = range.end,
                    _ => self.stretches.push(range),
                }
            }
            Operation::Lost(samples) => self.next += samples,
            Operation::Part => self.machines.push(pieces()),
            Operation::Join => {
                if let Some(other) = self.machines.len().checked_sub(2) {
                    let other = self.machines.remove(other);
                    self.machines.last_mut().unwrap().merge(other).unwrap();
                }
            }
            Operation::Restore => *own = Pieces::from_bytes(&bytes(own)).unwrap(),
            Operation::Release => drop((own.octave(0), own.level(0))),
        }
    }

    /// Whether all machines together have the sums of the definition, and the bytes of the record that none cut.
    fn check(&self, counts: &[i32]) {
        let (mut all, mut whole) = (pieces(), pieces());
        for part in &self.machines {
            all.merge(part.clone()).unwrap();
        }
        for stretch in &self.stretches {
            whole
                .push(stretch.start as u64, &counts[stretch.clone()])
                .unwrap();
        }
        assert_eq!(bytes(&all), bytes(&whole));
        for octave in 0..OCTAVES {
            let sum = |one: (u64, u128), other: (u64, u128)| (one.0 + other.0, one.1 + other.1);
            let found = all
                .pieces()
                .map(|piece| piece.octave(octave))
                .fold((0, 0), sum);
            let expected = self
                .stretches
                .iter()
                .map(|stretch| definition(stretch.start as u64, &counts[stretch.clone()], octave));
            assert_eq!(found, expected.fold((0, 0), sum), "octave {octave}");
            if found.0 == 0 {
                break;
            }
        }
    }
}

/// Checks every history of at most so many further operations, and returns their number.
fn every(history: &History, operations: usize, counts: &[i32]) -> usize {
    history.check(counts);
    if operations == 0 {
        return 1;
    }
    use Operation::{Join, Lost, Part, Push, Release, Restore};
    let all = [Push(3), Push(70), Lost(5), Part, Join, Restore, Release];
    let longer = all.map(|operation| {
        let mut longer = history.clone();
        longer.go_on(operation, counts);
        every(&longer, operations - 1, counts)
    });
    1 + longer.iter().sum::<usize>()
}

/// The module `thorough` checks those of seven operations, too.
#[test]
fn every_history_has_the_sums_of_the_definition_and_the_bytes_of_the_whole() {
    histories(5);
}

mod thorough {
    use super::*;

    #[test]
    fn every_history_of_seven_operations() {
        histories(7);
    }
}

fn histories(operations: usize) {
    let counts = counts(&mut random(4), 7 * 70, 1000);
    let begin = History {
        next: 0,
        machines: vec![pieces()],
        stretches: Vec::new(),
    };
    let number = every(&begin, operations, &counts);
    println!("{number} histories");
    let lengths = 0..=operations as u32;
    let expected: usize = lengths.map(|length| 7_usize.pow(length)).sum();
    assert_eq!(number, expected);
}
