//! `lot`: judges a lot of devices by limits, from their certificates alone.

mod device;
mod judgement;
mod limited;
mod text;
mod unusual;

use crate::{
    command::{
        decode::{self, certificate},
        examples,
        input::many,
        limit::{Limit, LimitArgument},
    },
    failure::{Failure, Place},
};
use clap::Args;
use device::Device;
use judgement::Lot;
use std::{
    collections::BTreeMap,
    fs,
    io::Write,
    path::{Path, PathBuf},
};

/// The risk unless another one is given: a device passes if its two-sided 95 % interval lies below the limit.
const RISK: f64 = 0.025;

/// Judge a lot of devices by limits: yield, guard bands, Cpk, outliers and drift, from their certificates
///
/// A device passes a limit if its coefficient is above the limit with a probability of at most --risk, and fails if it
/// is within the limit with at most this probability. In between it lies in the guard band, where the record is too
/// short to tell.
#[derive(Debug, Args)]
#[command(after_help = examples::LOT)]
pub(super) struct Arguments {
    /// Files with one certificate each, or folders of such files (.bin)
    #[arg(required = true, value_name = "CERTIFICATE")]
    files: Vec<PathBuf>,
    /// A limit of a coefficient, by its symbol or its name, in the unit of the certificate or in the customary one:
    /// N=0.005, N=0.3°/√h, B=10deg/h
    #[arg(long = "limit", value_name = "EFFECT=VALUE", required = true)]
    limits: Vec<String>,
    /// The largest probability that a device passes whose coefficient is at its limit, or that one fails
    #[arg(long, value_name = "PROBABILITY", default_value_t = RISK)]
    risk: f64,
    /// Earlier certificates of the same devices, to find those that drifted, or folders of them
    #[arg(long, num_args = 1.., value_name = "CERTIFICATE")]
    earlier: Vec<PathBuf>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
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
    let mut failures = Vec::new();
    let devices = devices(&arguments.files, &mut failures)?;
    let earlier = devices_before(&arguments.earlier, &mut failures)?;
    if let (false, Some(unit)) = (devices.is_empty(), devices.first().map(|one| one.unit)) {
        let mut all = devices.iter().chain(&earlier);
        if let Some(other) = all.find(|other| other.unit != unit) {
            return Err(Place::file(&other.file).failure(
                format!("rates are in {}, those of the others in {unit}", other.unit),
                "judge devices of one unit together",
            ));
        }
        let limits: Vec<Limit> = limits
            .iter()
            .map(|limit| limit.of_unit(unit))
            .collect::<Result<_, _>>()?;
        let lot = Lot::new(&devices, &earlier, unit, &limits, arguments.risk);
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

/// The devices of these files, each of which occurs once.
fn devices(files: &[PathBuf], failures: &mut Vec<Failure>) -> Result<Vec<Device>, Failure> {
    let devices = devices_before(files, failures)?;
    let mut seen: BTreeMap<&str, &Path> = BTreeMap::new();
    for device in &devices {
        if let Some(other) = seen.insert(&device.id, &device.file) {
            return Err(Place::file(&device.file).failure(
                format!("device {} is in {}, too", device.id, many::shown(other)),
                "give the earlier one after --earlier",
            ));
        }
    }
    Ok(devices)
}

/// The devices of these files.
fn devices_before(files: &[PathBuf], failures: &mut Vec<Failure>) -> Result<Vec<Device>, Failure> {
    let mut devices = Vec::new();
    for file in &in_folders(files)? {
        match certificate(file) {
            Ok(certificate) => devices.push(Device {
                id: decode::device(&certificate),
                unit: certificate.unit.into(),
                file: file.clone(),
                certificate,
            }),
            Err(failure) => failures.push(failure),
        }
    }
    Ok(devices)
}

/// These files, with the `.bin` files of a folder in its place, by their names.
fn in_folders(files: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut all = Vec::new();
    for file in files {
        if !file.is_dir() {
            all.push(file.clone());
            continue;
        }
        let failed = |error: std::io::Error| Place::file(file).io(&error);
        let mut inside = Vec::new();
        for entry in fs::read_dir(file).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            if path.extension().is_some_and(|extension| extension == "bin") {
                inside.push(path);
            }
        }
        if inside.is_empty() {
            return Err(Place::file(file).failure(
                "there is no certificate in this folder",
                "give files, or a folder whose files end with .bin",
            ));
        }
        inside.sort();
        all.extend(inside);
    }
    Ok(all)
}
