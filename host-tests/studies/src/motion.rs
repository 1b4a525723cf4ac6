//! Studies how often motion that never stops is told, and how often it is told of records at rest.

use super::noise::{butterworth, flicker, normal, normalised};
use allanite::{
    Accumulator, Scale,
    integrity::{Integrity, Reason},
    motion,
};
use allanite_host::simulate::Random;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Octaves of a record.
const OCTAVES: usize = 20;

/// The root mean square of motion, in standard deviations of the noise of a sample.
pub const LEVELS: [f64; 6] = [3.0, 10.0, 30.0, 100.0, 300.0, 1000.0];

/// What a gyro at rest shows beside its noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rests {
    /// Nothing.
    Plain,
    /// Strong flicker noise.
    Flicker,
    /// A strong walk.
    Walk,
    /// It warms up.
    WarmUp,
    /// It follows the temperature of a room.
    Thermal,
    /// A resonance that its axes share.
    Resonance,
    /// Random telegraph noise.
    Telegraph,
    /// A low pass.
    LowPass,
    /// A low pass behind strong flicker noise.
    LowPassFlicker,
    /// Gauss–Markov noise.
    GaussMarkov,
    /// Three lines that its axes share.
    Lines,
    /// The bench is touched up to five times.
    Touches,
}

impl Rests {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::Plain,
        Self::Flicker,
        Self::Walk,
        Self::WarmUp,
        Self::Thermal,
        Self::Resonance,
        Self::Telegraph,
        Self::LowPass,
        Self::LowPassFlicker,
        Self::GaussMarkov,
        Self::Lines,
        Self::Touches,
    ];
}

/// How a gyro moves without rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moves {
    /// Smoothly and at random.
    Smooth,
    /// As a pendulum.
    Pendulum,
    /// With a person who walks.
    Walking,
    /// In a car, with turns and bumps.
    Car,
    /// In a hand that trembles.
    Tremor,
    /// On a boat.
    Boat,
    /// On a drone.
    Drone,
    /// In a hand.
    Handheld,
    /// On a turntable that stops now and then.
    Turntable,
    /// With a person who exercises and rests.
    Exercise,
    /// About one axis, smoothly and at random.
    OneAxis,
}

impl Moves {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::Smooth,
        Self::Pendulum,
        Self::Walking,
        Self::Car,
        Self::Tremor,
        Self::Boat,
        Self::Drone,
        Self::Handheld,
        Self::Turntable,
        Self::Exercise,
        Self::OneAxis,
    ];
}

/// What is told of some records.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// The number of records.
    pub records: usize,
    /// Those of which the curves of all axes show motion.
    pub told: usize,
    /// Those of which the curve of the axis that varies most shows it by itself.
    pub alone: usize,
    /// Those of which any motion is told, also by the integrity of an axis.
    pub with_integrity: usize,
}

impl Tally {
    const fn add(&mut self, [told, alone, moved]: [bool; 3]) {
        self.records += 1;
        self.told += told as usize;
        self.alone += alone as usize;
        self.with_integrity += (told || moved) as usize;
    }
}

/// Judges records at rest, as many of each kind.
pub fn rest(records: u64, seed: u64) -> Vec<(Rests, Tally)> {
    let one = |record: u64| {
        let kind = Rests::ALL[record as usize % Rests::ALL.len()];
        let mut random = seeded(seed, record);
        let gyro = Gyro::any(&mut random);
        (kind, gyro.judge(&at_rest(kind, gyro, &mut random)))
    };
    let told: Vec<_> = (0..records).into_par_iter().map(one).collect();
    let tally = |kind: Rests| {
        let mut tally = Tally::default();
        let own = told.iter().filter(|(other, _)| *other == kind);
        own.for_each(|(_, told)| tally.add(*told));
        (kind, tally)
    };
    Rests::ALL.into_iter().map(tally).collect()
}

