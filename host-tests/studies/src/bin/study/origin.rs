//! Where the figures of a study come from.

use allanite_studies::resources::commit;
use serde::Serialize;
use std::time::Instant;

/// What it takes to repeat a study.
#[derive(Serialize)]
pub(crate) struct Origin {
    study: &'static str,
    /// The first and the last seed.
    seeds: [u64; 2],
    commit: String,
    seconds: f64,
    cores: usize,
}

impl Origin {
    /// The origin of a study that began at an instant and has just ended, with records of these seeds.
    pub(crate) fn new(study: &'static str, seeds: [u64; 2], begun: Instant) -> Self {
        Self {
            study,
            seeds,
            commit: commit(),
            seconds: begun.elapsed().as_secs_f64(),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
        }
    }
}

impl std::fmt::Display for Origin {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            seeds: [first, last],
            commit,
            seconds,
            cores,
            ..
        } = self;
        write!(
            f,
            "seeds {first} to {last}; commit {commit}; {seconds:.0} s on {cores} cores"
        )
    }
}

/// Prints the rows of a study as one JSON object, with their origin.
pub(crate) fn print_json(origin: Origin, rows: &impl Serialize) -> anyhow::Result<()> {
    #[derive(Serialize)]
    struct Study<'a, T> {
        #[serde(flatten)]
        origin: Origin,
        rows: &'a T,
    }
    println!("{}", serde_json::to_string(&Study { origin, rows })?);
    Ok(())
}
