//! `lot`: judges a lot of devices by limits, from their certificates, curve files or logs.

mod csv;
mod device;
mod judgement;
mod limited;
mod output;
mod page;
#[cfg(feature = "tables")]
mod parquet;
mod source;
mod table;
mod text;
mod unusual;

use crate::command::{
    examples,
    input::{
        many,
        record::{CovariateArguments, LogArguments},
    },
};
use allanite_host::{limit::LimitArgument, schema};
use allanite_log::failure::{Failure, Place};
use clap::Args;
use device::Device;
use judgement::{Judged, Lot};
use limited::Rule;
use output::Output;
use schemars::Schema;
use std::{
    collections::BTreeMap,
    io::Write,
    path::{Path, PathBuf},
};

/// The risk unless another one is given: a device passes if its two-sided 95 % interval lies below the limit.
const RISK: f64 = 0.025;

/// Judge a lot of devices by limits: yield, guard bands, Cpk, outliers and drift
///
/// The devices are certificates, curve files and logs, mixed; a log or a curve file is diagnosed first. A device passes a limit
/// if its coefficient is above the limit with a probability of at most --risk, and fails if it is within the limit with at
/// most this probability. In between it lies in the guard band, where the record is too short for a decision. The exit status is 0
/// for any decision: `fit --limit` decides one device by its exit status.
#[derive(Debug, Args)]
#[command(after_help = examples::LOT)]
pub(super) struct Arguments {
    /// Files of one device each, or folders of them: certificates (.bin), curve files (.json) and logs, whose device has the
    /// name of the file. Axes are identified by their order
    #[arg(required = true, value_name = "DEVICE")]
    files: Vec<PathBuf>,
    /// A limit of a coefficient, by its symbol or its name, in the unit of the certificate or in the customary one:
    /// N=0.005, N=0.3°/√h, B=10deg/h
    #[arg(long = "limit", value_name = "EFFECT=VALUE", required = true)]
    limits: Vec<String>,
    /// The largest probability that a device passes whose coefficient is at its limit, or that one fails
    #[arg(long, value_name = "PROBABILITY", default_value_t = RISK)]
    risk: f64,
    /// Earlier files of the same devices, to find those that drifted, or folders of them
    #[arg(long, num_args = 1.., value_name = "DEVICE")]
    earlier: Vec<PathBuf>,
    /// Write the results, too: one row for each device and axis into a .csv or a .parquet, or the lot with its pictures as a
    /// page, .html. May be given several times
    #[arg(long, short, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    covariates: CovariateArguments,
    #[command(flatten)]
    about_log: LogArguments,
}

/// The schema of what is printed with `--json`.
pub(super) fn schema(title: &str) -> Schema {
    schema::of::<Lot>(title)
}

/// Runs the command. Files that cannot be decoded are named, and the lot is that of the others.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let limits = LimitArgument::all(&arguments.limits)?;
    if !(arguments.risk > 0.0 && arguments.risk < 0.5) {
        return Err(Failure::option(
            format!("--risk {}: this is no risk", arguments.risk),
            "give a probability above 0 and below 0.5",
        ));
    }
    // The files come first, so that an output that cannot be written is refused before the work.
    let inputs = arguments.files.iter().chain(&arguments.earlier);
    let inputs: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
    let outputs = arguments.output.iter();
    let outputs = outputs.map(|path| Output::create(path, &inputs));
    let outputs: Vec<Output> = outputs.collect::<Result<_, _>>()?;
    let mut failures = Vec::new();
    let about = (&arguments.about_log, &arguments.covariates);
    let devices = source::devices(&arguments.files, about, &mut failures)?;
    each_once(&devices)?;
    let earlier = source::devices(&arguments.earlier, about, &mut failures)?;
    if let (false, Some(unit)) = (devices.is_empty(), devices.first().map(|one| one.unit)) {
        let mut all = devices.iter().chain(&earlier);
        if let Some(other) = all.find(|other| other.unit != unit) {
            return Err(Place::file(&other.file).failure(
                format!("rates are in {}, those of the others in {unit}", other.unit),
                "judge devices of one unit together",
            ));
        }
        let rules = limits.iter().map(|limit| {
            let limit = limit.of_unit(unit)?;
            Ok(Rule::of(&devices, limit, arguments.risk))
        });
        let rules: Vec<Rule> = rules.collect::<Result<_, Failure>>()?;
        let lot = Lot::new(&devices, &earlier, unit, &rules, arguments.risk);
        // Of several earlier ones of a device the last one counts.
        let before = earlier.iter().map(|one| (one.id.as_str(), one)).collect();
        let judged = Judged {
            devices: &devices,
            before: &before,
            unit,
            rules: &rules,
            lot: &lot,
        };
        for output in outputs {
            output.write(&judged)?;
        }
        let printed = if arguments.json {
            serde_json::to_writer(&mut *output, &lot)
                .map_err(std::io::Error::from)
                .and_then(|()| writeln!(output))
        } else {
            text::print(&lot, output)
        };
        let printed = printed.and_then(|()| output.flush());
        printed.map_err(|error| Failure::standard_output(&error))?;
    }
    many::failed(failures)
}

/// Refuses a device that occurs twice.
fn each_once(devices: &[Device]) -> Result<(), Failure> {
    let mut seen: BTreeMap<&str, &Path> = BTreeMap::new();
    for device in devices {
        if let Some(other) = seen.insert(&device.id, &device.file) {
            return Err(Place::file(&device.file).failure(
                format!("device {} is in {}, too", device.id, many::shown(other)),
                "give the earlier one after --earlier",
            ));
        }
    }
    Ok(())
}
