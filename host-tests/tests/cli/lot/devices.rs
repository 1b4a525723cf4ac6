//! A lot of simulated devices with known coefficients, some of which are bad on purpose.

use allanite::{
    Accumulator, Model, Scale,
    diagnosis::Options,
    effect::CATALOGUE,
    storage::{AxisCertificate, Certificate, Conditions, RateUnit},
};
use allanite_host::{
    diagnosis::diagnose,
    simulate::{Coefficients, Preset, Random, Simulator},
};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use std::fs;
use tempfile::TempDir;

pub(crate) const DEVICES: u64 = 500;
/// The first so many devices have earlier certificates.
pub(crate) const BEFORE: u64 = 250;
const SAMPLES: usize = 1 << 14;
const RATE_HZ: f64 = 100.0;

/// By how much the coefficients of a lot scatter, relative to the preset `mems`: 6 % in a triangle of ±15 %.
fn spread(device: u64) -> f64 {
    let mut random = Random::seed_from_u64(device);
    let [one, other] = [(); 2].map(|()| random.random::<f64>());
    1.0 + 0.15 * (one - other)
}

/// Every 50th device is an outlier: its white noise is twice that of the others.
pub(crate) fn is_noisy(device: u64) -> bool {
    device % 50 == 7
}

/// Every 100th device has five times the bias instability of the others.
pub(crate) fn is_unstable(device: u64) -> bool {
    device % 100 == 63
}

/// Every 100th device has drifted: its white noise is a quarter larger than it was.
pub(crate) fn has_become_noisy(device: u64) -> bool {
    device % 100 == 31
}

/// Every 100th device has drifted: its rate random walk, which did not show, is forty times as large as it was.
pub(crate) fn has_begun_to_walk(device: u64) -> bool {
    device % 100 == 77
}

/// Every 100th device has a line.
pub(crate) fn has_line(device: u64) -> bool {
    device % 100 == 91
}

/// The coefficients of a device, at first and now.
pub(crate) fn truth(device: u64, now: bool) -> Coefficients {
    let usual = Preset::Mems.coefficients();
    let factor = |is_so: bool, factor: f64| if is_so { factor } else { 1.0 };
    let white = if is_noisy(device) {
        2.0
    } else {
        spread(device)
    };
    Coefficients {
        angle_random_walk: white
            * factor(now && has_become_noisy(device), 1.25)
            * usual.angle_random_walk,
        bias_instability: factor(is_unstable(device), 5.0) * usual.bias_instability,
        rate_random_walk: factor(now && has_begun_to_walk(device), 40.0) * usual.rate_random_walk,
        ..usual
    }
}

pub(crate) fn name(device: u64) -> String {
    format!("SN-{device:04}")
}

/// The certificate of a device with these coefficients, and with a line of this amplitude, as its diagnosis writes it.
pub(crate) fn certificate(device: u64, truth: Coefficients, line: f64, seed: u64) -> Certificate {
    let quantum = 1e-5;
    let mut accumulator = Accumulator::<17>::new();
    let rates = Simulator::new(truth, RATE_HZ, seed).take(SAMPLES);
    for (n, rate) in rates.enumerate() {
        let phase = std::f64::consts::TAU * 7.7 * n as f64 / RATE_HZ;
        accumulator.push(((rate + line * phase.sin()) / quantum).round() as i32);
    }
    let curve = accumulator.curve(Scale::new(quantum, RATE_HZ).unwrap());
    let (model, options) = (Model::ieee_952(), Options::default());
    let mut axis = AxisCertificate::empty();
    let mut taken = Ok(());
    let verdict = diagnose(&curve, &model, &CATALOGUE, options, |step| {
        taken = axis.take(&curve, step);
    });
    taken.unwrap();
    axis.verdict = Some(verdict.unwrap());
    let conditions = Conditions {
        temperature_c: None,
        duration_s: SAMPLES as f64 / RATE_HZ,
        rate_hz: RATE_HZ,
        samples: SAMPLES as u64,
        gaps: 0,
    };
    let (id, unit) = (name(device), RateUnit::DegreesPerSecond);
    let mut certificate = Certificate::new(id.as_bytes(), [1, 0, 0], conditions, unit).unwrap();
    certificate.axes.push(axis).unwrap();
    certificate
}

pub(crate) fn encoded(certificate: &Certificate) -> Vec<u8> {
    let mut buffer = vec![0; Certificate::MAX_BYTES];
    certificate.encode(&mut buffer).unwrap().to_vec()
}

/// A folder with the certificates of a lot, and with the earlier ones of some of its devices.
pub(crate) struct Lot {
    pub(crate) folder: TempDir,
    pub(crate) now: Vec<String>,
    pub(crate) before: Vec<String>,
}

/// Measures these devices, of which the first so many have been measured before.
pub(crate) fn lot(
    devices: u64,
    before: u64,
    certificate: impl Fn(u64, bool) -> Certificate + Sync,
) -> Lot {
    let folder = TempDir::new().unwrap();
    let file = |kind: &str, device: u64| format!("{kind}-{}.bin", name(device));
    let write = |file: String, certificate: Certificate| {
        fs::write(folder.path().join(file), encoded(&certificate)).unwrap();
    };
    (0..devices).into_par_iter().for_each(|device| {
        write(file("now", device), certificate(device, true));
        if device < before {
            write(file("before", device), certificate(device, false));
        }
    });
    Lot {
        folder,
        now: (0..devices).map(|device| file("now", device)).collect(),
        before: (0..before).map(|device| file("before", device)).collect(),
    }
}
