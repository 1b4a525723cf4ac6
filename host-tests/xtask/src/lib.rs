//! The tasks of `cargo xtask`, set up, test and measure, and the images that they build and run.

pub mod firmware;

mod bench;
mod c;
pub mod cost;
#[cfg(feature = "dist")]
mod dist;
mod fleet;
mod fuzz;
mod hooks;
mod miri;
pub mod page;
mod python;
mod results;
mod setup;
mod soak;
mod step;
mod study;
mod supply_chain;
mod test;
pub mod watch;

pub use setup::CHROMIUM;

use anyhow::Result;
use clap::{Parser, Subcommand};
use firmware::c_library::Contents;
use std::path::PathBuf;

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
    /// Set up, then check and test what a change can break, in less than half an hour.
    Test {
        /// Test everything that the project promises, which takes hours: every core in both precisions, budgets, the package, the
        /// oldest compiler, injected faults, hostile inputs, fuzzing, Miri, studies and fleets.
        #[arg(long)]
        all: bool,
        /// Leave out the stages before this one, which a run that was interrupted has passed: a part of the name that stands
        /// behind `==`.
        #[arg(long, value_name = "STAGE")]
        from: Option<String>,
    },
    /// Run a study behind the figures of the pages: `cargo xtask study help` lists them.
    Study {
        /// The study and its options; `--help` lists them.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true, required = true)]
        arguments: Vec<String>,
    },
    /// Watch a gyro that an image simulates in QEMU, with `allanite watch`.
    Watch {
        /// The program `allanite` to watch with; without it, it is built.
        #[arg(long, value_name = "PROGRAM")]
        program: Option<PathBuf>,
        /// Arguments for `watch`, such as `--rate 100 --scale 0.00763`.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Accumulate samples with gaps, snapshots, power cuts and merges at random, and compare every sum with its
    /// definition.
    Soak {
        /// The number of samples.
        #[arg(long, default_value_t = 100_000_000)]
        samples: u64,
        /// The seed of samples and faults.
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// The number of samples before the first fault. The accumulator's counter laps at 2^32 samples.
        #[arg(long, default_value_t = 0)]
        first: u64,
        /// Run on a Cortex-M4F in QEMU instead of this machine.
        #[arg(long)]
        target: bool,
    },
    /// Give a fuzz target inputs that reach ever more of the code, until time is over or one fails. This needs
    /// rustup's nightly, and installs cargo-fuzz if it is missing.
    Fuzz {
        /// The target, a file of host-tests/fuzz/targets.
        target: String,
        /// The time to run, in seconds.
        #[arg(long, default_value_t = 120)]
        seconds: u64,
        /// The seed of the inputs.
        #[arg(long, default_value_t = 1)]
        seed: u32,
    },
    /// Run the queue between two threads, and the tests of sums and storage, in Miri, which reports races and undefined
    /// behaviour. Each seed is another order of the threads' steps. This needs rustup's nightly.
    Miri {
        /// The number of seeds.
        #[arg(long, default_value_t = 64)]
        seeds: u32,
    },
    /// Check the licences, versions, sources and known vulnerabilities of all crates with cargo-deny, which is installed if missing.
    Deny {
        /// A clone of the database of vulnerabilities, for a machine that does not reach it.
        #[arg(long, value_name = "FOLDER")]
        database: Option<PathBuf>,
    },
    /// Check that the library builds with the oldest versions that it allows. This needs rustup's nightly.
    MinimalVersions,
    /// Build an image twice from nothing, in different folders, and compare the bytes.
    Reproduce,
    /// Measure instructions, memory and time. QEMU counts instructions, not cycles.
    Bench {
        /// Print JSON instead of a table.
        #[arg(long)]
        json: bool,
        /// Write the figures of the target to host-tests/budgets.json, which the tests compare
        /// with.
        #[arg(long, conflicts_with = "json")]
        update_budgets: bool,
        /// Measure one core alone, such as Cortex-M4F, and print JSON.
        #[arg(long, value_name = "NAME", conflicts_with_all = ["json", "update_budgets"])]
        core: Option<String>,
        /// Seek the fit and the look that cost most among a thousand each, which takes minutes.
        #[arg(long, requires = "core")]
        worst: bool,
    },
    /// Build the static library for C, and put it beside its header and a package of CMake.
    C {
        /// Octaves of averaging time of a record.
        #[arg(long, default_value = "20", value_parser = ["14", "20", "26"])]
        octaves: String,
        /// One axis and the five terms alone, for a core with 32 KiB of flash.
        #[arg(long)]
        one_axis: bool,
        /// Target to build for, such as thumbv7em-none-eabihf; may be given several times. Without it, all are built.
        #[arg(long = "target", value_name = "TARGET", value_parser = c::targets())]
        targets: Vec<String>,
        /// Folder to write to, with a folder for every target in it.
        #[arg(long, value_name = "FOLDER", default_value = "target/c")]
        output: PathBuf,
    },
    /// Build the page that reads logs without a server: one file, which any browser opens. This needs rustup.
    Page {
        /// The file to write.
        #[arg(long, value_name = "FILE", default_value = "target/allanite.html")]
        output: PathBuf,
    },
    /// Build the package for Python as a wheel in target/wheels, and test it in a virtual environment in target/python. This
    /// needs Python from 3.10 on and the network.
    Python {
        /// Arguments for pytest, such as `-k arrow`.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Build and test the functions for fleets on DataFusion and Ballista, in target/fleet. The engine takes half an hour to build the
    /// first time.
    Fleet {
        /// Arguments for the tests, such as a part of a name.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Pack the program for others to install: a static program, its completions, its manual, a package for Debian, an
    /// archive, the list of its parts (CycloneDX), and checksums. SOURCE_DATE_EPOCH, or else the last commit, is their time.
    #[cfg(feature = "dist")]
    Dist {
        /// Build everything once more from nothing, in another folder, and compare the bytes.
        #[arg(long)]
        check: bool,
        /// Folder to write to.
        #[arg(long, value_name = "FOLDER", default_value = "target/dist")]
        output: PathBuf,
    },
    /// Ask the command line everything about some 70 records, and compare the answers with those of an earlier run: for
    /// changes that should change no result.
    Results {
        /// The folder to write records and answers to.
        folder: PathBuf,
        /// The folder of an earlier run.
        #[arg(long, value_name = "FOLDER")]
        against: Option<PathBuf>,
        /// Logs and curve files to ask about as well.
        files: Vec<PathBuf>,
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
            Task::Test { all, from } => test::run(all, from),
            Task::Study { arguments } => study::run(&arguments),
            Task::Watch { program, arguments } => watch::run_watch(program.as_deref(), &arguments),
            Task::Soak {
                samples,
                seed,
                first,
                target,
            } => soak::run([samples, seed, first], target),
            Task::Fuzz {
                target,
                seconds,
                seed,
            } => fuzz::fuzz(&target, seconds, seed),
            Task::Miri { seeds } => miri::miri(seeds),
            Task::Deny { database } => supply_chain::deny(database.as_deref()),
            Task::MinimalVersions => supply_chain::minimal_versions(),
            Task::Reproduce => supply_chain::reproduce(),
            Task::Bench {
                json,
                update_budgets,
                core,
                worst,
            } => match core {
                Some(core) => bench::of_core(&core, worst),
                None => bench::run(json, update_budgets),
            },
            Task::C {
                octaves,
                one_axis,
                targets,
                output,
            } => {
                let octaves = octaves.parse().unwrap_or(20);
                c::run(Contents { octaves, one_axis }, &targets, &output)
            }
            Task::Page { output } => page::page(&output),
            Task::Python { arguments } => python::run(&arguments),
            Task::Fleet { arguments } => fleet::run(&arguments),
            #[cfg(feature = "dist")]
            Task::Dist { check, output } => dist::run(&output, check),
            Task::Results {
                folder,
                against,
                files,
            } => results::run_all(&folder, against.as_deref(), &files),
            Task::Cost(product) => cost::run(&product),
        }
    }
}
