//! Builds the images of `src/bin` for a core and runs them in QEMU.

pub mod agreement;
pub mod board;
pub mod budgets;
pub mod c_library;
mod core;
pub mod emulator;
pub mod figures;
mod heartbeat;
pub mod image;
pub mod measure;
pub mod toolchain;

pub use board::{BOARDS, Board};
pub use core::{CORES, CORTEX_M4F, Core, Precision, RISCV};
pub use emulator::{Run, run, run_with, start};
pub use heartbeat::{Heartbeat, PERIOD};
pub use image::Image;
pub use toolchain::{Toolchain, Way, host_target_directory, target_directory};

/// The remedy at the end of every failure to build or run an image.
pub const REMEDY: &str = "`cargo xtask setup` installs what is missing";

/// The folder of the workspace. A program that others install has another name for it, from `cargo xtask dist`, and does not tell
/// where it was built.
pub fn workspace() -> &'static std::path::Path {
    if let Some(named) = option_env!("ALLANITE_SOURCES") {
        return std::path::Path::new(named);
    }
    let here = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    here.ancestors().nth(2).unwrap_or(here)
}

/// The cargo that runs this program, or else the one on the path.
pub fn cargo() -> std::process::Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = std::process::Command::new(cargo);
    command.current_dir(workspace());
    command
}
