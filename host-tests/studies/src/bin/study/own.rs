//! The library's own part of the study of peers, in a process of its own.

use allanite::Accumulator;
use allanite_cli::command::CommandLine;
use allanite_host::curve_file::CurveFile;
use allanite_log::npy_header::Header;
use allanite_studies::{OCTAVES, peers::agreement, resources::Resources};
use anyhow::{Result, bail};
use clap::{Parser, ValueEnum};
use std::{
    fs::File,
    io::{BufReader, Read},
    path::Path,
};

/// What is done with a record.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Task {
    /// Octaves alone, with the accumulator.
    Accumulate,
    /// `allanite measure`, with its checks of the log, spectrum and course.
    Measure,
}

/// Prints the deviations by averaging factor and what the process used.
pub(crate) fn print(task: Task, file: &Path) -> Result<()> {
    let deviations = match task {
        Task::Accumulate => accumulate(file)?,
        Task::Measure => measure(file)?,
    };
    let used = Resources::used();
    println!("{}", serde_json::to_string(&deviations)?);
    println!("{}", serde_json::to_string(&used)?);
    Ok(())
}

fn accumulate(file: &Path) -> Result<agreement::Deviations> {
    let mut reader = BufReader::with_capacity(1 << 16, File::open(file)?);
    if let Err(what) = Header::read(&mut reader)? {
        bail!("{what}");
    }
    let mut accumulator = Accumulator::<OCTAVES>::new();
    let mut bytes = [0; 4096];
    let mut counts = [0; 1024];
    loop {
        let mut filled = 0;
        while filled < bytes.len() {
            match reader.read(&mut bytes[filled..])? {
                0 => break,
                more => filled += more,
            }
        }
        let chunk = &mut counts[..filled / 4];
        for (count, bytes) in chunk.iter_mut().zip(bytes.chunks_exact(4)) {
            *count = i32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        }
        accumulator.push_slice(chunk);
        if filled < bytes.len() {
            return Ok(agreement::of(&accumulator));
        }
    }
}

fn measure(file: &Path) -> Result<agreement::Deviations> {
    let output = file.with_extension("json");
    let [log, curve] = [file, &output].map(|path| path.as_os_str());
    let options = ["--rate", "1", "--unit", "deg/s", "--scale", "1", "--output"].map(AsRef::as_ref);
    let start = ["allanite", "--quiet", "measure"].map(AsRef::as_ref);
    let line = start.into_iter().chain([log]).chain(options).chain([curve]);
    CommandLine::try_parse_from(line)?.run()?;
    let mut file = CurveFile::read(&output)?;
    let octaves = file.axes.remove(0).octaves.into_iter();
    Ok(octaves
        .map(|octave| (octave.m.into(), octave.variance.sqrt()))
        .collect())
}
