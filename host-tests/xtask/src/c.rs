//! Builds the library for C.

use crate::{
    firmware::{
        CORES, Core,
        c_library::{feature, folder, library},
    },
    setup,
};
use anyhow::{Context as _, Result};
use std::path::Path;

/// Builds the library for every core, and puts each beside the header into a folder of its own.
pub(crate) fn run(octaves: u32, output: &Path) -> Result<()> {
    println!("== set-up");
    setup::run()?;
    let mut cores: Vec<&Core> = CORES.iter().collect();
    cores.dedup_by_key(|core| core.target);
    for core in cores {
        let to = output.join(core.target);
        std::fs::create_dir_all(&to)
            .and_then(|()| {
                std::fs::copy(folder().join("include/allanite.h"), to.join("allanite.h"))
            })
            .with_context(|| format!("writing to {}", to.display()))?;
        let library = library(core, octaves)?;
        let copy = to.join("liballanite_c.a");
        std::fs::copy(&library, &copy).with_context(|| format!("writing {}", copy.display()))?;
        println!("{}: {}", core.name, copy.display());
    }
    if let Some(feature) = feature(octaves) {
        let define = feature.replace('-', "_").to_uppercase();
        println!("compile C code with -DALLANITE_{define}");
    }
    Ok(())
}
