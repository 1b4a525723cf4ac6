//! Builds the static library for C and programs that are linked with it.

use super::{
    Core, Heartbeat, Precision, REMEDY, Toolchain, cargo,
    toolchain::{artefacts, target_directory},
    workspace,
};
use crate::step::shown;
use anyhow::{Context as _, Result, bail, ensure};
use std::{
    path::{Path, PathBuf},
    process::Command,
};

/// The compiler for C on a Cortex-M.
pub const ARM_GCC: &str = "arm-none-eabi-gcc";

/// The folder with the package, the header and the example.
pub fn folder() -> PathBuf {
    workspace().join("src/c")
}

/// What a library for C holds.
#[derive(Clone, Copy, Debug)]
pub struct Contents {
    /// The number of octaves of a record: 14, 20 or 26.
    pub octaves: u32,
    /// Whether it has one axis and the five terms alone.
    pub one_axis: bool,
}

impl Contents {
    /// Everything, with the usual number of octaves.
    pub const ALL: Self = Self {
        octaves: 20,
        one_axis: false,
    };

    /// The features of the package, besides the default ones.
    fn features(self) -> Option<String> {
        (self.octaves != 20).then(|| format!("octaves-{}", self.octaves))
    }

    /// The folder for its artefacts. A library has the same name whatever it holds, so that only the usual one shares the images'.
    fn artefacts(self) -> PathBuf {
        match self.defines().join("-") {
            usual if usual.is_empty() => artefacts(Precision::Single),
            other => target_directory().join(other.to_lowercase()),
        }
    }

    /// What C code has to define for it.
    pub fn defines(self) -> Vec<String> {
        let octaves = (self.octaves != 20).then(|| format!("ALLANITE_OCTAVES_{}", self.octaves));
        let one_axis = self.one_axis.then(|| "ALLANITE_ONE_AXIS".to_owned());
        octaves.into_iter().chain(one_axis).collect()
    }
}

/// Puts a library, the header, a package of CMake and a module of Zephyr into a folder, and returns the library's path there.
///
/// # Errors
/// Fails if a file cannot be written.
pub fn package(library: &Path, contents: Contents, to: &Path) -> Result<PathBuf> {
    let copy = to.join("liballanite_c.a");
    let defined = match &contents.defines()[..] {
        [] => String::new(),
        names => format!(
            "\n    INTERFACE_COMPILE_DEFINITIONS \"{}\"",
            names.join(";")
        ),
    };
    let cmake = CMAKE.replace("@DEFINED@", &defined);
    let zephyr = to.join("zephyr");
    let module = ZEPHYR.replace("@DEFINES@", &contents.defines().join(" "));
    std::fs::create_dir_all(to)
        .and_then(|()| {
            let header = folder().join("include/allanite.h");
            std::fs::copy(header, to.join("allanite.h"))?;
            std::fs::copy(library, &copy)?;
            std::fs::write(to.join("allanite-config.cmake"), cmake)?;
            std::fs::create_dir_all(&zephyr)?;
            std::fs::write(zephyr.join("module.yml"), ZEPHYR_MODULE)?;
            std::fs::write(zephyr.join("Kconfig"), ZEPHYR_KCONFIG)?;
            std::fs::write(zephyr.join("CMakeLists.txt"), module)
        })
        .with_context(|| format!("writing to {}", to.display()))?;
    Ok(copy)
}

/// The package of CMake, as `find_package(allanite CONFIG)` reads it.
const CMAKE: &str = r#"# allanite, for find_package(allanite CONFIG REQUIRED PATHS ...) and target_link_libraries(... allanite::allanite).
if(NOT TARGET allanite::allanite)
  add_library(allanite::allanite STATIC IMPORTED)
  set_target_properties(allanite::allanite PROPERTIES
    IMPORTED_LOCATION "${CMAKE_CURRENT_LIST_DIR}/liballanite_c.a"
    INTERFACE_INCLUDE_DIRECTORIES "${CMAKE_CURRENT_LIST_DIR}"@DEFINED@)
endif()
"#;

