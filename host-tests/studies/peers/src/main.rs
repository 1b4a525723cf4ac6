//! Runs one of the crates on records for the study `peers`, as `peer.py` runs the Python packages:
//! `peers PEER TASK RATE SCALE FILE…`. A line of JSON is printed for each file, and one for the process at the end.

use allan::{Allan, DataType, Style};
use anyhow::{Context as _, Result, bail};
use imu_calib::allan::{AllanConfig, AllanEstimator, AllanResult, Sensor};
use rustix::time::{ClockId, clock_gettime};
use serde_json::{Value, json};
use std::{
    fs::{self, File},
    io::{BufReader, Read},
};

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [peer, task, rate, scale, files @ ..] = &arguments[..] else {
        bail!("the arguments are PEER TASK RATE SCALE FILE…");
    };
    let (rate, scale) = (rate.parse()?, scale.parse()?);
    for file in files {
        let found = match (peer.as_str(), task.as_str()) {
            ("allan", "octaves") => decades(file)?,
            ("allan", "same") => same(file)?,
            ("imu-calib", "octaves") => points(&clusters(file, 1.0, 1.0)?),
            ("imu-calib", "same") => points(&clusters(file, 1.0, 1.0)?),
            ("imu-calib", "fit") => coefficients(file, rate, scale)?,
            _ => bail!("{peer} has no {task}"),
        };
        println!("{found}");
    }
    println!(
        "{}",
        json!({ "cpu_s": cpu_s(), "peak_bytes": peak_bytes()? })
    );
    Ok(())
}

/// The counts of a NumPy file of 32-bit integers, one by one.
fn counts(file: &str) -> Result<impl Iterator<Item = f64>> {
    let mut reader = BufReader::with_capacity(1 << 16, File::open(file)?);
    let mut start = [0; 10];
    reader.read_exact(&mut start)?;
    // Version 1.0 has the length of the header in two bytes.
    let mut header = vec![0; usize::from(u16::from_le_bytes([start[8], start[9]]))];
    reader.read_exact(&mut header)?;
    let mut bytes = [0; 4];
    Ok(std::iter::from_fn(move || {
        reader.read_exact(&mut bytes).ok()?;
        Some(f64::from(i32::from_le_bytes(bytes)))
    }))
}

/// Fully overlapping deviations at 1, 2, 4 and 8 times powers of ten, up to an eighth of the record: the crate has no
/// octaves.
fn decades(file: &str) -> Result<Value> {
    let longest = samples(file)? / 8;
    let configuration = Allan::builder()
        .style(Style::Decade1248)
        .max_tau(longest as usize);
    let mut allan = configuration.data_type(DataType::Frequency).build_allan();
    counts(file)?.for_each(|count| allan.record(count));
    let taus = allan
        .iter()
        .filter_map(|tau| Some(json!([tau.tau(), tau.deviation()?])));
    Ok(taus.collect())
}

/// Deviations at every octave by the definition of the library: those of m = 4 over means of blocks of a quarter of a
/// cluster. The phase is handed over, because rates lose their last difference.
fn same(file: &str) -> Result<Value> {
    let counts: Vec<f64> = counts(file)?.collect();
    let mut found = Vec::new();
    for k in 0.. {
        let m = 1 << k;
        let block = (m / 4).max(1);
        if counts.len() < 2 * m {
            break;
        }
        let tau = m / block;
        let configuration = Allan::builder()
            .style(Style::SingleTau(tau as u32))
            .max_tau(tau);
        let mut allan = configuration.data_type(DataType::Phase).build_allan();
        let mut phase = 0.0;
        allan.record(phase);
        for counts in counts.chunks_exact(block) {
            phase += counts.iter().sum::<f64>() / block as f64;
            allan.record(phase);
        }
        let one = allan.get(tau).context("the only averaging time")?;
        found.push(json!([m, one.deviation()]));
    }
    Ok(found.into())
}

/// The deviations of six equal channels at octaves; the crate always takes six.
fn clusters(file: &str, rate: f64, scale: f64) -> Result<AllanResult> {
    let octaves = (samples(file)? / 2).ilog2();
    let configuration = AllanConfig {
        min_cluster_time: 1.0,
        max_cluster_time: f64::from(1 << octaves),
        num_clusters: octaves as usize + 1,
        min_pairs: 1,
    };
    estimated(
        file,
        AllanEstimator::with_rate(configuration, rate)?,
        rate,
        scale,
    )
}

fn estimated(
    file: &str,
    mut estimator: AllanEstimator,
    rate: f64,
    scale: f64,
) -> Result<AllanResult> {
    for (i, count) in (0..).zip(counts(file)?) {
        let rates = [scale * count; 3];
        estimator.push(f64::from(i) / rate, rates, rates);
    }
    estimator.finish()
}

fn points(result: &AllanResult) -> Value {
    let points = result.points.iter();
    points
        .map(|point| json!([point.tau.round() as u64, point.gyro[0]]))
        .collect()
}

/// N and K of the crate with its defaults, and its words where it has none.
fn coefficients(file: &str, rate: f64, scale: f64) -> Result<Value> {
    let estimator = AllanEstimator::with_rate(AllanConfig::default(), rate)?;
    let result = estimated(file, estimator, rate, scale)?;
    let white = result.noise_density_per_axis(Sensor::Gyro);
    let walk = result.random_walk_per_axis(Sensor::Gyro);
    let mut notes = Vec::new();
    let mut value = |found: Result<[f64; 3]>| match found {
        Ok(values) => Some(values[0]),
        Err(error) => {
            notes.push(error.to_string());
            None
        }
    };
    Ok(json!({ "N": value(white), "K": value(walk), "notes": notes }))
}

fn samples(file: &str) -> Result<u64> {
    // The header of a short shape takes 128 bytes.
    Ok((fs::metadata(file)?.len() - 128) / 4)
}

fn cpu_s() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

fn peak_bytes() -> Result<f64> {
    let status = fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.split_whitespace().next());
    Ok(1024.0
        * kib
            .context("Linux tells the peak of the memory")?
            .parse::<f64>()?)
}
