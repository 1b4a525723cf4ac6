//! Studies whether a diagnosis finds a temperature that the rate depends on, and how often it
//! blames one that has no effect.

use super::{OCTAVES, quantum};
use allanite::{
    Axis, Model, Record, Scale, course,
    diagnosis::{Addition, Options},
    effect::CATALOGUE,
};
use allanite_host::{
    confidence::TWO_SIDED_95,
    diagnosis,
    simulate::{Coefficients, Course, Hidden, Preset, Simulator, Thermal},
};
use rayon::prelude::*;

/// The sampling rate of these records, in Hz. A record of 2^16 samples takes 55 minutes.
pub const RATE_HZ: f64 = 20.0;
/// The number of samples of a record.
pub const SAMPLES: usize = 1 << 16;
/// The slope, in rate units per kelvin.
pub const SLOPE: f64 = 0.01;
/// The size of a count of the temperature, in kelvin.
const KELVIN: f64 = 1e-3;

/// The name and the course of each temperature, its size in kelvin, and the standard error that
/// generalised least squares could reach on the full record of the preset "mems", in deg/s per
/// kelvin.
pub const CASES: [(&str, Course, f64, f64); 2] = [
    (
        "10 K warm-up, 600 s",
        Course::WarmUp { time_s: 600.0 },
        10.0,
        0.00171,
    ),
    (
        "±5 K cycle, 20 min",
        Course::Cycle { period_s: 1200.0 },
        5.0,
        0.00040,
    ),
];

/// The result of a diagnosis of one record.
pub struct Outcome {
    /// The slope and its standard error, if the temperature was found.
    pub slope: Option<(f64, f64)>,
    /// The effects that were named beside the temperature.
    pub named: Vec<&'static str>,
}

/// Diagnoses a record of a gyro whose rate depends on a temperature with `slope`. A slope of zero
/// means no dependence.
pub fn diagnose(
    base: Coefficients,
    hidden: &[Hidden],
    course: Course,
    kelvin: f64,
    slope: f64,
    seed: u64,
) -> Outcome {
    let thermal = Thermal {
        slope,
        kelvin,
        course,
    };
    let mut simulator = Simulator::with_hidden(base, hidden, RATE_HZ, seed);
    let unit = quantum(base, RATE_HZ);
    let mut gyro = Axis::<OCTAVES, 1, (), ()>::new();
    let mut course = course::Course::<0>::new();
    for n in 0..SAMPLES {
        let time_s = n as f64 / RATE_HZ;
        let rate = simulator.next().unwrap_or_default() + thermal.rate_at(time_s);
        let count = (rate / unit).round() as i32;
        let celsius = (thermal.celsius_at(time_s) / KELVIN).round() as i32;
        gyro.push((count, [celsius]));
        course.push(count, []);
    }
    let scale = Scale::new(unit, RATE_HZ).expect("positive");
    let evidence = gyro.record_so_far(0, (scale, [KELVIN])).expect("one axis");
    let course = course.cosine_transform(scale);
    let record = Record {
        course: course.as_ref(),
        covariates: &evidence.covariates,
        ..(&evidence.curve).into()
    };
    let mut outcome = Outcome {
        slope: None,
        named: Vec::new(),
    };
    let model = Model::ieee_952();
    let options = Options::default();
    let report = diagnosis::diagnose(record, &model, &CATALOGUE, options, |step| {
        match &step.added {
            Some(Addition::Covariate(followed)) => {
                outcome.slope = Some((followed.slope.value, followed.slope.error));
            }
            Some(Addition::Effect(term)) => {
                outcome.named.push(term.effect.name());
                outcome.named.extend(step.ambiguous.iter());
            }
            _ => {}
        }
    });
    report.expect("a curve to diagnose");
    outcome
}

/// The counts and errors over the records of one course.
#[derive(Clone, Copy, Debug)]
pub struct Tally {
    /// The standard deviation of the slopes.
    pub deviation: f64,
    /// The share of records in which the temperature is found.
    pub found: f64,
    /// The mean of the slopes, relative to the true one.
    pub mean: f64,
    /// The share of 95 % intervals that contain the true slope.
    pub coverage: f64,
    /// The mean standard error that the diagnosis claims.
    pub error: f64,
    /// The share of records in which the diagnosis blames a temperature that has no effect on the
    /// gyro.
    pub blamed: f64,
}

/// Studies one course with the preset "mems".
pub fn study(course: Course, kelvin: f64, records: u64) -> Tally {
    let base = Preset::Mems.coefficients();
    let slopes = |slope: f64| -> Vec<(f64, f64)> {
        let one = |seed| diagnose(base, &[], course, kelvin, slope, seed).slope;
        (0..records).into_par_iter().filter_map(one).collect()
    };
    let (found, blamed) = (slopes(SLOPE), slopes(0.0));
    let n = found.len().max(1) as f64;
    let inside = |&&(value, error): &&(f64, f64)| (value - SLOPE).abs() <= TWO_SIDED_95 * error;
    let mean = found.iter().map(|one| one.0).sum::<f64>() / n;
    let squares = found.iter().map(|one| (one.0 - mean).powi(2));
    Tally {
        deviation: (squares.sum::<f64>() / n).sqrt(),
        found: found.len() as f64 / records as f64,
        mean: mean / SLOPE,
        coverage: found.iter().filter(inside).count() as f64 / n,
        error: found.iter().map(|one| one.1).sum::<f64>() / n,
        blamed: blamed.len() as f64 / records as f64,
    }
}

/// The share of records of the preset "mems" in which both a temperature and strong Gauss–Markov
/// noise are found.
pub fn with_gauss_markov(course: Course, kelvin: f64, records: u64) -> f64 {
    let base = Preset::Mems.coefficients();
    let hidden = Hidden::new("gauss_markov", [1.0, 0.0], 0.05).expect("in the catalogue");
    let both = |&seed: &u64| {
        let outcome = diagnose(base, &[hidden], course, kelvin, 10.0 * SLOPE, seed);
        outcome.slope.is_some() && outcome.named.contains(&"gauss_markov")
    };
    let count = (0..records).into_par_iter().filter(both).count();
    count as f64 / records as f64
}
