//! What a lot of many devices costs.

use allanite_studies::{
    long::Program,
    lot::{AXES, judge, write},
    resources::commit,
};
use anyhow::Result;
use std::{path::Path, time::Instant};

pub(crate) fn print(devices: u64, folder: Option<&Path>, program: &Program) -> Result<()> {
    let temporary = tempfile::tempdir()?;
    let folder = folder.unwrap_or(temporary.path());
    let begun = Instant::now();
    // What a run before this one has written is judged again.
    if !folder.join("now").exists() {
        write(folder, devices, program)?;
        println!("devices written in {:.0} s", begun.elapsed().as_secs_f64());
    }
    let cost = judge(folder, program)?;
    println!(
        "commit {}: {devices} devices of {AXES} axes judged in {:.1} s, with at most {:.0} MB of memory",
        commit(),
        cost.wall_s,
        1e-6 * cost.peak_bytes
    );
    for (file, bytes) in &cost.sizes {
        println!("{file}: {:.2} MB", 1e-6 * *bytes as f64);
    }
    for line in &cost.said {
        println!("  {line}");
    }
    Ok(())
}
