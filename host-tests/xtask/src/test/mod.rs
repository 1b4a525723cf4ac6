//! Checks a change: in less than half an hour what a change can break, and with `--all` everything that the project promises.
//!
//! Builds take longer than tests, so that each crate is built once: xtask, the tests, the programs and the package for Python share a profile and
//! a folder, and the images of a precision are built by one command. The table in `host-tests/doc/promises.md` names for each promise
//! the test that watches it in every run, and the test of `--all` that proves it.

mod lints;
mod programs;
mod publishing;
mod stages;
mod thorough;

use crate::{
    firmware::{CORES, CORTEX_M4F, Core, RISCV, image},
    python, setup,
};
use anyhow::Result;
use programs::Built;
use stages::Stages;

/// The images that each run builds and tests, on three cores: one without hardware for division and floats, one with floats in
/// hardware, and one of another architecture.
const IMAGES: [&str; 1] = ["characterise"];
/// Those that need more RAM than the smallest core has.
const LARGE_IMAGES: [&str; 1] = ["product"];
/// Those that are measured on the smallest core.
const MEASURED_IMAGES: [&str; 5] = [
    "bench",
    "footprint_fit",
    "footprint_five_terms",
    "footprint_screened",
    "footprint_self_test",
];
/// Those that are examined on one core.
const EXAMINED_IMAGES: [&str; 4] = [
    "footprint_everything",
    "footprint_five_terms",
    "footprint_self_test",
    "race",
];

pub(crate) fn run(all: bool, first: Option<String>) -> Result<()> {
    // The short run ends with the first failure; the long one shows all of them.
    let mut stages = Stages::new(all, first);
    stages.run("set-up", setup::run)?;
    lints::run(&mut stages, all)?;
    stages.run("the library in both precisions", programs::library)?;
    stages.run("the images for three cores", images)?;
    let mut built = Built::default();
    stages.needed("the build of the programs of the host", || {
        built = Built::new()?;
        Ok(())
    })?;
    stages.run("the programs of the host", || programs::host(&built, false))?;
    stages.run("Python", || python::test(&built.python()?))?;
    if all {
        thorough::run(&mut stages, &built)?;
    }
    stages.end()
}

/// Builds the images before the tests run them, several at once.
fn images() -> Result<()> {
    let [small, others] = [[CORES[0]].as_slice(), &[CORTEX_M4F, RISCV]];
    let profile = "firmware";
    let cores: Vec<Core> = [small, others].concat();
    image::build_all(&IMAGES, &cores, profile)?;
    image::build_all(&LARGE_IMAGES, others, profile)?;
    image::build_all(&MEASURED_IMAGES, small, profile)?;
    image::build_all(&EXAMINED_IMAGES, &[CORTEX_M4F], profile)
}
