//! Studies what a lot costs: a bench of thousands of devices, judged by the program with all its outputs.

use super::{OCTAVES, RATE_HZ, long::Program};
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
use anyhow::{Context, Result, bail};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use std::{
    fmt::Write as _,
    fs,
    io::Read,
    path::Path,
    process::{Command, Stdio},
    thread,
    time::{Duration, Instant},
};

/// The number of samples of an axis.
const SAMPLES: usize = 1 << 14;

/// The number of axes of a device.
pub const AXES: u64 = 3;

/// One device in so many has a log, and another one a curve file, instead of a certificate.
const OTHERS: u64 = 1000;

/// One device in so many was measured before.
const BEFORE: u64 = 5;

/// The quantum of the counts, in deg/s.
const QUANTUM: f64 = 1e-5;

/// How often the memory of the program is asked for.
const ASKED: Duration = Duration::from_millis(5);

/// What a device is read from.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Certificate,
    Curve,
    Log,
}

impl Kind {
    const fn of(device: u64) -> Self {
        match device % OTHERS {
            1 => Self::Curve,
            2 => Self::Log,
            _ => Self::Certificate,
        }
    }
}

/// The coefficients of an axis. Most scatter by 6 %; one device in 500 has twice the white noise. The mean of the production
/// rises by 5 % from the first device to the last one.
fn truth(device: u64, devices: u64, axis: u64, is_now: bool) -> Coefficients {
    let usual = Preset::Mems.coefficients();
    let mut random = Random::seed_from_u64(AXES * device + axis);
    let [one, other] = [(); 2].map(|()| random.random::<f64>());
    let mut factor = 1.0 + 0.15 * (one - other) + 0.05 * device as f64 / devices as f64;
    if device % 500 == 7 {
        factor *= 2.0;
    }
    if device % 500 == 5 && is_now {
        // It was measured before, and has drifted since.
        factor *= 1.25;
    }
    Coefficients {
        angle_random_walk: factor * usual.angle_random_walk,
        ..usual
    }
}

/// The rates of an axis.
fn rates(device: u64, devices: u64, axis: u64, is_now: bool) -> impl Iterator<Item = f64> {
    let seed = 2 * (AXES * device + axis) + u64::from(is_now);
    Simulator::new(truth(device, devices, axis, is_now), RATE_HZ, seed).take(SAMPLES)
}

fn name(device: u64) -> String {
    format!("SN-{device:05}")
}

/// The certificate of a device, as it writes it of itself.
fn certificate(device: u64, devices: u64, is_now: bool) -> Result<Vec<u8>> {
    let conditions = Conditions {
        temperature_c: Some((22.0, 24.0)),
        duration_s: SAMPLES as f64 / RATE_HZ,
        rate_hz: RATE_HZ,
        samples: SAMPLES as u64,
        gaps: 0,
    };
    let unit = RateUnit::DegreesPerSecond;
    let mut certificate = Certificate::new(name(device).as_bytes(), [1, 0, 0], conditions, unit)
        .map_err(|error| anyhow::anyhow!("{error}"))?;
    for axis in 0..AXES {
        let mut accumulator = Accumulator::<OCTAVES>::new();
        for rate in rates(device, devices, axis, is_now) {
            accumulator.push((rate / QUANTUM).round() as i32);
        }
        let scale = Scale::new(QUANTUM, RATE_HZ)?;
        let curve = accumulator.curve(scale);
        let mut certified = AxisCertificate::empty();
        let (model, options) = (Model::ieee_952(), Options::default());
        let mut taken = Ok(());
        let verdict = diagnose(&curve, &model, &CATALOGUE, options, |step| {
            let this = certified.take(&curve, step);
            taken = taken.and(this);
        })?;
        taken?;
        certified.verdict = Some(verdict);
        let pushed = certificate.axes.push(certified);
        pushed.map_err(|_| anyhow::anyhow!("too many axes"))?;
    }
    let mut buffer = vec![0; Certificate::MAX_BYTES];
    let encoded = certificate.encode(&mut buffer);
    Ok(encoded
        .map_err(|error| anyhow::anyhow!("{error}"))?
        .to_vec())
}

