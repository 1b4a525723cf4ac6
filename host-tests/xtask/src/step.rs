//! Runs one command of a task.

use crate::firmware::PERIOD;
use anyhow::{Context as _, Result, bail};
use std::{
    io::{self, IsTerminal as _, Read, Write},
    process::{Command, Stdio},
    sync::{Mutex, PoisonError},
    thread,
    time::{Duration, Instant},
};
use wait_timeout::ChildExt as _;

/// Cargo's variable for colours. Cargo prints none into a pipe unless this is set.
const COLOURS: &str = "CARGO_TERM_COLOR";

/// The interval between checks for silence.
const MOMENT: Duration = Duration::from_millis(500);

/// Prints a heading, runs a command, and tells how long it took.
pub(crate) fn step(heading: &str, command: &mut Command) -> Result<()> {
    println!("\n== {heading}");
    let begun = Instant::now();
    run(command)?;
    println!("      {heading}: {} s", begun.elapsed().as_secs());
    Ok(())
}

/// Runs a command and passes on what it prints. If it is silent for long, a line says that it still
/// runs. If it fails, the error names the whole command.
pub(crate) fn run(command: &mut Command) -> Result<()> {
    run_into(command, &mut io::stdout())
}

/// Runs a command as [`run`] does, and returns what it prints on standard output.
pub(crate) fn captured(command: &mut Command) -> Result<String> {
    let mut printed = Vec::new();
    run_into(command, &mut printed)?;
    String::from_utf8(printed).context("a command prints what is no text")
}

fn run_into(command: &mut Command, to: &mut (impl Write + Send)) -> Result<()> {
    let shown = shown(command);
    if io::stderr().is_terminal() && std::env::var_os(COLOURS).is_none() {
        command.env(COLOURS, "always");
    }
    let child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut child = child.with_context(|| format!("`{shown}` did not start"))?;
    let sign = Mutex::new(Instant::now());
    let begun = Instant::now();
    let (stdout, stderr) = (child.stdout.take(), child.stderr.take());
    let status = thread::scope(|scope| {
        scope.spawn(|| pass_on(stdout, to, &sign));
        scope.spawn(|| pass_on(stderr, &mut io::stderr(), &sign));
        loop {
            if let Some(status) = child.wait_timeout(MOMENT)? {
                return Ok::<_, io::Error>(status);
            }
            let mut sign = sign.lock().unwrap_or_else(PoisonError::into_inner);
            if sign.elapsed() >= PERIOD {
                eprintln!(
                    "      Still running after {} s: {shown}",
                    begun.elapsed().as_secs()
                );
                *sign = Instant::now();
            }
        }
    })?;
    if !status.success() {
        bail!("`{shown}` failed ({status})");
    }
    Ok(())
}

/// Copies the output until the command closes it, and notes the time of each sign of life.
fn pass_on(from: Option<impl Read>, to: &mut impl Write, sign: &Mutex<Instant>) {
    let Some(mut from) = from else { return };
    let mut chunk = [0; 4096];
    while let Ok(length @ 1..) = from.read(&mut chunk) {
        // If this program's output is closed, the rest is discarded.
        let _ = to.write_all(&chunk[..length]).and_then(|()| to.flush());
        *sign.lock().unwrap_or_else(PoisonError::into_inner) = Instant::now();
    }
}

/// The command as a user could type it, with the environment variables that are set for it.
pub(crate) fn shown(command: &Command) -> String {
    let mut words = Vec::new();
    for (name, value) in command.get_envs() {
        if let Some(value) = value {
            words.push(format!(
                "{}={}",
                name.display(),
                quoted(&value.to_string_lossy())
            ));
        }
    }
    words.push(command.get_program().display().to_string());
    let arguments = command.get_args();
    words.extend(arguments.map(|argument| quoted(&argument.to_string_lossy())));
    words.join(" ")
}

fn quoted(word: &str) -> String {
    if word.contains(' ') {
        format!("'{word}'")
    } else {
        word.to_owned()
    }
}