/// Judges records in motion, as many of each kind and level.
pub fn in_motion(records: u64, seed: u64) -> Vec<(Moves, f64, Tally)> {
    let one = |record: u64| {
        let at = record as usize;
        let kind = Moves::ALL[at % Moves::ALL.len()];
        let level = LEVELS[at / Moves::ALL.len() % LEVELS.len()];
        let mut random = seeded(seed.wrapping_add(1 << 31), record);
        let gyro = Gyro::any(&mut random);
        let mut axes = gyro.noise(&mut random);
        let motion = gyro.motion(kind, &mut random);
        add(&mut axes, &motion, level * gyro.sigma);
        if random.random_bool(0.3) {
            let cutoff = between(5.0, 0.4 * gyro.rate_hz.min(100.0), &mut random);
            axes = axes.map(|axis| gyro.low_pass(axis, cutoff, 1));
        }
        (kind, level, gyro.judge(&axes))
    };
    let told: Vec<_> = (0..records).into_par_iter().map(one).collect();
    let mut tallies = Vec::new();
    for kind in Moves::ALL {
        for level in LEVELS {
            let mut tally = Tally::default();
            let own = told
                .iter()
                .filter(|(other, at, _)| *other == kind && *at == level);
            own.for_each(|(.., told)| tally.add(*told));
            tallies.push((kind, level, tally));
        }
    }
    tallies
}

fn seeded(seed: u64, record: u64) -> Random {
    Random::seed_from_u64(seed.wrapping_mul(1 << 32).wrapping_add(record))
}

/// A value between two, uniform in its logarithm.
fn between(least: f64, most: f64, random: &mut Random) -> f64 {
    least * (most / least).powf(random.random_range(0.0..1.0))
}

type Axes = [Vec<f64>; 3];

fn add(axes: &mut Axes, other: &Axes, size: f64) {
    for (axis, other) in axes.iter_mut().zip(other) {
        for (value, other) in axis.iter_mut().zip(other) {
            *value += size * other;
        }
    }
}

/// A gyro and the length of its record.
#[derive(Clone, Copy)]
struct Gyro {
    rate_hz: f64,
    samples: usize,
    /// Angle random walk, in °/s/√Hz.
    n: f64,
    /// The noise of a sample, in °/s.
    sigma: f64,
}

impl Gyro {
    /// A consumer, tactical or navigation gyro with a record of 5 s to 20 min.
    fn any(random: &mut Random) -> Self {
        let rate_hz = [50.0, 100.0, 200.0, 500.0][random.random_range(0..4)];
        let n = match random.random_range(0..3) {
            0 => between(0.003, 0.03, random),
            1 => between(5e-4, 5e-3, random),
            _ => between(2e-5, 1e-3, random),
        };
        let seconds: f64 = between(5.0, 1200.0, random);
        Self {
            rate_hz,
            samples: ((seconds * rate_hz) as usize).min(1 << 17),
            n,
            sigma: n * rate_hz.sqrt(),
        }
    }

    fn white(&self, random: &mut Random) -> Vec<f64> {
        (0..self.samples).map(|_| normal(random)).collect()
    }

    fn whites(&self, random: &mut Random) -> Axes {
        [(); 3].map(|()| self.white(random))
    }

    /// Flicker noise that is as large as the white noise at a frequency.
    fn flicker(&self, corner_hz: f64, random: &mut Random) -> Axes {
        // One-sided: 2 N² at the corner.
        let size = self.n * (2.0 * corner_hz * 4_f64.ln()).sqrt();
        [(); 3].map(|()| {
            let unit = flicker::<10>(self.samples, random);
            unit.into_iter().map(|value| size * value).collect()
        })
    }

    fn walk(random: &mut Random, samples: usize) -> Vec<f64> {
        let mut walk = 0.0;
        let step = |_| {
            walk += normal(random);
            walk
        };
        (0..samples).map(step).collect()
    }

    /// The noise of three axes, in °/s.
    fn noise(&self, random: &mut Random) -> Axes {
        let mut axes = self.flicker(between(1e-3, 0.3, random), random);
        add(&mut axes, &self.whites(random), self.sigma);
        let walk = between(1e-5, 1e-3, random) * (100.0 / self.rate_hz).sqrt();
        let walks = [(); 3].map(|()| Self::walk(random, self.samples));
        add(&mut axes, &walks, self.sigma * walk);
        axes
    }

