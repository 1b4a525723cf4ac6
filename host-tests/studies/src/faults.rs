//! Studies how often faults of a logger are told, and how often they are told of records that have none.

use super::noise::{butterworth, flicker, normal, normalised};
use allanite::{
    faults::{JointRepeats, Reads, SampleFaults},
    integrity::Reason,
};
use allanite_host::simulate::Random;
use allanite_log::Places;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// The number of samples of a record.
pub const SAMPLES: usize = 1 << 14;

/// What a logger does to a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// Nothing.
    None,
    /// It reads faster than the sensor by a factor, with a jitter of some of its intervals.
    Polled(f64, f64),
    /// It repeats samples at random, with a probability.
    Repeated(f64),
    /// It holds a value for 4 to 12 samples, as a radio link does between packets, for a share of the record.
    Bursts(f64),
    /// An axis hangs for 5 to 50 samples, for a share of the record.
    Stuck(f64),
    /// An axis is clipped so many standard deviations above its mean.
    Clipped(f64),
    /// Values of an axis within so many counts of zero become zero. The noise is 0.7 to 2 times as large.
    DeadBand(i32),
    /// The same, and all other values move towards zero by as much.
    Threshold(i32),
    /// All axes read this number, for a share of the record; or any one number, if there is none.
    Unanswered(Option<i32>, f64),
    /// A half of a buffer of two, of so many samples each, is not refilled once in so many times.
    Stale(usize, usize),
}

impl Fault {
    /// The faults of the study.
    pub const ALL: [Self; 36] = [
        Self::Polled(1.02, 0.0),
        Self::Polled(1.02, 0.3),
        Self::Polled(1.05, 0.0),
        Self::Polled(1.2, 0.0),
        Self::Polled(1.2, 0.1),
        Self::Polled(1.25, 0.0),
        Self::Polled(1.5, 0.0),
        Self::Polled(2.0, 0.0),
        Self::Polled(2.0, 0.1),
        Self::Polled(2.5, 0.0),
        Self::Polled(3.0, 0.0),
        Self::Repeated(0.02),
        Self::Repeated(0.05),
        Self::Repeated(0.1),
        Self::Repeated(0.3),
        Self::Bursts(0.02),
        Self::Bursts(0.1),
        Self::Stuck(0.02),
        Self::Stuck(0.05),
        Self::Clipped(1.0),
        Self::Clipped(1.5),
        Self::Clipped(2.0),
        Self::Clipped(2.5),
        Self::DeadBand(1),
        Self::DeadBand(4),
        Self::Threshold(1),
        Self::Threshold(4),
        Self::Unanswered(Some(0), 0.001),
        Self::Unanswered(Some(0), 0.01),
        Self::Unanswered(Some(-1), 0.003),
        Self::Unanswered(None, 0.001),
        Self::Unanswered(None, 0.01),
        Self::Stale(8, 10),
        Self::Stale(16, 100),
        Self::Stale(32, 10),
        Self::Stale(64, 100),
    ];

    /// Whether a finding is the right one. Values held by a burst are stuck as well.
    fn is_told_by(self, reason: &Reason) -> bool {
        match self {
            Self::None => false,
            Self::Polled(..) | Self::Repeated(_) => matches!(reason, Reason::Repeated { .. }),
            Self::Bursts(_) => matches!(reason, Reason::Repeated { .. } | Reason::Stuck { .. }),
            Self::Stuck(_) => matches!(reason, Reason::Stuck { .. }),
            Self::Clipped(_) => matches!(reason, Reason::Railed { .. }),
            Self::DeadBand(_) | Self::Threshold(_) => matches!(reason, Reason::DeadBand { .. }),
            Self::Unanswered(..) => matches!(reason, Reason::Unanswered { .. }),
            Self::Stale(..) => matches!(reason, Reason::Stale { .. }),
        }
    }
}

/// The noise of a sensor: its spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Colour {
    /// White noise.
    White,
    /// White noise behind a low pass of one pole, or a Butterworth of two, with this cutoff in cycles a sample.
    LowPass(u8, f64),
    /// Flicker noise.
    Flicker,
    /// White noise and flicker noise of half its size.
    WhiteAndFlicker,
    /// White noise and a random walk.
    Walk,
    /// White noise and a sinusoid that is common to the axes.
    Vibration,
}