/// What makes the folder a module of Zephyr, for `-DZEPHYR_EXTRA_MODULES=...` and `CONFIG_ALLANITE=y`.
const ZEPHYR_MODULE: &str = "name: allanite
build:
  cmake: zephyr
  kconfig: zephyr/Kconfig
";
const ZEPHYR_KCONFIG: &str = "config ALLANITE
	bool \"Gyro self-characterisation\"
	help
	  Links liballanite_c.a, which needs no heap, no C library and no other module.
";
const ZEPHYR: &str = "if(CONFIG_ALLANITE)
  zephyr_library_import(allanite ${CMAKE_CURRENT_LIST_DIR}/../liballanite_c.a)
  zephyr_include_directories(${CMAKE_CURRENT_LIST_DIR}/..)
  zephyr_compile_definitions(@DEFINES@)
endif()
";

/// Builds the library for a core, in single precision.
///
/// # Errors
/// Fails if the build fails.
pub fn library(core: &Core, contents: Contents) -> Result<PathBuf> {
    let folder = contents.artefacts();
    let mut command = Toolchain::find(core)?.cargo_into("rustc", &folder)?;
    command.args(["--package", "allanite-c", "--lib", "--profile", "firmware"]);
    // As one of several kinds, a static library would not be optimised as a whole.
    command.args(["--crate-type", "staticlib"]);
    if let Some(features) = contents.features() {
        command.args(["--features", &features]);
    }
    if contents.one_axis {
        command.arg("--no-default-features");
    }
    let _heartbeat = Heartbeat::new(format!("the library for C for {}", core.name));
    succeed(&mut command)?;
    let built = folder.join(core.target);
    Ok(built.join("firmware/liballanite_c.a"))
}

/// Builds the library for this host, in single precision.
///
/// # Errors
/// Fails if the build fails.
pub fn host_library() -> Result<PathBuf> {
    let mut command = cargo();
    command
        .args(["build", "--package", "allanite-c", "--lib", "--target-dir"])
        .arg(artefacts(Precision::Single));
    let _heartbeat = Heartbeat::new("the library for C for this host".into());
    succeed(&mut command)?;
    Ok(artefacts(Precision::Single).join("debug/liballanite_c.a"))
}

/// The lines that the example in Rust prints on this host, in single precision.
///
/// # Errors
/// Fails if it cannot be built or run.
pub fn rust_example() -> Result<Vec<String>> {
    let mut command = cargo();
    command
        .args(["run", "--package", "allanite-c", "--example", "product"])
        .arg("--target-dir")
        .arg(artefacts(Precision::Single));
    let _heartbeat = Heartbeat::new("the product in Rust on this host".into());
    lines(&mut command)
}

/// Plays the calls of every file of a folder in single precision with debug assertions, and returns what is printed: the
/// number of the files.
///
/// # Errors
/// Fails if it cannot be built, or if a call goes wrong.
pub fn replay(corpus: &Path) -> Result<Vec<String>> {
    let mut command = cargo();
    command
        .args(["run", "--package", "allanite-c", "--example", "replay"])
        .arg("--target-dir")
        .arg(artefacts(Precision::Single))
        .arg("--")
        .arg(corpus);
    let _heartbeat = Heartbeat::new("calls of the interface for C".into());
    lines(&mut command)
}

/// Compiles a program of the example's folder for this host, with checks of memory and of undefined behaviour, and returns
/// the lines that it prints.
///
/// # Errors
/// Fails if it cannot be built, or if it ends with a failure.
pub fn host_program(sources: &[&str], into: &Path) -> Result<Vec<String>> {
    lines(&mut Command::new(build_for_host(sources, into)?))
}

