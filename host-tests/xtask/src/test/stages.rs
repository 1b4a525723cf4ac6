//! The stages of a run, and how long each of them takes.

use anyhow::{Result, bail};
use comfy_table::{CellAlignment, Table, presets};
use std::time::{Duration, Instant};

/// What has run so far.
pub(crate) struct Stages {
    /// Whether a failed stage lets the next one run.
    goes_on: bool,
    begun: Instant,
    done: Vec<Stage>,
}

struct Stage {
    name: String,
    time: Duration,
    failed: bool,
}

impl Stages {
    /// No stage has run. If `goes_on` is set, a failed stage ends the run only after all others.
    pub(crate) fn new(goes_on: bool) -> Self {
        Self {
            goes_on,
            begun: Instant::now(),
            done: Vec::new(),
        }
    }

    /// Runs a stage and prints how long it took.
    ///
    /// # Errors
    /// Fails if the stage fails and nothing is to run after it.
    pub(crate) fn run(&mut self, name: &str, stage: impl FnOnce() -> Result<()>) -> Result<()> {
        println!("\n== {name}");
        let begun = Instant::now();
        let result = stage();
        let time = begun.elapsed();
        println!("      {name}: {} s", time.as_secs());
        self.done.push(Stage {
            name: name.to_owned(),
            time,
            failed: result.is_err(),
        });
        match result {
            Err(error) if self.goes_on => println!("\nFAILED: {name}: {error:#}"),
            Err(error) => {
                println!("\n{}", self.table());
                return Err(error);
            }
            Ok(()) => {}
        }
        Ok(())
    }

    /// Prints the stages and their times.
    ///
    /// # Errors
    /// Names the stages that failed.
    pub(crate) fn end(&self) -> Result<()> {
        println!("\n{}", self.table());
        let failed = self.done.iter().filter(|stage| stage.failed);
        let failed: Vec<&str> = failed.map(|stage| stage.name.as_str()).collect();
        if !failed.is_empty() {
            bail!(
                "{} of {} stages failed: {}",
                failed.len(),
                self.done.len(),
                failed.join("; ")
            );
        }
        println!("\nall passed");
        Ok(())
    }

    /// A row for each stage, and one for all of them.
    fn table(&self) -> Table {
        let mut table = Table::new();
        table
            .load_style(presets::NOTHING)
            .set_header(["stage", "seconds", ""]);
        for stage in &self.done {
            let end = if stage.failed { "failed" } else { "" };
            table.add_row([&stage.name, &stage.time.as_secs().to_string(), end]);
        }
        let all = self.begun.elapsed().as_secs();
        table.add_row(["all stages", &all.to_string(), ""]);
        if let Some(times) = table.column_mut(1) {
            times.set_cell_alignment(CellAlignment::Right);
        }
        table
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_run_ends_with_the_first_failure_and_a_long_one_names_all() {
        let mut short = Stages::new(false);
        assert!(short.run("sound", || Ok(())).is_ok());
        assert!(short.run("broken", || bail!("no")).is_err());
        let mut long = Stages::new(true);
        for name in ["broken", "worse"] {
            assert!(long.run(name, || bail!("no")).is_ok());
        }
        assert!(long.run("sound", || Ok(())).is_ok());
        let said = long.end().unwrap_err().to_string();
        assert_eq!(said, "2 of 3 stages failed: broken; worse");
    }
}