    /// A Butterworth low pass of one to three poles.
    fn low_pass(&self, samples: Vec<f64>, cutoff_hz: f64, poles: u8) -> Vec<f64> {
        let cutoff = (cutoff_hz / self.rate_hz).min(0.47);
        match poles {
            1 => one_pole(samples, cutoff),
            2 => butterworth(&samples, cutoff),
            _ => {
                // The pair of poles of three has a quality of 1; a pair of 0.7 is near enough for a study of motion.
                one_pole(butterworth(&samples, cutoff), cutoff)
            }
        }
    }

    /// Noise within a band about a frequency, of unit size. It has rung in.
    fn band(&self, frequency_hz: f64, quality: f64, random: &mut Random) -> Vec<f64> {
        let frequency = (frequency_hz / self.rate_hz).min(0.47);
        let before = ((5.0 * quality / frequency) as usize).min(4 * self.samples);
        let white: Vec<f64> = (0..before + self.samples).map(|_| normal(random)).collect();
        let mut band = band_pass(&white, frequency, quality);
        band.drain(..before);
        normalised(band)
    }

    fn bands(&self, frequency_hz: f64, quality: f64, random: &mut Random) -> Axes {
        [(); 3].map(|()| self.band(frequency_hz, quality, random))
    }

    /// Smooth noise of unit size.
    fn smooth(&self, cutoff_hz: f64, random: &mut Random) -> Vec<f64> {
        let before = ((2.0 * self.rate_hz / cutoff_hz) as usize).min(4 * self.samples);
        let white = (0..before + self.samples).map(|_| normal(random)).collect();
        let mut smooth = self.low_pass(white, cutoff_hz, 2);
        smooth.drain(..before);
        normalised(smooth)
    }

    fn smooths(&self, cutoff_hz: f64, random: &mut Random) -> Axes {
        [(); 3].map(|()| self.smooth(cutoff_hz, random))
    }

    fn times(&self) -> impl Iterator<Item = f64> {
        let rate_hz = self.rate_hz;
        (0..self.samples).map(move |n| n as f64 / rate_hz)
    }

    /// Motion without rest, of unit root mean square over the axes.
    fn motion(&self, kind: Moves, random: &mut Random) -> Axes {
        let mut axes = match kind {
            Moves::Smooth => mixed(self.smooths(between(0.2, 5.0, random), random), 0.5, random),
            Moves::OneAxis => {
                let moving = self.smooth(between(0.2, 5.0, random), random);
                let axis = random.random_range(0..3);
                std::array::from_fn(|other| {
                    // No axis is aligned exactly.
                    let share = if other == axis { 1.0 } else { 0.01 };
                    moving.iter().map(|value| share * value).collect()
                })
            }
            Moves::Pendulum => {
                let (frequency, quality) = (between(0.3, 1.2, random), between(10.0, 60.0, random));
                mixed(self.bands(frequency, quality, random), 0.9, random)
            }
            Moves::Walking => self.walking(random),
            Moves::Car => self.car(random),
            Moves::Tremor => {
                let (frequency, quality) = (between(6.0, 12.0, random), between(3.0, 8.0, random));
                let mut axes = mixed(self.bands(frequency, quality, random), 0.5, random);
                let slow = mixed(self.smooths(between(0.3, 2.0, random), random), 0.5, random);
                let size = between(0.3, 2.0, random);
                add(&mut axes, &slow, size);
                axes
            }
            Moves::Boat => {
                let (frequency, quality) = (between(0.08, 0.3, random), between(2.0, 6.0, random));
                mixed(self.bands(frequency, quality, random), 0.6, random)
            }
            Moves::Drone => {
                let mut axes = mixed(self.smooths(between(1.0, 8.0, random), random), 0.2, random);
                let motors = self.bands(between(15.0, 40.0, random), 10.0, random);
                let motors = mixed(motors, 0.5, random);
                let size = between(0.1, 1.0, random);
                add(&mut axes, &motors, size);
                axes
            }
            Moves::Handheld => {
                let axes = mixed(
                    self.bands(between(0.3, 2.0, random), 0.8, random),
                    0.3,
                    random,
                );
                let loud = self.smooth(0.1, random);
                axes.map(|axis| {
                    let values = axis.iter().zip(&loud);
                    values
                        .map(|(value, loud)| value * (0.6 * loud).exp())
                        .collect()
                })
            }
            Moves::Turntable => self.turntable(random),
            Moves::Exercise => {
                let axes = mixed(
                    self.bands(between(0.5, 2.0, random), 4.0, random),
                    0.5,
                    random,
                );
                let part = (2.56 * self.rate_hz) as usize;
                let is_moving: Vec<bool> = (0..=self.samples / part)
                    .map(|_| random.random_bool(0.6))
                    .collect();
                axes.map(|axis| {
                    let values = axis.into_iter().enumerate();
                    values
                        .map(|(n, value)| if is_moving[n / part] { value } else { 0.0 })
                        .collect()
                })
            }
        };
        let squares: f64 = axes.iter().flatten().map(|value| value * value).sum();
        let rms = (squares / (3 * self.samples) as f64).sqrt();
        axes.iter_mut().flatten().for_each(|value| *value /= rms);
        axes
    }

