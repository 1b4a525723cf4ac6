//! Everything that a product does with three axes and every part of the library. Samples pass through a queue
//! that overflows now and then, together with a temperature, which the first axis follows late. Three samples are corrupt, the gyro is moved
//! once, and the power fails once after a snapshot. At the end there are a verdict of the self-test and a
//! diagnosis.

use super::{AMPLITUDES, lines, simulated::SimulatedGyro};
use allanite::{
    Axes, Error, Model, Real, Scale,
    axis::{Courses, Gated, Moments, Sample, Spectral},
    course::analyse,
    covariate::Lags,
    diagnosis::{Addition, Diagnosis, Options, Step},
    effect::CATALOGUE,
    fit,
    queue::{self, Queued},
    self_test::{Limit, Plan, SelfTest},
    storage,
};
use core::{fmt::Arguments, ops::ControlFlow};
use heapless::{Vec, spsc::Queue};

/// The number of octaves of averaging time.
pub const OCTAVES: usize = 16;

/// Three axes and a temperature as it is and behind a lag, with a gate, fourth moments, a spectrum and the course.
pub type Gyro = Axes<OCTAVES, 2, Gated, Moments, 3, Spectral<64, 7, 84>, Courses>;

/// The number of samples that the sensor makes: 11 minutes.
pub const SAMPLES: u32 = 1 << 16;

/// The seed of the first axis' noise. Each further axis adds one.
const SEED: u64 = 3952;
/// The sample, the axis and the count of each corruption on the bus.
const SPIKES: [(u32, usize, i32); 3] = [(9000, 0, 20_000), (21_000, 1, -9000), (33_000, 2, 32_767)];
/// The samples during which the second axis turns.
const MOTION: core::ops::Range<u32> = 40_000..40_500;
/// The sample at which a snapshot is taken.
const SNAPSHOT: u32 = 50_000;
/// The sample at which the power fails.
const POWER_LOSS: u32 = 52_000;
/// The number of samples from one overflow of the queue to the next, and the number of samples that are
/// made while the main loop is late.
const LATE: (u32, u32) = (7000, 40);
/// The number of samples that are usually made before the main loop takes them.
const USUAL: u32 = 8;

const RATE_HZ: Real = 100.0;
/// The scale of the temperature in kelvin per count.
const KELVIN: Real = 0.01;
/// The temperature as it is, and behind a lag of 20 s. The lag of the first axis is between the two.
const BANK: [u32; 2] = [0, 11];
const LAG: u32 = 10;
/// The scale of the covariates.
const UNITS: [Real; 2] = [KELVIN / Lags::<2>::PER_COUNT as Real; 2];

/// Three simulated gyros and a thermometer.
pub(super) struct Sensor {
    gyros: [SimulatedGyro; 3],
    made: u32,
    /// The temperature that the first axis follows.
    inside: Lags<1>,
}

impl Sensor {
    /// The first axis follows the temperature with a lag of 2^`log2` samples, or at once if it is 0.
    pub(super) fn new(log2: u32) -> Self {
        Self {
            inside: Lags::new([log2]),
            gyros: [0, 1, 2].map(|axis| SimulatedGyro::new(AMPLITUDES, SEED + axis)),
            made: 0,
        }
    }

    /// The number of samples that were made.
    pub(super) fn made(&self) -> u32 {
        self.made
    }

    pub(super) fn sample(&mut self) -> Sample<3, 1> {
        let n = self.made;
        self.made += 1;
        let mut counts = [0; 3];
        for (count, gyro) in counts.iter_mut().zip(&mut self.gyros) {
            *count = gyro.next().unwrap_or(0);
        }
        // The temperature rises by ten kelvin and falls again within eleven minutes. The first axis follows
        // it by 0.06 °/s per kelvin.
        let half = SAMPLES / 2;
        let temperature = (n.min(SAMPLES.saturating_sub(n)) * 1000 / half) as i32;
        let [inside] = self.inside.push(temperature);
        counts[0] += (inside >> 8) * 8 / 100;
        if MOTION.contains(&n) {
            counts[1] += 3000;
        }
        for (at, axis, count) in SPIKES {
            if at == n {
                counts[axis] = count;
            }
        }
        (counts, [temperature]).into()
    }
}

/// The self-test of the first axis.
pub(super) fn self_test(scale: Scale) -> Option<SelfTest<OCTAVES>> {
    let limit = Limit {
        effect: "angle_random_walk",
        most: 0.00495,
    };
    let mut limits = Vec::new();
    limits.push(limit).ok()?;
    let plan = Plan {
        limits,
        least_p: 0.0,
        false_pass: 0.01,
        false_fail: 0.01,
        shortest_s: 10.0,
        longest_s: 640.0,
    };
    SelfTest::new(plan, scale).ok()
}

