//! `lot`: judges a lot of devices by limits, from their certificates alone.

mod judgement;
mod limit;
mod statistics;
mod text;

use crate::{
    command::{
        decode::{self, certificate},
        examples,
        input::many,
    },
    failure::{Failure, Place},
};
use clap::Args;
use judgement::{Device, Lot};
use limit::Limit;

use std::{
    collections::BTreeMap,
    io::Write,
    path::{Path, PathBuf},
};

/// Judge a lot of devices by limits: yield, guard bands, Cpk, outliers and drift, from their certificates
///
/// A device passes a limit if the upper end of its 95 % interval is at most the limit, and fails if the lower end
/// is above it. In between it lies in the guard band, where the record is too short to tell.
#[derive(Debug, Args)]
#[command(after_help = examples::LOT)]
pub(super) struct Arguments {
    /// Files with one certificate each
    #[arg(required = true, value_name = "CERTIFICATE")]
    files: Vec<PathBuf>,
    /// A limit of a coefficient, by its symbol or its name, in the unit of the certificate
    #[arg(long = "limit", value_name = "EFFECT=VALUE", required = true)]
    limits: Vec<String>,
    /// Earlier certificates of the same devices, to find those that drifted
    #[arg(long, num_args = 1.., value_name = "CERTIFICATE")]
    earlier: Vec<PathBuf>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command. Files that cannot be decoded are named, and the lot is that of the others.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let limits: Vec<Limit> = arguments
        .limits
        .iter()
        .map(|text| Limit::parse(text))
        .collect::<Result<_, _>>()?;
    if let Some((i, limit)) = (limits.iter().enumerate()).find(|(i, limit)| {
        limits[..*i]
            .iter()
            .any(|other| other.effect == limit.effect)
    }) {
        return Err(Failure::option(
            format!(
                "--limit {}: {} has two limits",
                arguments.limits[i], limit.effect
            ),
            "give one",
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
        let lot = Lot::new(&devices, &earlier, &limits);
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
    for file in files {
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