    fn walking(&self, random: &mut Random) -> Axes {
        let frequency = between(0.8, 1.2, random);
        let pace = self.smooth(0.5, random);
        let mut phase = 0.0;
        let phases: Vec<f64> = pace
            .iter()
            .map(|pace| {
                phase += TAU * frequency * (1.0 + 0.05 * pace) / self.rate_hz;
                phase
            })
            .collect();
        let axes = [(); 3].map(|()| {
            let harmonics: Vec<(f64, f64, f64)> = (1..9)
                .map(|harmonic| {
                    let harmonic = f64::from(harmonic);
                    (
                        harmonic,
                        normal(random) / harmonic,
                        random.random_range(0.0..TAU),
                    )
                })
                .collect();
            let at = |phase: &f64| {
                harmonics
                    .iter()
                    .map(|(h, size, own)| size * (h * phase + own).sin())
                    .sum()
            };
            phases.iter().map(at).collect::<Vec<f64>>()
        });
        let loud = self.smooth(0.5, random);
        mixed(axes, 0.3, random).map(|axis| {
            let values = axis.iter().zip(&loud);
            values
                .map(|(value, loud)| value * (1.0 + 0.2 * loud))
                .collect()
        })
    }

    fn car(&self, random: &mut Random) -> Axes {
        let turns = between(0.05, 0.5, random);
        let mut axes = match random.random_bool(0.5) {
            true => mixed(self.smooths(turns, random), 0.3, random),
            false => {
                let yaw = self.smooth(turns, random);
                [0.02, 0.05, 1.0].map(|share| yaw.iter().map(|value| share * value).collect())
            }
        };
        let often = between(0.1, 1.0, random) / self.rate_hz;
        let bumps: Vec<f64> = (0..self.samples)
            .map(|_| {
                if random.random_bool(often) {
                    normal(random)
                } else {
                    0.0
                }
            })
            .collect();
        let bumps = normalised(band_pass(
            &bumps,
            between(2.0, 12.0, random) / self.rate_hz,
            3.0,
        ));
        let size = between(0.3, 2.0, random);
        let shares: Vec<f64> = (0..3).map(|_| size * normal(random)).collect();
        for (axis, share) in axes.iter_mut().zip(shares) {
            axis.iter_mut()
                .zip(&bumps)
                .for_each(|(value, bump)| *value += share * bump);
        }
        axes
    }

    fn turntable(&self, random: &mut Random) -> Axes {
        let about: [f64; 3] = match random.random_bool(0.5) {
            true => [(); 3].map(|()| normal(random)),
            false => {
                let axis = random.random_range(0..3);
                std::array::from_fn(|other| if other == axis { 1.0 } else { 0.0 })
            }
        };
        let mut rate = Vec::new();
        while rate.len() < self.samples {
            let long = (between(1.0, 15.0, random) * self.rate_hz) as usize;
            let moves = if random.random_bool(0.7) {
                normal(random)
            } else {
                0.0
            };
            rate.extend(std::iter::repeat_n(moves, long));
        }
        rate.truncate(self.samples);
        let rate = self.low_pass(rate, 2.0, 2);
        about.map(|share| rate.iter().map(|value| share * value).collect())
    }

