//! Studies how often a self-test errs, and how much sooner it ends than a test of fixed length.

use super::{OCTAVES, RATE_HZ, quantile, quantum};
use crate::simulate::{Coefficients, Preset, Simulator};
use allanite::{
    Axis, Scale,
    self_test::{Limit, Plan, SelfTest, Status},
};
use rayon::prelude::*;

/// The probabilities of false pass and false fail that the tests are planned for.
pub const PROBABILITY: f64 = 0.01;

/// A limit that devices are tested for.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// The effect whose coefficient is limited.
    pub effect: &'static str,
    /// The lengths of the record at the first and the last look, in seconds.
    pub lengths_s: (f64, f64),
    /// The flicker noise of the gyro, as a multiple of the preset's.
    pub flicker: f64,
    /// Whether the study compares the test with one of fixed length. That takes too long for long
    /// tests.
    pub compared: bool,
}

/// The first limit is decided in seconds and the second in minutes. The third is hidden by other
/// noise at first.
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

/// The results for devices whose coefficient is `factor` times the limit.
#[derive(Clone, Copy, Debug)]
pub struct Tally {
    /// The share of devices that passed.
    pub passed: f64,
    /// The share of devices that failed.
    pub failed: f64,
    /// The share of devices without a verdict.
    pub undecided: f64,
    /// The median length of the record at the verdict, in seconds.
    pub median_s: f64,
}

/// Tests `devices` devices of the preset "mems" whose limited coefficient is `factor` times the
/// limit.
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

/// When a test looks at its record.
#[derive(Clone, Copy, Debug)]
pub enum Looks {
    /// At the first time when the record may suffice for a verdict, and again later.
    Early,
    /// Only once, after this many seconds.
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

/// The length in seconds, to 6 %, of the shortest test with one look that is good enough. At most the
/// share `missed` of the devices whose coefficient is a factor of 1.3 from the limit may get a wrong
/// verdict or none.
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
