//! An accumulator under any sequence of samples and events, against the definition in 128-bit integers.

use allanite::Accumulator;

const OCTAVES: usize = 10;

/// Plays the events that the bytes encode.
pub fn check(bytes: &[u8]) {
    let mut accumulator = Accumulator::<OCTAVES>::new();
    let mut stretches = vec![Vec::new()];
    let mut bytes = bytes.iter().copied();
    while let Some(event) = bytes.next() {
        let stretch = stretches.last_mut().unwrap_or_else(|| unreachable!());
        match event % 8 {
            0 => {
                accumulator.gap();
                stretches.push(Vec::new());
            }
            1 => {
                let mut buffer = [0; Accumulator::<OCTAVES>::SNAPSHOT_BYTES];
                let stored = accumulator.snapshot(&mut buffer).unwrap();
                accumulator = Accumulator::restore(stored).unwrap();
                stretches.push(Vec::new());
            }
            2 => {
                let other = accumulator.clone();
                accumulator.merge(&other);
                let copies = stretches.clone();
                stretches.extend(copies);
                stretches.push(Vec::new());
            }
            kind => {
                let count = count(kind, &mut bytes);
                let times = 1 << (event >> 5);
                let counts = vec![count; times];
                stretch.extend(&counts);
                if kind == 3 {
                    accumulator.push_slice(&counts);
                } else {
                    counts.iter().for_each(|&count| accumulator.push(count));
                }
            }
        }
        // Copies of copies would grow without end.
        if stretches.iter().map(Vec::len).sum::<usize>() > 1 << 14 || stretches.len() > 64 {
            break;
        }
    }
    for (k, octave) in accumulator.octaves().enumerate() {
        let (sum, differences) = definition(&stretches, k);
        let [low, middle, high] = octave.sum.limbs();
        let found = (u128::from(middle) << 64 | u128::from(low), high);
        assert_eq!(
            (found, octave.differences),
            ((sum, 0), differences),
            "octave {k}"
        );
    }
    let samples: usize = stretches.iter().map(Vec::len).sum();
    assert_eq!(accumulator.samples(), samples as u64);
}

fn count(kind: u8, bytes: &mut impl Iterator<Item = u8>) -> i32 {
    let mut next = || bytes.next().unwrap_or(0);
    match kind {
        3 | 4 => i32::from_le_bytes([next(), next(), next(), next()]),
        5 => i32::MIN,
        6 => i32::MAX,
        _ => i32::from(next() as i8),
    }
}

/// Σ D² of octave `k` and the number of differences, as the definition of the accumulator has them.
pub(crate) fn definition(stretches: &[Vec<i32>], k: usize) -> (u128, u64) {
    let m = 1_usize << k;
    let step = (m / 4).max(1);
    let (mut sum, mut differences) = (0, 0);
    for stretch in stretches {
        let mut angles = vec![0_i128];
        for &count in stretch {
            angles.push(angles[angles.len() - 1] + i128::from(count));
        }
        for start in (0..angles.len().saturating_sub(2 * m)).step_by(step) {
            let difference = angles[start + 2 * m] - 2 * angles[start + m] + angles[start];
            sum += difference.unsigned_abs().pow(2);
            differences += 1;
        }
    }
    (sum, differences)
}