    /// Whether the curves of all axes show motion, whether that of the axis that varies most does, and whether the integrity of an axis
    /// finds motion.
    fn judge(&self, axes: &Axes) -> [bool; 3] {
        // The quantum lies well below the noise.
        let quantum = self.sigma / 16.0;
        let counts = axes.each_ref().map(|axis| {
            let counts = axis.iter().map(|value| (value / quantum).round() as i32);
            counts.collect::<Vec<_>>()
        });
        let scale = Scale::new(quantum, self.rate_hz).expect("a scale");
        let curves = counts.each_ref().map(|counts| {
            let mut accumulator = Accumulator::<OCTAVES>::new();
            accumulator.push_slice(counts);
            accumulator.curve(scale)
        });
        let found = motion::judge(curves.each_ref(), Some(1.0));
        let alone = motion::judge([&curves[loudest(axes)]], Some(1.0));
        let moved = counts.iter().any(|counts| {
            let mut integrity = Integrity::new();
            counts
                .chunks(64)
                .for_each(|chunk| integrity.push_slice(chunk));
            matches!(integrity.verdict(), Some(Reason::Moved { .. }))
        });
        [found.is_some(), alone.is_some(), moved]
    }
}

/// The axis that varies most.
fn loudest(axes: &Axes) -> usize {
    let size = |&axis: &usize| axes[axis].iter().map(|value| value * value).sum::<f64>();
    let larger = |one: &usize, other: &usize| size(one).total_cmp(&size(other));
    (0..axes.len()).max_by(larger).unwrap_or(0)
}

/// Axes that share some of their motion.
fn mixed(axes: Axes, common: f64, random: &mut Random) -> Axes {
    let rows: [[f64; 3]; 3] = [(); 3].map(|()| {
        let row = [(); 3].map(|()| normal(random));
        [row[0], (1.0 - common) * row[1], (1.0 - common) * row[2]]
    });
    let [x, y, z] = axes;
    rows.map(|[of_x, of_y, of_z]| {
        let values = x.iter().zip(&y).zip(&z);
        values
            .map(|((x, y), z)| of_x * x + of_y * y + of_z * z)
            .collect()
    })
}

/// A low pass of one pole by the bilinear transform.
fn one_pole(samples: Vec<f64>, cutoff: f64) -> Vec<f64> {
    let k = (PI * cutoff).tan();
    let (b, a) = (k / (1.0 + k), (k - 1.0) / (1.0 + k));
    let (mut before, mut state) = (0.0, 0.0);
    let step = |value: f64| {
        state = b * (value + before) - a * state;
        before = value;
        state
    };
    samples.into_iter().map(step).collect()
}

/// A band pass of two poles by the bilinear transform.
fn band_pass(samples: &[f64], frequency: f64, quality: f64) -> Vec<f64> {
    let k = (PI * frequency.min(0.47)).tan();
    let scale = 1.0 / (1.0 + k / quality + k * k);
    let (b, a1, a2) = (
        k / quality * scale,
        2.0 * (k * k - 1.0) * scale,
        (1.0 - k / quality + k * k) * scale,
    );
    let ([mut x1, mut x2], [mut y1, mut y2]) = ([0.0; 2], [0.0; 2]);
    let step = |&x: &f64| {
        let y = b * (x - x2) - a1 * y1 - a2 * y2;
        (x2, x1, y2, y1) = (x1, x, y1, y);
        y
    };
    samples.iter().map(step).collect()
}

