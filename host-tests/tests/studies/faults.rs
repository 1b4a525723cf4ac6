//! Faults of a logger are told, and records without one have none.

use allanite::{faults::SampleFaults, integrity::Reason};
use allanite_studies::faults::{Fault, Resolution, study};

/// Seeds that the study does not use.
const SEED: u64 = 77;

#[test]
fn records_without_a_fault_have_none() {
    for resolution in [Resolution::Counts, Resolution::Fine, Resolution::Pulses] {
        for tally in study(Fault::None, resolution, 2000, SEED) {
            // 0.2 % of them at most, in a sample: 10 of 2000 have a probability below 1 % then. Pulses with hardly any noise are
            // nearly periodic: 0.7 % of them.
            let most = if resolution == Resolution::Pulses {
                26
            } else {
                10
            };
            assert!(tally.otherwise.len() < most, "{:?}", tally.otherwise);
            assert_eq!(tally.records, 2000);
        }
    }
}

#[test]
fn repeats_are_told_with_the_rate_of_the_sensor() {
    for fault in Fault::ALL {
        let least = match fault {
            // A device sees repeats of all axes alone.
            Fault::Polled(..) | Fault::Repeated(_) => [0.0, 0.98, 0.97],
            Fault::Bursts(_) => [0.0, 0.98, 0.9],
            Fault::Stuck(_) => [0.9, 0.9, 0.0],
            Fault::Clipped(level) if level < 2.5 => [0.88, 0.88, 0.0],
            Fault::Clipped(_) => [0.4, 0.4, 0.0],
            Fault::DeadBand(_) => [0.95, 0.95, 0.0],
            // A step of a count is hard to tell from coarse noise: some 46 % are told, of 150 with a scatter of 4 %.
            Fault::Threshold(1) => [0.3, 0.3, 0.0],
            Fault::Threshold(_) => [0.9, 0.9, 0.0],
            // One axis cannot tell. Near the mean such a read changes nothing, and is not seen.
            Fault::Unanswered(Some(_), _) => [0.0, 0.5, 0.5],
            Fault::Unanswered(None, _) => [0.0, 0.95, 0.95],
            Fault::Stale(8, _) => [0.0, 0.8, 0.8],
            Fault::Stale(64, _) => [0.0, 0.8, 0.8],
            Fault::Stale(..) => [0.0, 0.93, 0.93],
            Fault::None => unreachable!("a record without a fault"),
        };
        for (tally, least) in study(fault, Resolution::Counts, 200, SEED)
            .iter()
            .zip(least)
        {
            let told = tally.told as f64 / tally.judged as f64;
            assert!(tally.judged > 60, "{fault:?}: {}", tally.judged);
            assert!(
                told >= least,
                "{fault:?}: {told}, missed {:?}",
                tally.missed
            );
        }
    }
}

#[test]
fn repeats_of_fine_values_are_told_exactly() {
    for fault in [
        Fault::Polled(1.02, 0.0),
        Fault::Polled(1.25, 0.0),
        Fault::Polled(3.0, 0.0),
    ] {
        for tally in study(fault, Resolution::Fine, 50, SEED) {
            assert_eq!(tally.told, 50, "{fault:?}");
            let worst = tally
                .rate_errors
                .iter()
                .fold(0.0, |worst: f64, error| worst.max(error.abs()));
            assert!(worst < 1e-3, "{fault:?}: {worst}");
        }
    }
}

/// Fine values that are there twice and once in turn: the sensor's rate is two thirds, not half.
#[test]
fn two_thirds_are_not_called_half() {
    let (mut faults, mut random) = (SampleFaults::new(), 1_u32);
    for n in 0..30_000 {
        if n % 3 != 1 {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        }
        faults.push((random >> 4) as i32);
    }
    let Some(reason @ Reason::Repeated { times: 1, .. }) = faults.verdict(None) else {
        panic!("{:?}", faults.verdict(None))
    };
    let words = reason.to_string();
    assert!(
        words.contains("33.3 % of the samples") && words.contains("rate is 0.666"),
        "{words}"
    );
}
