//! Studies what the course of a record tells: how often it tells of an event, when there is one and when there is
//! none.

use super::{OCTAVES, RATE_HZ, quantum};
use allanite::{
    Accumulator, Model, Scale,
    course::{Analysis, Course, Event, Largest, What, analyse},
    fit::Options,
};
use allanite_host::simulate::{Coefficients, Preset, Random, Simulator};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

/// The number of samples of a record, which is 22 minutes long.
pub const SAMPLES: usize = 1 << 17;

/// The number of bursts, their duration in samples, and how many times the noise is larger in them.
const BURSTS: (usize, usize, f64) = (8, 30, 4.0);

/// The size of a step and of a warm-up, in standard deviations of the white noise of a sample: 0.1 °/s for the
/// preset "mems".
pub const SHIFT: f64 = 2.0;

/// The time constant of a warm-up, in seconds.
pub const TIME_CONSTANT_S: f64 = 60.0;

/// What happens in a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Case {
    /// Nothing.
    Clean,
    /// The white noise and the quantization are this many times as large from half-way on.
    Noise(f64),
    /// Eight bursts of 0.3 s, one at a random time of each eighth of the record, in which the white
    /// noise and the quantization are four times as large.
    Bursts,
    /// A step of twice the standard deviation of a sample, between a fifth and four fifths of the record.
    Step,
    /// A warm-up of twice the standard deviation of a sample.
    WarmUp,
}

/// All cases.
pub const CASES: [Case; 6] = [
    Case::Clean,
    Case::Noise(1.5),
    Case::Noise(1.03),
    Case::Bursts,
    Case::Step,
    Case::WarmUp,
];

/// What was told of one record.
#[derive(Clone, Copy, Debug)]
pub struct Outcome {
    /// Whether the event was told.
    pub told: bool,
    /// Whether its time is right to one block, or the time constant to a quarter.
    pub on_time: bool,
    /// Whether the interval of its size contains the true size.
    pub covered: bool,
    /// The size, relative to the true size.
    pub size: f64,
    /// The numbers of events of other kinds, or in excess: noise changes, bursts, steps, warm-ups.
    pub besides: [usize; 4],
    /// The largest standardised deviations.
    pub largest: Largest,
}

/// The counts of one case.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// The number of records.
    pub records: usize,
    /// Records in which the event was told.
    pub told: usize,
    /// Records in which it was told, with the right time.
    pub on_time: usize,
    /// Records in which it was told, with an interval that contains the true size.
    pub covered: usize,
    /// The sizes that were told, relative to the true one, in ascending order.
    pub sizes: Vec<f64>,
    /// Records with an event that is not there, of each kind: noise change, bursts, step, warm-up.
    pub besides: [usize; 4],
    /// Records with an event that is not there.
    pub any_besides: usize,
    /// The sizes of the largest standardised deviations of each kind, in ascending order.
    pub largest: [Vec<f64>; 4],
}

/// The noise of a record: the white part, and the part that wanders.
struct Noise {
    white: Vec<f64>,
    slow: Vec<f64>,
}

impl Noise {
    fn new(coefficients: Coefficients, seed: u64) -> Self {
        let white = Coefficients {
            bias_instability: 0.0,
            rate_random_walk: 0.0,
            rate_ramp: 0.0,
            ..coefficients
        };
        let slow = Coefficients {
            quantization: 0.0,
            angle_random_walk: 0.0,
            ..coefficients
        };
        let record = |coefficients, seed| {
            Simulator::new(coefficients, RATE_HZ, seed)
                .take(SAMPLES)
                .collect()
        };
        Self {
            white: record(white, 2 * seed),
            slow: record(slow, 2 * seed + 1),
        }
    }
}

/// Where and how large the events of a record are.
struct Truth {
    step_at: usize,
    bursts: Vec<usize>,
    shift: f64,
}

/// Analyses records of a preset in every case of `cases`. All cases of a seed have the same noise.
pub fn study(preset: Preset, cases: &[Case], seeds: std::ops::Range<u64>) -> Vec<Tally> {
    let outcomes: Vec<Vec<Outcome>> = seeds
        .into_par_iter()
        .map(|seed| {
            let noise = Noise::new(preset.coefficients(), seed);
            let one = |&case: &Case| outcome(preset, &noise, case, seed);
            cases.iter().map(one).collect()
        })
        .collect();
    let case = |i: usize| tally(outcomes.iter().map(|outcomes| outcomes[i]));
    (0..cases.len()).map(case).collect()
}

fn outcome(preset: Preset, noise: &Noise, case: Case, seed: u64) -> Outcome {
    let coefficients = preset.coefficients();
    let mut random = Random::seed_from_u64(seed ^ 0xC0_0125E);
    let deviation = coefficients.angle_random_walk * RATE_HZ.sqrt();
    let (bursts, length, _) = BURSTS;
    let truth = Truth {
        step_at: random.random_range(SAMPLES / 5..4 * SAMPLES / 5),
        bursts: (0..bursts)
            .map(|i| i * SAMPLES / bursts + random.random_range(0..SAMPLES / bursts - length))
            .collect(),
        shift: SHIFT * deviation,
    };
    let analysis = analysis(coefficients, noise, case, &truth);
    judge(&analysis, case, &truth)
}

