//! The tasks of `cargo xtask`, set up, test and measure, and the images that they build and run.

pub mod firmware;

mod bench;
mod c;
pub mod cost;
mod setup;
mod step;
mod test;

pub use setup::CHROMIUM;

use anyhow::Result;
use clap::{Parser, Subcommand};
use firmware::cargo;

/// Tasks of the project.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
pub struct CommandLine {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    /// Install what this machine lacks to build, run and test everything.
    Setup,
    /// Set up, then check and test everything.
    Test,
    /// Run a study behind the README's figures: theory, coefficients, calibration, paper, hidden-effect,
    /// confusion, detection, lines, clean, course, thermal, self-test or precision.
    Study {
        /// The study and its options; `--help` lists them.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true, required = true)]
        arguments: Vec<String>,
    },
    /// Measure instructions, memory and time. QEMU counts instructions, not cycles.
    Bench {
        /// Print JSON instead of a table.
        #[arg(long)]
        json: bool,
        /// Write the figures of the target to host-tests/budgets.json, which the tests compare
        /// with.
        #[arg(long, conflicts_with = "json")]
        update_budgets: bool,
    },
    /// Build the static library for C for every core, and put it beside its header.
    C {
        /// Octaves of averaging time of a record.
        #[arg(long, default_value = "20", value_parser = ["14", "20", "26"])]
        octaves: String,
        /// Folder to write to, with a folder for every target in it.
        #[arg(long, value_name = "FOLDER", default_value = "target/c")]
        output: std::path::PathBuf,
    },
    /// Add up what a product costs on a core, by the figures of `bench`, and say whether it fits.
    Cost(cost::Product),
}

impl CommandLine {
    /// The product of the task `cost`.
    pub fn product(self) -> Option<cost::Product> {
        match self.task {
            Task::Cost(product) => Some(product),
            _ => None,
        }
    }

    /// Runs the task.
    ///
    /// # Errors
    /// Fails with the first step that fails.
    pub fn run(self) -> Result<()> {
        match self.task {
            Task::Setup => setup::run(),
            Task::Test => test::run(),
            Task::Study { arguments } => {
                let mut study = cargo();
                study.args(["run", "--release", "--package", "host-tests"]);
                study.args(["--no-default-features", "--features", "study"]);
                study.args(["--bin", "study", "--"]).args(arguments);
                step::step("the study", &mut study)
            }
            Task::Bench {
                json,
                update_budgets,
            } => bench::run(json, update_budgets),
            Task::C { octaves, output } => c::run(octaves.parse().unwrap_or(20), &output),
            Task::Cost(product) => cost::run(&product),
        }
    }
}
