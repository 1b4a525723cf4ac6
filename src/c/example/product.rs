//! The product of `product.c` in Rust, which prints the same lines.

// The conversions change nothing in single precision, in which the lines are compared.
#![allow(clippy::unnecessary_cast, clippy::useless_conversion)]

use allanite::{
    Axes, Model, Real, Scale,
    axis::{AxisRecord, Courses, Gated, Moments, Spectral},
    covariate::Lags,
    diagnosis::{Addition, Diagnosis, Options, Progress, Verdict},
    effect::CATALOGUE,
    fit::{self, Fit, State, fit},
    self_test::{Failure, Limit, Plan, SelfTest, Status},
    spectrum::Spectrum,
    storage::{AxisCertificate, Certificate, Conditions, RateUnit},
};
use std::ops::ControlFlow;

const OCTAVES: usize = allanite_c::ALLANITE_OCTAVES;
const SAMPLES: u32 = 65_536;
const SNAPSHOT: u32 = 40_000;
const POWER_LOSS: u32 = 41_000;

type Gyro = Axes<OCTAVES, 4, Gated, Moments, 3, Spectral<64, 7, 140>, Courses>;
type Record = AxisRecord<OCTAVES, 4, Spectrum<140>>;

/// White noise, an oscillation, and a temperature that rises and falls, which the first axis follows with a lag of 20 s.
struct Sensor {
    seed: u32,
    sine: i32,
    cosine: i32,
    inside: i32,
}

impl Sensor {
    fn noise(&mut self) -> i32 {
        (0..4)
            .map(|_| {
                self.seed = self
                    .seed
                    .wrapping_mul(1_664_525)
                    .wrapping_add(1_013_904_223);
                (self.seed >> 25) as i32
            })
            .sum()
    }

    fn sample(&mut self, n: u32) -> ([i32; 3], i32) {
        self.sine -= self.cosine * 3 / 4;
        self.cosine += self.sine * 3 / 4;
        let rise = n.min(SAMPLES - n) / 128;
        let temperature = 2500 + rise as i32;
        self.inside += (temperature * 65_536 - self.inside) / 2048;
        let x = self.noise() + self.sine / 64 + self.inside / 131_072;
        let y = self.noise() + if n == 5000 { 20_000 } else { 0 };
        let z = self.noise();
        ([x, y, z], temperature)
    }
}

fn bits(value: Real) -> String {
    format!(" {:08x}", (value as f32).to_bits())
}

fn self_test(scale: Scale) -> Result<SelfTest<OCTAVES>, Box<dyn std::error::Error>> {
    let limits = ["angle_random_walk", "bias_instability"];
    let limits = limits.map(|effect| Limit { effect, most: 0.5 });
    let plan = Plan {
        limits: limits.into_iter().collect(),
        least_p: 0.0,
        false_pass: 0.01_f32.into(),
        false_fail: 0.01_f32.into(),
        shortest_s: 5.0,
        longest_s: 640.0,
    };
    Ok(SelfTest::new(plan, scale)?)
}

fn print_status(status: Status) {
    let effects = ["", "quantization", "angle_random_walk", "bias_instability"];
    let code = |name| {
        effects
            .iter()
            .position(|effect| *effect == name)
            .unwrap_or(0)
    };
    let (verdict, effect, value, expected_s) = match status {
        Status::Running {
            progress,
            expected_s,
        } => (0, 0, progress.into(), expected_s),
        Status::Passed => (1, 0, 0.0, 0.0),
        Status::Failed(Failure::Limit { limit, value }) => (2, code(limit.effect), value, 0.0),
        Status::Failed(Failure::Misfit { p_value }) => (3, 0, p_value, 0.0),
        Status::Undecided {
            limit,
            decided_by_s,
        } => (4, code(limit.effect), 0.0, decided_by_s.unwrap_or(0.0)),
        Status::Invalid(_) => (5, 0, 0.0, 0.0),
    };
    println!(
        "self-test {verdict} effect {effect}{}{}",
        bits(value),
        bits(expected_s)
    );
}

fn print_fit(model: &Model, fit: &Fit) {
    let adequacy = fit.is_adequate().map_or(2, i32::from);
    println!(
        "adequacy {adequacy} degrees {}{}{}",
        fit.degrees_of_freedom,
        bits(fit.chi_squared),
        bits(fit.p_value)
    );
    for (coefficient, term) in fit.coefficients.iter().zip(model.terms()) {
        let state = match coefficient.state {
            State::Measured => 0,
            State::UpperBound => 1,
            State::NotObservable { .. } => 2,
        };
        let numbers = [coefficient.value, coefficient.lower, coefficient.upper].map(bits);
        println!("  {} state {state}{}", term.effect.name(), numbers.concat());
    }
    for shape in &fit.shape {
        let numbers = [shape.value, shape.lower, shape.upper].map(bits);
        println!("  {}{}", shape.name, numbers.concat());
    }
}

