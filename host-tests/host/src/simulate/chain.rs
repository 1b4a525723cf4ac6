//! White noise behind the filters of a sensor and its driver, as they run: at a multiple of the rate of the log, sample by sample.
//!
//! No kernel of the library has a part in this, so that records of a chain test the kernels that are fitted.

use super::{
    Source,
    filtered::{Section, butterworth},
    random::{Random, normal},
};
use crate::effect_argument::EffectArgument;
use allanite_log::failure::Failure;
use rustfft::num_complex::Complex;
use std::f64::consts::{PI, TAU};

/// The name of the option.
const OPTION: &str = "--chain";
/// The names of all stages.
const NAMES: &str = "butterworth, pt, notch, average, cic, fir, ema, median and every";
/// The most samples within one of the log, and the longest stage. Chosen by hand.
const MOST: f64 = 256.0;
/// The number of samples of the log after which a chain has forgotten how it began: 25 times its slowest pole, whose corner is at a
/// thousandth of the rate or above.
const FORGOTTEN: usize = 8192;

/// The stages that the noise goes through, in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    stages: Vec<Stage>,
    /// Samples of the first stage within one of the log.
    times: usize,
}

/// A stage, at the rate of its input.
#[derive(Clone, Debug, PartialEq)]
enum Stage {
    /// A Butterworth low pass by the bilinear transform.
    Butterworth { poles: f64, cutoff_hz: f64 },
    /// Equal smoothing filters in series, whose common cut-off at −3 dB is given, as flight controllers have them.
    Pt { stages: usize, cutoff_hz: f64 },
    /// A biquad notch after Bristow-Johnson's audio EQ cookbook.
    Notch { frequency_hz: f64, quality: f64 },
    /// The mean over the last samples.
    Average { samples: usize },
    /// Integrators and combs, of whose output every sample of so many is kept.
    Cic { stages: usize, factor: usize },
    /// A windowed ideal low pass (Hamming).
    Fir { taps: usize, cutoff_hz: f64 },
    /// Exponential smoothing with this share of the newest sample.
    Ema { share: f64 },
    /// The median of the last samples.
    Median { samples: usize },
    /// Every sample of so many is kept.
    Every { samples: usize },
}

impl Chain {
    /// Reads a chain: stages with `|` between them, such as `butterworth:poles=2,cutoff_hz=42 | every:samples=8`. The noise
    /// begins at as many times the rate of the log as samples are dropped.
    ///
    /// # Errors
    /// When there is no such stage, or it lacks a parameter.
    pub fn parse(text: &str) -> Result<Self, Failure> {
        let stages = text.split('|').map(Stage::parse);
        let stages = stages.collect::<Result<Vec<_>, _>>()?;
        let times: f64 = stages.iter().map(|stage| stage.factor() as f64).product();
        if times > MOST {
            return Err(Failure::option(
                format!("{OPTION}: the noise would begin at {times} times the rate"),
                format!("drop fewer samples: at most {MOST} for one"),
            ));
        }
        Ok(Self {
            stages,
            times: times as usize,
        })
    }

    /// White noise of this angle random walk behind the chain, sampled at this rate.
    pub fn source(
        &self,
        angle_random_walk: f64,
        rate_hz: f64,
        random: &mut Random,
    ) -> impl Source + use<> {
        let mut input_hz = self.times as f64 * rate_hz;
        let deviation = angle_random_walk * input_hz.sqrt();
        let mut running = Vec::new();
        for stage in &self.stages {
            running.push(Running {
                kind: stage.running(input_hz),
                keep: stage.factor(),
                taken: 0,
            });
            input_hz /= stage.factor() as f64;
        }
        let mut filtered = Chained { running, deviation };
        for _ in 0..FORGOTTEN {
            let _ = filtered.next(random);
        }
        filtered
    }

    /// The density of white noise behind the chain relative to that before it, at a frequency of the log in Hz, with all that is
    /// aliased there; `None` if a stage is no linear filter.
    pub fn density(&self, frequency_hz: f64, rate_hz: f64) -> Option<f64> {
        let aliases = (0..self.times).map(|alias| {
            let f = frequency_hz + alias as f64 * rate_hz;
            let mut input_hz = self.times as f64 * rate_hz;
            let mut power = 1.0;
            for stage in &self.stages {
                power *= stage.response(f, input_hz)?.norm_sqr();
                input_hz /= stage.factor() as f64;
            }
            Some(power)
        });
        // Noise of one density at the fast rate is spread over as many bands as fold onto one.
        aliases.sum()
    }
}

