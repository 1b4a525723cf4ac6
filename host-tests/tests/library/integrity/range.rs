//! A record whose range, rate or filter was changed is refused where its course is kept.

use super::{RATE_HZ, SAMPLES, counts_per_rate, quantised};
use allanite::{
    Axes, Scale,
    axis::{Courses, Gated, Moments},
    integrity::Reason,
};
use allanite_host::simulate::{Preset, Simulator};

/// The reason why a record is not valid whose counts are multiplied by a factor from a share of it on.
fn judged(preset: Preset, factor: f64, from: f64, seed: u64) -> Option<Reason> {
    let per_rate = counts_per_rate(preset, 40.0);
    let counts = [0, 1, 2].map(|axis| {
        let simulator = Simulator::new(preset.coefficients(), RATE_HZ, 3 * seed + axis);
        let change = (from * SAMPLES as f64) as usize;
        let scaled = simulator.enumerate().map(|(row, rate)| match row < change {
            true => rate,
            false => factor * rate,
        });
        quantised(scaled, per_rate)
    });
    let mut axes = Axes::<16, 0, Gated, Moments, 3, (), Courses>::new();
    let [x, y, z] = &counts;
    for ((&x, &y), &z) in x.iter().zip(y).zip(z) {
        axes.push([x, y, z]);
    }
    let scale = Scale::new((1.0 / per_rate) as _, RATE_HZ as _).unwrap();
    axes.record(0, scale).unwrap().invalid
}

#[test]
fn a_change_of_range_is_refused_with_its_place_and_its_factor() {
    for preset in [Preset::Mems, Preset::Tactical] {
        for (factor, from) in [(0.125, 0.5), (0.5, 0.9), (2.0, 0.3), (4.0, 0.1)] {
            let found = judged(preset, factor, from, 5);
            let Some(Reason::Changed { after, percent }) = found else {
                panic!("{preset:?}, {factor} from {from} on: {found:?}");
            };
            let place = after as f64 / SAMPLES as f64;
            assert!((place - from).abs() < 0.04, "{from}: {place}");
            let ratio = f64::from(percent) / 100.0;
            assert!((ratio / factor - 1.0).abs() < 0.05, "{factor}: {ratio}");
        }
    }
}

#[test]
fn the_range_of_a_gyro_at_rest_does_not_change() {
    for preset in Preset::TYPICAL {
        for seed in 0..6 {
            assert_eq!(judged(preset, 1.0, 0.5, seed), None, "{preset:?} {seed}");
        }
    }
}
