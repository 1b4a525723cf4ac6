//! How often a self-test errs, and how much sooner than a test of fixed length it ends.

use super::{OCTAVES, RATE_HZ, quantile, quantum};
use crate::simulate::{Coefficients, Preset, Simulator};
use allanite::{
    Axis, Scale,
    self_test::{Limit, Plan, SelfTest, Status},
};
use rayon::prelude::*;

/// Probabilities of false pass and false fail that are asked for.
pub const PROBABILITY: f64 = 0.01;

/// A limit that devices are tested for.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// What is limited.
    pub effect: &'static str,
    /// First and last look, in seconds.
    pub lengths_s: (f64, f64),
    /// Flicker noise, as a multiple of the usual gyro's.
    pub flicker: f64,
    /// Whether a test of one look is short enough to look for its length.
    pub compared: bool,
}

/// A limit that is told in seconds, one that takes minutes, and one that other noise hides at first.
pub const CASES: [Case; 3] = [
    Case {
        effect: "angle_random_walk",
        lengths_s: (1.0, 256.0),
        flicker: 1.0,
        compared: true,
    },
    Case {
        effect: "bias_instability",
        lengths_s: (40.96, 1310.72),
        flicker: 1.0,
        compared: false,
    },
    Case {
        effect: "angle_random_walk",
        lengths_s: (1.0, 256.0),
        flicker: 4.0,
        compared: false,
    },
];

/// What came of the devices whose coefficient is at `factor` times the limit.
#[derive(Clone, Copy, Debug)]
pub struct Tally {
    /// Shares of all devices.
    pub passed: f64,
    /// Shares of all devices.
    pub failed: f64,
    /// Shares of all devices.
    pub undecided: f64,
    /// Median length of the record at the verdict, in seconds.
    pub median_s: f64,
}

/// Tests `devices` of "mems", their limited coefficient at `factor` times the limit.
pub fn study(case: Case, factor: f64, devices: u64, looks: Looks) -> Tally {
    let one = |seed| test(case, factor, seed, looks);
    let verdicts: Vec<(Status, f64)> = (0..devices).into_par_iter().map(one).collect();
    let share = |is: fn(&Status) -> bool| {
        let count = verdicts.iter().filter(|(status, _)| is(status)).count();
        count as f64 / devices as f64
    };
    let mut lengths: Vec<f64> = verdicts.iter().map(|(_, seconds)| *seconds).collect();
    lengths.sort_by(f64::total_cmp);
    Tally {
        passed: share(|status| matches!(status, Status::Passed)),
        failed: share(|status| matches!(status, Status::Failed(_))),
        undecided: share(|status| matches!(status, Status::Undecided { .. })),
        median_s: quantile(&lengths, 0.5),
    }
}

/// When a test looks.
#[derive(Clone, Copy, Debug)]
pub enum Looks {
    /// As early as the record may bear a verdict.
    Early,
    /// Once, after so many seconds.
    Once(f64),
}

fn test(case: Case, factor: f64, seed: u64, looks: Looks) -> (Status, f64) {
    let mut base = Preset::Mems.coefficients();
    base.bias_instability *= case.flicker;
    let limited = limited(&mut base, case.effect);
    let most = *limited / factor;
    let (shortest_s, longest_s) = match looks {
        Looks::Early => case.lengths_s,
        Looks::Once(seconds) => (seconds, seconds),
    };
    let plan = Plan {
        limits: [Limit {
            effect: case.effect,
            most,
        }]
        .into_iter()
        .collect(),
        least_p: 0.0,
        false_pass: PROBABILITY,
        false_fail: PROBABILITY,
        shortest_s,
        longest_s,
    };
    let unit = quantum(base, RATE_HZ);
    let scale = Scale::new(unit, RATE_HZ).expect("positive");
    let mut test = SelfTest::<OCTAVES>::new(plan, scale).expect("a plan");
    let mut gyro = Axis::<OCTAVES, 0, (), ()>::new();
    for rate in Simulator::new(base, RATE_HZ, seed) {
        gyro.push((rate / unit).round() as i32);
        if !test.is_due(gyro.samples()) {
            continue;
        }
        let record = gyro.evidence(0, scale, []).expect("one axis");
        let status = test.look(record.samples, &record.curve, record.invalid);
        if !matches!(status, Status::Running { .. }) {
            return (status, record.samples as f64 / RATE_HZ);
        }
    }
    unreachable!("a simulator never ends")
}

fn limited<'a>(base: &'a mut Coefficients, effect: &str) -> &'a mut f64 {
    match effect {
        "bias_instability" => &mut base.bias_instability,
        _ => &mut base.angle_random_walk,
    }
}

/// Length in seconds, to 6 %, of the shortest test of one look that errs or leaves undecided no larger
/// share of the devices a factor of 1.3 off the limit than `missed`.
pub fn fixed_length_s(case: Case, devices: u64, missed: f64) -> f64 {
    let mut seconds = case.lengths_s.0;
    loop {
        let once = |factor| study(case, factor, devices, Looks::Once(seconds));
        let (good, bad) = (once(1.0 / 1.3), once(1.3));
        if good.passed >= 1.0 - missed && bad.failed >= 1.0 - missed {
            return seconds;
        }
        seconds *= 1.125;
    }
}
