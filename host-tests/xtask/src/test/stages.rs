//! The stages of a run, and how long each of them takes.

use anyhow::{Result, bail};
use comfy_table::{CellAlignment, Table, presets};
use std::time::{Duration, Instant};

/// What has run so far.
pub(crate) struct Stages {
    /// Whether a failed stage lets the next one run.
    goes_on: bool,
    /// A part of the name of the first stage to run, until that one has begun.
    first: Option<String>,
    begun: Instant,
    done: Vec<Stage>,
}

struct Stage {
    name: String,
    time: Duration,
    failed: bool,
}

impl Stages {
    /// No stage has run. If `goes_on` is set, a failed stage ends the run only after all others. The stages before the one whose
    /// name holds `first` are left out, as those of a run that was interrupted.
    pub(crate) fn new(goes_on: bool, first: Option<String>) -> Self {
        Self {
            goes_on,
            first,
            begun: Instant::now(),
            done: Vec::new(),
        }
    }

    /// Runs a stage and prints how long it took.
    ///
    /// # Errors
    /// Fails if the stage fails and nothing is to run after it.
    pub(crate) fn run(&mut self, name: &str, stage: impl FnOnce() -> Result<()>) -> Result<()> {
        if let Some(first) = &self.first {
            if !name.contains(first.as_str()) {
                return Ok(());
            }
            self.first = None;
        }
        self.needed(name, stage)
    }

    /// Runs a stage that others need, and that is never left out.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub(crate) fn needed(&mut self, name: &str, stage: impl FnOnce() -> Result<()>) -> Result<()> {
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
        if let Some(first) = &self.first {
            bail!("no stage has a name with `{first}`: a run prints its stages behind `==`");
        }
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
        let mut short = Stages::new(false, None);
        assert!(short.run("sound", || Ok(())).is_ok());
        assert!(short.run("broken", || bail!("no")).is_err());
        let mut long = Stages::new(true, None);
        for name in ["broken", "worse"] {
            assert!(long.run(name, || bail!("no")).is_ok());
        }
        assert!(long.run("sound", || Ok(())).is_ok());
        let said = long.end().unwrap_err().to_string();
        assert_eq!(said, "2 of 3 stages failed: broken; worse");
    }
    #[test]
    fn an_interrupted_run_goes_on_where_it_ended() {
        let mut stages = Stages::new(true, Some("Miri".to_owned()));
        let mut run = Vec::new();
        for name in ["format", "fuzzing", "Miri", "fleets"] {
            let done = stages.run(name, || {
                run.push(name);
                Ok(())
            });
            assert!(done.is_ok());
        }
        assert!(stages.end().is_ok());
        assert_eq!(run, ["Miri", "fleets"]);
        let mut stages = Stages::new(true, Some("Mira".to_owned()));
        assert!(stages.run("Miri", || bail!("never")).is_ok());
        assert!(stages.needed("the build", || Ok(())).is_ok());
        let said = stages.end().unwrap_err().to_string();
        assert!(
            said.starts_with("no stage has a name with `Mira`"),
            "{said}"
        );
    }
}
