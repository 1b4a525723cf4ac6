//! `export`: writes a model in the formats of other programs.

mod accelerometer;
mod arguments;
mod autopilot;
mod axis_noise;
mod bins_csv;
mod c_header;
mod characterisation;
mod curve_csv;
mod decimal;
mod explained;
mod filter_states;
mod given;
mod gtsam;
mod kalibr;
mod kf_gins;
mod matlab;
mod model_json;
mod odometry;
mod ros;
mod sdf;
mod summary;

use crate::command::output::file::OutputFile;
use allanite_log::failure::{Failure, Place};
pub(super) use arguments::Arguments;
use arguments::Format;
use characterisation::{Characterisation, characterise};
use std::{io::Write, path::Path};

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    arguments.check()?;
    // The file comes first, so that an output that cannot be written is refused before the fit.
    let create = |path| OutputFile::create(path, [&*arguments.input]);
    let file = arguments.output.as_deref().map(create).transpose()?;
    let known = characterise(arguments)?;
    let text = match arguments.format {
        Format::Kalibr => kalibr::kalibr(&known, arguments),
        Format::Openvins => kalibr::openvins(&known, arguments),
        Format::VinsFusion => odometry::vins_fusion(&known, arguments),
        Format::OrbSlam3 => odometry::orb_slam3(&known, arguments),
        Format::LioSam => odometry::lio_sam(&known, arguments),
        Format::FastLio => odometry::fast_lio(&known, arguments),
        Format::Gtsam => gtsam::python(&known, arguments),
        Format::KfGins => kf_gins::yaml(&known, arguments),
        Format::Ros => ros::yaml(&known, arguments),
        Format::Json => model_json::text(&known),
        Format::Px4 => autopilot::px4(&known, arguments),
        Format::Ardupilot => autopilot::ardupilot(&known, arguments),
        Format::Matlab => matlab::json(&known, arguments),
        Format::Sdf => sdf::xml(&known, arguments),
        Format::C => c_header::header(&known, &arguments.name),
        Format::Csv => {
            curve_csv::table(&known).map_err(|error| Failure::standard_output(&error.into()))?
        }
    };
    if arguments.format == Format::Csv
        && let Some(path) = &arguments.output
    {
        write_beside(path, arguments, &known)?;
    }
    let Some(mut file) = file else {
        let written = output.write_all(text.as_bytes());
        return written.map_err(|error| Failure::standard_output(&error));
    };
    let place = arguments
        .output
        .as_deref()
        .map_or_else(Place::default, Place::file);
    file.write_all(text.as_bytes())
        .map_err(|error| place.io(&error))?;
    file.commit()
}

/// Writes the tables of a record that have other columns than the curve, each into a file beside that of the curve.
fn write_beside(
    path: &Path,
    arguments: &Arguments,
    known: &Characterisation,
) -> Result<(), Failure> {
    for (name, table) in [
        ("spectrum", bins_csv::spectrum(known)),
        ("course", bins_csv::course(known)),
    ] {
        let table = table.map_err(|error| Failure::standard_output(&error.into()))?;
        let Some(table) = table else { continue };
        let beside = path.with_extension(format!("{name}.csv"));
        let mut file = OutputFile::create(&beside, [&*arguments.input])?;
        let written = file.write_all(table.as_bytes());
        written.map_err(|error| Place::file(&beside).io(&error))?;
        file.commit()?;
    }
    Ok(())
}
