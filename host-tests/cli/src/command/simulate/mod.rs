//! `simulate`: writes the log of a gyro with known coefficients.

mod hidden_effects;

use crate::command::{
    examples,
    output::{file::OutputFile, progress},
};
use allanite_host::simulate::{Chain, Coefficients, Hidden, Preset, Simulator};
use allanite_log::{
    failure::{Failure, Place, brief, quoted},
    npy_header::{Header, Kind, sidecar},
    unit::{Sensor, Unit},
};
use clap::Args;
use flate2::{Compression, write::GzEncoder};
use hidden_effects::{HiddenArguments, HiddenEffects};
use std::{
    io::{self, BufWriter, Write},
    path::{Path, PathBuf},
};

/// Number of axes of a sensor.
const AXES: usize = 3;

/// Names of the axes of a sensor.
const fn axes(sensor: Sensor) -> [&'static str; AXES] {
    match sensor {
        Sensor::Gyro => ["gx", "gy", "gz"],
        Sensor::Accelerometer => ["ax", "ay", "az"],
    }
}

/// Name of the column of temperatures.
const TEMPERATURE: &str = "temp_C";

/// Simulate the log of a gyro at rest
#[derive(Debug, Args)]
#[command(after_help = examples::SIMULATE)]
pub(super) struct Arguments {
    /// A typical gyro; the options below override its coefficients one by one
    #[arg(value_name = "PRESET")]
    gyro: Option<Preset>,
    /// The same as PRESET
    #[arg(long, value_name = "PRESET", conflicts_with = "gyro")]
    preset: Option<Preset>,
    /// Quantization Q, in the unit of the angle (deg or rad)
    #[arg(long, value_name = "Q", allow_negative_numbers = true)]
    quantization: Option<f64>,
    /// Angle random walk N, in UNIT/√Hz
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    angle_random_walk: Option<f64>,
    /// Bias instability B, in UNIT
    #[arg(long, value_name = "B", allow_negative_numbers = true)]
    bias_instability: Option<f64>,
    /// Rate random walk K, in UNIT/√s
    #[arg(long, value_name = "K", allow_negative_numbers = true)]
    rate_random_walk: Option<f64>,
    /// Rate ramp R, in UNIT/s
    #[arg(long, value_name = "R", allow_negative_numbers = true)]
    rate_ramp: Option<f64>,
    #[command(flatten)]
    hidden: HiddenArguments,
    /// The filters that the white noise goes through, at a multiple of the rate, as in a sensor and its driver:
    /// `butterworth:poles=2,cutoff_hz=42 | every:samples=8`, of the stages butterworth, pt, notch, average, cic, fir, ema,
    /// median and every
    #[arg(long, value_name = "STAGE | STAGE …")]
    chain: Option<String>,
    /// Samples per second
    #[arg(
        long,
        value_name = "HZ",
        default_value_t = 100.0,
        allow_negative_numbers = true
    )]
    rate: f64,
    /// Length of the record, in seconds or with a unit, such as 10min, 2h, 1d
    #[arg(
        long,
        value_name = "TIME",
        default_value = "1h",
        allow_negative_numbers = true
    )]
    duration: String,
    /// Seed of the random numbers: the same seed gives the same record
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Number of axes: gx, gy, gz, or ax, ay, az for an accelerometer
    #[arg(long, default_value_t = 1)]
    axes: usize,
    /// The unit of coefficients and rates
    #[arg(long, default_value = "deg/s")]
    unit: Unit,
    /// Write rounded counts instead of rates; one count is this many rate units
    #[arg(long, value_name = "RATE_PER_COUNT", allow_negative_numbers = true)]
    scale: Option<f64>,
    /// The log to write: .csv, .csv.gz, or .npy with its rate and unit in a file .npy.txt beside it [default: CSV on
    /// standard output]
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let record = SimulatedRecord::new(arguments)?;
    let Some(path) = &arguments.output else {
        return record
            .write_csv(output)
            .map_err(|error| record.failure(&error, || Failure::standard_output(&error)));
    };
    let name = path.to_string_lossy().to_lowercase();
    let write = |record: &SimulatedRecord, file: &mut BufWriter<OutputFile>| -> io::Result<()> {
        if name.ends_with(".npy") {
            record.write_npy(file)
        } else if name.ends_with(".gz") {
            let mut packed = BufWriter::new(GzEncoder::new(file, Compression::default()));
            record.write_csv(&mut packed)?;
            packed
                .into_inner()
                .map_err(io::IntoInnerError::into_error)?
                .finish()
                .map(drop)
        } else {
            record.write_csv(file)
        }
    };
    if ![".csv", ".csv.gz", ".npy"]
        .iter()
        .any(|extension| name.ends_with(extension))
    {
        return Err(Place::file(path).failure(
            "the file's extension is not that of a log",
            "name the output .csv, .csv.gz or .npy",
        ));
    }
    if name.ends_with(".npy") && record.effects.thermal.is_some() {
        return Err(Place::file(path).failure(
            "columns of an array have no names, so the temperature would be taken for an axis",
            "name the output .csv or .csv.gz",
        ));
    }
    let mut file = BufWriter::with_capacity(1 << 16, OutputFile::create(path, [])?);
    let failure = |error: &io::Error| record.failure(error, || Place::file(path).io(error));
    write(&record, &mut file).map_err(|error| failure(&error))?;
    let file = file.into_inner().map_err(|error| failure(error.error()))?;
    if name.ends_with(".npy") && path_is_kept(path) {
        // The rate of an array is in a file beside it. The array comes last, so that it is never without its rate.
        let beside = sidecar(path);
        let mut comment = OutputFile::create(&beside, [path.as_path()])?;
        let written = record.write_comment(&mut comment);
        written.map_err(|error| Place::file(&beside).io(&error))?;
        comment.commit()?;
    }
    file.commit()
}

