//! Noise with memory: poles, telegraph noise, filtered white noise.

use super::{Random, Source, random::normal};
use rand::RngExt;
use std::f64::consts::PI;

/// Noise of one complex pole `z` (Gillespie 1996, of the rate at the samples): Gauss–Markov noise,
/// a resonance, or low-passed white noise.
pub(super) struct Pole {
    state: [f64; 2],
    decay: f64,
    turn: (f64, f64),
    step: f64,
}

impl Pole {
    pub(super) fn new(
        rms: f64,
        time_s: f64,
        frequency_hz: f64,
        interval_s: f64,
        random: &mut Random,
    ) -> Self {
        let decay = (-interval_s / time_s).exp();
        Self {
            state: [rms * normal(random), rms * normal(random)],
            decay,
            turn: (2.0 * PI * frequency_hz * interval_s).sin_cos(),
            step: rms * (-(-2.0 * interval_s / time_s).exp_m1()).sqrt(),
        }
    }
}

impl Source for Pole {
    fn next(&mut self, random: &mut Random) -> f64 {
        let ([re, im], (sine, cosine)) = (self.state, self.turn);
        self.state = [
            self.decay * (re * cosine - im * sine) + self.step * normal(random),
            self.decay * (re * sine + im * cosine) + self.step * normal(random),
        ];
        // One part of a circular process has the autocovariance Re zⁿ.
        self.state[0]
    }
}

/// A rate that jumps between `+rms` and `−rms`, on average every `2 T_c` (Machlup 1954).
pub(super) struct Telegraph {
    rate: f64,
    flip: f64,
}

impl Telegraph {
    pub(super) fn new(
        rms: f64,
        correlation_time_s: f64,
        interval_s: f64,
        random: &mut Random,
    ) -> Self {
        Self {
            rate: if random.random_bool(0.5) { rms } else { -rms },
            // The chance of an odd number of jumps between two samples.
            flip: -0.5 * (-interval_s / correlation_time_s).exp_m1(),
        }
    }
}

impl Source for Telegraph {
    fn next(&mut self, random: &mut Random) -> f64 {
        if random.random_bool(self.flip) {
            self.rate = -self.rate;
        }
        self.rate
    }
}

/// White noise behind boxcars, sampled: white noise at a multiple of the sample rate, and running
/// sums over it.
pub(super) struct Filtered {
    stages: Vec<Boxcar>,
    oversampling: usize,
    deviation: f64,
}

struct Boxcar {
    ring: Vec<f64>,
    at: usize,
    sum: f64,
}

impl Boxcar {
    fn next(&mut self, value: f64) -> f64 {
        let length = self.ring.len();
        self.sum += value - self.ring[self.at];
        self.ring[self.at] = value;
        self.at = (self.at + 1) % length;
        if self.at == 0 {
            // Rounding must not walk.
            self.sum = self.ring.iter().sum();
        }
        self.sum / length as f64
    }
}

impl Filtered {
    /// A width is met to 2 % or better, exactly where it is a multiple of a 32nd of a sample.
    pub(super) fn new(
        angle_random_walk: f64,
        width_s: f64,
        stages: usize,
        interval_s: f64,
        random: &mut Random,
    ) -> Self {
        let width = width_s / interval_s;
        // Narrow filters need finer steps than wide ones.
        let oversampling = ((32.0 / width).ceil() as usize).clamp(4, 32);
        let length = ((width * oversampling as f64).round() as usize).max(1);
        // The density at frequency zero is N² for the samples, aliases included.
        let pulse = (0..stages).fold(vec![1.0], |pulse, _| smoothed(&pulse, length));
        let folded: f64 = (0..oversampling)
            .map(|phase| {
                pulse
                    .iter()
                    .skip(phase)
                    .step_by(oversampling)
                    .sum::<f64>()
                    .powi(2)
            })
            .sum();
        let gain = 1.0 / (folded * oversampling as f64).sqrt();
        let boxcar = || Boxcar {
            ring: vec![0.0; length],
            at: 0,
            sum: 0.0,
        };
        let mut filtered = Self {
            stages: (0..stages).map(|_| boxcar()).collect(),
            oversampling,
            deviation: gain * angle_random_walk / (interval_s / oversampling as f64).sqrt(),
        };
        for _ in 0..stages * length / oversampling + 1 {
            filtered.next(random);
        }
        filtered
    }
}

/// A pulse behind a boxcar.
fn smoothed(pulse: &[f64], length: usize) -> Vec<f64> {
    let mut smooth = vec![0.0; pulse.len() + length - 1];
    for (at, value) in pulse.iter().enumerate() {
        for slot in &mut smooth[at..at + length] {
            *slot += value / length as f64;
        }
    }
    smooth
}

impl Source for Filtered {
    fn next(&mut self, random: &mut Random) -> f64 {
        let mut value = 0.0;
        for _ in 0..self.oversampling {
            value = self.deviation * normal(random);
            for stage in &mut self.stages {
                value = stage.next(value);
            }
        }
        value
    }
}

/// A sinusoidal rate, of random phase.
pub(super) struct Sinusoid {
    amplitude: f64,
    cycles: f64,
    phase: f64,
    samples: u64,
}

impl Sinusoid {
    pub(super) fn new(
        amplitude: f64,
        frequency_hz: f64,
        interval_s: f64,
        random: &mut Random,
    ) -> Self {
        Self {
            amplitude,
            cycles: frequency_hz * interval_s,
            phase: random.random(),
            samples: 0,
        }
    }
}

impl Source for Sinusoid {
    fn next(&mut self, _: &mut Random) -> f64 {
        self.samples += 1;
        let turns = (self.cycles * self.samples as f64 + self.phase).fract();
        self.amplitude * (2.0 * PI * turns).sin()
    }
}
