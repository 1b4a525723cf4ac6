//! The boards to copy, in `src/bin/board`. Each of them is a project of its own, built from its folder as somebody does who
//! has copied it.

use super::{
    CORES, CORTEX_M4F, Core, Heartbeat, Image, REMEDY, Toolchain, target_directory, workspace,
};
use anyhow::{Context as _, Result, ensure};
use std::{
    path::PathBuf,
    process::{Command, Stdio},
};

/// A board to copy.
#[derive(Clone, Copy, Debug)]
pub struct Board {
    /// The name of its folder, of its package and of its image.
    pub name: &'static str,
    /// Its core. QEMU has no model of the board.
    pub core: Core,
}

/// Every board.
pub const BOARDS: [Board; 2] = [
    Board {
        name: "nrf52840",
        core: CORTEX_M4F,
    },
    Board {
        name: "stm32g030",
        // Its memories are those of its own `memory.x`.
        core: Core {
            board: None,
            ..CORES[0]
        },
    },
];

impl Board {
    /// The folder of the project.
    pub fn folder(&self) -> PathBuf {
        workspace().join("src/bin/board").join(self.name)
    }

    /// A cargo command such as `build` or `clippy` in the folder of the project, with the versions of its `Cargo.lock`. The
    /// boards share the artefacts for the host.
    ///
    /// # Errors
    /// The errors are those of [`Toolchain::cargo`].
    pub fn cargo(&self, subcommand: &str) -> Result<Command> {
        let artefacts = target_directory().join("board");
        let mut command = Toolchain::find(&self.core)?.cargo_into(subcommand, &artefacts)?;
        command.current_dir(self.folder());
        command.args(["--release", "--locked"]);
        Ok(command)
    }

    /// Builds the image.
    ///
    /// # Errors
    /// Fails if no compiler for the target is found, or if the build fails.
    pub fn build(&self) -> Result<Image> {
        let _heartbeat = Heartbeat::new(format!("the build of the board {}", self.name));
        let status = self.cargo("build")?.stdin(Stdio::null()).status();
        let status = status.with_context(|| format!("cargo did not start: {REMEDY}"))?;
        ensure!(
            status.success(),
            "building the board {} failed ({status}): {REMEDY}",
            self.name
        );
        let folder = target_directory().join("board").join(self.core.target);
        let path = folder.join("release").join(self.name);
        let elf = std::fs::read(&path).with_context(|| format!("reading {}", path.display()))?;
        Ok(Image {
            core: self.core,
            path,
            elf,
        })
    }
}
