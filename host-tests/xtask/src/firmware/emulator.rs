//! Runs an image in QEMU and reads its log.

use super::{Heartbeat, Image, REMEDY};
use anyhow::{Context as _, Result, bail};
use defmt_decoder::{DecodeError, Table};
use std::{
    io::Read,
    process::{Child, Command, ExitStatus, Stdio},
    thread,
    time::Duration,
};
use wait_timeout::ChildExt as _;

/// The longest time that an image may run. Images take seconds to minutes, and one that hangs is ended. On a machine
/// that was busy with other work, the benchmark in double precision took more than ten minutes.
const LIMIT: Duration = Duration::from_secs(1800);

/// The result of running an image.
#[derive(Clone, Debug)]
pub struct Run {
    /// The log of the image, one line per message.
    pub lines: Vec<String>,
    /// The exit status of QEMU.
    pub status: ExitStatus,
}

/// Runs an image on the board of its core. An instruction takes 1 ns of simulated time.
///
/// # Errors
/// Fails if QEMU does not start, if the image does not end, or if its log cannot be decoded.
pub fn run(image: &Image) -> Result<Run> {
    run_with(image, &[])
}

/// Runs an image with arguments.
///
/// # Errors
/// The errors are those of [`run`].
pub fn run_with(image: &Image, arguments: &[&str]) -> Result<Run> {
    let mut child = start(image, arguments)?;
    let name = image.path.file_name().unwrap_or_default();
    let _heartbeat = Heartbeat::new(format!("{} on {} in QEMU", name.display(), image.core));
    let mut stdout = child.stdout.take().context("no output to read")?;
    let reader = thread::spawn(move || {
        let mut log = Vec::new();
        stdout.read_to_end(&mut log).map(|_| log)
    });
    let Some(status) = child.wait_timeout(LIMIT)? else {
        child.kill()?;
        child.wait()?;
        bail!(
            "{} did not end in {} s",
            image.path.display(),
            LIMIT.as_secs()
        );
    };
    let log = match reader.join() {
        Ok(log) => log?,
        Err(_) => bail!("reading the output of {} failed", image.core.qemu),
    };
    let lines = decode(&image.elf, &log).with_context(|| {
        let path = image.path.display();
        format!("decoding the log of {path}, which ended with {status}")
    })?;
    Ok(Run { lines, status })
}

/// Starts an image. Its standard output has to be read.
///
/// # Errors
/// Fails if QEMU does not start.
pub fn start(image: &Image, arguments: &[&str]) -> Result<Child> {
    let mut semihosting = String::from("enable=on,target=native,arg=image");
    for argument in arguments {
        semihosting += &format!(",arg={argument}");
    }
    let qemu = image.core.qemu;
    Command::new(qemu)
        .args(["-machine", image.core.machine, "-cpu", image.core.cpu])
        // No firmware runs besides the image. QEMU would otherwise start its own on RISC-V.
        .args(["-bios", "none"])
        .args(["-icount", "shift=0", "-nographic", "-monitor", "none"])
        .args(["-serial", "null"])
        .args(["-semihosting-config", &semihosting])
        .arg("-kernel")
        .arg(&image.path)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .with_context(|| format!("{qemu} did not start: {REMEDY}"))
}

/// The messages of a defmt log, each preceded by its level.
fn decode(elf: &[u8], log: &[u8]) -> Result<Vec<String>> {
    let table = Table::parse(elf)?.context("the image logs nothing by defmt")?;
    let mut decoder = table.new_stream_decoder();
    decoder.received(log);
    let mut lines = Vec::new();
    loop {
        match decoder.decode() {
            Ok(frame) => {
                let message = frame.display_message();
                lines.push(match frame.level() {
                    Some(level) => format!("{} {message}", level.as_str()),
                    None => message.to_string(),
                });
            }
            Err(DecodeError::UnexpectedEof) => return Ok(lines),
            Err(DecodeError::Malformed) => bail!("a message is malformed"),
        }
    }
}