fn print_sum(what: &str, bytes: &[u8]) {
    let add = |sum: u32, byte: &u8| sum.wrapping_mul(31).wrapping_add((*byte).into());
    println!(
        "{what} bytes {} sum {}",
        bytes.len(),
        bytes.iter().fold(0, add)
    );
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scale = Scale::new((1.0_f32 / 131.0).into(), 100.0)?;
    let kelvin = [Real::from(0.01_f32) / Lags::<4>::PER_COUNT as Real; 4];
    let mut sensor = Sensor {
        seed: 1,
        sine: 0,
        cosine: 4096,
        inside: 2500 * 65_536,
    };
    // The temperature as it is, and behind lags of 10, 41 and 164 s.
    let mut lags = Lags::new([0, 10, 12, 14]);
    let mut gyro = Box::new(Gyro::new());
    let mut tests = [self_test(scale)?];
    let mut buffer = vec![0; Gyro::snapshot_bytes(1)];
    let mut stored = Vec::new();
    for n in 0..SAMPLES {
        let (counts, temperature) = sensor.sample(n);
        gyro.push((counts, lags.push(temperature)));
        while gyro.advance() {}
        if tests[0].is_due(gyro.samples()) {
            let x = gyro.record_so_far(0, (scale, kelvin))?;
            print_status(tests[0].look(&x)?);
        }
        if n == SNAPSHOT {
            stored = gyro.snapshot(&tests, &mut buffer)?.to_vec();
            print_sum("snapshot", &stored);
        }
        if n == POWER_LOSS {
            gyro.reset();
            lags = Lags::new([0, 10, 12, 14]);
            tests = [self_test(scale)?];
            gyro.restore(&mut tests, &stored)?;
            gyro.lost((POWER_LOSS - SNAPSHOT).into());
        }
    }
    gyro.release();
    println!("kept {} left out {}", gyro.samples(), gyro.left_out());

    let x: Record = gyro.record_so_far(0, (scale, kelvin))?;
    let model = Model::ieee_952();
    print_fit(&model, &fit(&x, &model, fit::Options::default())?);
    let mut diagnosis = Diagnosis::new(&x, &model, &CATALOGUE, Options::default());
    let mut axis = AxisCertificate::empty();
    let mut dependence = None;
    let mut pauses = 0;
    let mut count = || {
        pauses += 1;
        ControlFlow::Continue(())
    };
    let verdict = loop {
        match diagnosis.advance(&mut count)? {
            Progress::Paused => {}
            Progress::Step(step) => {
                print_fit(&step.model, &step.fit);
                if let Some(Addition::Covariate(followed)) = &step.added {
                    dependence = followed.dependence(&lags, 100.0);
                }
                axis.take(&x, step)?;
            }
            Progress::Finished(verdict) => break verdict,
        }
    };
    let code = match verdict {
        Verdict::Adequate => 2,
        Verdict::Improved => 3,
        Verdict::Incomplete => 4,
        Verdict::Unexplained => 5,
        Verdict::TooShort => 6,
        Verdict::Invalid(_) => 7,
        _ => 8,
    };
    println!("verdict {code} pauses {pauses}");
    let follows = dependence.map_or([Real::NAN; 4], |it| {
        let error_s = it.lag_error_s.unwrap_or(Real::NAN);
        [it.slope.value, it.slope.error, it.lag_s, error_s]
    });
    println!("follows the temperature{}", follows.map(bits).concat());

    axis.verdict = Some(verdict);
    let conditions = Conditions {
        temperature_c: Some((25.0, 27.5)),
        duration_s: 655.36,
        rate_hz: 100.0,
        samples: gyro.samples(),
        gaps: 1,
    };
    let unit = RateUnit::DegreesPerSecond;
    let mut certificate = Certificate::new(b"SN-7", [1, 2, 3], conditions, unit)?;
    certificate
        .axes
        .push(axis)
        .map_err(|_| "no room for an axis")?;
    let mut buffer = [0; Certificate::MAX_BYTES];
    print_sum("certificate", certificate.encode(&mut buffer)?);
    Ok(())
}
