//! Checks the state after every sample, and that reading does not change it.

use super::{
    definition::{angles, big, octaves, square},
    events::Counts,
};
use allanite::Accumulator;
use num_bigint::BigUint;

#[test]
fn every_octave_is_up_to_date_after_every_sample() {
    const OCTAVES: usize = 9;
    let counts = Counts::Wide { seed: 1 }.take(1300);
    let mut accumulator = Accumulator::<OCTAVES>::new();
    let theta = angles(&counts);
    let (mut differences, mut sums) = ([0; OCTAVES], [BigUint::ZERO; OCTAVES]);
    for n in 1..=counts.len() {
        accumulator.push(counts[n - 1]);
        for k in 0..OCTAVES {
            let m = 1 << k;
            // A difference ends here if its start is at least 0 and a multiple of h.
            if n >= 2 * m && (n - 2 * m).is_multiple_of((m / 4).max(1)) {
                differences[k] += 1;
                sums[k] += square(theta[n] - 2 * theta[n - m] + theta[n - 2 * m]);
            }
            let octave = accumulator.octave(k).expect("an octave of the accumulator");
            let read = (octave.m, octave.differences, big(octave.sum.limbs()));
            assert_eq!(read, (m as u32, differences[k], sums[k].clone()), "n = {n}");
        }
        assert!(accumulator.octave(OCTAVES).is_none());
    }
}

#[test]
fn reading_does_not_change_the_state() {
    let counts = Counts::Wide { seed: 2 }.take(5000);
    let (mut read, mut unread) = (Accumulator::<13>::new(), Accumulator::<13>::new());
    for chunk in counts.chunks(37) {
        read.push_slice(chunk);
        let before = read.clone();
        assert_eq!(octaves(&read), octaves(&read));
        assert_eq!(read, before);
        unread.push_slice(chunk);
    }
    assert_eq!(read, unread);
}

#[test]
fn an_empty_record_has_no_differences() {
    let mut accumulator = Accumulator::<30>::new();
    accumulator.gap();
    accumulator.push_slice(&[]);
    accumulator.merge(&Accumulator::new());
    assert_eq!(accumulator, Accumulator::default());
    assert_eq!((accumulator.samples(), accumulator.gaps()), (0, 0));
    accumulator.push(i32::MIN);
    assert!(accumulator.octaves().all(|octave| octave.differences == 0));
    accumulator.reset();
    assert_eq!(accumulator, Accumulator::new());
}
