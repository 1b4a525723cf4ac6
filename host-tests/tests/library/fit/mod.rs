//! Tests the fit on exact curves, under changes of unit, at its optimum, and where it must refuse.

mod limits;
mod oracle;
mod recovery;

use allanite::{
    Curve, Model,
    fit::{Fit, Method, Options, fit},
};
use allanite_host::simulate::{Preset, record};

const OCTAVES: usize = record::OCTAVES;

const RATE_HZ: f64 = 100.0;

const METHODS: [Method; 5] = [
    Method::Ordinary,
    Method::AccuratePart,
    Method::RelativeAccuracy,
    Method::ClusterCount,
    Method::Covariance,
];

/// The coefficients Q, N, B, K and R. Each of them shows in some octave of a three-hour record.
const ALL: [f64; 5] = [2e-4, 5e-3, 4e-3, 3e-4, 3e-6];

fn settings(method: Method) -> Options {
    Options {
        method,
        ..Options::default()
    }
}

/// The expected curve of a gyro for a record of the given length.
fn exact(coefficients: [f64; 5], samples: u64, rate_hz: f64) -> Curve<OCTAVES> {
    let model = Model::ieee_952();
    let squares = coefficients.map(|x| x * x);
    let octave = |k: u32| {
        let m = 1_u64 << k;
        let differences = (samples.checked_sub(2 * m)?) / (m / 4).max(1) + 1;
        let variance = model.variance(&squares, m as u32, 1.0 / rate_hz);
        (differences >= 6).then_some((m as u32, differences, variance))
    };
    Curve::new(rate_hz, (0..OCTAVES as u32).map_while(octave)).expect("possible")
}

/// The same curve, with every variance multiplied by the factor of its octave.
fn changed(curve: &Curve<OCTAVES>, factor: impl Fn(usize) -> f64) -> Curve<OCTAVES> {
    let points = curve.points().iter().enumerate();
    let octaves = points.map(|(k, p)| (p.m, p.differences, p.variance * factor(k)));
    Curve::new(curve.rate_hz(), octaves).expect("possible")
}

/// The curve of a simulated record.
fn noisy(samples: usize, seed: u64) -> Curve<OCTAVES> {
    record::curve(Preset::Mems.coefficients(), samples, seed)
}

fn fitted(curve: &Curve<OCTAVES>, settings: Options) -> Fit {
    fit(curve, &Model::ieee_952(), settings).expect("a curve to fit")
}

fn assert_relative(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!(
        (found - expected).abs() <= tolerance * expected.abs(),
        "{what}: {found:e}, expected {expected:e}"
    );
}