/// Whether an output is a file that can be read again, and not a device or a pipe.
fn path_is_kept(path: &Path) -> bool {
    path.metadata().map_or(true, |there| there.is_file())
}

/// A record to be simulated.
struct SimulatedRecord {
    coefficients: Coefficients,
    effects: HiddenEffects,
    chain: Option<Chain>,
    /// The effects as the options give them.
    effects_text: String,
    rate_hz: f64,
    samples: u64,
    seed: u64,
    axes: usize,
    unit: Unit,
    scale: Option<f64>,
}

impl SimulatedRecord {
    fn new(arguments: &Arguments) -> Result<Self, Failure> {
        for (option, value) in [
            ("--rate", Some(arguments.rate)),
            ("--scale", arguments.scale),
        ] {
            if let Some(value) = value.filter(|value| !(value.is_finite() && *value > 0.0)) {
                return Err(Failure::option(
                    format!("{option} {} is impossible", brief(value)),
                    "give a positive, finite number",
                ));
            }
        }
        if !(1..=AXES).contains(&arguments.axes) {
            return Err(Failure::option(
                format!("--axes {} is impossible", arguments.axes),
                format!("give 1 to {AXES}"),
            ));
        }
        let duration_s = seconds(&arguments.duration)?;
        let samples = (duration_s * arguments.rate).round();
        if !(1.0..2f64.powi(53)).contains(&samples) {
            return Err(Failure::option(
                format!(
                    "--duration {} at {} Hz is impossible",
                    quoted(arguments.duration.as_bytes()).trim_matches('"'),
                    brief(arguments.rate)
                ),
                "give a length of at least one sample, such as 600 or 10min",
            ));
        }
        let coefficients = coefficients(arguments)?;
        let effects = arguments.hidden.effects(coefficients)?;
        effects.check_widths(arguments.rate)?;
        let chain = arguments.chain.as_deref().map(Chain::parse).transpose()?;
        if chain.is_some() && effects.hidden.iter().any(Hidden::replaces_white_noise) {
            return Err(Failure::option(
                "--chain and a filter of --effect replace the same white noise",
                "drop one of them",
            ));
        }
        let texts = arguments
            .hidden
            .texts()
            .map(|text| format!(" effect={text}"));
        let chain_text = arguments.chain.iter().map(|text| format!(" chain={text}"));
        Ok(Self {
            coefficients,
            effects,
            chain,
            effects_text: texts.chain(chain_text).collect(),
            rate_hz: arguments.rate,
            samples: samples as u64,
            seed: arguments.seed,
            axes: arguments.axes,
            unit: arguments.unit,
            scale: arguments.scale,
        })
    }

