//! A gyro with a line, a filter, a temperature and a Gauss–Markov process of random sizes and shapes.

use allanite_host::simulate::{Coefficients, Hidden, Random, Simulator};
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use std::{
    f64::consts::TAU,
    fs::File,
    io::{self, BufWriter, Write},
    path::Path,
};

/// The sampling rate in Hz.
pub const RATE_HZ: f64 = 100.0;

/// The share of gyros that have each of the four.
const PRESENT: f64 = 0.75;

/// The temperature about which the course is, in °C.
const MEAN_C: f64 = 25.0;

/// A count of the log in °/s, far below the noise of a sample.
const COUNT: f64 = 1e-4;

/// A gyro of known noise, in degrees and seconds.
#[derive(Clone)]
pub struct Gyro {
    base: Coefficients,
    hidden: Vec<Hidden>,
    /// Root-mean-square and correlation time of the Gauss–Markov process; zero for none.
    process: (f64, f64),
    /// Slope in °/s/K, amplitude in K and period in s of the temperature.
    thermal: (f64, f64, f64),
    /// The constant bias in °/s.
    constant: f64,
}

/// A sample of a record, with what is true at it.
#[derive(Clone, Copy, Debug)]
pub struct Truth {
    /// The rate that the gyro shows, in °/s.
    pub rate: f64,
    /// The temperature that is recorded beside it, in °C.
    pub temperature: f64,
    /// The bias in °/s: the constant, what follows the temperature, and the process.
    pub bias: f64,
}

impl Gyro {
    /// The gyro of a seed.
    pub fn drawn(base: Coefficients, seed: u64) -> Self {
        let mut random = Random::seed_from_u64(seed ^ 0x6578_706f_7274);
        let white = base.angle_random_walk;
        let sample = white * RATE_HZ.sqrt();
        let mut uniform = || random.random::<f64>();
        let log = |u: f64, low: f64, high: f64| low * (high / low).powf(u);
        let mut hidden = Vec::new();
        if uniform() < PRESENT {
            let (name, shape) = match uniform() < 0.5 {
                true => {
                    let time_constant_s = 1.0 / (TAU * log(uniform(), 4.0, 30.0));
                    (
                        "low_pass",
                        [time_constant_s, log(uniform(), 1.0, 2.99).floor()],
                    )
                }
                false => (
                    "decimation_filter",
                    [
                        log(uniform(), 0.02, 0.08),
                        log(uniform(), 1.0, 2.99).floor(),
                    ],
                ),
            };
            hidden.extend(Hidden::new(name, shape, white));
        }
        if uniform() < PRESENT {
            let amplitude = sample * log(uniform(), 0.3, 3.0);
            hidden.extend(Hidden::new(
                "sinusoid",
                [log(uniform(), 2.0, 47.0)],
                amplitude,
            ));
        }
        let has_process = uniform() < PRESENT;
        let process = (sample * log(uniform(), 0.1, 1.0), log(uniform(), 0.5, 50.0));
        let is_thermal = uniform() < PRESENT;
        let thermal = (
            white * log(uniform(), 2.0, 6.0),
            log(uniform(), 2.0, 6.0),
            log(uniform(), 400.0, 1500.0),
        );
        let constant = 20.0 * white * random.sample::<f64, _>(StandardNormal);
        Self {
            base,
            hidden,
            process: if has_process { process } else { (0.0, 1.0) },
            thermal: if is_thermal {
                thermal
            } else {
                (0.0, 3.0, 800.0)
            },
            constant,
        }
    }

    /// What the gyro has.
    pub fn words(&self) -> String {
        let mut words = Vec::new();
        for hidden in &self.hidden {
            let used = hidden.effect.parameters().len();
            let shape: Vec<String> = hidden.parameters[..used]
                .iter()
                .map(|x| format!("{x:.4}"))
                .collect();
            words.push(format!(
                "{}({}) {:.4}",
                hidden.effect.name(),
                shape.join(", "),
                hidden.coefficient
            ));
        }
        if self.process.0 > 0.0 {
            words.push(format!(
                "gauss_markov({:.3} s) {:.4}",
                self.process.1, self.process.0
            ));
        }
        if self.thermal.0 > 0.0 {
            let (slope, kelvin, period_s) = self.thermal;
            words.push(format!(
                "thermal {slope:.4}/K, {kelvin:.1} K, {period_s:.0} s"
            ));
        }
        words.join(" + ")
    }

    /// A record of this gyro. Another seed is another record of the same gyro.
    pub fn record(&self, samples: usize, seed: u64) -> Vec<Truth> {
        let mut noise = Simulator::with_hidden(self.base, &self.hidden, RATE_HZ, seed);
        let mut random = Random::seed_from_u64(seed ^ 0x7265_636f_7264);
        let mut normal = move || random.sample::<f64, _>(StandardNormal);
        let (sigma, time_s) = self.process;
        let kept = (-1.0 / (time_s * RATE_HZ)).exp();
        let driven = sigma * (1.0 - kept * kept).sqrt();
        let mut process = sigma * normal();
        let (slope, kelvin, period_s) = self.thermal;
        let one = |n: usize| {
            let time_s = n as f64 / RATE_HZ;
            let temperature = kelvin * (TAU * time_s / period_s).sin();
            process = kept * process + driven * normal();
            let bias = self.constant + slope * temperature + process;
            Truth {
                rate: noise.next().unwrap_or_default() + bias,
                temperature: MEAN_C + temperature + 0.01 * normal(),
                bias,
            }
        };
        (0..samples).map(one).collect()
    }

    /// Writes a record as a log.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, path: &Path, samples: usize, seed: u64) -> io::Result<()> {
        let mut file = BufWriter::new(File::create(path)?);
        writeln!(file, "gx,temperature_C")?;
        for truth in self.record(samples, seed) {
            let rate = (truth.rate / COUNT).round() * COUNT;
            writeln!(file, "{rate:.4},{:.3}", truth.temperature)?;
        }
        file.flush()
    }
}
