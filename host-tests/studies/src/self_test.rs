//! Studies how often a self-test errs, and how much sooner it ends than a test of fixed length.

use super::{OCTAVES, RATE_HZ, quantum};
use allanite::{
    Axis, Scale,
    self_test::{Limit, Plan, SelfTest, Status},
};
use allanite_host::{
    confidence::share_is_at_most,
    quantile::quantile,
    simulate::{Coefficients, Preset, Simulator},
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

/// Limits that are decided in seconds and in minutes, for gyros whose flicker noise hides them more and
/// more.
pub const CASES: [Case; 6] = [
    Case {
        compared: true,
        ..angle_random_walk(1.0)
    },
    angle_random_walk(4.0),
    angle_random_walk(10.0),
    bias_instability(1.0),
    bias_instability(4.0),
    bias_instability(10.0),
];

const fn angle_random_walk(flicker: f64) -> Case {
    Case {
        effect: "angle_random_walk",
        lengths_s: (1.0, 256.0),
        flicker,
        compared: false,
    }
}

const fn bias_instability(flicker: f64) -> Case {
    Case {
        effect: "bias_instability",
        lengths_s: (40.96, 1310.72),
        flicker,
        compared: false,
    }
}

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

/// Tests `devices` devices of the preset "mems" for several limits, of which the limited coefficient is
/// `factors` times as large. A device is simulated once for all of them.
pub fn study(case: Case, factors: &[f64], devices: u64, looks: Looks) -> Vec<Tally> {
    let one = |seed| test(case, factors, seed, looks);
    let verdicts: Vec<Vec<Verdict>> = (0..devices).into_par_iter().map(one).collect();
    let of_factor = |i: usize| {
        let verdicts: Vec<Verdict> = verdicts.iter().map(|device| device[i]).collect();
        tally(&verdicts)
    };
    (0..factors.len()).map(of_factor).collect()
}

/// A verdict, and the length of the record at the verdict, in seconds.
type Verdict = (Status, f64);

fn tally(verdicts: &[Verdict]) -> Tally {
    let share = |is: fn(&Status) -> bool| {
        let count = verdicts.iter().filter(|(status, _)| is(status)).count();
        count as f64 / verdicts.len() as f64
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

/// The upper end of the one-sided 95 % confidence interval of a probability, from a share of `devices`.
pub fn at_most(share: f64, devices: u64) -> f64 {
    share_is_at_most(share, devices, 0.95)
}

/// When a test looks at its record.
#[derive(Clone, Copy, Debug)]
pub enum Looks {
    /// At the first time when the record may suffice for a verdict, and again later.
    Early,
    /// Only once, after this many seconds.
    Once(f64),
}

fn test(case: Case, factors: &[f64], seed: u64, looks: Looks) -> Vec<Verdict> {
    let mut base = Preset::Mems.coefficients();
    base.bias_instability *= case.flicker;
    let unit = quantum(base, RATE_HZ);
    let scale = Scale::new(unit, RATE_HZ).expect("positive");
    let coefficient = limited(base, case.effect);
    let plans = factors
        .iter()
        .map(|factor| plan(case, coefficient / factor, looks));
    let mut tests: Vec<SelfTest<OCTAVES>> = plans
        .map(|plan| SelfTest::new(plan, scale).expect("a plan"))
        .collect();
    let mut verdicts = vec![None; tests.len()];
    let mut gyro = Axis::<OCTAVES, 0, (), ()>::new();
    for rate in Simulator::new(base, RATE_HZ, seed) {
        gyro.push((rate / unit).round() as i32);
        let samples = gyro.samples();
        if !tests.iter().any(|test| test.is_due(samples)) {
            continue;
        }
        let record = gyro.record_so_far(0, scale).expect("one axis");
        for (test, verdict) in tests.iter_mut().zip(&mut verdicts) {
            let status = test.look(&record).expect("the scale of the plan");
            if verdict.is_none() && !matches!(status, Status::Running { .. }) {
                *verdict = Some((status, samples as f64 / RATE_HZ));
            }
        }
        if verdicts.iter().all(Option::is_some) {
            break;
        }
    }
    verdicts.into_iter().flatten().collect()
}

fn plan(case: Case, most: f64, looks: Looks) -> Plan {
    let (shortest_s, longest_s) = match looks {
        Looks::Early => case.lengths_s,
        Looks::Once(seconds) => (seconds, seconds),
    };
    let limit = Limit {
        effect: case.effect,
        most,
    };
    Plan {
        limits: [limit].into_iter().collect(),
        least_p: 0.0,
        false_pass: PROBABILITY,
        false_fail: PROBABILITY,
        shortest_s,
        longest_s,
    }
}

fn limited(base: Coefficients, effect: &str) -> f64 {
    match effect {
        "bias_instability" => base.bias_instability,
        _ => base.angle_random_walk,
    }
}

/// The length in seconds, to 6 %, of the shortest test with one look that is good enough. At most the
/// share `missed` of the devices whose coefficient is a factor of 1.3 from the limit may get a wrong
/// verdict or none.
pub fn fixed_length_s(case: Case, devices: u64, missed: f64) -> f64 {
    let mut seconds = case.lengths_s.0;
    loop {
        let tallies = study(case, &[1.0 / 1.3, 1.3], devices, Looks::Once(seconds));
        let (good, bad) = (tallies[0], tallies[1]);
        if good.passed >= 1.0 - missed && bad.failed >= 1.0 - missed {
            return seconds;
        }
        seconds *= 1.125;
    }
}