/// A record at rest, in °/s.
fn at_rest(kind: Rests, gyro: Gyro, random: &mut Random) -> Axes {
    let mut axes = gyro.noise(random);
    let sigma = gyro.sigma;
    match kind {
        Rests::Plain => {}
        Rests::Flicker => add(
            &mut axes,
            &gyro.flicker(between(0.3, 10.0, random), random),
            1.0,
        ),
        Rests::Walk => {
            let size = between(1e-3, 3e-2, random) * (100.0 / gyro.rate_hz).sqrt();
            let walks = [(); 3].map(|()| Gyro::walk(random, gyro.samples));
            add(&mut axes, &walks, sigma * size);
        }
        Rests::WarmUp => {
            let size = (sigma * between(1.0, 300.0, random)).min(0.5);
            let time_s = between(30.0, 1000.0, random);
            let slow = [(); 3].map(|()| {
                let share = normal(random);
                gyro.times().map(|t| share * (-t / time_s).exp()).collect()
            });
            add(&mut axes, &slow, size);
        }
        Rests::Thermal => {
            let size = (sigma * between(1.0, 100.0, random)).min(0.5);
            let (period_s, phase) = (between(60.0, 600.0, random), random.random_range(0.0..TAU));
            let air = gyro.smooth(0.01, random);
            let room: Vec<f64> = gyro
                .times()
                .zip(air)
                .map(|(t, air)| (TAU * t / period_s + phase).sin() + 0.5 * air)
                .collect();
            let slow = [(); 3].map(|()| {
                let share = normal(random);
                room.iter().map(|value| share * value).collect()
            });
            add(&mut axes, &slow, size);
        }
        Rests::Resonance => {
            let (frequency, quality) = (
                between(3.0, 0.45 * gyro.rate_hz, random),
                between(2.0, 30.0, random),
            );
            let size = 0.6 * sigma * between(0.3, 3.0, random);
            let bands = mixed(gyro.bands(frequency, quality, random), 1.0, random);
            add(&mut axes, &bands, size);
        }
        Rests::Telegraph => {
            let dwell_s = between(0.02, 20.0, random);
            let size = (sigma * between(0.3, 2.0, random)).min(0.1);
            let flips = (1.0 / (2.0 * dwell_s * gyro.rate_hz)).min(1.0);
            let levels = [(); 3].map(|()| {
                let mut level = 1.0;
                let step = |_| {
                    if random.random_bool(flips) {
                        level = -level;
                    }
                    level
                };
                (0..gyro.samples).map(step).collect()
            });
            add(&mut axes, &levels, size);
        }
        Rests::LowPass | Rests::LowPassFlicker => {
            if kind == Rests::LowPassFlicker {
                add(
                    &mut axes,
                    &gyro.flicker(between(0.3, 10.0, random), random),
                    1.0,
                );
            }
            let (cutoff, poles) = (
                between(0.5, 0.4 * gyro.rate_hz, random),
                random.random_range(1..4),
            );
            axes = axes.map(|axis| gyro.low_pass(axis, cutoff, poles));
        }
        Rests::GaussMarkov => {
            let size = sigma * between(0.1, 1.0, random);
            let cutoff_hz = 1.0 / (TAU * between(0.03, 30.0, random));
            let noise = gyro.whites(random);
            let noise = noise.map(|axis| normalised(gyro.low_pass(axis, cutoff_hz, 1)));
            add(&mut axes, &noise, size);
        }
        Rests::Lines => {
            for _ in 0..3 {
                let size = (sigma * between(0.1, 10.0, random)).min(1.0);
                let frequency = between(4.0, 0.49 * gyro.rate_hz, random);
                let lines = [(); 3].map(|()| {
                    let (share, phase) =
                        (random.random_range(0.3..1.0), random.random_range(0.0..TAU));
                    gyro.times()
                        .map(|t| share * (TAU * frequency * t + phase).sin())
                        .collect()
                });
                add(&mut axes, &lines, size);
            }
        }
        Rests::Touches => {
            for _ in 0..random.random_range(1..6) {
                let (rings, long) = (between(4.0, 15.0, random), (2.0 * gyro.rate_hz) as usize);
                let start = random.random_range(0..gyro.samples - long);
                let size = sigma * between(3.0, 100.0, random);
                for axis in &mut axes {
                    let share = normal(random);
                    for (value, t) in axis[start..start + long].iter_mut().zip(gyro.times()) {
                        *value += size * share * (-t / 0.2).exp() * (TAU * rings * t).sin();
                    }
                }
            }
        }
    }
    axes
}
