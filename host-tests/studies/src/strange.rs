//! Studies records of noise that the catalogue does not have, or has only nearly: what is said of it.

use super::{RATE_HZ, measured::Sums, quantum, said::Said};
use allanite::Scale;
use allanite_host::simulate::{Coefficients, Hidden, Preset, Random, Simulator};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution as _, StandardNormal};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// The number of samples of a record, which is 22 minutes long.
pub const SAMPLES: usize = 1 << 17;

/// A kind of strange records.
#[derive(Clone, Copy)]
pub struct Kind {
    /// What is strange.
    pub name: &'static str,
    /// The words that are right; none where *nothing* is right.
    pub right: &'static [&'static str],
    /// Whether the coefficient of white noise is still that of the gyro.
    keeps_white_noise: bool,
    make: fn(Coefficients, &mut Random, u64) -> Vec<f64>,
}

/// All kinds.
pub const KINDS: [Kind; 14] = [
    Kind {
        name: "moving average of the whole signal",
        right: &["moving_average", "decimation_filter"],
        keeps_white_noise: true,
        make: averaged,
    },
    Kind {
        // The counts are rounded behind the filter.
        name: "second-order low pass of the whole signal",
        right: &["low_pass", "angle_random_walk"],
        keeps_white_noise: true,
        make: low_passed,
    },
    Kind {
        name: "notch of quality 0.7 to 1.3",
        right: &["notch"],
        keeps_white_noise: true,
        make: |c, random, seed| {
            let shape = [log(random, 8.0, 35.0), log(random, 0.7, 1.3)];
            hidden(c, "notch", shape, 1.0, seed)
        },
    },
    Kind {
        // White noise of the angle is quantization to the eye of Allan.
        name: "white noise that rises with the square of the frequency",
        right: &[],
        keeps_white_noise: true,
        make: rising,
    },
    Kind {
        name: "resonance of quality 0.5 to 1.5",
        right: &["resonance"],
        keeps_white_noise: true,
        make: |c, random, seed| {
            let shape = [log(random, 0.5, 20.0), log(random, 0.5, 1.5)];
            hidden(c, "resonance", shape, log(random, 0.5, 2.0), seed)
        },
    },
    Kind {
        name: "Gauss–Markov noise of 0.1 to 1 s that dominates",
        right: &["gauss_markov", "low_pass"],
        keeps_white_noise: true,
        make: |c, random, seed| {
            let time_s = log(random, 0.1, 1.0);
            hidden(
                c,
                "gauss_markov",
                [time_s, 0.0],
                log(random, 5.0, 50.0),
                seed,
            )
        },
    },
    Kind {
        name: "rate random walk and ramp",
        right: &[],
        keeps_white_noise: true,
        make: |c, random, seed| {
            let c = Coefficients {
                rate_random_walk: c.angle_random_walk * log(random, 0.01, 0.3),
                rate_ramp: c.angle_random_walk * log(random, 1e-3, 3e-2),
                ..c
            };
            Simulator::new(c, RATE_HZ, seed).take(SAMPLES).collect()
        },
    },
    Kind {
        name: "line whose amplitude changes by 80 %",
        right: &[
            "sinusoid",
            "resonance",
            "drifting_sinusoid",
            "drifting_resonance",
        ],
        keeps_white_noise: true,
        make: |c, random, seed| {
            let (frequency_hz, size) = (log(random, 0.5, 45.0), log(random, 0.2, 2.0));
            let period_s = log(random, 20.0, 300.0);
            with(c, seed, size, |time_s| {
                (TAU * frequency_hz * time_s).sin() * (1.0 + 0.8 * (TAU * time_s / period_s).sin())
            })
        },
    },
    Kind {
        name: "line that runs from one frequency to another",
        right: &["drifting_sinusoid", "drifting_resonance"],
        keeps_white_noise: true,
        make: |c, random, seed| {
            let frequency_hz = log(random, 3.0, 40.0);
            let rate = frequency_hz * log(random, 0.03, 0.15) / (SAMPLES as f64 / RATE_HZ);
            with(c, seed, log(random, 0.3, 2.0), |time_s| {
                (TAU * (frequency_hz + 0.5 * rate * time_s) * time_s).sin()
            })
        },
    },
    Kind {
        name: "mains of 50 Hz, off by up to 0.05 Hz",
        right: &["sinusoid"],
        keeps_white_noise: true,
        make: |c, random, seed| {
            let frequency_hz = 50.0 - log(random, 0.002, 0.05);
            with(c, seed, log(random, 0.2, 2.0), |time_s| {
                (TAU * frequency_hz * time_s).sin()
            })
        },
    },
    Kind {
        name: "flicker with a slope of 0.7 to 1.4",
        right: &["power_law"],
        keeps_white_noise: true,
        make: |c, random, seed| {
            let exponent = log(random, 0.7, 1.4);
            hidden(
                c,
                "power_law",
                [exponent, 0.0],
                log(random, 0.05, 0.3),
                seed,
            )
        },
    },
    Kind {
        name: "white noise with heavy tails",
        right: &[],
        keeps_white_noise: true,
        make: heavy,
    },
    Kind {
        name: "counts of 0.5 to 2 standard deviations",
        right: &[],
        keeps_white_noise: false,
        make: |c, random, seed| {
            let step = log(random, 0.5, 2.0) * white(c);
            let rates = Simulator::new(c, RATE_HZ, seed).take(SAMPLES);
            rates.map(|rate| (rate / step).round() * step).collect()
        },
    },
    Kind {
        name: "digital Butterworth filter of 1 to 4 poles, 4 % to 42 % of the rate",
        right: &["low_pass"],
        keeps_white_noise: true,
        make: |c, random, seed| {
            let poles = drawn_poles(random);
            let time_s = 1.0 / (TAU * log(random, 4.0, 42.0));
            hidden(c, "digital_low_pass", [time_s, poles], 1.0, seed)
        },
    },
];

