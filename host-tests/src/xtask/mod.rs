//! What `cargo xtask` does: set up, test, measure.

mod bench;
mod setup;
mod step;
mod test;

use anyhow::Result;
use clap::{Parser, Subcommand};

/// Chores of the project.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
pub struct CommandLine {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    /// Install what this machine lacks to build and run the images.
    Setup,
    /// Set up, then check and test everything.
    Test,
    /// Measure instructions, memory and time. QEMU counts instructions, not cycles.
    Bench {
        /// Print JSON instead of a table.
        #[arg(long)]
        json: bool,
    },
}

impl CommandLine {
    /// Does the task.
    ///
    /// # Errors
    /// The first step that failed.
    pub fn run(self) -> Result<()> {
        match self.task {
            Task::Setup => setup::run(),
            Task::Test => test::run(),
            Task::Bench { json } => bench::run(json),
        }
    }
}