/// The noises of the study.
pub const COLOURS: [Colour; 11] = [
    Colour::White,
    Colour::LowPass(1, 0.25),
    Colour::LowPass(1, 0.1),
    Colour::LowPass(1, 0.04),
    Colour::LowPass(2, 0.2),
    Colour::LowPass(2, 0.1),
    Colour::LowPass(2, 0.05),
    Colour::Flicker,
    Colour::WhiteAndFlicker,
    Colour::Walk,
    Colour::Vibration,
];

/// The resolution of a record, relative to its noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resolution {
    /// Counts of 0.4 to 10 to a standard deviation, at random.
    Counts,
    /// Far below the noise.
    Fine,
    /// Counts are the pulses of an angle since the last sample: a few levels, whose neighbours are opposed. Half of them have a dither.
    Pulses,
}

/// What is told of records of one fault.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// The number of records.
    pub records: usize,
    /// The records in which fewer than 45 % of the neighbours are equal by chance, of every axis that is looked at.
    pub judged: usize,
    /// Of these, the records of which the right thing is told.
    pub told: usize,
    /// Those of which something else is told, with its name.
    pub otherwise: Vec<String>,
    /// All records with what is told and should not be.
    pub missed: Vec<String>,
    /// The relative errors of the sensor's rate, where repeats are told.
    pub rate_errors: Vec<f64>,
    /// The records of which the smallest share that can be told is above 2 %.
    pub undecided: usize,
}

struct Record {
    axes: [Vec<f64>; 3],
    colour: Colour,
    sigma: f64,
}

/// Judges records of a fault: the first axis alone, three axes together, and three axes by what a device counts of them.
pub fn study(fault: Fault, resolution: Resolution, records: u64, seed: u64) -> [Tally; 3] {
    let judged: Vec<[One; 3]> = (0..records)
        .into_par_iter()
        .map(|record| {
            let mut random = Random::seed_from_u64(seed.wrapping_mul(1 << 32).wrapping_add(record));
            judge(fault, resolution, &mut random)
        })
        .collect();
    [0, 1, 2].map(|axes| {
        let mut tally = Tally::default();
        for record in &judged {
            tally.add(fault, &record[axes]);
        }
        tally
    })
}

/// What is told of one record.
struct One {
    /// The largest share of equal neighbours before the fault.
    chance: f64,
    verdicts: Vec<Option<Reason>>,
    share: f64,
    repeated: f64,
    least: f64,
    noise: String,
}

impl Tally {
    fn add(&mut self, fault: Fault, one: &One) {
        self.records += 1;
        self.undecided += usize::from(one.least > 0.02);
        let is_judged = one.chance < 0.45;
        self.judged += usize::from(is_judged);
        // A fault of one axis is told there; repeats of all axes are told of each.
        let mut reasons = one.verdicts.iter().flatten();
        let told = one
            .verdicts
            .iter()
            .flatten()
            .any(|reason| fault.is_told_by(reason));
        self.told += usize::from(told && is_judged);
        if let Some(other) = reasons.find(|reason| !fault.is_told_by(reason)) {
            self.otherwise.push(format!("{other:?}, {}", one.noise));
        }
        if !told && is_judged {
            self.missed.push(one.noise.clone());
        }
        if told && is_judged && one.repeated > 0.0 {
            self.rate_errors
                .push((1.0 - one.share) / (1.0 - one.repeated) - 1.0);
        }
    }
}

fn judge(fault: Fault, resolution: Resolution, random: &mut Random) -> [One; 3] {
    let record = record(fault, resolution, random);
    let counts = |axes: &[Vec<f64>; 3]| {
        axes.each_ref().map(|axis| {
            axis.iter()
                .map(|value| value.round() as i32)
                .collect::<Vec<_>>()
        })
    };
    let chances = counts(&record.axes).map(|axis| {
        let equal = axis.windows(2).filter(|pair| pair[0] == pair[1]).count();
        equal as f64 / axis.len() as f64
    });
    let (faulty, repeated) = spoilt(fault, &record, random);
    let mut axes = [(); 3].map(|()| SampleFaults::new());
    let mut reads: Reads = Reads::new();
    let mut first_reads = Reads::<1>::new();
    let mut places = [(); 2].map(|()| Places::default());
    let [x, y, z] = &faulty;
    for ((&x, &y), &z) in x.iter().zip(y).zip(z) {
        let [of_x, of_y, of_z] = &mut axes;
        let steps = [of_x.push(x), of_y.push(y), of_z.push(z)];
        reads.push_steps([x, y, z], steps);
        first_reads.push([x]);
        let [first, all] = &mut places;
        first.push(steps[0] == Some(0));
        all.push(steps == [Some(0); 3]);
    }
    let of_reads = [first_reads.verdict(), reads.verdict()];
    let one = |joint: Option<&JointRepeats>, number: usize| {
        let of_reads = of_reads[usize::from(joint.is_some())];
        let unanswered = of_reads.filter(|reason| matches!(reason, Reason::Unanswered { .. }));
        let repeats = axes[0].repeats(joint);
        let places = &places[usize::from(joint.is_some())];
        One {
            chance: chances[..number]
                .iter()
                .fold(0.0, |most, &one| one.max(most)),
            verdicts: axes[..number]
                .iter()
                .map(|axis| unanswered.or_else(|| axis.verdict(joint)).or(of_reads))
                .collect(),
            share: places.share(&repeats).unwrap_or(repeats.share),
            repeated,
            least: repeats.least,
            noise: format!("{:?} {:.2}", record.colour, record.sigma),
        }
    };
    let joint = reads.joint();
    let mut device = one(Some(&joint), 3);
    device.verdicts = vec![reads.verdict()];
    [one(None, 1), one(Some(&joint), 3), device]
}