impl Stage {
    fn parse(text: &str) -> Result<Self, Failure> {
        let mut argument = EffectArgument::parse(OPTION, text.trim())?;
        let whole = |argument: &mut EffectArgument<'_>, name, low: f64, high: f64| {
            let value = argument.require(name)?;
            if value.fract() != 0.0 || !(low..=high).contains(&value) {
                let remedy = format!("give a whole number, {low} to {high}");
                return Err(argument.failure(format!("{name}={value} is impossible"), &remedy));
            }
            Ok(value as usize)
        };
        let stage = match argument.name {
            "butterworth" => Self::Butterworth {
                poles: whole(&mut argument, "poles", 1.0, 8.0)? as f64,
                cutoff_hz: argument.require("cutoff_hz")?,
            },
            "pt" => Self::Pt {
                stages: whole(&mut argument, "stages", 1.0, 3.0)?,
                cutoff_hz: argument.require("cutoff_hz")?,
            },
            "notch" => Self::Notch {
                frequency_hz: argument.require("frequency_hz")?,
                quality: argument.require("quality")?,
            },
            "average" => Self::Average {
                samples: whole(&mut argument, "samples", 2.0, MOST)?,
            },
            "cic" => Self::Cic {
                stages: whole(&mut argument, "stages", 1.0, 8.0)?,
                factor: whole(&mut argument, "factor", 2.0, MOST)?,
            },
            "fir" => Self::Fir {
                taps: whole(&mut argument, "taps", 3.0, MOST)?,
                cutoff_hz: argument.require("cutoff_hz")?,
            },
            "ema" => match argument.require("share")? {
                share if share <= 1.0 => Self::Ema { share },
                share => {
                    let what = format!("share={share} is impossible");
                    return Err(argument.failure(what, "give at most 1"));
                }
            },
            "median" => Self::Median {
                samples: whole(&mut argument, "samples", 2.0, MOST)?,
            },
            "every" => Self::Every {
                samples: whole(&mut argument, "samples", 2.0, MOST)?,
            },
            _ => return Err(argument.failure("no such stage", &format!("choose from {NAMES}"))),
        };
        argument.finish()?;
        Ok(stage)
    }

    /// The samples of which one is kept.
    const fn factor(&self) -> usize {
        match self {
            Self::Cic { factor, .. } => *factor,
            Self::Every { samples } => *samples,
            _ => 1,
        }
    }

    fn running(&self, rate_hz: f64) -> Kind {
        match *self {
            Self::Butterworth { poles, cutoff_hz } => {
                // The bilinear transform ends at half of the rate.
                let angle = (TAU * cutoff_hz / rate_hz).min(0.98 * PI);
                Kind::Sections(butterworth(angle, poles))
            }
            Self::Pt { .. } | Self::Ema { .. } => {
                let (share, stages) = self.smoothing(rate_hz);
                let stage = Section::new([share, 0.0, 0.0], [share - 1.0, 0.0]);
                Kind::Sections(vec![stage; stages])
            }
            Self::Notch { .. } => {
                let (b, a) = self.biquad(rate_hz);
                Kind::Sections(vec![Section::new(b, a)])
            }
            Self::Average { samples } => Kind::Taps(Taps::new(vec![1.0 / samples as f64; samples])),
            Self::Cic { stages, factor } => Kind::Taps(Taps::new(cic(stages, factor))),
            Self::Fir { taps, cutoff_hz } => Kind::Taps(Taps::new(fir(taps, cutoff_hz / rate_hz))),
            Self::Median { samples } => Kind::Median(vec![0.0; samples], 0),
            Self::Every { .. } => Kind::Sections(Vec::new()),
        }
    }

    /// The share of the newest sample, and how often it is smoothed.
    fn smoothing(&self, rate_hz: f64) -> (f64, usize) {
        match *self {
            Self::Pt { stages, cutoff_hz } => {
                // The stages have a higher cut-off each, so that all have this one together.
                let order = stages as f64;
                let each = cutoff_hz / (2.0_f64.powf(1.0 / order) - 1.0).sqrt();
                let ratio = TAU * each / rate_hz;
                (ratio / (1.0 + ratio), stages)
            }
            Self::Ema { share } => (share, 1),
            _ => (1.0, 0),
        }
    }

    fn biquad(&self, rate_hz: f64) -> ([f64; 3], [f64; 2]) {
        let Self::Notch {
            frequency_hz,
            quality,
        } = *self
        else {
            return ([1.0, 0.0, 0.0], [0.0; 2]);
        };
        let (sine, cosine) = (TAU * frequency_hz / rate_hz).sin_cos();
        let alpha = sine / (2.0 * quality);
        let unit = 1.0 + alpha;
        let both = -2.0 * cosine / unit;
        ([1.0 / unit, both, 1.0 / unit], [both, (1.0 - alpha) / unit])
    }

    /// The response at a frequency, by the definition of each filter and not by its recursion.
    fn response(&self, frequency_hz: f64, rate_hz: f64) -> Option<Complex<f64>> {
        let delay = Complex::from_polar(1.0, -TAU * frequency_hz / rate_hz);
        let sum = |taps: &[f64]| {
            let mut power = Complex::new(1.0, 0.0);
            taps.iter().fold(Complex::new(0.0, 0.0), |sum, tap| {
                let sum = sum + power * *tap;
                power *= delay;
                sum
            })
        };
        Some(match *self {
            Self::Butterworth { poles, cutoff_hz } => {
                let warped = |hz: f64| (PI * hz / rate_hz).tan().abs();
                let ratio = warped(frequency_hz) / warped(cutoff_hz.min(0.49 * rate_hz));
                Complex::new((1.0 + ratio.powf(2.0 * poles)).recip().sqrt(), 0.0)
            }
            Self::Pt { .. } | Self::Ema { .. } => {
                let (share, stages) = self.smoothing(rate_hz);
                (share / (1.0 - delay * (1.0 - share))).powi(stages as i32)
            }
            Self::Notch { .. } => {
                let ([b0, b1, b2], [a1, a2]) = self.biquad(rate_hz);
                (b0 + delay * (b1 + delay * b2)) / (1.0 + delay * (a1 + delay * a2))
            }
            Self::Average { samples } => sum(&vec![1.0 / samples as f64; samples]),
            Self::Cic { stages, factor } => {
                sum(&vec![1.0 / factor as f64; factor]).powi(stages as i32)
            }
            Self::Fir { taps, cutoff_hz } => sum(&fir(taps, cutoff_hz / rate_hz)),
            Self::Every { .. } => Complex::new(1.0, 0.0),
            Self::Median { .. } => return None,
        })
    }
}

