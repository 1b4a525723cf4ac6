//! `certify`: writes the certificates of logs and of curve files, as a device would write them of itself.

use crate::command::{
    certified::{self, Content, Identity, device_of},
    decode, examples,
    input::{
        many,
        record::{CovariateArguments, LogArguments},
    },
    output::{file::OutputFile, places::places},
};
use allanite::storage::Certificate;
use allanite_log::failure::{Failure, Place, quoted};
use clap::Args;
use std::{
    io::Write,
    path::{Path, PathBuf},
};

/// Write the certificates of logs and of curve files, as devices store them
///
/// Every axis is diagnosed as `diagnose` does. `decode` prints a certificate, and `lot` judges many.
#[derive(Debug, Args)]
#[command(after_help = examples::CERTIFY)]
pub(super) struct Arguments {
    /// Logs (text, .npy, .ulg, or a bag of ROS), or curve files (.json) that `measure` wrote
    #[arg(required = true, value_name = "INPUT")]
    inputs: Vec<PathBuf>,
    /// The certificate to write, .bin, or an existing folder that gets one file for each input
    #[arg(long, short, value_name = "CERTIFICATE.bin")]
    output: PathBuf,
    /// The identity of the device, such as its serial number, of at most 16 bytes [default: the name of the input without
    /// its extension]
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
    /// The version of the device's firmware
    #[arg(long, value_name = "MAJOR.MINOR.PATCH", default_value = "0.0.0", value_parser = firmware)]
    firmware: [u16; 3],
    /// The temperature during the measurement in °C: `23`, or the lowest and the highest one, `22.5..24`
    #[arg(long, value_name = "LOW..HIGH", value_parser = temperature, allow_hyphen_values = true)]
    temperature: Option<(f32, f32)>,
    /// Print the certificates as JSON, as `decode --json` does
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    covariates: CovariateArguments,
    #[command(flatten)]
    about_log: LogArguments,
}

fn firmware(text: &str) -> Result<[u16; 3], String> {
    let parts: Vec<&str> = text.split('.').collect();
    let read = |part: &str| part.parse().map_err(|_| "write 1.2.0".to_owned());
    match parts[..] {
        [major, minor, patch] => Ok([read(major)?, read(minor)?, read(patch)?]),
        _ => Err("write 1.2.0".into()),
    }
}

fn temperature(text: &str) -> Result<(f32, f32), String> {
    let (low, high) = text.split_once("..").unwrap_or((text, text));
    let read = |part: &str| part.trim().parse::<f32>().ok();
    match read(low).zip(read(high)) {
        Some((low, high)) if low <= high && low >= -273.15 && high.is_finite() => Ok((low, high)),
        _ => Err("write 23 or 22.5..24".into()),
    }
}

/// Runs the command. Inputs that can be certified are, even if others cannot.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let several = arguments.inputs.len() > 1;
    if several && let Some(device) = &arguments.device {
        return Err(Failure::option(
            format!(
                "--device {}: there are several inputs",
                quoted(device.as_bytes())
            ),
            "name each file like its device, or certify them one by one",
        ));
    }
    if !several && !arguments.output.is_dir() && !is_certificate(&arguments.output) {
        return Err(Place::file(&arguments.output)
            .failure("a certificate must end in .bin", "rename the output"));
    }
    let places = places(&arguments.inputs, &arguments.output, "bin", "certify")?;
    let work = |input: &Path| {
        let place = places.get(input).unwrap_or(&arguments.output);
        // The file comes first, so that an output that cannot be written is refused before the diagnosis.
        let mut file = OutputFile::create(place, arguments.inputs.iter().map(PathBuf::as_path))?;
        let identity = Identity {
            device: arguments.device.clone().unwrap_or_else(|| device_of(input)),
            firmware: arguments.firmware,
            temperature_c: arguments.temperature,
        };
        let about = (&arguments.about_log, &arguments.covariates);
        let certificate = certified::certificate(input, about, &identity, Content::All)?;
        let bytes = encoded(input, &certificate)?;
        let written = file.write_all(&bytes);
        written.map_err(|error| Place::file(place).io(&error))?;
        file.commit()?;
        Ok((place.clone(), certificate))
    };
    let (mut written, mut failures) = (Vec::new(), Vec::new());
    many::each(&arguments.inputs, work, |_, certified| {
        match certified {
            Ok(one) => written.push(one),
            Err(failure) => failures.push(failure),
        }
        Ok(())
    })?;
    decode::print_certificates(written, arguments.json, output)?;
    many::failed(failures)
}

/// The bytes of a certificate, which can be decoded again.
fn encoded(input: &Path, certificate: &Certificate) -> Result<Vec<u8>, Failure> {
    let mut buffer = vec![0; Certificate::MAX_BYTES];
    let encoded = certificate.encode(&mut buffer).map(<[u8]>::to_vec);
    let checked = encoded.and_then(|bytes| Certificate::decode(&bytes).map(|_| bytes));
    checked.map_err(|error| {
        Place::file(input).failure(
            format!("this record has no certificate: {error:#}"),
            "see what `diagnose` says of it",
        )
    })
}

fn is_certificate(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("bin"))
}
