//! Studies what the host's diagnosis says of a temperature that the rate follows with a lag.

use super::quantum;
use allanite::{
    Axis, Curve, Model, Record, Scale,
    course::{self, CosineTransform},
    diagnosis::{Options, Step},
    effect::CATALOGUE,
    spectrum::Spectrum,
};
use allanite_host::{
    confidence::TWO_SIDED_95,
    dependence::candidates::{Candidates, Form},
    diagnosis,
    simulate::{Preset, Random, Simulator},
    tried::tried,
};
use allanite_log::{
    BINS, Evidence, OCTAVES, SpectrumSums,
    block_means::{BlockMeans, BlockSums},
};
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rayon::prelude::*;
use std::f64::consts::PI;

/// The sampling rate of these records, in Hz, and their number of samples: 55 minutes.
pub const RATE_HZ: f64 = 20.0;
/// The number of samples of a record.
pub const SAMPLES: usize = 1 << 16;
/// The size of a count of the temperature, in kelvin.
const KELVIN: f64 = 1e-3;

/// The name of the column, by which it is known as a temperature.
const COLUMN: &str = "temp_C";

/// The course of a temperature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Course {
    /// A rise of 10 K with a time constant of 200 to 900 s.
    WarmUp,
    /// ±3 K with a period of 20 min.
    SlowCycle,
    /// ±2 K with a period of 200 to 400 s.
    FastCycle,
    /// A random walk of 0.05 K/√s.
    Walk,
    /// A ramp of 6 K an hour.
    Ramp,
}

impl Course {
    /// All courses.
    pub const ALL: [Self; 4] = [Self::WarmUp, Self::SlowCycle, Self::FastCycle, Self::Walk];
}

/// What is drawn for a record.
#[derive(Clone, Copy, Debug)]
pub struct Truth {
    /// The course of the temperature.
    pub course: Course,
    /// The slope in deg/s/K; zero for no dependence.
    pub slope: f64,
    /// The slope on the square of the temperature less its mean, in deg/s/K².
    pub square: f64,
    /// The lag in seconds.
    pub lag_s: f64,
    /// White noise of the thermometer, in kelvin.
    pub noise: f64,
    /// The steps of the thermometer, in kelvin.
    pub step: f64,
}

/// How a rate depends on the temperature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dependence {
    /// Not at all.
    None,
    /// At once.
    AtOnce,
    /// With a lag of 10 to 120 s.
    Lagged,
    /// At once, and on the square as well.
    Square,
    /// At once, by a thirtieth to a third of the others.
    Weak,
}

/// A simulated record.
struct Simulated {
    curve: Curve<OCTAVES>,
    spectrum: Spectrum<BINS>,
    densities: Option<CosineTransform>,
    evidence: Evidence,
    truth: Truth,
}

