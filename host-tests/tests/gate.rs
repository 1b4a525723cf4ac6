//! Samples that are left out, and samples that are lost on the way: counted, and never averaged over.

use allanite::{
    Accumulator, Curve, Gate, Integrity, Model, Scale,
    fit::{Options, fit},
    queue::{self, Queued},
};
use heapless::spsc::Queue;
use host_tests::simulate::{Preset, Simulator};
use proptest::prelude::*;

const RATE_HZ: f64 = 100.0;
/// °/s a count.
const UNIT: f64 = 1e-3;
const SAMPLES: usize = 1 << 16;

fn rest() -> Vec<i32> {
    let simulator = Simulator::new(Preset::Mems.coefficients(), RATE_HZ, 3);
    let counts = simulator.map(|rate| (rate / UNIT).round() as i32);
    counts.take(SAMPLES).collect()
}

fn angle_random_walk(accumulator: &Accumulator<16>) -> f64 {
    let curve: Curve<16> = accumulator.curve(Scale::new(UNIT, RATE_HZ).unwrap());
    let fit = fit(&curve, &Model::ieee_952(), Options::default()).unwrap();
    assert!(fit.p_value > 1e-3, "{}", fit.p_value);
    fit.coefficients[1].value
}

#[test]
fn a_gyro_that_is_moved_and_hit_now_and_then_keeps_its_noise() {
    let mut counts = rest();
    for at in [9000, 30_000, 50_000] {
        for (i, count) in counts[at..at + 500].iter_mut().enumerate() {
            *count += (3000.0 * (i as f64 / 40.0).sin().abs()) as i32;
        }
    }
    counts[20_000] = 32_767;
    counts[25_000] = -20_000;
    let (mut gate, mut plain) = (Gate::<16>::new(Integrity::default()), Integrity::default());
    for &count in &counts {
        gate.push(count);
        plain.push(count);
    }
    gate.gap();
    assert!(
        plain.verdict().is_some(),
        "without a gate the record is invalid"
    );
    // Each motion and the cluster of 1024 that it ends in.
    let skipped = gate.skipped();
    assert!((1502..8000).contains(&skipped), "{skipped}");
    assert_eq!(gate.accumulator().samples() + skipped, SAMPLES as u64);
    let value = angle_random_walk(gate.accumulator());
    assert!((value / 0.005 - 1.0).abs() < 0.03, "{value}");
}

#[test]
fn a_gate_leaves_a_gyro_at_rest_alone() {
    let counts = rest();
    let mut gate = Gate::<16>::new(Integrity::default());
    let mut plain = Accumulator::<16>::new();
    for (n, &count) in counts.iter().enumerate() {
        gate.push(count);
        plain.push(count);
        if n == 40_000 {
            gate.gap();
            plain.gap();
        }
    }
    gate.gap();
    plain.gap();
    assert_eq!((gate.skipped(), gate.accumulator()), (0, &plain));
}

proptest! {
    #[test]
    fn nothing_is_lost_in_a_queue_without_being_told_where(
        bursts in proptest::collection::vec((0_usize..12, 0_usize..12, 0_u32..3), 1..60),
    ) {
        let mut queue = Queue::<Queued<u32>, 8>::new();
        let (mut sender, mut receiver) = queue::split(&mut queue);
        let (mut sent, mut expected, mut received) = (0, 0, 0_u64);
        for (sends, takes, missed) in bursts {
            for _ in 0..sends {
                sender.send(sent);
                sent += 1;
            }
            sender.missed(missed);
            sent += missed;
            for _ in 0..takes {
                let Some(Queued { sample, lost }) = receiver.receive() else { break };
                prop_assert_eq!(sample, expected + lost);
                expected = sample + 1;
                received += 1;
            }
        }
        while let Some(Queued { sample, lost }) = receiver.receive() {
            prop_assert_eq!(sample, expected + lost);
            expected = sample + 1;
            received += 1;
        }
        prop_assert_eq!(received + receiver.lost() + u64::from(sender.untold()), u64::from(sent));
    }
}