/// The counts of records of a kind.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// All records.
    pub records: usize,
    /// Only right words were said.
    pub right: usize,
    /// A right word was among the alternatives, or it was said that something is left.
    pub honest: usize,
    /// A wrong word was said, and nothing else.
    pub wrong: usize,
    /// A right word and a wrong one were said.
    pub beside: usize,
    /// Nothing was said, where something is hidden.
    pub silent: usize,
    /// The interval of N contains its true value; `None` where the gyro's N is not what there is.
    pub covered: Option<usize>,
    /// The right word came with the number of poles that the filter has; `None` where there is no filter.
    pub order: Option<usize>,
    /// What was said wrong.
    pub words: Vec<String>,
}

/// Diagnoses records of a kind of mems and fog in turn.
pub fn study(kind: Kind, records: u64) -> Tally {
    let said: Vec<(Coefficients, Option<f64>, Said)> = (0..records)
        .into_par_iter()
        .map(|seed| {
            let preset = [Preset::Mems, Preset::Fog][usize::from(seed % 2 == 1)];
            let base = preset.coefficients();
            let mut random = Random::seed_from_u64(seed ^ 0x6f64_6400);
            let rates = (kind.make)(base, &mut random, seed);
            // The number of poles is drawn first.
            let mut again = Random::seed_from_u64(seed ^ 0x6f64_6400);
            let poles = kind.name.contains("poles").then(|| drawn_poles(&mut again));
            (base, poles, diagnose(base, &rates))
        })
        .collect();
    let mut tally = Tally::default();
    for (base, poles, said) in &said {
        tally.records += 1;
        if kind.keeps_white_noise {
            let covered = usize::from(said.covers("N", base.angle_random_walk));
            *tally.covered.get_or_insert(0) += covered;
        }
        if let Some(poles) = poles {
            let names = said.named.iter().zip(&said.shapes);
            let mut filters = names.filter(|((name, _), _)| super::said::word(name) == "low_pass");
            let is_right = filters.any(|(_, shape)| shape.get(1) == Some(poles));
            *tally.order.get_or_insert(0) += usize::from(is_right);
        }
        let is_right = |name: &str| kind.right.contains(&super::said::word(name));
        let right = said.named.iter().filter(|(name, _)| is_right(name)).count();
        let place = if said.named.is_empty() {
            match (kind.right.is_empty(), said.is_unexplained()) {
                (true, _) => &mut tally.right,
                (false, true) => &mut tally.honest,
                (false, false) => &mut tally.silent,
            }
        } else if right == said.named.len() {
            &mut tally.right
        } else if said.is_unexplained()
            || said
                .named
                .iter()
                .all(|(name, others)| is_right(name) || others.iter().any(|other| is_right(other)))
        {
            &mut tally.honest
        } else if right > 0 {
            &mut tally.beside
        } else {
            &mut tally.wrong
        };
        *place += 1;
        if right < said.named.len() {
            tally.words.push(said.words());
        }
    }
    tally
}

