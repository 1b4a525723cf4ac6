//! Which shape of an effect explains a curve best, and which shapes explain it nearly as well.
//!
//! The profile of a shape parameter is χ² as a function of the parameter, with all coefficients fitted
//! anew at every value. A [`GridSearch`](search::GridSearch) finds its minimum, a [`Refinement`](refinement::Refinement)
//! polishes a minimum, and a [`JointInterval`] finds
//! the interval around it. Each of them does a few
//! evaluations per call, so that a caller can do something else in between.

mod grid;
mod interval;
mod likelihood;
mod refinement;
mod search;

pub(crate) use grid::Grid;
pub(crate) use interval::JointInterval;
pub(crate) use likelihood::{Evaluation, Profile};

/// The number of evaluations of a profile in one call, with so many bins of a spectrum. On a Cortex-M4F, an evaluation
/// takes some 40 000 instructions with octaves alone, and four times as many with a spectrum. Chosen by hand, so that a
/// call stays below 1 million instructions (`cargo xtask bench`).
const fn evaluations_a_call(bins: usize) -> u32 {
    if bins == 0 { 8 } else { 4 }
}

#[cfg(test)]
mod tests;
