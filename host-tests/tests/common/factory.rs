//! Records of simulated gyros, like those that a factory would write.

use allanite::{
    Accumulator, Axis, Model, Scale,
    axis::{Courses, Gated, Moments, Spectral},
    course::events,
    diagnosis::Options,
    effect::CATALOGUE,
    storage::{AxisCertificate, Certificate, Conditions, RateUnit},
};
use allanite_host::diagnosis::diagnose;
use demonstration::{
    AMPLITUDES,
    simulated::{Disturbance, SimulatedGyro},
};

pub(crate) const SAMPLES: usize = 1 << 16;
pub(crate) const SINUSOID: Disturbance = Disturbance::Sinusoid {
    amplitude: 16 << 24,
    turn: 8_032_000,
};

pub(crate) type Counts = Accumulator<17>;

pub(crate) fn counts(disturbance: Option<Disturbance>, seed: u64) -> Counts {
    let mut accumulator = Counts::new();
    let gyro = SimulatedGyro::disturbed(AMPLITUDES, disturbance, seed);
    gyro.take(SAMPLES).for_each(|count| accumulator.push(count));
    accumulator
}

/// An axis with its fit and its diagnosis.
pub(crate) fn axis(disturbance: Option<Disturbance>, seed: u64) -> AxisCertificate {
    let curve = counts(disturbance, seed).curve(Scale::new(1.0 / 131.0, 100.0).unwrap());
    let (mut last, model) = (None, Model::ieee_952());
    let report =
        |step: &allanite::diagnosis::Step<17>| last = Some((step.model.clone(), step.fit.clone()));
    let options = Options::default();
    let verdict = diagnose(&curve, &model, &CATALOGUE, options, report).unwrap();
    let (model, fit) = last.unwrap();
    let mut axis = AxisCertificate::new(&curve, &model, &fit).unwrap();
    axis.verdict = Some(verdict);
    axis
}

/// An axis of a gyro that follows its temperature and has a line, with all that its diagnosis found.
pub(crate) fn followed() -> AxisCertificate {
    type Gyro = Axis<17, 1, Gated, Moments, Spectral<64, 4, 112>, Courses>;
    let scale = Scale::new(1.0 / 131.0, 100.0).unwrap();
    let mut gyro = Box::new(Gyro::new());
    let counts = SimulatedGyro::disturbed(AMPLITUDES, Some(SINUSOID), 6).take(SAMPLES);
    for (n, count) in (0..).zip(counts) {
        // A triangle of ±10 K with a period of 328 s, which the rate follows with 20 counts per kelvin.
        let temperature = ((n & 0x7fff) - 0x4000_i32).abs() / 8 - 1024;
        gyro.push(([count + temperature / 5], [temperature]));
        while gyro.advance() {}
    }
    let record = gyro.record(0, (scale, [0.01])).unwrap();
    let model = Model::ieee_952();
    let mut axis = AxisCertificate::empty();
    let mut taken = Ok(());
    let options = Options::default();
    let verdict = diagnose(&record, &model, &CATALOGUE, options, |step| {
        taken = axis.take(&record, step);
    });
    taken.unwrap();
    axis.verdict = Some(verdict.unwrap());
    let course = gyro.courses()[0].unwrap();
    axis.findings
        .set_events(&events(course, scale, &model, &[0.0; 5]));
    axis
}

pub(crate) fn record(device: &str, unit: RateUnit, axes: &[AxisCertificate]) -> Certificate {
    let conditions = Conditions {
        temperature_c: Some((22.5, 24.25)),
        duration_s: SAMPLES as f64 / 100.0,
        rate_hz: 100.0,
        samples: SAMPLES as u64,
        gaps: 0,
    };
    let mut record = Certificate::new(device.as_bytes(), [1, 2, 300], conditions, unit).unwrap();
    for axis in axes {
        record.axes.push(axis.clone()).unwrap();
    }
    record
}

pub(crate) fn encoded(record: &Certificate) -> Vec<u8> {
    let mut buffer = vec![0; Certificate::MAX_BYTES];
    record.encode(&mut buffer).unwrap().to_vec()
}