/// A record of the sensor, long enough for a fault that leaves samples out.
fn record(fault: Fault, resolution: Resolution, random: &mut Random) -> Record {
    let colour = COLOURS[random.random_range(0..COLOURS.len())];
    let sigma = match (resolution, fault) {
        (Resolution::Fine, _) => 1e5,
        (_, Fault::DeadBand(width) | Fault::Threshold(width)) => {
            f64::from(width) * random.random_range(0.7..2.0)
        }
        (_, Fault::Clipped(_)) => 10_f64.powf(random.random_range(0.0..1.0)),
        _ => 0.4 * 25_f64.powf(random.random_range(0.0..1.0)),
    };
    let [line, phase] = [
        random.random_range(0.01..0.45),
        random.random_range(0.0..TAU),
    ];
    let amplitude = random.random_range(0.3..2.0);
    if resolution == Resolution::Pulses {
        return pulses(random);
    }
    let axes = [(); 3].map(|()| {
        let own = sigma * random.random_range(0.8..1.25);
        let offset = match fault {
            Fault::DeadBand(width) | Fault::Threshold(width) => {
                f64::from(width) * random.random_range(-0.5..0.5)
            }
            _ => random.random_range(-20.0..20.0),
        };
        let noise = noise(colour, (line, phase, amplitude), random);
        noise
            .into_iter()
            .map(|value| own * value + offset)
            .collect()
    });
    Record {
        axes,
        colour,
        sigma,
    }
}

/// The pulses of an angle since the last sample, of three axes that turn by less than one a sample.
fn pulses(random: &mut Random) -> Record {
    let size = 0.001 * 500_f64.powf(random.random_range(0.0..1.0));
    let dither = match random.random_range(0..2) {
        0 => 0.0,
        _ => 0.05 * 10_f64.powf(random.random_range(0.0..1.0)),
    };
    let axes = [(); 3].map(|()| {
        let turn = 0.05 * 20_f64.powf(random.random_range(0.0..1.0));
        let turn = if random.random_range(0..2) == 0 {
            turn
        } else {
            -turn
        };
        let mut angle: f64 = random.random_range(0.0..9.0);
        let mut counted = angle.floor();
        let step = |_| {
            angle += turn + size * normal(random);
            let before = counted;
            counted = (angle + dither * normal(random)).floor();
            counted - before
        };
        (0..SAMPLES).map(step).collect()
    });
    Record {
        axes,
        colour: Colour::White,
        sigma: size,
    }
}

/// Noise whose standard deviation is 1; with a walk, that of its white noise.
fn noise(
    colour: Colour,
    (line, phase, amplitude): (f64, f64, f64),
    random: &mut Random,
) -> Vec<f64> {
    let white: Vec<f64> = (0..SAMPLES + 400).map(|_| normal(random)).collect();
    let mut noise = match colour {
        Colour::White => white,
        Colour::LowPass(1, cutoff) => {
            let pole = (-TAU * cutoff).exp();
            let mut state = 0.0;
            let step = |value| {
                state = pole * state + (1.0 - pole) * value;
                state
            };
            white.into_iter().map(step).collect()
        }
        Colour::LowPass(_, cutoff) => butterworth(&white, cutoff),
        Colour::Flicker => flicker::<7>(white.len(), random),
        Colour::WhiteAndFlicker => {
            let slow = normalised(flicker::<7>(white.len(), random));
            white
                .iter()
                .zip(slow)
                .map(|(white, slow)| white + 0.5 * slow)
                .collect()
        }
        Colour::Walk => {
            let mut walk = 0.0;
            let step = |value| {
                walk += 0.02 * normal(random);
                value + walk
            };
            return white.into_iter().map(step).skip(400).collect();
        }
        Colour::Vibration => {
            let at = |n: usize| amplitude * (TAU * line * n as f64 + phase).sin();
            white
                .iter()
                .enumerate()
                .map(|(n, value)| value + at(n))
                .collect()
        }
    };
    noise.drain(..400);
    normalised(noise)
}

