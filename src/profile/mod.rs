//! Which shape of an effect explains a curve best, and which shapes explain it nearly as well.
//!
//! The profile of a shape parameter is χ² as a function of it, all coefficients fitted anew at every
//! value. A [`GridSearch`] finds its minimum, a [`Refinement`] polishes one, a [`JointInterval`] bounds
//! the values around it. Each does a few evaluations a call, so that a caller can do something else in
//! between.

mod grid;
mod interval;
mod likelihood;
mod refinement;
mod search;

pub(crate) use interval::JointInterval;
pub(crate) use likelihood::{Evaluation, Found, Profile};
pub(crate) use search::GridSearch;

/// Evaluations of a profile that one call does: some 40 000 instructions each on a Cortex-M4F.
const EVALUATIONS_A_CALL: u32 = 8;

#[cfg(test)]
mod tests;
