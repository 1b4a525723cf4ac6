//! The work that is measured.

use crate::clock::Clock;
use allanite::effect::{
    CATALOGUE, DecimationFilter, Effect, GaussMarkov, LowPass, MAX_PARAMETERS, RandomTelegraph,
    Resonance, SampledShape, Sinusoid, padded,
};
use allanite::{
    Accumulator, Axes, Curve, Error, Model, Real, Record, Scale,
    axis::{CoursePart, GatePart, MomentPart, SpectrumPart},
    diagnosis::{self, Diagnosis, Verdict},
    fit::{Fit, Fitting, Options, fit},
    self_test::{Limit, Plan, SelfTest, Status},
    spectrum::{Bin, Spectrum, SpectrumAccumulator},
};
use core::{hint::black_box, ops::ControlFlow};
use demonstration::{
    AMPLITUDES,
    simulated::{Random, SimulatedGyro},
};

/// A push in a separate call. Its cost above that of [`nothing`] is the cost of the push.
#[inline(never)]
pub(crate) fn push<const OCTAVES: usize>(accumulator: &mut Accumulator<OCTAVES>, count: i32) {
    accumulator.push(count);
}

#[inline(never)]
pub(crate) fn nothing<const OCTAVES: usize>(accumulator: &mut Accumulator<OCTAVES>, count: i32) {
    black_box((accumulator, count));
}

/// The number of counts in memory, small enough to fit into 16 KiB.
const LENGTH: usize = 1024;
/// How often these counts are repeated for a mean.
pub(crate) const ROUNDS: i32 = 64;
const SAMPLES: f64 = ROUNDS as f64 * LENGTH as f64;

/// The counts of a gyro at rest.
fn counts() -> [i32; LENGTH] {
    let mut gyro = SimulatedGyro::new(AMPLITUDES, 1);
    core::array::from_fn(|_| gyro.next().unwrap_or(0))
}

/// The mean number of instructions of `work` for one count, including the loop around it.
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

/// The mean number of instructions of a sample of all axes with the given parts, including the loop.
pub(crate) fn mean_of_axes<const COVARIATES: usize, G, M, const AXES: usize, S, T>(
    clock: &Clock,
    rounds: i32,
) -> f64
where
    G: GatePart,
    M: MomentPart,
    S: SpectrumPart,
    T: CoursePart,
{
    let counts = counts();
    let mut axes = Axes::<20, COVARIATES, G, M, AXES, S, T>::new();
    let mut round = |n: i32| {
        for i in 0..LENGTH {
            let count = |axis| counts[(i + axis) % LENGTH];
            let temperature = n + i as i32 / 64;
            axes.push((core::array::from_fn(count), [temperature; COVARIATES]));
        }
    };
    round(0);
    let total = clock.instructions(|| (1..=rounds).for_each(&mut round));
    black_box(&axes);
    total / (f64::from(rounds) * LENGTH as f64)
}

/// The mean numbers of instructions of one count in the interrupt and in the main loop, for a spectrum.
pub(crate) fn mean_of_spectrum(clock: &Clock) -> [f64; 2] {
    /// The number of counts that wait when the main loop comes.
    const LATE: usize = 8;
    let counts = counts();
    let mut accumulator = SpectrumAccumulator::<64, 7>::new();
    let (mut interrupt, mut main_loop) = (0.0, 0.0);
    for _ in 0..ROUNDS {
        for counts in counts.chunks(LATE) {
            interrupt += clock.instructions(|| {
                for &count in counts {
                    accumulator.push(black_box(count));
                }
            });
            main_loop += clock.instructions(|| while accumulator.advance() {});
        }
    }
    black_box(&accumulator);
    [interrupt / SAMPLES, main_loop / SAMPLES]
}

/// A slice in a separate call. What surrounds it would otherwise change how it is compiled.
#[inline(never)]
fn push_slice<const OCTAVES: usize>(accumulator: &mut Accumulator<OCTAVES>, counts: &[i32]) {
    accumulator.push_slice(counts);
}

/// The mean number of instructions of one count in a slice.
pub(crate) fn mean_of_slices(clock: &Clock) -> f64 {
    let counts = counts();
    let mut accumulator = Accumulator::<24>::new();
    accumulator.push_slice(&counts);
    let total = clock.instructions(|| {
        for _ in 0..ROUNDS {
            push_slice(&mut accumulator, black_box(&counts));
        }
    });
    total / SAMPLES
}