/// A record of a preset, drawn with a seed.
fn simulated(
    preset: Preset,
    course: Course,
    dependence: Dependence,
    steps: Option<f64>,
    seed: u64,
) -> Simulated {
    let base = preset.coefficients();
    let mut random = Random::seed_from_u64(seed ^ 0x7e3a_91d4);
    let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    let (lag, period, time) = (
        10.0 * 12_f64.powf(between(0.0, 1.0)),
        between(200.0, 400.0),
        between(200.0, 900.0),
    );
    let is_coarse = between(0.0, 1.0) < 0.5;
    let noise = match steps {
        Some(_) => 0.02,
        None => between(0.0, 0.2),
    };
    // Some times the white noise of one second, so that a change of a few kelvin stands out.
    let slope = between(2.0, 6.0) * base.angle_random_walk;
    let slope = match dependence {
        Dependence::Weak => slope * 0.3 * 0.1_f64.powf(between(0.0, 1.0)),
        _ => slope,
    };
    let truth = Truth {
        course,
        slope: if dependence == Dependence::None {
            0.0
        } else {
            slope
        },
        square: if dependence == Dependence::Square {
            0.3 * slope
        } else {
            0.0
        },
        lag_s: if dependence == Dependence::Lagged {
            lag
        } else {
            0.0
        },
        noise,
        step: steps.unwrap_or(if is_coarse { 0.1 } else { KELVIN }),
    };
    let mut walk = 0.0;
    let mut temperature: Vec<f64> = Vec::new();
    for n in 0..SAMPLES {
        let t = n as f64 / RATE_HZ;
        walk += 0.05 / RATE_HZ.sqrt() * random.sample::<f64, _>(StandardNormal);
        temperature.push(match course {
            Course::WarmUp => -10.0 * (-t / time).exp_m1(),
            Course::SlowCycle => 3.0 * (2.0 * PI * t / 1200.0).sin(),
            Course::FastCycle => 2.0 * (2.0 * PI * t / period).sin(),
            Course::Walk => walk,
            Course::Ramp => 6.0 * t / 3600.0,
        });
    }
    let mean = temperature.iter().sum::<f64>() / SAMPLES as f64;
    let mut behind = temperature[0];
    let mut simulator = Simulator::new(base, RATE_HZ, seed);
    let unit = quantum(base, RATE_HZ);
    let (mut counts, mut kelvins) = (Vec::new(), Vec::new());
    for &x in &temperature {
        behind = match truth.lag_s > 0.0 {
            true => behind + (x - behind) / (truth.lag_s * RATE_HZ),
            false => x,
        };
        let rate = simulator.next().unwrap_or_default()
            + truth.slope * behind
            + truth.square * (behind - mean).powi(2);
        counts.push((rate / unit).round() as i32);
        let told = 25.0 + x + truth.noise * random.sample::<f64, _>(StandardNormal);
        let told = (told / truth.step).round() * truth.step;
        kelvins.push((told / KELVIN).round() as i32);
    }
    let mut axis = Axis::<OCTAVES, 1, (), ()>::new();
    for (&count, &kelvin) in counts.iter().zip(&kelvins) {
        axis.push((count, [kelvin]));
    }
    let mut spectrum = SpectrumSums::new();
    spectrum.push_slice(&counts);
    let mut sums = course::Course::<0>::new();
    sums.push_slice(&counts);
    let mut blocks = BlockSums::new(2);
    blocks.push(&[counts, kelvins]);
    let scale = Scale::new(unit, RATE_HZ).expect("positive");
    let told = axis.record_so_far(0, (scale, [KELVIN])).expect("one axis");
    let means = BlockMeans {
        samples: blocks.samples(),
        block_s: f64::from(blocks.samples()) / RATE_HZ,
        broken: blocks.broken().into(),
        rate: blocks.means(0).map(|mean| mean * unit).collect(),
        columns: [(
            COLUMN.to_owned(),
            blocks.means(1).map(|mean| mean * KELVIN).collect(),
        )]
        .into(),
    };
    let cross = told.covariates.into_iter().next().expect("one covariate");
    Simulated {
        curve: told.curve,
        spectrum: spectrum.spectrum(scale),
        densities: sums.cosine_transform(scale),
        evidence: Evidence {
            covariates: vec![(COLUMN.to_owned(), cross)],
            means: Some(means),
            ..Evidence::default()
        },
        truth,
    }
}

/// What the diagnosis says of one record.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What was drawn.
    pub truth: Truth,
    /// The names of what the rate is said to follow, each with its slope and the error of the slope.
    pub follows: Vec<(String, f64, f64)>,
    /// The lag that is told, with its interval.
    pub lag: Option<(f64, f64, f64)>,
    /// Whether the square is told.
    pub square: bool,
    /// Whether the rate of change is told beside the value or alone.
    pub rate_of_change: bool,
    /// The effects that were named beside the temperature and kept.
    pub named: Vec<&'static str>,
    /// The largest slope that is said not to be excluded, where no dependence is told.
    pub most: Option<f64>,
}