    /// One simulator for each axis. The seeds of the axes are far apart, so that no axis of one record
    /// equals an axis of another.
    fn simulators(&self) -> Vec<Simulator> {
        const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;
        let axis = |axis: u64| {
            let seed = self.seed.wrapping_add(axis.wrapping_mul(GOLDEN));
            let sweep_s = self.samples as f64 / self.rate_hz;
            let hidden = &self.effects.hidden;
            let (c, rate_hz) = (self.coefficients, self.rate_hz);
            match &self.chain {
                Some(chain) => Simulator::behind(c, chain, hidden, (rate_hz, sweep_s), seed),
                None => Simulator::with_sweep(c, hidden, rate_hz, sweep_s, seed),
            }
        };
        (0..self.axes as u64).map(axis).collect()
    }

    /// Calls `write` for every row, with the rates of the axes and the temperature, if there is one.
    fn each(&self, mut write: impl FnMut(&[f64], Option<f64>) -> io::Result<()>) -> io::Result<()> {
        const STRIDE: u64 = 1 << 16;
        let bar = progress::simulating(self.samples);
        let mut simulators = self.simulators();
        let mut rates = vec![0.0; self.axes];
        for sample in 0..self.samples {
            let time_s = sample as f64 / self.rate_hz;
            let thermal = self.effects.thermal.map_or(0.0, |one| one.rate_at(time_s));
            for (rate, simulator) in rates.iter_mut().zip(&mut simulators) {
                *rate = simulator.next().unwrap_or_default() + thermal;
                if !rate.is_finite() {
                    return Err(io::Error::new(
                        io::ErrorKind::InvalidInput,
                        "a simulated rate exceeds the range of numbers",
                    ));
                }
            }
            let celsius = self.effects.thermal.map(|one| one.celsius_at(time_s));
            write(&rates, celsius)?;
            if sample % STRIDE == 0 {
                bar.set_position(sample);
            }
        }
        bar.finish_and_clear();
        Ok(())
    }

    fn write_csv(&self, output: &mut impl Write) -> io::Result<()> {
        self.write_comment(output)?;
        let temperature = self.effects.thermal.map(|_| TEMPERATURE);
        let axes = axes(self.unit.sensor());
        let names = axes[..self.axes].iter().copied().chain(temperature);
        writeln!(output, "{}", names.collect::<Vec<_>>().join(","))?;
        let mut float = ryu::Buffer::new();
        self.each(|rates, celsius| {
            for (axis, &rate) in rates.iter().enumerate() {
                if axis > 0 {
                    output.write_all(b",")?;
                }
                match self.scale {
                    Some(scale) => write!(output, "{}", count(rate, scale)?)?,
                    None => output.write_all(float.format(rate).as_bytes())?,
                }
            }
            if let Some(celsius) = celsius {
                output.write_all(b",")?;
                output.write_all(float.format(celsius).as_bytes())?;
            }
            output.write_all(b"\n")
        })
    }

    /// Writes the comment with the facts that `measure` needs and the coefficients of the record.
    fn write_comment(&self, output: &mut impl Write) -> io::Result<()> {
        write!(
            output,
            "# rate_hz={} unit={}",
            self.rate_hz,
            self.unit.name()
        )?;
        if let Some(scale) = self.scale {
            write!(output, " scale={scale}")?;
        }
        let c = &self.coefficients;
        writeln!(
            output,
            " seed={} quantization={} angle_random_walk={} bias_instability={} \
             rate_random_walk={} rate_ramp={}{}",
            self.seed,
            c.quantization,
            c.angle_random_walk,
            c.bias_instability,
            c.rate_random_walk,
            c.rate_ramp,
            self.effects_text
        )
    }