/// The log of a device.
fn log(device: u64, devices: u64) -> String {
    let axes: Vec<Vec<f64>> = (0..AXES)
        .map(|axis| rates(device, devices, axis, true).collect())
        .collect();
    let mut text = format!("# rate_hz={RATE_HZ} unit=deg/s\ngx,gy,gz\n");
    for row in 0..SAMPLES {
        let rounded = |axis: &Vec<f64>| (axis[row] / QUANTUM).round() * QUANTUM;
        let cells: Vec<String> = axes
            .iter()
            .map(|axis| format!("{:.5}", rounded(axis)))
            .collect();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}", cells.join(","));
    }
    text
}

/// Writes the files of so many devices into the folders `now` and `before`.
///
/// # Errors
/// When a file cannot be written, or a record cannot be measured.
pub fn write(folder: &Path, devices: u64, program: &Program) -> Result<()> {
    for part in ["now", "before", "logs"] {
        fs::create_dir_all(folder.join(part))?;
    }
    (0..devices).into_par_iter().try_for_each(|device| {
        let name = name(device);
        match Kind::of(device) {
            Kind::Certificate => {
                let file = folder.join(format!("now/{name}.bin"));
                fs::write(file, certificate(device, devices, true)?)?;
            }
            Kind::Log => fs::write(folder.join(format!("now/{name}.csv")), log(device, devices))?,
            Kind::Curve => fs::write(
                folder.join(format!("logs/{name}.csv")),
                log(device, devices),
            )?,
        }
        if device.is_multiple_of(BEFORE) {
            let file = folder.join(format!("before/{name}.bin"));
            fs::write(file, certificate(device, devices, false)?)?;
        }
        anyhow::Ok(())
    })?;
    let measured = (0..devices).filter(|device| Kind::of(*device) == Kind::Curve);
    for device in measured {
        let (log, curve) = (
            format!("logs/{}.csv", name(device)),
            format!("now/{}.json", name(device)),
        );
        program.run(folder, &["measure", &log, "--output", &curve])?;
    }
    Ok(())
}

/// What the program took, and what it said.
#[derive(Clone, Debug)]
pub struct Cost {
    /// The time by the clock, in s.
    pub wall_s: f64,
    /// The largest resident memory, in bytes; NaN where the system does not tell.
    pub peak_bytes: f64,
    /// The sizes of the files that were written, in bytes.
    pub sizes: Vec<(String, u64)>,
    /// The first lines of the text.
    pub said: Vec<String>,
}

/// Judges the devices in a folder, and writes the table and the page.
///
/// # Errors
/// When the program fails.
pub fn judge(folder: &Path, program: &Program) -> Result<Cost> {
    const OUTPUTS: [&str; 3] = ["lot.csv", "lot.parquet", "lot.html"];
    let begun = Instant::now();
    let mut command = Command::new(&program.file);
    command.current_dir(folder).args(&program.first);
    command.args([
        "--quiet",
        "lot",
        "--limit",
        "N=0.33°/√h",
        "--limit",
        "B=58°/h",
        "now",
    ]);
    command.args(["--earlier", "before"]);
    for output in OUTPUTS {
        command.args(["--output", output]);
    }
    let mut child = command.stdout(Stdio::piped()).spawn().context("allanite")?;
    let mut output = child.stdout.take().context("its output")?;
    // The text is shorter than a pipe is long only for small lots.
    let reader = thread::spawn(move || {
        let mut text = String::new();
        output.read_to_string(&mut text).map(|_| text)
    });
    let mut peak_bytes = f64::NAN;
    let status = loop {
        peak_bytes = peak_bytes.max(memory(child.id()));
        if let Some(status) = child.try_wait()? {
            break status;
        }
        thread::sleep(ASKED);
    };
    let wall_s = begun.elapsed().as_secs_f64();
    let Ok(text) = reader.join() else {
        bail!("the output could not be read");
    };
    if !status.success() {
        bail!("allanite lot: {status}");
    }
    let size = |file: &str| Ok((file.to_owned(), fs::metadata(folder.join(file))?.len()));
    Ok(Cost {
        wall_s,
        peak_bytes,
        sizes: OUTPUTS.into_iter().map(size).collect::<Result<_>>()?,
        said: text?.lines().take(11).map(str::to_owned).collect(),
    })
}

/// The largest resident memory of a process until now, `VmHWM` of Linux; NaN once it has ended.
fn memory(process: u32) -> f64 {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    kib.map_or(f64::NAN, |kib| 1024.0 * kib)
}