/// The number of instructions of the most expensive sample near `deepest`. The counts are full-scale and of
/// random sign.
pub(crate) fn worst<const OCTAVES: usize>(clock: &Clock, deepest: u32) -> u64 {
    const AROUND: u32 = 256;
    /// The number of repetitions, which resolves half an instruction.
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

/// An effect that is hidden in a curve, with its shape and its coefficient.
pub(crate) type Hidden = (&'static dyn Effect, [Real; 2], Real);

/// The same with room for every shape parameter.
fn widened(hidden: &Hidden) -> (&'static dyn Effect, [Real; MAX_PARAMETERS], Real) {
    let (effect, parameters, coefficient) = *hidden;
    (effect, padded(parameters), coefficient)
}

/// The cases of `cargo xtask study hidden-effect`, and their names in the figures.
pub(crate) const HIDDEN: [(&str, &[Hidden]); 11] = [
    ("nothing", &[]),
    ("sinusoid_0_3_hz", &[(&Sinusoid, [0.3, 0.0], 0.005)]),
    ("sinusoid_7_7_hz", &[SINUSOID]),
    ("gauss_markov_0_1_s", &[(&GaussMarkov, [0.1, 0.0], 0.02)]),
    ("gauss_markov_1_s", &[(&GaussMarkov, [1.0, 0.0], 0.01)]),
    ("resonance_3_hz", &[(&Resonance, [3.0, 3.0], 0.02)]),
    ("low_pass", &[(&LowPass, [0.02, 0.0], 0.005)]),
    (
        "decimation_filter_1",
        &[(&DecimationFilter, [0.03, 1.0], 0.005)],
    ),
    (
        "decimation_filter_2",
        &[(&DecimationFilter, [0.03, 2.0], 0.005)],
    ),
    (
        "random_telegraph_0_1_s",
        &[(&RandomTelegraph, [0.1, 0.0], 0.02)],
    ),
    (
        "sinusoid_and_filter",
        &[SINUSOID, (&DecimationFilter, [0.03, 2.0], 0.005)],
    ),
];

/// The case whose diagnosis with a spectrum has the longest piece.
pub(crate) const HARDEST: &str = "sinusoid_0_3_hz";

/// An oscillation at 7.7 Hz.
pub(crate) const SINUSOID: Hidden = (&Sinusoid, [7.7, 0.0], 0.02);

/// The coefficients of the five terms of [`curve`], in the model's order.
const SMOOTH: [Real; 5] = [2.0e-4, 5.0e-3, 4.0e-3, 3.0e-4, 5.0e-6];

/// The spectrum of a gyro with all five terms and hidden effects, after 2^21 samples. Each bin deviates by
/// about its standard error.
pub(crate) fn spectrum<const B: usize>(hidden: &[Hidden]) -> Option<Spectrum<B>> {
    let levels = [(1, 65_535), (8, 8191), (64, 1023), (512, 127)];
    let bins = levels.iter().flat_map(|&(block, segments)| {
        (4..32).map(move |index| Bin {
            block,
            index,
            frequency_hz: 0.0,
            density: 0.0,
            segments,
            spectral_kurtosis: 1.0,
        })
    });
    let empty: Spectrum<B> = Spectrum::new(100.0, 64, bins).ok()?;
    let is_filter = |(effect, ..): &Hidden| effect.replaces().is_some();
    let is_replaced = |name: &str| name == "angle_random_walk" && hidden.iter().any(is_filter);
    let model = Model::ieee_952();
    let terms = model.terms().iter().zip(SMOOTH);
    let terms = terms.filter(|(term, _)| !is_replaced(term.effect.name()));
    let terms = terms.map(|(term, coefficient)| (term.effect, term.parameters, coefficient));
    let mut densities = [0.0; B];
    for (effect, parameters, coefficient) in terms.chain(hidden.iter().map(widened)) {
        for (sum, density) in densities.iter_mut().zip(empty.expected(effect, parameters)) {
            *sum += coefficient * coefficient * density;
        }
    }
    let mut random = Random::new(1);
    let bins = empty.bins().iter().zip(densities).map(|(bin, density)| {
        // Four uniform numbers have the variance 1/3.
        let bits = random.bits().to_le_bytes();
        let off = bits
            .iter()
            .map(|&byte| Real::from(byte) - 127.5)
            .sum::<Real>()
            / 147.8;
        let error = libm::sqrt(1.0 / demonstration::double(bin.effective_segments())) as Real;
        let density = density * (1.0 + off * error);
        Bin { density, ..*bin }
    });
    Spectrum::new(100.0, 64, bins).ok()
}

/// The curve of a gyro with all five terms and hidden effects. Each octave deviates by a few per cent.
pub(crate) fn curve<const OCTAVES: usize>(hidden: &[Hidden]) -> Option<Curve<OCTAVES>> {
    let mut offs = [0.3, -0.5, 0.9, -0.2, -0.7].iter().cycle();
    let next = |differences| offs.next().copied().unwrap_or(0.0) / (differences * 0.2 + 9.0);
    curve_of(&[1.0; 5], hidden, next)
}

/// The same with the squares of the coefficients multiplied, and with other deviations of an octave of so many differences.
pub(crate) fn curve_of<const OCTAVES: usize>(
    squares: &[Real; 5],
    hidden: &[Hidden],
    mut off: impl FnMut(Real) -> Real,
) -> Option<Curve<OCTAVES>> {
    let is_filter = |(effect, ..): &Hidden| effect.replaces().is_some();
    let [quantization, white, flicker, walk, ramp] = squares;
    let white = if hidden.iter().any(is_filter) {
        0.0
    } else {
        2.5e-5 * white
    };
    let octaves = (0..OCTAVES).map(|k| {
        let m = 1_u32 << k;
        let averaged = (1_u64 << k) as Real;
        let tau_s = averaged / 100.0;
        let smooth = 1.2e-7 * quantization / (tau_s * tau_s)
            + white / tau_s
            + 7.1e-6 * flicker
            + 3.0e-8 * walk * tau_s
            + 1.3e-11 * ramp * tau_s * tau_s;
        let more = hidden.iter().map(|&(effect, parameters, coefficient)| {
            let shape = SampledShape::known(0.01, parameters);
            coefficient * coefficient * effect.variance(averaged, &shape)
        });
        let smooth = smooth + more.sum::<Real>();
        let differences = (2_u64 << OCTAVES) / u64::from((m / 4).max(1)) - 7;
        (m, differences, smooth * (1.0 + off(differences as Real)))
    });
    Curve::new(100.0, octaves).ok()
}

#[inline(never)]
pub(crate) fn characterise<const OCTAVES: usize>(curve: &Curve<OCTAVES>) -> Result<Fit, Error> {
    fit(curve, &Model::ieee_952(), Options::default())
}

/// The verdict of a self-test on the noise of an accumulator, which keeps its limit by far.
#[inline(never)]
pub(crate) fn look<const OCTAVES: usize>(accumulator: &Accumulator<OCTAVES>) -> Option<Status> {
    let limit = Limit {
        effect: "angle_random_walk",
        most: 20.0,
    };
    let plan = Plan {
        limits: [limit].into_iter().collect(),
        least_p: 0.0,
        false_pass: 0.01,
        false_fail: 0.01,
        shortest_s: 1.0,
        longest_s: 256.0,
    };
    let scale = Scale::new(1.0, 100.0).ok()?;
    let mut test = SelfTest::new(plan, scale).ok()?;
    Some(test.look_at(accumulator, None))
}

/// Diagnoses the curve, and returns whether the diagnosis found an effect.
#[inline(never)]
pub(crate) fn diagnose<const OCTAVES: usize>(curve: &Curve<OCTAVES>, model: &Model) -> bool {
    let options = diagnosis::Options::default();
    let mut diagnosis = Diagnosis::new(curve, model, &CATALOGUE, options);
    let report = |step: &_| {
        black_box(step);
    };
    diagnosis.run(report, &mut go_on) == Ok(Some(Verdict::Improved))
}

/// A pause in which nothing is done.
fn go_on() -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Diagnoses the curve and the spectrum, and returns whether the diagnosis found an effect.
#[inline(never)]
pub(crate) fn diagnose_both<const OCTAVES: usize, const B: usize>(
    curve: &Curve<OCTAVES>,
    spectrum: &Spectrum<B>,
    model: &Model,
) -> bool {
    let options = diagnosis::Options::default();
    let record = Record::new(curve, spectrum);
    let mut diagnosis = Diagnosis::new(record, model, &CATALOGUE, options);
    let report = |step: &_| {
        black_box(step);
    };
    diagnosis.run(report, &mut go_on) == Ok(Some(Verdict::Improved))
}

/// The largest number of instructions between two pauses of a diagnosis, including its start and its end; `None`
/// if it fails.
#[inline(never)]
pub(crate) fn longest_stretch_of_diagnosis<const OCTAVES: usize, const B: usize>(
    clock: &Clock,
    curve: &Curve<OCTAVES>,
    spectrum: &Spectrum<B>,
    model: &Model,
) -> Option<f64> {
    let options = diagnosis::Options::default();
    let record = Record::new(curve, spectrum);
    let (mut longest, mut before) = (0, clock.now());
    let mut diagnosis = Diagnosis::new(record, model, &CATALOGUE, options);
    let mut pause = || {
        let now = clock.now();
        longest = longest.max(now - before);
        // The clock's own work is not counted.
        before = clock.now();
        ControlFlow::Continue(())
    };
    let report = |step: &_| {
        black_box(step);
    };
    diagnosis.run(report, &mut pause).ok()?;
    let _ = pause();
    Some(clock.instructions_of(longest))
}

/// The largest number of instructions between two returns of a fit; a look of the self-test consists of the
/// same pieces of work.
#[inline(never)]
pub(crate) fn longest_stretch_of_fit<const OCTAVES: usize>(
    clock: &Clock,
    curve: &Curve<OCTAVES>,
    model: &Model,
) -> Option<f64> {
    let mut fitting = Fitting::new(curve, model.clone(), Options::default());
    let mut longest = 0.0_f64;
    loop {
        let mut outcome = None;
        let stretch =
            clock.instructions(|| outcome = fitting.advance().ok().map(|fit| fit.is_some()));
        longest = longest.max(stretch);
        if outcome? {
            return Some(longest);
        }
    }
}