    fn write_npy(&self, output: &mut impl Write) -> io::Result<()> {
        let (kind, size) = match self.scale {
            Some(_) => (Kind::Signed, 4),
            None => (Kind::Float, 8),
        };
        Header {
            kind,
            size,
            big_endian: false,
            fortran_order: false,
            shape: if self.axes == 1 {
                vec![self.samples]
            } else {
                vec![self.samples, self.axes as u64]
            },
        }
        .write(output)?;
        self.each(|rates, _| {
            rates.iter().try_for_each(|&rate| match self.scale {
                Some(scale) => output.write_all(&count(rate, scale)?.to_le_bytes()),
                None => output.write_all(&rate.to_le_bytes()),
            })
        })
    }

    /// The failure of a record whose rates exceed floats or whose counts exceed `i32`, or otherwise the
    /// failure of the output.
    fn failure(&self, error: &io::Error, otherwise: impl FnOnce() -> Failure) -> Failure {
        match error.kind() {
            io::ErrorKind::InvalidData => Failure::option(error, "give a larger --scale"),
            io::ErrorKind::InvalidInput => Failure::option(
                error,
                "give smaller coefficients, such as --angle-random-walk",
            ),
            _ => otherwise(),
        }
    }
}

/// A rate as a count.
///
/// # Errors
/// When the count does not fit into 32 bits.
fn count(rate: f64, scale: f64) -> io::Result<i32> {
    let count = (rate / scale).round();
    if (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&count) {
        Ok(count as i32)
    } else {
        let what = format!(
            "a rate of {} does not fit into a 32-bit count of {}",
            brief(rate),
            brief(scale)
        );
        Err(io::Error::new(io::ErrorKind::InvalidData, what))
    }
}

/// The coefficients of the preset in the chosen unit, with those that options override.
fn coefficients(arguments: &Arguments) -> Result<Coefficients, Failure> {
    let mut coefficients = Coefficients::default();
    let preset = arguments.gyro.or(arguments.preset);
    if let Some(preset) = preset {
        if arguments.unit.sensor() != Sensor::Gyro {
            return Err(Failure::option(
                format!(
                    "presets describe gyros, but --unit {} is for accelerometers",
                    arguments.unit.name()
                ),
                "give coefficients such as --angle-random-walk, or another --unit",
            ));
        }
        let per_degree = arguments.unit.in_usual().recip();
        let in_degrees = preset.coefficients();
        coefficients = Coefficients {
            quantization: in_degrees.quantization * per_degree,
            angle_random_walk: in_degrees.angle_random_walk * per_degree,
            bias_instability: in_degrees.bias_instability * per_degree,
            rate_random_walk: in_degrees.rate_random_walk * per_degree,
            rate_ramp: in_degrees.rate_ramp * per_degree,
        };
    }
    let own = [
        (
            "--quantization",
            arguments.quantization,
            &mut coefficients.quantization,
        ),
        (
            "--angle-random-walk",
            arguments.angle_random_walk,
            &mut coefficients.angle_random_walk,
        ),
        (
            "--bias-instability",
            arguments.bias_instability,
            &mut coefficients.bias_instability,
        ),
        (
            "--rate-random-walk",
            arguments.rate_random_walk,
            &mut coefficients.rate_random_walk,
        ),
        (
            "--rate-ramp",
            arguments.rate_ramp,
            &mut coefficients.rate_ramp,
        ),
    ];
    let mut anything = preset.is_some() || !arguments.hidden.is_empty();
    for (option, value, coefficient) in own {
        let Some(value) = value else { continue };
        if !(value.is_finite() && value >= 0.0) {
            return Err(Failure::option(
                format!("{option} {} is impossible", brief(value)),
                "give a finite number that is not negative",
            ));
        }
        *coefficient = value;
        anything = true;
    }
    if !anything {
        return Err(Failure::option(
            "no preset and no coefficient is given",
            "name a preset (tactical, fog, mems, srs2000, vg951, crg20) or give coefficients such as --angle-random-walk",
        ));
    }
    Ok(coefficients)
}

/// A length of time in seconds, from a number or a text with units.
fn seconds(text: &str) -> Result<f64, Failure> {
    text.parse()
        .ok()
        .or_else(|| {
            humantime::parse_duration(text)
                .ok()
                .map(|duration| duration.as_secs_f64())
        })
        .ok_or_else(|| {
            Failure::option(
                format!("--duration {text:?} is not a length of time"),
                "give seconds, or a number with a unit, such as 10min, 2h, 1d",
            )
        })
}