/// Compiles a program of the example's folder for this host, with checks of memory and of undefined behaviour.
///
/// # Errors
/// Fails if it cannot be built.
pub fn build_for_host(sources: &[&str], into: &Path) -> Result<PathBuf> {
    let library = host_library()?;
    let program = into.join("program");
    let mut gcc = Command::new("gcc");
    gcc.args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-g", "-O1"])
        .args(["-fsanitize=address,undefined", "-fno-sanitize-recover=all"])
        .arg("-I")
        .arg(folder().join("include"))
        .args(
            sources
                .iter()
                .map(|name| folder().join("example").join(name)),
        )
        .arg(library)
        .args(["-lm", "-lpthread", "-ldl", "-o"])
        .arg(&program);
    succeed(&mut gcc)?;
    Ok(program)
}

/// The options by which GCC compiles for a Cortex-M4F, and for a Cortex-M0+.
const CORTEX_M4F_OPTIONS: &[&str] = &["-mcpu=cortex-m4", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"];
const CORTEX_M0_OPTIONS: &[&str] = &["-mcpu=cortex-m0plus"];

/// Compiles an example for a Cortex-M4F, or for a Cortex-M0+ if the core is small.
///
/// # Errors
/// Fails if it cannot be built.
pub fn build_for_target(
    core: &Core,
    contents: Contents,
    source: &str,
    into: &Path,
) -> Result<PathBuf> {
    let library = library(core, contents)?;
    let program = into.join("program.elf");
    let example = folder().join("example");
    let mut gcc = Command::new(ARM_GCC);
    gcc.args([
        "-std=c11",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-Os",
        "-ffreestanding",
    ])
    .arg("-mthumb")
    .args(if core.small {
        CORTEX_M0_OPTIONS
    } else {
        CORTEX_M4F_OPTIONS
    })
    .args(contents.defines().iter().map(|name| format!("-D{name}")))
    .args([
        "-ffunction-sections",
        "-fdata-sections",
        "-nostdlib",
        "-Wl,--gc-sections",
    ])
    .arg("-T")
    .arg(example.join("cortex_m.ld"))
    .arg("-I")
    .arg(folder().join("include"))
    .args([source, "cortex_m.c"].map(|name| example.join(name)))
    .arg(library)
    .args(["-lgcc", "-o"])
    .arg(&program);
    succeed(&mut gcc)?;
    Ok(program)
}

/// Compiles an example for a Cortex-M4F, and returns the lines that it prints in QEMU.
///
/// # Errors
/// Fails if it cannot be built, or if it ends with a failure.
pub fn target_program(core: &Core, source: &str, into: &Path) -> Result<Vec<String>> {
    let program = build_for_target(core, Contents::ALL, source, into)?;
    let _heartbeat = Heartbeat::new(format!("the product in C on {core} in QEMU"));
    lines(&mut in_emulator(core, &program))
}

/// The command that runs a program for a core in QEMU.
pub fn in_emulator(core: &Core, program: &Path) -> Command {
    let mut qemu = Command::new(core.qemu);
    qemu.args(["-machine", core.machine, "-cpu", core.cpu])
        .args(["-nographic", "-monitor", "none", "-serial", "null"])
        .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
        .arg(program);
    qemu
}

fn succeed(command: &mut Command) -> Result<()> {
    let line = shown(command);
    let output = command.output();
    let output = output.with_context(|| format!("`{line}` did not start: {REMEDY}"))?;
    if !output.status.success() {
        let complaint = String::from_utf8_lossy(&output.stderr);
        bail!("`{line}` failed ({}):\n{complaint}", output.status);
    }
    Ok(())
}

/// The lines that a program prints.
///
/// # Errors
/// Fails if it ends with a failure.
pub fn lines(command: &mut Command) -> Result<Vec<String>> {
    let line = shown(command);
    let output = command.output();
    let output = output.with_context(|| format!("`{line}` did not start: {REMEDY}"))?;
    // QEMU writes what an image prints to one or the other.
    let printed = [&output.stdout[..], &output.stderr[..]].concat();
    let status = output.status;
    ensure!(
        status.success(),
        "`{line}` ended with {status}:\n{}",
        String::from_utf8_lossy(&printed)
    );
    let printed = if output.stdout.is_empty() {
        output.stderr
    } else {
        output.stdout
    };
    Ok(String::from_utf8(printed)?
        .lines()
        .map(str::to_owned)
        .collect())
}