/// The impulse response of integrators and combs, which is a boxcar with itself.
fn cic(stages: usize, factor: usize) -> Vec<f64> {
    let mut taps = vec![1.0];
    for _ in 0..stages {
        let mut next = vec![0.0; taps.len() + factor - 1];
        for (at, tap) in taps.iter().enumerate() {
            for one in &mut next[at..at + factor] {
                *one += tap / factor as f64;
            }
        }
        taps = next;
    }
    taps
}

/// A low pass with this cut-off, relative to the rate, cut by Hamming's window; its sum is one.
fn fir(count: usize, cutoff: f64) -> Vec<f64> {
    let middle = 0.5 * (count - 1) as f64;
    let tap = |at: usize| {
        let x = TAU * cutoff * (at as f64 - middle);
        let ideal = if x == 0.0 { 1.0 } else { x.sin() / x };
        ideal * (0.54 - 0.46 * (TAU * at as f64 / (count - 1) as f64).cos())
    };
    let taps: Vec<f64> = (0..count).map(tap).collect();
    let sum: f64 = taps.iter().sum();
    taps.into_iter().map(|tap| tap / sum).collect()
}

/// White noise that goes through stages.
struct Chained {
    running: Vec<Running>,
    deviation: f64,
}

struct Running {
    kind: Kind,
    /// Of so many samples, the last is kept.
    keep: usize,
    taken: usize,
}

enum Kind {
    Sections(Vec<Section>),
    Taps(Taps),
    /// The last samples, and the place of the next.
    Median(Vec<f64>, usize),
}

impl Source for Chained {
    fn next(&mut self, random: &mut Random) -> f64 {
        loop {
            let mut value = Some(self.deviation * normal(random));
            for stage in &mut self.running {
                value = value.and_then(|value| stage.output(value));
            }
            if let Some(value) = value {
                return value;
            }
        }
    }
}

impl Running {
    fn output(&mut self, input: f64) -> Option<f64> {
        self.taken = (self.taken + 1) % self.keep;
        let is_kept = self.taken == 0;
        match &mut self.kind {
            Kind::Sections(sections) => {
                let output = sections.iter_mut().fold(input, |x, one| one.output(x));
                is_kept.then_some(output)
            }
            Kind::Taps(taps) => {
                taps.push(input);
                is_kept.then(|| taps.sum())
            }
            Kind::Median(last, next) => {
                last[*next] = input;
                *next = (*next + 1) % last.len();
                let mut sorted = last.clone();
                sorted.sort_by(f64::total_cmp);
                let (low, high) = (sorted[(sorted.len() - 1) / 2], sorted[sorted.len() / 2]);
                is_kept.then_some(0.5 * (low + high))
            }
        }
    }
}

/// A filter with a finite impulse response.
struct Taps {
    taps: Vec<f64>,
    last: std::collections::VecDeque<f64>,
}

impl Taps {
    fn new(taps: Vec<f64>) -> Self {
        let last = taps.iter().map(|_| 0.0).collect();
        Self { taps, last }
    }

    fn push(&mut self, input: f64) {
        self.last.pop_back();
        self.last.push_front(input);
    }

