//! Builds the program `allanite` and runs it: `launch [options of cargo build] -- [arguments of allanite]`.
//!
//! Cargo prints nothing while it compiles one large package. This program says every few seconds that the build goes
//! on.

use std::{
    env,
    io::{self, IsTerminal as _},
    path::{Path, PathBuf},
    process::{Command, ExitCode},
    sync::mpsc::{RecvTimeoutError, channel},
    thread,
    time::{Duration, Instant},
};

/// The interval between two signs of life.
const PERIOD: Duration = Duration::from_secs(8);

fn main() -> ExitCode {
    match run() {
        Ok(code) => code,
        Err(error) => {
            eprintln!(
                "launch: {error}; `cargo run -p allanite-cli --bin allanite` runs the program, too"
            );
            ExitCode::FAILURE
        }
    }
}

fn run() -> io::Result<ExitCode> {
    let mut arguments = env::args_os().skip(1);
    let options: Vec<_> = arguments.by_ref().take_while(|word| word != "--").collect();
    // The program lies beside this one, if the build has the same profile and the same folder.
    let here = env::current_exe()?;
    let target = here.ancestors().nth(2).map(PathBuf::from);
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../Cargo.toml");
    let mut build = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    build.args(["build", "--package", "allanite-cli"]);
    build.args(["--bin", "allanite"]).args(options);
    build.arg("--manifest-path").arg(workspace);
    if let Some(target) = target {
        build.arg("--target-dir").arg(target);
    }
    let (ended, end) = channel();
    let signs = thread::spawn(move || {
        let begun = Instant::now();
        // On a terminal cargo draws a bar, which the sign replaces until cargo draws it again.
        let over = if io::stderr().is_terminal() {
            "\r\x1b[K"
        } else {
            ""
        };
        while end.recv_timeout(PERIOD) == Err(RecvTimeoutError::Timeout) {
            let seconds = begun.elapsed().as_secs();
            eprintln!(
                "{over}    Building since {seconds} s; the first build takes a minute or two"
            );
        }
    });
    let status = build.status()?;
    // The thread has ended only if it could not print, which does not matter here.
    let _ = ended.send(());
    let _ = signs.join();
    if !status.success() {
        // Cargo has said why.
        return Ok(ExitCode::FAILURE);
    }
    let name = format!("allanite{}", env::consts::EXE_SUFFIX);
    let mut program = Command::new(here.with_file_name(name));
    program.args(arguments);
    replace_with(&mut program)
}

/// Runs the program in the place of this one, so that interruptions reach it alone.
#[cfg(unix)]
fn replace_with(program: &mut Command) -> io::Result<ExitCode> {
    Err(std::os::unix::process::CommandExt::exec(program))
}

/// Runs the program and ends as it ends.
#[cfg(not(unix))]
fn replace_with(program: &mut Command) -> io::Result<ExitCode> {
    let code = program.status()?.code();
    let code = code.and_then(|code| u8::try_from(code).ok());
    Ok(code.map_or(ExitCode::FAILURE, ExitCode::from))
}