/// The reason why the product stopped. It is a defect, unless the snapshot does not fit its buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Failure {
    /// The plan of the self-test is not valid.
    Plan,
    /// The record cannot be fitted or diagnosed.
    Record(Error),
    /// The snapshot cannot be written or read.
    Storage(storage::Error),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Record(error)
    }
}

impl From<storage::Error> for Failure {
    fn from(error: storage::Error) -> Self {
        Self::Storage(error)
    }
}

/// Runs the product and reports its results line by line. `flash` holds the bytes that survive a loss of
/// power.
///
/// # Errors
/// [`Failure`].
pub fn run(
    gyro: &mut Gyro,
    flash: &mut [u8],
    mut line: impl FnMut(Arguments<'_>),
) -> Result<(), Failure> {
    let scale = Scale::new(1.0 / 131.0, RATE_HZ)?;
    let mut sensor = Sensor::new(LAG);
    let mut lags = Lags::new(BANK);
    let mut tests = [self_test(scale).ok_or(Failure::Plan)?];
    let mut stored: &[u8] = &[];
    let mut flash = Some(flash);
    let mut lost_power = false;
    let mut queue = Queue::<Queued<Sample<3, 1>>, 16>::new();
    let (mut interrupt, mut main_loop) = queue::split(&mut queue);
    while sensor.made < SAMPLES {
        // The interrupt sends these samples while the main loop is busy.
        let (every, late) = LATE;
        let more = if sensor.made % every < USUAL {
            late
        } else {
            USUAL
        };
        for _ in 0..more.min(SAMPLES - sensor.made) {
            interrupt.send(sensor.sample());
        }
        while let Some(Queued { sample, lost }) = main_loop.receive() {
            gyro.lost(lost.into());
            let [temperature] = sample.covariates;
            gyro.push((sample.counts, lags.push(temperature)));
        }
        // The main loop has nothing else to do.
        while gyro.advance() {}
        if tests[0].is_due(gyro.samples()) {
            let x = gyro.record_so_far(0, (scale, UNITS))?;
            let status = tests[0].look(&x)?;
            line(format_args!("look samples {} {status:?}", x.samples));
        }
        if sensor.made >= SNAPSHOT
            && let Some(buffer) = flash.take()
        {
            stored = gyro.snapshot(&tests, buffer)?;
            let sum = stored.iter().fold(0_u32, |sum, &byte| {
                sum.wrapping_mul(31).wrapping_add(byte.into())
            });
            line(format_args!("snapshot bytes {} sum {sum:x}", stored.len()));
        }
        if sensor.made >= POWER_LOSS && !lost_power {
            lost_power = true;
            gyro.reset();
            tests = [self_test(scale).ok_or(Failure::Plan)?];
            gyro.restore(&mut tests, stored)?;
            line(format_args!("restored samples {}", gyro.samples()));
        }
    }
    gyro.release();
    line(format_args!(
        "record samples {} left_out {} losses {}",
        gyro.samples(),
        gyro.left_out(),
        gyro.losses()
    ));
    for (axis, seen) in gyro.seen().into_iter().enumerate() {
        line(format_args!("axis {axis} seen {:?}", seen.tally()));
        lines::record(&gyro.record_so_far(axis, (scale, UNITS))?, &mut line);
    }
    let x = gyro.record_so_far(0, (scale, UNITS))?;
    let (model, options) = (Model::ieee_952(), Options::default());
    let mut diagnosis = Diagnosis::new(&x, &model, &CATALOGUE, options);
    // A product feeds its watchdog here, and takes the next samples.
    let mut pause = || ControlFlow::Continue(());
    let told = |step: &Step<_, _>| {
        lines::step(step, &mut line);
        if let Some(Addition::Covariate(followed)) = &step.added {
            lines::dependence(followed.dependence(&lags, RATE_HZ), &mut line);
        }
    };
    if let Some(verdict) = diagnosis.run(told, &mut pause)? {
        line(format_args!("verdict {verdict:?}"));
    }
    course(gyro, scale, &mut line)?;
    Ok(())
}

/// Prints the course of the second axis, and what happened in it.
#[inline(never)]
fn course(gyro: &Gyro, scale: Scale, line: &mut impl FnMut(Arguments<'_>)) -> Result<(), Error> {
    let [_, Some(course), _] = gyro.courses() else {
        return Ok(());
    };
    for block in course.blocks(scale) {
        lines::block(&block, &mut *line);
    }
    let y = gyro.record_so_far(1, (scale, UNITS))?;
    let analysis = analyse(
        &y.curve,
        &Model::ieee_952(),
        course,
        scale,
        fit::Options::default(),
    )?;
    for event in &analysis.events {
        line(format_args!("event {event:?}"));
    }
    line(format_args!("largest {:?}", analysis.largest));
    Ok(())
}