    fn sum(&self) -> f64 {
        self.taps
            .iter()
            .zip(&self.last)
            .map(|(tap, x)| tap * x)
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng as _;
    use rustfft::FftPlanner;

    const RATE_HZ: f64 = 100.0;

    const CHAINS: [&str; 10] = [
        "butterworth:poles=2,cutoff_hz=12 | every:samples=8",
        "butterworth:poles=1,cutoff_hz=9 | every:samples=2",
        "butterworth:poles=1,cutoff_hz=6 | average:samples=8 | every:samples=8",
        "cic:stages=4,factor=16",
        "cic:stages=3,factor=8 | fir:taps=47,cutoff_hz=50 | every:samples=2",
        "pt:stages=3,cutoff_hz=20 | notch:frequency_hz=60,quality=2 | every:samples=4",
        "notch:frequency_hz=30,quality=1",
        "ema:share=0.4",
        "average:samples=5 | average:samples=5",
        "fir:taps=31,cutoff_hz=80 | every:samples=4 | butterworth:poles=3,cutoff_hz=20 | ema:share=0.7",
    ];

    #[test]
    fn recursions_have_the_densities_of_their_definitions() {
        const LENGTH: usize = 256;
        const SEGMENTS: usize = 2000;
        for (seed, text) in CHAINS.into_iter().enumerate() {
            let chain = Chain::parse(text).expect(text);
            let mut random = Random::seed_from_u64(seed as u64);
            let mut source = chain.source(0.1, RATE_HZ, &mut random);
            let fft = FftPlanner::new().plan_fft_forward(LENGTH);
            let mut sums = vec![0.0; LENGTH / 2];
            let window = |at: usize| 0.5 - 0.5 * (TAU * at as f64 / LENGTH as f64).cos();
            let squares: f64 = (0..LENGTH).map(|at| window(at).powi(2)).sum();
            for _ in 0..SEGMENTS {
                let mut segment: Vec<Complex<f64>> = (0..LENGTH)
                    .map(|at| Complex::new(source.next(&mut random) * window(at), 0.0))
                    .collect();
                fft.process(&mut segment);
                for (sum, value) in sums.iter_mut().zip(&segment) {
                    *sum += value.norm_sqr();
                }
            }
            let bins: Vec<(f64, f64)> = (2..LENGTH / 2 - 1)
                .map(|k| {
                    let measured = sums[k] / (SEGMENTS as f64 * squares * RATE_HZ * 0.01);
                    // Hann's window mixes the density of a bin with that of its neighbours.
                    let near = [(-1.0, 1.0), (0.0, 4.0), (1.0, 1.0)].map(|(bins, weight)| {
                        let f = (k as f64 + bins) * RATE_HZ / LENGTH as f64;
                        weight / 6.0 * chain.density(f, RATE_HZ).expect("linear")
                    });
                    (measured, near.iter().sum::<f64>())
                })
                .collect();
            let most = bins
                .iter()
                .map(|(_, expected)| *expected)
                .fold(0.0, f64::max);
            let mut square = 0.0;
            let mut count = 0.0;
            for (measured, expected) in bins {
                // Hann's window leaks little from bins that are a thousand times higher.
                if expected > 1e-3 * most {
                    let z = (measured / expected - 1.0) * (SEGMENTS as f64).sqrt();
                    square += z * z;
                    count += 1.0;
                }
            }
            let reduced: f64 = square / count;
            assert!(
                (0.5..1.7).contains(&reduced),
                "{text}: {reduced} over {count} bins"
            );
        }
    }

    #[test]
    fn a_median_is_the_middle_of_the_last_samples() {
        let chain = Chain::parse("median:samples=3").expect("a chain");
        assert_eq!(chain.density(1.0, RATE_HZ), None);
        let mut stage = Running {
            kind: chain.stages[0].running(RATE_HZ),
            keep: 1,
            taken: 0,
        };
        let inputs = [1.0, 5.0, 2.0, 9.0, 3.0];
        let medians: Vec<f64> = inputs.iter().filter_map(|x| stage.output(*x)).collect();
        assert_eq!(medians, [0.0, 1.0, 2.0, 5.0, 3.0]);
    }

    #[test]
    fn a_chain_that_is_not_understood_is_refused() {
        for (text, expected) in [
            (
                "bessel:poles=2",
                "bessel: no such stage; choose from butterworth",
            ),
            ("butterworth:poles=2", "cutoff_hz is missing"),
            (
                "cic:stages=4,factor=1.5",
                "factor=1.5 is impossible; give a whole number",
            ),
            ("ema:share=2", "share=2 is impossible; give at most 1"),
            (
                "every:samples=200 | every:samples=2",
                "400 times the rate; drop fewer",
            ),
            ("average:samples=4,width=2", "no parameter \"width\""),
        ] {
            let told = Chain::parse(text).expect_err(text).to_string();
            assert!(told.contains(expected), "{text}: {told}");
        }
    }
}