fn diagnose(base: Coefficients, rates: &[f64]) -> Said {
    let quantum = quantum(base, RATE_HZ);
    let mut sums = Sums::new();
    let counts = rates.iter().map(|rate| (rate / quantum).round() as i32);
    sums.push_slice(&counts.collect::<Vec<_>>());
    Said::of(&sums.measured(Scale::new(quantum, RATE_HZ).expect("positive")))
}

/// A number between two, uniform in its logarithm.
fn log(random: &mut Random, low: f64, high: f64) -> f64 {
    low * (high / low).powf(random.random::<f64>())
}

fn drawn_poles(random: &mut Random) -> f64 {
    f64::from(random.random_range(1..=4_u32))
}

/// The standard deviation of the white noise of a sample.
fn white(c: Coefficients) -> f64 {
    c.angle_random_walk * RATE_HZ.sqrt()
}

/// An effect of the catalogue; the size is relative to the white noise of a sample.
fn hidden(c: Coefficients, name: &str, shape: [f64; 2], size: f64, seed: u64) -> Vec<f64> {
    let mut hidden = Hidden::new(name, shape, c.angle_random_walk).expect("of the catalogue");
    if !hidden.replaces_white_noise() {
        hidden.coefficient = size * white(c);
    }
    let simulator = Simulator::with_hidden(c, &[hidden], RATE_HZ, seed);
    simulator.take(SAMPLES).collect()
}

/// A course beside the noise; its size is relative to the white noise of a sample.
fn with(c: Coefficients, seed: u64, size: f64, course: impl Fn(f64) -> f64) -> Vec<f64> {
    let rates = Simulator::new(c, RATE_HZ, seed).take(SAMPLES);
    let rates = rates.enumerate();
    rates
        .map(|(i, rate)| rate + size * white(c) * course(i as f64 / RATE_HZ))
        .collect()
}

fn averaged(c: Coefficients, random: &mut Random, seed: u64) -> Vec<f64> {
    let length = random.random_range(2..=9_usize);
    let rates: Vec<f64> = Simulator::new(c, RATE_HZ, seed)
        .take(SAMPLES + length)
        .collect();
    let means = rates.windows(length).take(SAMPLES);
    means
        .map(|window| window.iter().sum::<f64>() / length as f64)
        .collect()
}

/// Behind a digital Butterworth filter of two poles (Oppenheim & Schafer 2010, section 7.2.2).
fn low_passed(c: Coefficients, random: &mut Random, seed: u64) -> Vec<f64> {
    let w = (PI * log(random, 4.0, 35.0) / RATE_HZ).tan();
    let norm = 1.0 / (1.0 + std::f64::consts::SQRT_2 * w + w * w);
    let (gain, first) = (w * w * norm, 2.0 * (w * w - 1.0) * norm);
    let second = (1.0 - std::f64::consts::SQRT_2 * w + w * w) * norm;
    let (mut x, mut y) = ([0.0; 2], [0.0; 2]);
    let passed = Simulator::new(c, RATE_HZ, seed).map(|rate| {
        let out = gain * (rate + 2.0 * x[0] + x[1]) - first * y[0] - second * y[1];
        (x, y) = ([rate, x[0]], [out, y[0]]);
        out
    });
    // The first second holds the start of the filter.
    passed.skip(100).take(SAMPLES).collect()
}

/// White noise of the angle beside that of the rate, whose density rises with `f²`: as large as that of the rate at a corner
/// frequency.
fn rising(c: Coefficients, random: &mut Random, seed: u64) -> Vec<f64> {
    let corner_hz = log(random, 5.0, 25.0);
    let size = white(c) / (2.0 * (PI * corner_hz / RATE_HZ).sin());
    let mut last: f64 = StandardNormal.sample(random);
    let rates = Simulator::new(c, RATE_HZ, seed).take(SAMPLES);
    rates
        .map(|rate| {
            let next: f64 = StandardNormal.sample(random);
            let change = size * (next - last);
            last = next;
            rate + change
        })
        .collect()
}

/// White noise of which one sample in ten has three times the spread.
fn heavy(c: Coefficients, random: &mut Random, seed: u64) -> Vec<f64> {
    let rest = Coefficients {
        angle_random_walk: 0.0,
        ..c
    };
    let scale = white(c) / 1.8_f64.sqrt();
    let rates = Simulator::new(rest, RATE_HZ, seed).take(SAMPLES);
    rates
        .map(|rate| {
            let spread = if random.random::<f64>() < 0.1 {
                3.0
            } else {
                1.0
            };
            let noise: f64 = StandardNormal.sample(random);
            rate + spread * scale * noise
        })
        .collect()
}