/// The counts that the logger writes, and by how much the sensor's rate is below that of the record, relative to it.
fn spoilt(fault: Fault, record: &Record, random: &mut Random) -> ([Vec<i32>; 3], f64) {
    let last = SAMPLES - 1;
    // The place of the sensor's sample in each row.
    let mut places: Vec<usize> = (0..SAMPLES).collect();
    let held = |lengths: std::ops::Range<usize>, share: f64, random: &mut Random| {
        let mean = (lengths.start + lengths.end - 1) as f64 / 2.0;
        let number = (share * SAMPLES as f64 / mean).round() as usize;
        let mut held = vec![false; SAMPLES];
        for _ in 0..number {
            let length = random.random_range(lengths.clone());
            let start = random.random_range(1..SAMPLES - length);
            held[start..start + length].fill(true);
        }
        held
    };
    match fault {
        Fault::Polled(ratio, jitter) => {
            let phase: f64 = random.random_range(0.0..1.0);
            let mut before = 0;
            for (row, place) in places.iter_mut().enumerate() {
                let late = if jitter > 0.0 {
                    jitter * normal(random)
                } else {
                    0.0
                };
                let time = (row as f64 + late) / ratio + phase;
                *place = (time.max(0.0) as usize).clamp(before, last);
                before = *place;
            }
        }
        Fault::Repeated(share) => {
            let mut place = 0;
            for own in &mut places {
                place += usize::from(random.random_range(0.0..1.0) >= share);
                *own = place.min(last);
            }
        }
        Fault::Bursts(share) => {
            let (mut place, held) = (0, held(4..13, share, random));
            for (own, held) in places.iter_mut().zip(held) {
                place += usize::from(!held);
                *own = place.min(last);
            }
        }
        _ => {}
    }
    let mut axes = record.axes.each_ref().map(|axis| {
        let rows = places.iter().map(|&place| axis[place].round() as i32);
        rows.collect::<Vec<_>>()
    });
    match fault {
        Fault::Unanswered(value, share) => {
            for row in 0..SAMPLES {
                if random.random_range(0.0..1.0) < share {
                    let value = value.unwrap_or_else(|| random.random_range(-300..300));
                    axes.iter_mut().for_each(|axis| axis[row] = value);
                }
            }
        }
        Fault::Stale(length, one_in) => {
            let before = axes.clone();
            for block in 2..SAMPLES / length {
                if random.random_range(0..one_in) == 0 {
                    let rows = block * length..(block + 1) * length;
                    for (axis, before) in axes.iter_mut().zip(&before) {
                        let first = rows.start - 2 * length;
                        axis[rows.clone()].copy_from_slice(&before[first..first + length]);
                    }
                }
            }
        }
        _ => {}
    }
    let axis = &mut axes[0];
    match fault {
        Fault::Stuck(share) => {
            for (row, held) in held(5..51, share, random).into_iter().enumerate() {
                if held {
                    axis[row] = axis[row - 1];
                }
            }
        }
        Fault::Clipped(level) => {
            let values = &record.axes[0];
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
            let most = (mean + level * (squares / values.len() as f64).sqrt()).round() as i32;
            axis.iter_mut().for_each(|count| *count = most.min(*count));
        }
        Fault::DeadBand(width) => {
            let cut = |count: &mut i32| *count *= i32::from(count.abs() > width);
            axis.iter_mut().for_each(cut);
        }
        Fault::Threshold(width) => {
            let moved = |count: &mut i32| *count = count.signum() * (count.abs() - width).max(0);
            axis.iter_mut().for_each(moved);
        }
        _ => {}
    }
    // A reader that is late skips samples as well, which does not make the sensor slower.
    let advanced = places[last] - places[0];
    (axes, 1.0 - advanced as f64 / last as f64)
}
