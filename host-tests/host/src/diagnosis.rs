//! Diagnoses in a program that has nothing else to do meanwhile.

use allanite::{
    Error, Model, Record,
    diagnosis::{Diagnosis, Options, Step, Verdict},
    effect::Effect,
};
use std::ops::ControlFlow;

/// A pause in which nothing is done.
pub fn go_on() -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Does a whole diagnosis, and calls `report` for every step.
///
/// # Errors
/// As of [`Diagnosis::run`].
pub fn diagnose<'a, const K: usize, const B: usize>(
    record: impl Into<Record<'a, K, B>>,
    model: &Model,
    effects: &'a [&'static dyn Effect],
    options: Options,
    mut report: impl FnMut(&Step<K, B>),
) -> Result<Verdict, Error> {
    let mut diagnosis = Diagnosis::new(record, model, effects, options);
    loop {
        // A pause that never ends the work leads to a verdict.
        if let Some(verdict) = diagnosis.run(&mut report, &mut go_on)? {
            return Ok(verdict);
        }
    }
}
