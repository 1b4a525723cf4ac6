//! Records of three axes, at rest and not: a simulator of its own.

use super::RATE_HZ;
use rand::RngExt as _;
use rand_distr::{Distribution as _, StandardNormal, StudentT};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::f64::consts::TAU;

/// The noise of a gyro at rest, in counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Noise {
    White,
    WithWalk,
    HeavyTails,
    LowPass,
    WithLine,
    /// Pulses of an angle since the last sample.
    Pulses,
}

pub(super) const NOISES: [Noise; 6] = [
    Noise::White,
    Noise::WithWalk,
    Noise::HeavyTails,
    Noise::LowPass,
    Noise::WithLine,
    Noise::Pulses,
];

/// What happens to a record.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) enum Event {
    Nothing,
    Swing,
    HandHeld,
    Vehicle,
    Knock,
    Range(f64),
    Polled(f64),
    Stale(usize),
    Unanswered(i32),
    Unsigned,
    Stuck,
}

pub(super) const EVENTS: [Event; 15] = [
    Event::Swing,
    Event::HandHeld,
    Event::Vehicle,
    Event::Knock,
    Event::Range(0.125),
    Event::Range(0.5),
    Event::Range(4.0),
    Event::Polled(1.04),
    Event::Polled(2.0),
    Event::Stale(16),
    Event::Stale(64),
    Event::Unanswered(0),
    Event::Unanswered(-1),
    Event::Unsigned,
    Event::Stuck,
];

pub(super) type Rows = Vec<[i32; 3]>;

/// Axes of this noise, with the size of the noise in counts.
fn at_rest(noise: Noise, samples: usize, random: &mut Xoshiro256PlusPlus) -> ([Vec<f64>; 3], f64) {
    let size = 2.0 * 8_f64.powf(random.random_range(0.0..1.0));
    let line: f64 = random.random_range(5.0..40.0);
    let axes = [(); 3].map(|()| {
        let offset = f64::from(random.random_range(-60..60));
        let own = size * random.random_range(0.7..1.4);
        let pole: f64 = random.random_range(0.3..0.8);
        let turn = random.random_range(0.1..0.9);
        let (mut walk, mut state, mut angle) = (0.0, 0.0, 0.0_f64);
        let tails = StudentT::new(5.0).unwrap();
        let one = |n: usize| {
            let white: f64 = StandardNormal.sample(random);
            match noise {
                Noise::White => own * white,
                Noise::WithWalk => {
                    let step: f64 = StandardNormal.sample(random);
                    walk += 0.01 * own * step;
                    own * white + walk
                }
                Noise::HeavyTails => 0.77 * own * tails.sample(random),
                Noise::LowPass => {
                    state = pole * state + (1.0 - pole * pole).sqrt() * white;
                    own * state
                }
                Noise::WithLine => own * (white + 0.5 * (TAU * line * n as f64 / RATE_HZ).sin()),
                Noise::Pulses => {
                    let before = angle.floor();
                    angle += turn + 0.3 * white;
                    angle.floor() - before
                }
            }
        };
        (0..samples).map(one).map(|value| value + offset).collect()
    });
    (axes, size)
}

/// A record in which something happens.
pub(super) fn record(
    noise: Noise,
    event: Event,
    samples: usize,
    random: &mut Xoshiro256PlusPlus,
) -> Rows {
    let (mut axes, size) = at_rest(noise, samples, random);
    let at = random.random_range(0.2..0.8) * samples as f64;
    let phases = [(); 3].map(|()| random.random_range(0.0..TAU));
    let large = 30.0 * size;
    let slow: Vec<[f64; 3]> = {
        // Motion of a hand and of a vehicle: noise with a memory of a second, and of a tenth.
        let memory = if event == Event::Vehicle { 10.0 } else { 100.0 };
        let keep = (-1.0_f64 / memory).exp();
        let mut state = [0.0; 3];
        let step = |_| {
            state = state.map(|value| {
                let white: f64 = StandardNormal.sample(random);
                keep * value + (1.0 - keep * keep).sqrt() * white
            });
            state
        };
        (0..samples).map(step).collect()
    };
    for (axis, values) in axes.iter_mut().enumerate() {
        for (n, value) in values.iter_mut().enumerate() {
            let time_s = n as f64 / RATE_HZ;
            match event {
                Event::Swing => *value += large * (TAU * 0.4 * time_s + phases[axis]).sin(),
                Event::HandHeld | Event::Vehicle => *value += large * slow[n][axis],
                Event::Knock if (0.0..200.0).contains(&(n as f64 - at)) => {
                    *value += 100.0 * large * (-(n as f64 - at) / 40.0).exp();
                }
                Event::Range(factor) if n as f64 > at => *value *= factor,
                _ => {}
            }
        }
    }
    let mut rows: Rows = (0..samples)
        .map(|n| axes.each_ref().map(|axis| axis[n].round() as i32))
        .collect();
    let fresh = rows.clone();
    match event {
        Event::Polled(factor) => {
            for (n, row) in rows.iter_mut().enumerate() {
                *row = fresh[(n as f64 / factor) as usize];
            }
        }
        Event::Stale(length) => {
            for block in 2..samples / length {
                if random.random_range(0..15) == 0 {
                    let (from, to) = ((block - 2) * length, block * length);
                    rows[to..to + length].copy_from_slice(&fresh[from..from + length]);
                }
            }
        }
        Event::Unanswered(value) => {
            for row in &mut rows {
                if random.random_range(0..150) == 0 {
                    *row = [value; 3];
                }
            }
        }
        // Counts about zero.
        Event::Unsigned => {
            for row in &mut rows {
                *row = row.map(|count| (count - count.signum() * 60) & 0xffff);
            }
        }
        Event::Stuck => {
            let until = samples.min(at as usize + samples / 8);
            rows[at as usize..until].fill(fresh[at as usize]);
        }
        _ => {}
    }
    rows
}
