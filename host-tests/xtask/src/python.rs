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

/// The native part of the package, and the program to compare the package with.
pub(crate) struct Native {
    pub(crate) library: PathBuf,
    pub(crate) program: PathBuf,
}

/// Tests the package in a folder of its own, with a native part that is built already. [`run`] tests the wheel.
///
/// # Errors
/// When the package cannot be copied, or a test fails.
pub(crate) fn test(native: &Native) -> Result<()> {
    let Some(environment) = Environment::new()? else {
        return Ok(());
    };
    let folder = host_target_directory().join("python-package");
    let package = folder.join("allanite");
    if package.exists() {
        // Only what is there now is to be tested.
        fs::remove_dir_all(&package).with_context(|| package.display().to_string())?;
    }
    fs::create_dir_all(&package)?;
    for entry in fs::read_dir(workspace().join("src/python/python/allanite"))? {
        let file = entry?.path();
        if let Some(name) = file.file_name().filter(|_| file.is_file()) {
            fs::copy(&file, package.join(name))?;
        }
    }
    let name = if cfg!(windows) {
        "_native.pyd"
    } else {
        "_native.abi3.so"
    };
    fs::copy(&native.library, package.join(name))?;
    environment.pytest(&[], &native.program, Some(&folder))
}

/// Builds the wheel, installs it, and runs its tests. `arguments` go to pytest.
///
/// # Errors
/// When the wheel does not build, or a test fails.
pub(crate) fn run(arguments: &[String]) -> Result<()> {
    let Some(environment) = Environment::new()? else {
        return Ok(());
    };
    // The wheel shares it with the programs of the host.
    let target = host_target_directory();
    let wheels = target.join("wheels");
    if wheels.exists() {
        // Only the wheel that is built now is to be there.
        fs::remove_dir_all(&wheels).with_context(|| wheels.display().to_string())?;
    }
    step(
        "Python: the wheel",
        environment
            .program("maturin")
            .args(["build", "--locked", "--manifest-path"])
            .arg(workspace().join("src/python/Cargo.toml"))
            .arg("--out")
            .arg(&wheels)
            .env("CARGO_TARGET_DIR", &target),
    )?;
    step(
        "Python: the program to compare with",
        cargo()
            .args(["build", "--package", "allanite-cli"])
            .args(["--bin", "allanite"]),
    )?;
    let wheel = fs::read_dir(&wheels)?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .find(|path| path.extension().is_some_and(|extension| extension == "whl"));
    let Some(wheel) = wheel else {
        bail!("maturin has put no wheel into {}", wheels.display());
    };
    step(
        "Python: installing the wheel",
        environment
            .pip()
            .args(["--force-reinstall", "--no-deps"])
            .arg(&wheel),
    )?;
    environment.pytest(arguments, &target.join("debug/allanite"), None)
}

/// A virtual environment with what the tests need.
struct Environment {
    programs: PathBuf,
}

impl Environment {
    /// Makes the environment in `target/python`, or says why the tests are skipped.
    fn new() -> Result<Option<Self>> {
        let Some(python) = NAMES.into_iter().find(|name| is_able(name)) else {
            println!(
                "skipped: no Python from 3.10 on with venv is here; install python3 and python3-venv"
            );
            return Ok(None);
        };
        let folder = host_target_directory().join("python");
        let environment = Self {
            programs: programs(&folder),
        };
        let own = environment.programs.join("python");
        if !is_able(&own.to_string_lossy()) {
            step(
                "Python: a virtual environment",
                Command::new(python)
                    .args(["-m", "venv", "--clear"])
                    .arg(&folder),
            )?;
        }
        let installed = step(
            "Python: maturin and what the tests need",
            environment
                .pip()
                .args(["--requirement", REQUIREMENTS])
                .current_dir(workspace()),
        );
        if let Err(error) = installed {
            println!(
                "skipped: pip cannot install {REQUIREMENTS}, which needs the network: {error:#}"
            );
            return Ok(None);
        }
        Ok(Some(environment))
    }

    fn program(&self, name: &str) -> Command {
        Command::new(self.programs.join(name))
    }

    fn pip(&self) -> Command {
        let mut pip = self.program("python");
        pip.args(["-m", "pip", "install", "--quiet"])
            .arg("--disable-pip-version-check");
        pip
    }

    /// Runs the tests against a program, with the package that is installed or with that in a folder.
    fn pytest(&self, arguments: &[String], program: &Path, folder: Option<&Path>) -> Result<()> {
        let mut pytest = self.program("python");
        pytest
            .args(["-m", "pytest", "--quiet"])
            .args(arguments)
            .current_dir(workspace().join("src/python"))
            .env("ALLANITE", program);
        match folder {
            Some(folder) => pytest.env("PYTHONPATH", folder),
            // Only the wheel is optimised as users get it, so that only its times count.
            None => pytest.env("ALLANITE_TIMES", "1"),
        };
        step("Python: tests", &mut pytest)
    }
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
