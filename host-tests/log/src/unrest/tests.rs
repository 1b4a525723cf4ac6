//! Motion beside rest.

use super::*;

/// Uniform noise within ±`size`.
fn noise(n: usize, axis: u32, size: i32) -> i32 {
    let n = 3 * n as u32 + axis;
    let mixed = n.wrapping_mul(2_654_435_761) ^ (n.wrapping_mul(40_503) << 7);
    (mixed.wrapping_mul(2_246_822_519) >> 8) as i32 % (2 * size + 1) - size
}

/// A swing of a second about all axes whose size changes, with a share of each.
fn swing(n: usize, share: f64) -> i32 {
    let time = n as f64 / 100.0;
    (share * (5.0 * time).sin() * (1.0 + 0.5 * (0.7 * time).sin())) as i32
}

fn record(samples: usize, size: [f64; AXES]) -> [Vec<i32>; AXES] {
    std::array::from_fn(|axis| {
        let count = |n| noise(n, axis as u32, 100) + swing(n, size[axis]);
        (0..samples).map(count).collect()
    })
}

fn of(axes: &[Vec<i32>; AXES]) -> Unrest {
    let mut unrest = Unrest::new();
    unrest.push(axes.each_ref().map(Vec::as_slice));
    unrest
}

#[test]
fn motion_is_told_and_rest_is_not() {
    let still = of(&record(40_000, [0.0; 3]));
    assert_eq!(still.found(100.0, [1e-4; 3], Some(1.0)), None);
    // 58 counts of noise at 100 Hz are 0.58 °/s/√Hz if a count is 0.1 °/s: no gyro is that bad.
    assert!(still.found(100.0, [0.1; 3], Some(1.0)).is_some());
    assert_eq!(still.found(100.0, [0.1; 3], None), None);
    for size in [[500.0, 300.0, -400.0], [0.0, 900.0, 0.0]] {
        let found = of(&record(40_000, size)).found(100.0, [1e-4; 3], None);
        assert!(found.is_some_and(|found| found.percent > 90), "{found:?}");
    }
    // The first is too short, and an axis of the second does not vary.
    assert_eq!(
        of(&record(4000, [500.0; 3])).found(100.0, [1e-4; 3], None),
        None
    );
    let [x, y, _] = record(40_000, [500.0; 3]);
    assert_eq!(
        of(&[x, y, vec![0; 40_000]]).found(100.0, [1e-4; 3], None),
        None
    );
}

#[test]
fn single_losses_do_not_hide_motion() {
    let axes = record(40_000, [500.0, 300.0, -400.0]);
    let mut unrest = Unrest::new();
    let mut row = 0;
    while row + 40 < 40_000 {
        unrest.push(axes.each_ref().map(|axis| &axis[row..row + 39]));
        unrest.gap(1);
        row += 40;
    }
    let whole = of(&axes).found(100.0, [1e-4; 3], None);
    let found = unrest.found(100.0, [1e-4; 3], None);
    assert_eq!(
        found.map(|found| found.cluster),
        whole.map(|found| found.cluster)
    );
}

#[test]
fn batches_give_what_the_whole_gives() {
    let axes = record(5000, [100.0, 0.0, 0.0]);
    let mut parts = Unrest::new();
    for start in (0..5000).step_by(77) {
        let end = (start + 77).min(5000);
        parts.push(axes.each_ref().map(|axis| &axis[start..end]));
    }
    let whole = of(&axes);
    assert_eq!((parts.length, parts.filled), (whole.length, whole.filled));
    assert_eq!(parts.blocks.len(), whole.blocks.len());
    for (one, other) in parts.blocks.iter().zip(&whole.blocks) {
        assert_eq!(one.sums, other.sums);
    }
}
