//! What `--all` adds: every core in both precisions, budgets, the package, faults, hostile inputs, fuzzing, Miri, fleets and studies.

use super::{
    programs::{self, Built},
    publishing,
    stages::Stages,
};
use crate::{bench, firmware::workspace, fleet, fuzz, miri, python, study};
use anyhow::Result;

/// The seconds for which each fuzz target runs.
const FUZZING_S: u64 = 10;
/// The orders of the queue's two threads that Miri tries.
const MIRI_SEEDS: u32 = 8;
/// The studies that say most about the whole, in small.
const STUDIES: [&[&str]; 7] = [
    &["calibration", "--records", "20"],
    &["clean", "--records", "10"],
    &["export", "--gyros", "10"],
    &["export", "--walks", "--gyros", "20"],
    &["export", "--consumers"],
    &["five-terms", "--records", "20"],
    &["theory", "--records", "300"],
];

pub(crate) fn run(stages: &mut Stages, built: &Built) -> Result<()> {
    publishing::run(stages)?;
    stages.run("budgets of every core", bench::check_budgets)?;
    stages.run("the programs of the host, thoroughly", || {
        programs::host(built, true)
    })?;
    stages.run("the wheel for Python", || python::run(&[]))?;
    for target in fuzz::targets(&workspace().join("host-tests/fuzz"))? {
        stages.run(&format!("fuzzing of {target}"), || {
            fuzz::fuzz(&target, FUZZING_S, 1)
        })?;
    }
    stages.run("Miri", || miri::miri(MIRI_SEEDS))?;
    stages.run("studies", study::test)?;
    for arguments in STUDIES {
        let name = match arguments.get(1) {
            Some(&option @ ("--walks" | "--consumers")) => format!("the study export {option}"),
            _ => format!("the study {}", arguments[0]),
        };
        stages.run(&name, || study::in_small(arguments))?;
    }
    stages.run("fleets", || fleet::run(&[]))
}
