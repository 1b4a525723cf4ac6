//! What is measured.

use crate::clock::Clock;
use crate::demonstration::{
    AMPLITUDES,
    simulated::{Random, SimulatedGyro},
};
use allanite::effect::{CATALOGUE, Effect as _, Setting, Sinusoid};
use allanite::{
    Accumulator, Axes, Curve, Diagnosis, Error, Evidence, Fit, GatePart, Model, MomentPart, Real,
    Settings, Verdict, fit,
};
use core::hint::black_box;

/// A push as a call of its own. What it costs beyond [`nothing`] is the push.
#[inline(never)]
pub(crate) fn push<const OCTAVES: usize>(accumulator: &mut Accumulator<OCTAVES>, count: i32) {
    accumulator.push(count);
}

#[inline(never)]
pub(crate) fn nothing<const OCTAVES: usize>(accumulator: &mut Accumulator<OCTAVES>, count: i32) {
    black_box((accumulator, count));
}

/// Counts that a mean is over, so few that 16 KiB have room for them, and how often they come.
const LENGTH: usize = 1024;
const ROUNDS: u32 = 64;
const SAMPLES: f64 = ROUNDS as f64 * LENGTH as f64;

/// Of a gyro at rest.
fn counts() -> [i32; LENGTH] {
    let mut gyro = SimulatedGyro::new(AMPLITUDES, 1);
    core::array::from_fn(|_| gyro.next().unwrap_or(0))
}

/// Mean instructions of what is done with every count, the loop around it included.
pub(crate) fn mean(clock: &Clock, work: fn(&mut Accumulator<24>, i32)) -> f64 {
    let counts = counts();
    let mut accumulator = Accumulator::<24>::new();
    accumulator.push_slice(&counts);
    let total = clock.instructions(|| {
        for _ in 0..ROUNDS {
            for &count in &counts {
                work(&mut accumulator, count);
            }
        }
    });
    total / SAMPLES
}

/// Mean instructions of a sample of three axes, with or without some parts, the loop around it included.
pub(crate) fn mean_of_axes<const COVARIATES: usize, G: GatePart, M: MomentPart>(
    clock: &Clock,
) -> f64 {
    let counts = counts();
    let mut axes = Axes::<20, COVARIATES, G, M>::new();
    let mut round = |n: i32| {
        for (i, &count) in (0..).zip(&counts) {
            let at = |behind: usize| counts[(i + behind) % LENGTH];
            axes.push(([count, at(1), at(2)], [n + i as i32 / 64; COVARIATES]));
        }
    };
    round(0);
    let total = clock.instructions(|| (1..=ROUNDS as i32).for_each(&mut round));
    black_box(&axes);
    total / SAMPLES
}

/// Mean instructions of a count in a slice.
pub(crate) fn mean_of_slices(clock: &Clock) -> f64 {
    let counts = counts();
    let mut accumulator = Accumulator::<24>::new();
    accumulator.push_slice(&counts);
    let total = clock.instructions(|| {
        for _ in 0..ROUNDS {
            accumulator.push_slice(black_box(&counts));
        }
    });
    total / SAMPLES
}

/// The most expensive sample of full-scale counts of random signs, of those around `deepest`.
pub(crate) fn worst<const OCTAVES: usize>(clock: &Clock, deepest: u32) -> u64 {
    const AROUND: u32 = 256;
    /// Resolves half an instruction.
    const REPETITIONS: u32 = 200;
    let mut random = Random::new(1);
    let mut count = || {
        if random.bits() & 1 == 0 {
            i32::MIN
        } else {
            i32::MAX
        }
    };
    let mut before = Accumulator::<OCTAVES>::new();
    for _ in 0..deepest - AROUND {
        before.push(count());
    }
    let mut scratch = before.clone();
    let mut total = |before: &Accumulator<OCTAVES>, count, work: fn(&mut Accumulator<_>, i32)| {
        clock.ticks(|| {
            for _ in 0..REPETITIONS {
                scratch.clone_from(black_box(before));
                work(&mut scratch, count);
            }
        })
    };
    let idle = total(&before, 0, nothing);
    let mut worst = 0;
    for _ in 0..2 * AROUND {
        let count = count();
        worst = worst.max(total(&before, count, push));
        before.push(count);
    }
    let instructions = clock.instructions_of(worst.saturating_sub(idle));
    (instructions / f64::from(REPETITIONS) + 0.5) as u64
}

/// Octaves of a gyro with all five terms, each off by a few per cent, and an oscillation at 7.7 Hz of
/// some amplitude.
pub(crate) fn curve<const OCTAVES: usize>(amplitude: Real) -> Option<Curve<OCTAVES>> {
    let octaves = (0..OCTAVES).map(|k| {
        let m = 1_u32 << k;
        let averaged = (1_u64 << k) as Real;
        let tau_s = averaged / 100.0;
        let smooth = 1.2e-7 / (tau_s * tau_s)
            + 2.5e-5 / tau_s
            + 7.1e-6
            + 3.0e-8 * tau_s
            + 1.3e-11 * tau_s * tau_s;
        let setting = Setting {
            parameters: [7.7, 0.0],
            ..Setting::new(0.01)
        };
        let wave = amplitude * amplitude * Sinusoid.variance(averaged, &setting);
        let smooth = smooth + wave;
        let differences = (2_u64 << OCTAVES) / u64::from((m / 4).max(1)) - 7;
        let off = [0.3, -0.5, 0.9, -0.2, -0.7][k % 5] / (differences as Real * 0.2 + 9.0);
        (m, differences, smooth * (1.0 + off))
    });
    Curve::new(100.0, octaves).ok()
}

#[inline(never)]
pub(crate) fn characterise<const OCTAVES: usize>(curve: &Curve<OCTAVES>) -> Result<Fit, Error> {
    fit(curve, &Model::ieee_952(), Settings::default())
}

/// Whether it finds something.
#[inline(never)]
pub(crate) fn diagnose<const OCTAVES: usize>(curve: &Curve<OCTAVES>, model: &Model) -> bool {
    let evidence = Evidence::NONE;
    let verdict = Diagnosis::default().run(curve, &evidence, model, &CATALOGUE, |step| {
        black_box(step);
    });
    verdict == Ok(Verdict::Improved)
}