/// Diagnoses one record as the command line does.
pub fn diagnose(
    preset: Preset,
    course: Course,
    dependence: Dependence,
    steps: Option<f64>,
    seed: u64,
) -> Outcome {
    let record = simulated(preset, course, dependence, steps, seed);
    let model = Model::ieee_952();
    let (curve, spectrum) = (&record.curve, &record.spectrum);
    let candidates = Candidates::new(curve, spectrum, &model, &record.evidence);
    let candidates = candidates.expect("a curve to fit");
    let told = Record {
        course: record.densities.as_ref(),
        ..candidates.record(curve, spectrum)
    };
    let mut last = None;
    let report = |step: &Step<OCTAVES, BINS>| last = Some(step.clone());
    diagnosis::diagnose(told, &model, &CATALOGUE, Options::default(), report)
        .expect("a curve to diagnose");
    let last = last.expect("a step");
    let followed = last.covariate.as_ref();
    let slopes = followed.map_or(Vec::new(), |followed| candidates.slopes(followed));
    let has = |is: fn(&Form) -> bool| slopes.iter().any(|(_, one)| is(&one.form));
    let lag = slopes.iter().find_map(|(_, one)| match &one.form {
        Form::Behind(lag) => Some((lag.lag_s, lag.lower_s, lag.upper_s)),
        _ => None,
    });
    let names = last.model.terms().iter().map(|term| term.effect.name());
    let most = tried(curve, &candidates, &last)
        .iter()
        .find_map(|tried| tried.most(COLUMN));
    Outcome {
        most,
        truth: record.truth,
        follows: slopes
            .iter()
            .map(|(slope, one)| (one.name.clone(), slope.value, slope.error))
            .collect(),
        lag,
        square: has(|form| matches!(form, Form::Square { .. })),
        rate_of_change: has(|form| matches!(form, Form::RateOfChange)),
        named: names
            .filter(|name| model.position(name).is_none())
            .collect(),
    }
}

/// Counts over the records of one case.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// Records.
    pub records: usize,
    /// Those in which the rate is said to follow the temperature in any form.
    pub found: usize,
    /// Those in which a lag is told, and in which the rate of change or the square is.
    pub lagged: usize,
    /// See `lagged`.
    pub rate_of_change: usize,
    /// See `lagged`.
    pub square: usize,
    /// Those in which the interval of the first slope has the true one.
    pub slope_inside: usize,
    /// Those in which the interval of the lag has the true one.
    pub lag_inside: usize,
    /// Those in which an effect is named that the record does not have.
    pub wrong: usize,
    /// Those without a dependence that say how large one may be, and those of them in which the true one is no larger.
    pub bounded: usize,
    /// See `bounded`.
    pub bound_holds: usize,
}

/// Counts over the records of one case. The thermometer has steps of so many kelvin, or is drawn.
pub fn study(
    preset: Preset,
    course: Course,
    dependence: Dependence,
    steps: Option<f64>,
    records: u64,
) -> Tally {
    let one = |seed: u64| Tally::of(&diagnose(preset, course, dependence, steps, seed));
    let outcomes = (0..records).into_par_iter().map(one);
    outcomes.reduce(Tally::default, Tally::plus)
}

impl Tally {
    fn of(outcome: &Outcome) -> Self {
        let truth = outcome.truth;
        let slope_inside = |&(_, value, error): &(String, f64, f64)| {
            (value - truth.slope).abs() <= TWO_SIDED_95 * error
        };
        let lag_inside =
            |(_, lower, upper): (f64, f64, f64)| (lower..=upper).contains(&truth.lag_s);
        Self {
            records: 1,
            found: usize::from(!outcome.follows.is_empty()),
            lagged: usize::from(outcome.lag.is_some()),
            rate_of_change: usize::from(outcome.rate_of_change),
            square: usize::from(outcome.square),
            slope_inside: usize::from(outcome.follows.first().is_some_and(slope_inside)),
            lag_inside: usize::from(outcome.lag.is_some_and(lag_inside)),
            wrong: usize::from(!outcome.named.is_empty()),
            bounded: usize::from(outcome.most.is_some()),
            bound_holds: usize::from(outcome.most.is_some_and(|most| truth.slope <= most)),
        }
    }

    const fn plus(self, other: Self) -> Self {
        Self {
            records: self.records + other.records,
            found: self.found + other.found,
            lagged: self.lagged + other.lagged,
            rate_of_change: self.rate_of_change + other.rate_of_change,
            square: self.square + other.square,
            slope_inside: self.slope_inside + other.slope_inside,
            lag_inside: self.lag_inside + other.lag_inside,
            wrong: self.wrong + other.wrong,
            bounded: self.bounded + other.bounded,
            bound_holds: self.bound_holds + other.bound_holds,
        }
    }
}
