//! A short run of the study of long records. The figures of the manual come from `cargo xtask study long`.

use allanite_studies::long::{OCTAVES, Program, Sequence, distributed, growth, merged, slope};
use program::path;

/// The sum over all starts, from the counts themselves.
fn definition(counts: &[i32], k: u32) -> (u64, u128) {
    let (m, mut differences, mut sum) = (1 << k, 0, 0);
    for s in (0..counts.len()).step_by((m / 4).max(1)) {
        let mean = |from: usize| {
            counts
                .get(from..from + m)
                .map(|c| c.iter().map(|&c| i64::from(c)).sum::<i64>())
        };
        let (Some(first), Some(second)) = (mean(s), mean(s + m)) else {
            break;
        };
        differences += 1;
        sum += u128::from(second.abs_diff(first)).pow(2);
    }
    (differences, sum)
}

/// The sums that the sequence predicts are those of its counts, on either side of an edge of its square wave, after
/// several of them, and where differences span more than one.
#[test]
fn the_known_sums_are_those_of_the_counts() {
    let sequence = Sequence::new(7);
    for (start, end) in [
        ((1 << 24) - 6001, (1 << 24) + 5000),
        ((9 << 24) - 4096, (9 << 24) + 70_000),
        ((1 << 40) + 3, (1 << 40) + 140_000),
    ] {
        let mut counts = Vec::new();
        sequence.each(start, end, |slice| counts.extend_from_slice(slice));
        assert_eq!(counts.len() as u64, end - start);
        for k in 0..18 {
            let expected = sequence.expected(k, start, end);
            let by_counts = definition(&counts, k);
            assert_eq!(
                (expected.differences, expected.sum),
                by_counts,
                "{start} {k}"
            );
        }
    }
}

/// Every octave of a record that passes three edges is exact, in one piece and in parts, its state does not grow, and
/// another sequence does not have its sums.
#[test]
fn a_record_of_known_sums_is_exact_and_takes_linear_time() {
    let samples = 3 << 24;
    let sequence = Sequence::new(1);
    let lengths = growth(&sequence, samples);
    assert_eq!(lengths.len(), 7);
    for length in &lengths {
        assert_eq!(length.exact, OCTAVES, "{length:?}");
    }
    assert_eq!(
        lengths.last().map(|last| (last.samples, last.octaves)),
        Some((samples, 25))
    );
    // A slope of 1 for time; other processes may disturb a short one.
    let time = slope(&lengths, |length| length.cpu_s).expect("seven lengths");
    assert!((0.7..1.3).contains(&time.value), "{time:?}");
    let merged = merged(&sequence, samples, 5);
    assert_eq!((merged.exact, merged.octaves), (OCTAVES, 23));
    let other = Sequence::new(2);
    assert_ne!(
        other.expected(3, 0, samples),
        sequence.expected(3, 0, samples)
    );
}

/// Whatever the order of merging, the bytes are the same, and each cut costs an octave seven differences.
#[test]
fn the_order_of_merging_changes_no_byte() {
    let program = Program {
        file: path().into(),
        first: Vec::new(),
    };
    let (files, file_s) = (5, 20);
    let all = distributed(&program, files, file_s).expect("the program runs");
    assert_eq!(
        (all.samples, all.orders.len(), all.same_bytes),
        (100_000, 3, 3)
    );
    assert!(all.same_sums_in_groups);
    assert!(all.density_in_groups < 1e-12, "{}", all.density_in_groups);
    // A file has 20000 samples, 625 blocks of 32. Longer blocks are cut, too, and cost more.
    for (k, octave) in (0..).zip(&all.octaves) {
        let lost = octave.whole - octave.merged;
        match k {
            0 => assert_eq!(lost, files - 1),
            1 => assert_eq!(lost, 3 * (files - 1)),
            2..8 => assert_eq!(lost, 7 * (files - 1), "{octave:?}"),
            _ => assert!(lost >= 7 * (files - 1) || octave.merged == 0, "{octave:?}"),
        }
    }
    assert_eq!(all.octaves.len(), 16);
}
