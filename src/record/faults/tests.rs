//! The counters agree with their definition, whatever the size of a step.

extern crate std;
use super::*;
use crate::numerics::test_random::Random;
use crate::record::reads::Reads;
use std::{vec, vec::Vec};

const ROWS: usize = 5000;

/// Coarse noise that begins at 0 and 1, so that the step and the edge of the zeros are known at once, and that repeats
/// often.
fn noise(seed: u64) -> Vec<i32> {
    let mut random = Random::new(seed);
    let mut value = 0;
    let mut noise = vec![0, 1];
    for _ in 2..ROWS {
        if random.below(3) > 0 {
            value = (0..4).map(|_| random.below(5) as i32 - 2).sum();
        }
        noise.push(value);
    }
    noise
}

/// The lengths of the runs of `true`.
fn lengths(zeros: &[bool]) -> Vec<usize> {
    let runs = zeros.split(|zero| !zero);
    runs.map(<[bool]>::len)
        .filter(|&length| length > 0)
        .collect()
}

fn is_counted(runs: &ZeroRuns, zeros: &[bool]) {
    let lengths = lengths(zeros);
    let reached = [1, 2, 4, 8, 16, 32]
        .map(|least| lengths.iter().filter(|&&length| length >= least).count() as u64);
    assert_eq!(runs.reached, reached);
    assert_eq!(runs.zeros, lengths.iter().sum::<usize>() as u64);
    assert_eq!(
        runs.longest as usize,
        lengths.iter().copied().max().unwrap_or(0)
    );
    let long = lengths.iter().filter(|&&length| length >= 8);
    assert_eq!(runs.long, long.sum::<usize>() as u64);
}

#[test]
fn counters_are_those_of_the_definition() {
    for (seed, step) in (1..6).zip([1, 3, 16, 1000, 1 << 20]) {
        let axes = [noise(seed), noise(seed + 10), noise(seed + 20)];
        let mut faults = [(); 3].map(|()| SampleFaults::new());
        let mut reads: Reads = Reads::new();
        // A gap lies before this row.
        let gap = 2000;
        for row in 0..ROWS {
            if row == gap {
                faults.iter_mut().for_each(SampleFaults::gap);
                reads.gap();
            }
            let mut steps = [None; 3];
            for ((steps, faults), axis) in steps.iter_mut().zip(&mut faults).zip(&axes) {
                *steps = faults.push(step * axis[row]);
            }
            reads.push_steps(axes.each_ref().map(|axis| step * axis[row]), steps);
        }
        let pairs = || (1..ROWS).filter(|&row| row != gap);
        let difference = |axis: &[i32], row: usize| axis[row].abs_diff(axis[row - 1]);
        for (faults, axis) in faults.iter().zip(&axes) {
            let differences: Vec<u32> = pairs().map(|row| difference(axis, row)).collect();
            let near = [0, 1, 2, 3].map(|k| differences.iter().filter(|&&d| d == k).count() as u64);
            assert_eq!(
                (faults.steps.near, faults.steps.pairs),
                (near, (ROWS - 2) as u64)
            );
            let (first, second) = differences.split_at(gap - 1);
            let zeros = |differences: &[u32]| differences.iter().map(|&d| d == 0).collect();
            let zeros: [Vec<bool>; 2] = [zeros(first), zeros(second)];
            is_counted(&faults.runs, &zeros.join(&[false][..]));
            for (end, sign) in faults.ends.iter().zip([1, -1]) {
                let most = axis.iter().map(|&value| sign * value).max().unwrap();
                let near = [0, 1, 2].map(|k| {
                    axis.iter()
                        .filter(|&&value| sign * value == most - k)
                        .count() as u64
                });
                assert_eq!((end.near, end.value()), (near, i64::from(step * most)));
                let enters = |row: &usize| {
                    let repeats = *row > 0 && *row != gap && difference(axis, *row) == 0;
                    sign * axis[*row] == most && !repeats
                };
                assert_eq!(end.entries, (0..ROWS).filter(enters).count() as u64);
            }
            let at = |size: u32| {
                axis.iter()
                    .filter(|value| value.unsigned_abs() == size)
                    .count()
            };
            let hole = (at(0) as u64, step.unsigned_abs(), at(1) as u64);
            assert_eq!(
                (faults.hole.zeros, faults.hole.edge, faults.hole.beside),
                hole
            );
            let own = |row: &usize| *row == 0 || *row == gap || difference(axis, *row) > 0;
            let levels = [0, 1, 2].map(|level| {
                let rows = (0..ROWS).filter(own);
                rows.filter(|&row| axis[row].unsigned_abs() == level)
                    .count() as u64
            });
            assert_eq!(faults.hole.levels, levels);
            let sum: i64 = axis.iter().map(|&value| i64::from(step * value)).sum();
            let square = |value: &i32| u128::from((step * value).unsigned_abs()).pow(2);
            assert_eq!(
                faults.spread.sums(),
                (0, sum, axis.iter().map(square).sum())
            );
        }
        let (mut cells, mut third) = ([0; 8], [0; 2]);
        let mut all = vec![false; ROWS];
        for row in pairs() {
            let steps = axes.each_ref().map(|axis| difference(axis, row));
            let place = (0..3)
                .filter(|&axis| steps[axis] == 0)
                .fold(0, |place, axis| place | 1 << axis);
            cells[place] += 1;
            all[row] = place == 7;
            let size = steps.iter().sum::<u32>() as usize;
            if steps.iter().filter(|&&steps| steps == 0).count() == 2 && size <= 2 {
                third[size - 1] += 1;
            }
        }
        let joint = reads.joint();
        assert_eq!((joint.cells, joint.third), (cells, third));
        is_counted(&joint.runs, &all);
    }
}

#[test]
fn steps_that_were_taken_for_too_long_are_forgotten() {
    let mut faults = SampleFaults::new();
    for value in [0, 100, 200, 200, 210, 230, 230, 260, 300] {
        faults.push(value);
    }
    assert_eq!((faults.steps.step(), faults.steps.pairs), (10, 5));
    assert_eq!(faults.steps.near, [1, 1, 1, 1]);
}

#[test]
fn no_count_overflows() {
    let mut faults = SampleFaults::with_zero(i32::MIN);
    for n in 0..1000 {
        faults.push(if n % 2 == 0 { i32::MIN } else { i32::MAX });
    }
    assert_eq!(faults.steps.step(), u32::MAX);
    assert_eq!(faults.hole.zeros, 500);
    assert_eq!(faults.verdict(None), None);
    assert!(
        size_of::<SampleFaults>() <= 512,
        "{}",
        size_of::<SampleFaults>()
    );
}
