//! Builds the package for Python, and tests it in a virtual environment of its own.

use crate::{
    firmware::{cargo, host_target_directory, workspace},
    step::step,
};
use anyhow::{Context as _, Result, bail};
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

/// What a Python has to be able to do. The wheel is for every Python from 3.10 on.
const ABLE: &str = "import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 10))";

/// The names under which a Python is looked for, newest last.
const NAMES: [&str; 2] = ["python3", "python"];

/// What the tests need beside the wheel, with versions.
const REQUIREMENTS: &str = "src/python/tests/requirements.txt";

/// The parts of the program that the wheel has too. With the wheel's package beside it, what both depend on has the same
/// features, and is built once.
const PARTS: [&str; 5] = [
    "--package",
    "allanite-python",
    "--no-default-features",
    "--features",
    "allanite-cli/bags,allanite-cli/tables",
];

/// Builds the wheel, installs it, and runs its tests. `arguments` go to pytest.
///
/// # Errors
/// When the wheel does not build, or a test fails.
pub(crate) fn run(arguments: &[String]) -> Result<()> {
    let Some(python) = NAMES.into_iter().find(|name| is_able(name)) else {
        println!(
            "\n== Python\nskipped: no Python from 3.10 on with venv is here; install python3 and python3-venv"
        );
        return Ok(());
    };
    // The wheel shares it with the programs of the host.
    let target = host_target_directory();
    let environment = target.join("python");
    let of_environment = programs(&environment);
    if !is_able(&of_environment.join("python").to_string_lossy()) {
        step(
            "Python: a virtual environment",
            Command::new(python)
                .args(["-m", "venv", "--clear"])
                .arg(&environment),
        )?;
    }
    let program = |name: &str| Command::new(of_environment.join(name));
    let installed = step(
        "Python: maturin and what the tests need",
        program("python")
            .args([
                "-m",
                "pip",
                "install",
                "--quiet",
                "--disable-pip-version-check",
            ])
            .args(["--requirement", REQUIREMENTS])
            .current_dir(workspace()),
    );
    if let Err(error) = installed {
        println!("skipped: pip cannot install {REQUIREMENTS}, which needs the network: {error:#}");
        return Ok(());
    }
    let wheels = target.join("wheels");
    if wheels.exists() {
        // Only the wheel that is built now is to be there.
        fs::remove_dir_all(&wheels).with_context(|| wheels.display().to_string())?;
    }
    step(
        "Python: the wheel",
        program("maturin")
            .args(["build", "--locked", "--profile", "dev", "--manifest-path"])
            .arg(workspace().join("src/python/Cargo.toml"))
            .arg("--out")
            .arg(&wheels)
            .env("CARGO_TARGET_DIR", &target),
    )?;
    step(
        "Python: the program to compare with",
        cargo()
            .args(["build", "--package", "allanite-cli"])
            .args(["--bin", "allanite"])
            .args(PARTS),
    )?;
    let wheel = fs::read_dir(&wheels)?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .find(|path| path.extension().is_some_and(|extension| extension == "whl"));
    let Some(wheel) = wheel else {
        bail!("maturin has put no wheel into {}", wheels.display());
    };
    step(
        "Python: installing the wheel",
        program("python")
            .args([
                "-m",
                "pip",
                "install",
                "--quiet",
                "--disable-pip-version-check",
            ])
            .args(["--force-reinstall", "--no-deps"])
            .arg(&wheel),
    )?;
    step(
        "Python: tests",
        program("python")
            .args(["-m", "pytest", "--quiet"])
            .args(arguments)
            .current_dir(workspace().join("src/python"))
            .env("ALLANITE", target.join("debug/allanite")),
    )
}

/// The folder of the programs of a virtual environment.
fn programs(environment: &Path) -> PathBuf {
    environment.join(if cfg!(windows) { "Scripts" } else { "bin" })
}

fn is_able(python: &str) -> bool {
    let mut command = Command::new(python);
    command
        .args(["-c", ABLE])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}
