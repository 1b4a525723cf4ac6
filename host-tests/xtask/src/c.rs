//! Builds the library for C.

use crate::{
    firmware::{
        CORES, Core,
        c_library::{self, Contents, library},
    },
    setup,
};
use anyhow::Result;
use std::path::Path;

/// Builds the library for the targets, or for every core if none is named, and puts each beside the header and a package of
/// CMake into a folder of its own.
pub(crate) fn run(contents: Contents, targets: &[String], output: &Path) -> Result<()> {
    println!("== set-up");
    setup::compiler()?;
    let is_wanted = |core: &&Core| targets.is_empty() || targets.iter().any(|it| it == core.target);
    let mut cores: Vec<&Core> = CORES.iter().filter(is_wanted).collect();
    cores.dedup_by_key(|core| core.target);
    for core in cores {
        let to = output.join(core.target);
        let library = library(core, contents)?;
        let package = c_library::package(&library, contents, &to)?;
        println!("{}: {}", core.name, package.display());
    }
    for define in contents.defines() {
        println!("compile C code with -D{define}, unless CMake does");
    }
    Ok(())
}

/// The targets that the library is built for.
pub(crate) fn targets() -> clap::builder::PossibleValuesParser {
    let mut targets = CORES.map(|core| core.target).to_vec();
    targets.dedup();
    targets.into()
}