fn analysis(
    coefficients: Coefficients,
    noise: &Noise,
    case: Case,
    truth: &Truth,
) -> Analysis<OCTAVES> {
    let quantum = quantum(coefficients, RATE_HZ);
    let mut accumulator = Accumulator::<OCTAVES>::new();
    let mut course = Course::<0>::new();
    let (_, length, times) = BURSTS;
    for (n, (white, slow)) in noise.white.iter().zip(&noise.slow).enumerate() {
        let mut rate = white + slow;
        match case {
            Case::Clean => {}
            Case::Noise(factor) => {
                if n >= SAMPLES / 2 {
                    rate += (factor - 1.0) * white;
                }
            }
            Case::Bursts => {
                let mut bursts = truth.bursts.iter();
                if bursts.any(|&start| (start..start + length).contains(&n)) {
                    rate += (times - 1.0) * white;
                }
            }
            Case::Step => {
                if n >= truth.step_at {
                    rate += truth.shift;
                }
            }
            Case::WarmUp => {
                rate += truth.shift * (-(n as f64) / (RATE_HZ * TIME_CONSTANT_S)).exp();
            }
        }
        let count = (rate / quantum).round() as i32;
        accumulator.push(count);
        course.push(count, []);
    }
    let scale = Scale::new(quantum, RATE_HZ).expect("positive");
    let curve = accumulator.curve(scale);
    let model = Model::ieee_952();
    analyse(&curve, &model, &course, scale, Options::default()).expect("a record with noise")
}

fn judge(analysis: &Analysis<OCTAVES>, case: Case, truth: &Truth) -> Outcome {
    let block_s = (SAMPLES / 64) as f64 / RATE_HZ;
    let kind = |event: &Event| match event.what {
        What::NoiseChange => Some(0),
        What::Bursts { .. } => Some(1),
        What::Step => Some(2),
        What::WarmUp { .. } => Some(3),
        _ => None,
    };
    let near = |event: &Event, at_s: f64| (event.at_s - at_s).abs() <= block_s;
    let (expected, size) = match case {
        Case::Clean => (None, f64::NAN),
        Case::Noise(factor) => (Some(0), factor),
        Case::Bursts => (Some(1), f64::NAN),
        Case::Step => (Some(2), truth.shift),
        Case::WarmUp => (Some(3), truth.shift),
    };
    let on_time = |event: &Event| match (case, event.what) {
        (Case::Noise(_), _) => near(event, 0.5 * SAMPLES as f64 / RATE_HZ),
        (Case::Bursts, _) => {
            let mut bursts = truth.bursts.iter();
            bursts.any(|&start| near(event, start as f64 / RATE_HZ))
        }
        (Case::Step, _) => near(event, truth.step_at as f64 / RATE_HZ),
        (_, What::WarmUp { time_constant_s }) => {
            (time_constant_s / TIME_CONSTANT_S - 1.0).abs() < 0.25
        }
        _ => false,
    };
    let events = || analysis.events.iter();
    let strongest = events()
        .filter(|event| expected.is_some() && kind(event) == expected)
        .max_by(|a, b| a.z.abs().total_cmp(&b.z.abs()));
    let mut besides = [0; 4];
    for kind in events().filter_map(kind) {
        besides[kind] += 1;
    }
    if let (Some(_), Some(kind)) = (strongest, expected) {
        besides[kind] -= 1;
    }
    Outcome {
        told: strongest.is_some(),
        on_time: strongest.is_some_and(on_time),
        covered: strongest.is_some_and(|event| (event.lower..=event.upper).contains(&size)),
        size: strongest.map_or(f64::NAN, |event| event.size / size),
        besides,
        largest: analysis.largest,
    }
}

fn tally(outcomes: impl Iterator<Item = Outcome>) -> Tally {
    let mut tally = Tally::default();
    for outcome in outcomes {
        tally.records += 1;
        tally.told += usize::from(outcome.told);
        tally.on_time += usize::from(outcome.on_time);
        tally.covered += usize::from(outcome.covered);
        if outcome.told {
            tally.sizes.push(outcome.size);
        }
        for (count, besides) in tally.besides.iter_mut().zip(outcome.besides) {
            *count += usize::from(besides > 0);
        }
        tally.any_besides += usize::from(outcome.besides.iter().any(|&count| count > 0));
        let largest = outcome.largest;
        let sizes = [
            largest.noise_change,
            largest.burst,
            largest.step,
            largest.warm_up,
        ];
        for (list, size) in tally.largest.iter_mut().zip(sizes) {
            list.push(size.abs());
        }
    }
    tally.sizes.sort_by(f64::total_cmp);
    for list in &mut tally.largest {
        list.sort_by(f64::total_cmp);
    }
    tally
}
